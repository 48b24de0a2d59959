//! Outputs of commands: no command writes to its input under any name, files are written completely, and outputs that would block are refused.

use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::calibrate::{CONFIG, TOUCHES, counts, sets};
use super::program::{directory, stderr, stdout, vibrissa, without_origin};

const LIBRARY: &str = "library laws\nlet still(w: whisker) = not w.touching\n";
const POLICY: &str = "machine quick\nuse \"laws.fsm\" (still)\n\
    whisker r0  param speed = 5 cm/s in 1 cm/s .. 10 cm/s\ninitial Going\n\
    state Going {\n  steer r0 along vector(1, 0) at speed turning 0 deg/s\n  after 0.1 s -> Failure(\"over\")\n\
    when not still(r0) -> Failure(\"touched\")\n}\n\
    test \"it fails\" in \"scene.yaml\" { expect run.failed }\n";

/// A folder with files of every kind that commands read.
pub(super) fn folder(name: &str) -> PathBuf {
    let folder = directory(name);
    let scene = "name: scene\nworld: quasistatic\npolicy: quick.fsm\n\
        rig: {whiskers: {r0: {calibration: r0.yaml}, l0: {}}}\n\
        objects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
        start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 1 s}\nexpect: {outcome: failed}\n";
    let sweep = "name: small\npolicies: [quick.fsm]\nscenes: [{scenario: scene.yaml}]\n\
        vary: {policy: {speed: [4 cm/s, 5 cm/s]}}\n";
    let property = "machine prop  param speed = 5 cm/s in 1 .. 10 cm/s  initial Still  state Still { stop }\n\
        property \"it holds\" over thin-wall { expect run.time > 0 s }\n";
    let regressions = "- {property: \"another\", family: thin-wall, values: {speed: 5 cm/s}}\n";
    let calibration = "vibrissa_calibration: 2\nabout: a test\nhinge_stiffness: 1.1\n";
    for (name, text) in [
        ("quick.fsm", POLICY),
        ("laws.fsm", LIBRARY),
        ("scene.yaml", scene),
        ("r0.yaml", calibration),
        ("small.yaml", sweep),
        ("prop.fsm", property),
        ("prop.regressions.yaml", regressions),
        ("measured.csv", &sets()),
        ("counts.csv", &counts()),
        ("array.yaml", CONFIG),
        ("pressed.csv", TOUCHES),
    ] {
        fs::write(folder.join(name), text).unwrap();
    }
    folder
}

/// A command line in which `@` stands for a folder.
pub(super) fn in_folder(folder: &Path, line: &str) -> std::process::Output {
    let words: Vec<_> = line.split(' ').map(|word| word.replace('@', folder.to_str().unwrap())).collect();
    vibrissa(&words.iter().map(String::as_str).collect::<Vec<_>>())
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// Commands with an input that the place of an output is made to be.
const ONTO_INPUTS: &[(&str, &str, &str, &str)] = &[
    // command, input, output, argument
    ("run @/scene.yaml --ticks @/OUT", "scene.yaml", "OUT", "--ticks"),
    ("run @/scene.yaml --ticks @/OUT", "r0.yaml", "OUT", "--ticks"),
    ("run @/scene.yaml --ticks @/OUT", "quick.fsm", "OUT", "--ticks"),
    ("run @/scene.yaml --ticks @/OUT", "laws.fsm", "OUT", "--ticks"),
    ("run @/scene.yaml --policy @/quick.fsm --ticks @/OUT", "quick.fsm", "OUT", "--ticks"),
    #[cfg(feature = "render")]
    ("run @/scene.yaml --video @/run.gif", "scene.yaml", "run.gif", "--video"),
    ("run @/scene.yaml --out @", "laws.fsm", "scene.svg", "--out"),
    ("run @/scene.yaml --out @", "scene.yaml", "scene.json", "--out"),
    ("run @/scene.yaml --out @", "scene.yaml", "scene.retrievals.svg", "--out"),
    ("test @/quick.fsm --out @", "quick.fsm", "01-it-fails.json", "--out"),
    ("test @/quick.fsm --out @", "scene.yaml", "01-it-fails.svg", "--out"),
    ("test @/prop.fsm --out @", "prop.regressions.yaml", "01-it-holds.yaml", "--out"),
    ("test @/prop.fsm --out @", "prop.fsm", "01-it-holds.svg", "--out"),
    ("graph @/quick.fsm -o @/OUT", "quick.fsm", "OUT", "--out"),
    ("graph @/quick.fsm -o @/OUT", "laws.fsm", "OUT", "--out"),
    ("compile @/quick.fsm -o @/OUT", "quick.fsm", "OUT", "--out"),
    ("compile @/quick.fsm -o @/OUT", "laws.fsm", "OUT", "--out"),
    ("drive @/quick.fsm --emulate @/scene.yaml --record @/OUT", "quick.fsm", "OUT", "--record"),
    ("drive @/quick.fsm --emulate @/scene.yaml --record @/OUT", "scene.yaml", "OUT", "--record"),
    ("setup services generate @/quick.fsm --out @", "quick.fsm", "env.example", "--out"),
    ("setup services generate @/quick.fsm --out @ --config @/array.yaml", "array.yaml", "compose.yaml", "--out"),
    ("calibrate @/measured.csv --out @", "measured.csv", "sets.csv", "--out"),
    ("calibrate --touches @/pressed.csv --out @", "pressed.csv", "touches.csv", "--out"),
    ("calibrate --touches @/pressed.csv --out @", "pressed.csv", "l0.yaml", "--out"),
    ("calibrate @/measured.csv --rig @/scene.yaml --out @", "scene.yaml", "calibration.yaml", "--out"),
    ("calibrate @/measured.csv --rig @/scene.yaml --out @", "r0.yaml", "profile.svg", "--out"),
    (
        "calibrate @/counts.csv --config @/array.yaml --neutral -812 --whisker l0 --out @",
        "array.yaml",
        "robot.yaml",
        "--out",
    ),
    ("bench --ideal --policy @/quick.fsm --simulator quasistatic --out @", "laws.fsm", "results.json", "--out"),
    ("bench --ideal --policy @/quick.fsm --simulator quasistatic --out @", "quick.fsm", "disk-quick.svg", "--out"),
    ("bench --ideal --policy @/quick.fsm --simulator quasistatic --out @", "quick.fsm", "unfinished.jsonl", "--out"),
    ("run @/scene.yaml --out @", "quick.fsm", "index.html", "--out"),
    ("compare @/quick.fsm policies/thesis.fsm @/scene.yaml --out @", "scene.yaml", "results.json", "--out"),
    (
        "families polygon --count 1 --policy @/quick.fsm --simulator quasistatic --out @",
        "laws.fsm",
        "polygon-0.svg",
        "--out",
    ),
    (
        "families polygon --count 1 --policy @/quick.fsm --simulator quasistatic --out @",
        "quick.fsm",
        "results.jsonl",
        "--out",
    ),
    (
        "study pareto @/scene.yaml --policy @/quick.fsm --repeats 1 --out @",
        "scene.yaml",
        "scene-quick-pareto.json",
        "--out",
    ),
    (
        "study pareto @/scene.yaml --policy @/quick.fsm --repeats 1 --out @",
        "laws.fsm",
        "scene-quick-pareto.svg",
        "--out",
    ),
    ("tune @/quick.fsm --scene polygon --count 1 --runs 9 --out @", "laws.fsm", "results.jsonl", "--out"),
    ("tune @/quick.fsm --scene polygon --count 1 --runs 9 --out @ --write @/OUT", "quick.fsm", "OUT", "--write"),
    ("study pareto @/scene.yaml --policy @/quick.fsm --repeats 1 --out @", "quick.fsm", "index.html", "--out"),
    ("sweep @/small.yaml --out @", "small.yaml", "results.jsonl", "--out"),
    ("sweep @/small.yaml --out @", "quick.fsm", "index.html", "--out"),
    ("sweep @/small.yaml --out @", "quick.fsm", "results.jsonl", "--out"),
    ("sweep @/small.yaml --out @", "laws.fsm", "results.jsonl", "--out"),
    ("sweep @/small.yaml --out @", "scene.yaml", "results.jsonl", "--out"),
    ("sweep @/small.yaml --out @", "r0.yaml", "results.jsonl", "--out"),
];

#[test]
fn no_command_writes_to_what_it_reads_under_any_name_or_link() {
    let folder = folder("onto-input");
    let inputs = [
        "quick.fsm",
        "laws.fsm",
        "scene.yaml",
        "r0.yaml",
        "small.yaml",
        "measured.csv",
        "counts.csv",
        "array.yaml",
        "pressed.csv",
        "prop.fsm",
        "prop.regressions.yaml",
    ];
    let texts = inputs.map(|name| text(&folder, name));
    for &(line, input, output, argument) in ONTO_INPUTS {
        let place = folder.join(output);
        let by_name = |name: &str| in_folder(&folder, &line.replace("OUT", name));
        let mut refused = vec![];
        if output == "OUT" {
            refused.push(("its name", by_name(input)));
            refused.push(("another path", by_name(&format!("../onto-input/./{input}"))));
        }
        for way in ["a symbolic link", "a hard link"] {
            match way {
                "a symbolic link" => symlink(folder.join(input), &place).unwrap(),
                _ => fs::hard_link(folder.join(input), &place).unwrap(),
            }
            refused.push((way, by_name("OUT")));
            fs::remove_file(&place).unwrap();
        }
        for (way, refused) in refused {
            let told = stderr(&refused);
            assert_eq!(refused.status.code(), Some(2), "{line}, {input} by {way}: {told}");
            for wanted in ["this command reads it as", input, &format!("another path with {argument}")] {
                assert!(told.contains(wanted), "{line}, {input} by {way}: {wanted}: {told}");
            }
        }
        for (name, before) in inputs.iter().zip(&texts) {
            assert_eq!(&text(&folder, name), before, "{line} has changed {name}");
        }
    }
}

#[test]
fn merge_writes_to_none_of_its_inputs() {
    let folder = folder("onto-merged");
    assert_eq!(in_folder(&folder, "sweep @/small.yaml --out @").status.code(), Some(0));
    let before = text(&folder, "results.jsonl");
    symlink(folder.join("results.jsonl"), folder.join("link.jsonl")).unwrap();
    fs::hard_link(folder.join("results.jsonl"), folder.join("hard.jsonl")).unwrap();
    for line in [
        "study merge @/results.jsonl",
        "study merge @",
        "study merge @/results.jsonl --out @/link.jsonl",
        "study merge @/link.jsonl --out @/hard.jsonl",
    ] {
        let refused = in_folder(&folder, line);
        assert_eq!(refused.status.code(), Some(2), "{line}: {}", stderr(&refused));
        assert!(stderr(&refused).contains("this command reads it as"), "{line}: {}", stderr(&refused));
    }
    assert_eq!(text(&folder, "results.jsonl"), before);
    assert_eq!(in_folder(&folder, "study merge @ --out @/merged.jsonl").status.code(), Some(0));
    assert_eq!(text(&folder, "merged.jsonl").lines().count(), before.lines().count());
}

#[test]
fn merge_follows_a_link_to_results_and_says_why_others_will_not_do() {
    let folder = folder("merged-links");
    assert_eq!(in_folder(&folder, "sweep @/small.yaml --out @/done").status.code(), Some(0));
    fs::create_dir(folder.join("linked")).unwrap();
    let results = folder.join("linked/results.jsonl");
    let merge = |words: &str| {
        let output = in_folder(&folder, &format!("study merge @/linked --out @/merged.jsonl{words}"));
        (output.status.code(), stderr(&output))
    };
    assert!(merge("").1.contains("there are no results of a sweep"));
    symlink("../done/results.jsonl", &results).unwrap();
    assert_eq!(merge("").0, Some(0));
    // A sweep adds its results as runs end.
    let [merged, done] = ["merged.jsonl", "done/results.jsonl"].map(|name| {
        let mut lines: Vec<String> = without_origin(&text(&folder, name)).lines().map(str::to_owned).collect();
        lines.sort();
        lines
    });
    assert_eq!(merged, done);
    for (make, reason) in [
        ("ln -s nowhere", "No such file"),
        ("mkfifo", "it is a pipe, not a regular file"),
        ("mkdir", "it is a directory, not a regular file"),
    ] {
        let _ = fs::remove_file(&results);
        let mut words = make.split(' ');
        assert!(Command::new(words.next().unwrap()).args(words).arg(&results).status().unwrap().success());
        let (status, told) = merge("");
        assert_eq!(status, Some(2), "{make}: {told}");
        assert!(told.contains("linked/results.jsonl") && told.contains(reason), "{make}: {told}");
    }
}

#[test]
fn two_outputs_are_two_files_also_where_there_is_none_yet() {
    let folder = folder("two-outputs");
    symlink("new.json", folder.join("later.json")).unwrap();
    symlink("later.json", folder.join("scene.svg")).unwrap();
    for line in [
        "run @/scene.yaml --out @/new --ticks @/new/../new/scene.json",
        // Links to what is not there.
        "run @/scene.yaml --out @ --ticks @/new.json",
    ] {
        let refused = in_folder(&folder, line);
        let told = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains("--out writes it as") && told.contains("another path with --ticks"), "{line}: {told}");
        assert!(!folder.join("new/scene.json").exists() && !folder.join("new.json").exists());
    }
}

#[test]
fn what_standard_output_goes_to_is_not_read() {
    let folder = folder("onto-stdout");
    for name in ["quick.fsm", "laws.fsm"] {
        let file = fs::OpenOptions::new().append(true).open(folder.join(name)).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        let output = command.arg("graph").arg(folder.join("quick.fsm")).stdout(file).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("standard output"), "{}", stderr(&output));
    }
    assert_eq!((text(&folder, "quick.fsm"), text(&folder, "laws.fsm")), (POLICY.to_owned(), LIBRARY.to_owned()));
}

#[test]
fn a_file_that_is_written_keeps_its_mode_its_links_and_its_protection() {
    let folder = folder("modes");
    let chart = folder.join("chart.svg");
    let mode = |path: &Path| path.metadata().unwrap().mode() & 0o7777;
    let graph = |to: &str| in_folder(&folder, &format!("graph @/quick.fsm -o @/{to}"));
    assert_eq!(graph("chart.svg").status.code(), Some(0));
    // A new file is like any that others make.
    fs::write(folder.join("usual"), "").unwrap();
    assert_eq!(mode(&chart), mode(&folder.join("usual")));
    for wanted in [0o600, 0o640, 0o755] {
        fs::set_permissions(&chart, Permissions::from_mode(wanted)).unwrap();
        assert_eq!(graph("chart.svg").status.code(), Some(0));
        assert_eq!(mode(&chart), wanted);
    }
    let whole = text(&folder, "chart.svg");

    // What may not be written is left alone; root may write everything.
    fs::set_permissions(&chart, Permissions::from_mode(0o444)).unwrap();
    let may_write = fs::OpenOptions::new().write(true).open(&chart).is_ok();
    let refused = in_folder(&folder, "graph @/quick.fsm --format dot -o @/chart.svg");
    assert_eq!(refused.status.code(), Some(if may_write { 0 } else { 2 }), "{}", stderr(&refused));
    assert_eq!(text(&folder, "chart.svg") == whole, !may_write);
    assert_eq!(mode(&chart), 0o444);

    // A link stays, and the file that it leads to is written, be it there or not.
    fs::create_dir(folder.join("other")).unwrap();
    for (link, target) in [("first", "other/there"), ("second", "other/new")] {
        symlink(target, folder.join(link)).unwrap();
    }
    fs::write(folder.join("other/there"), "old").unwrap();
    for (link, target) in [("first", "other/there"), ("second", "other/new")] {
        assert_eq!(graph(link).status.code(), Some(0));
        assert_eq!(fs::read_link(folder.join(link)).unwrap(), Path::new(target));
        assert_eq!(text(&folder, target), whole);
    }

    // What is called as temporary files once were is nobody's business.
    fs::write(folder.join("mine"), "mine").unwrap();
    symlink(folder.join("mine"), folder.join("chart.svg.unfinished")).unwrap();
    assert_eq!(graph("chart.svg").status.code(), Some(0));
    assert_eq!((text(&folder, "mine"), text(&folder, "chart.svg.unfinished")), ("mine".to_owned(), "mine".to_owned()));

    // `fmt`, too: mode and link stay.
    symlink("quick.fsm", folder.join("link.fsm")).unwrap();
    fs::set_permissions(folder.join("quick.fsm"), Permissions::from_mode(0o604)).unwrap();
    assert_eq!(in_folder(&folder, "fmt @/link.fsm").status.code(), Some(0));
    assert!(folder.join("link.fsm").is_symlink() && text(&folder, "quick.fsm") != POLICY);
    assert_eq!(mode(&folder.join("quick.fsm")), 0o604);
    let names: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(names.iter().all(|name| !name.to_string_lossy().starts_with(".vibrissa-")), "{names:?}");
}

#[test]
fn what_is_no_file_is_written_to_directly() {
    let folder = folder("special-outputs");
    let wanted = stdout(&in_folder(&folder, "graph @/quick.fsm"));
    assert_eq!(stdout(&in_folder(&folder, "graph @/quick.fsm -o /dev/stdout")), wanted);
    assert_eq!(in_folder(&folder, "graph @/quick.fsm -o /dev/null").status.code(), Some(0));
    assert!(!Path::new("/dev/null").metadata().unwrap().is_file());
    // Standard output that is a file gets all that the command prints, in order.
    let printed = folder.join("printed");
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.arg("run").arg(folder.join("scene.yaml")).args(["--ticks", "/dev/stdout"]);
    assert!(command.stdout(fs::File::create(&printed).unwrap()).status().unwrap().success());
    let printed = fs::read_to_string(printed).unwrap();
    assert!(printed.starts_with('{') && !printed.lines().last().unwrap().starts_with('{'), "{printed}");

    let pipe = folder.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().unwrap();
    assert_eq!(in_folder(&folder, "graph @/quick.fsm -o @/pipe").status.code(), Some(0));
    assert_eq!(stdout(&reader.wait_with_output().unwrap()), wanted);
    let refused = in_folder(&folder, "graph @/quick.fsm -o @");
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("another path with --out"), "{}", stderr(&refused));
}

/// Nothing waits: a pipe that nobody reads would never be opened.
#[test]
fn a_pipe_that_nobody_reads_is_refused_before_the_first_run() {
    let folder = folder("stale-outputs");
    assert_eq!(in_folder(&folder, "sweep @/small.yaml --out @/done").status.code(), Some(0));
    for (line, name) in [
        ("families polygon --count 1 --simulator quasistatic --out @", "results.jsonl"),
        ("graph @/quick.fsm -o @/pipe", "pipe"),
        ("compile @/quick.fsm -o @/pipe", "pipe"),
        ("run @/scene.yaml --ticks @/pipe", "pipe"),
        ("drive @/quick.fsm --emulate @/scene.yaml --record @/pipe", "pipe"),
        ("run @/scene.yaml --out @", "scene.svg"),
        ("study merge @/done --out @/pipe", "pipe"),
        ("calibrate @/measured.csv --out @", "profile.svg"),
    ] {
        let pipe = folder.join(name);
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let refused = in_folder(&folder, line);
        let told = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{line}: {told}");
        let wanted = [name, "a pipe without a reader", "remove it", "another path with --"];
        assert!(wanted.iter().all(|wanted| told.contains(wanted)), "{line}: {told}");
        assert_eq!(stdout(&refused), "", "{line}");
        fs::remove_file(&pipe).unwrap();
    }
}

/// Whoever reads meanwhile finds one of them whole, and so it is in the end.
#[test]
fn of_two_that_write_one_file_at_once_one_is_there() {
    let folder = folder("at-once");
    let formats = ["svg", "mermaid", "dot"];
    let chart = folder.join("chart");
    let graph = |format: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        command.arg("graph").arg(folder.join("quick.fsm")).args(["--format", format, "-o"]).arg(&chart);
        command
    };
    let wanted: Vec<_> = formats
        .iter()
        .map(|format| {
            assert!(graph(format).status().unwrap().success());
            fs::read(&chart).unwrap()
        })
        .collect();
    for _ in 0..20 {
        let mut writers: Vec<_> = formats.iter().map(|format| graph(format).spawn().unwrap()).collect();
        while writers.iter_mut().any(|writer| writer.try_wait().unwrap().is_none()) {
            let found = fs::read(&chart).unwrap();
            assert!(wanted.contains(&found), "{} bytes", found.len());
        }
        assert!(writers.iter_mut().all(|writer| writer.wait().unwrap().success()));
        assert!(wanted.contains(&fs::read(&chart).unwrap()));
    }
    let names: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(names.iter().all(|name| !name.to_string_lossy().starts_with('.')), "{names:?}");
}
