//! Every command that writes, killed or refused at every system call by which it does: what it replaces is then as it was, or as it is to be.
//! The real program runs with `shim.c` between it and the C library.

mod case;
mod shim;

use case::{CALIBRATE, COMPILE, Case, DRIVE, FAMILIES, FMT, GRAPH, KEEP, MERGE, REGRESSIONS, RUN, TEST};
use shim::{Kind, Shim};

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::command::program::directory;
#[cfg(feature = "render")]
use crate::command::video::can_draw;

/// The files in a folder by their names.
type Content = BTreeMap<String, Vec<u8>>;

/// The file of finished runs. It grows by whole lines, an incomplete last one is removed, and it is gone in the end.
const UNFINISHED: &str = "unfinished.jsonl";

/// The files in a folder that replace others at once.
fn content(folder: &Path) -> Content {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let files = files.filter(|entry| entry.path().is_file() && entry.file_name() != UNFINISHED);
    files.map(|file| (file.file_name().into_string().unwrap(), fs::read(file.path()).unwrap())).collect()
}

fn restore(folder: &Path, old: &Content) {
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).unwrap();
    for (name, bytes) in old {
        fs::write(folder.join(name), bytes).unwrap();
    }
}

/// Whether a file's name is one that the documentation gives to temporary files.
fn is_temporary(name: &str) -> bool {
    let drawn = name.strip_prefix(".vibrissa-").and_then(|rest| rest.strip_suffix(".tmp"));
    drawn.is_some_and(|drawn| drawn.len() == 12 && drawn.bytes().all(|byte| byte.is_ascii_alphanumeric()))
}

/// Whether a file is as a run of its command leaves it. The times that runs take are written in some: those need only be whole.
fn is_new(name: &str, bytes: &[u8], new: &Content) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let is_json = |text: &str| serde_json::from_str::<serde_json::Value>(text).is_ok();
    new.get(name).is_some_and(|new| new == bytes)
        || match name.rsplit_once('.') {
            Some((_, "json")) => text.ends_with('\n') && is_json(&text),
            Some((_, "jsonl")) => {
                let lines = String::from_utf8_lossy(&new[name]).lines().count();
                text.ends_with('\n') && text.lines().count() == lines && text.lines().all(is_json)
            }
            Some((_, "svg")) => text.trim_end().ends_with("</svg>"),
            Some((_, "html")) => text.trim_end().ends_with("</html>"),
            _ => false,
        }
}

/// Checks what a fault has left.
fn check(found: &Content, old: &Content, new: &Content, kind: Kind) -> Result<(), String> {
    let (temporary, named): (Vec<_>, Vec<_>) = found.iter().partition(|(name, _)| is_temporary(name));
    if temporary.len() > usize::from(kind == Kind::Kill) {
        return Err(format!("{} temporary files are left", temporary.len()));
    }
    if let Some(gone) = old.keys().find(|name| !found.contains_key(*name)) {
        return Err(format!("{gone} is gone"));
    }
    let torn = named.into_iter().find(|(name, bytes)| old.get(*name) != Some(*bytes) && !is_new(name, bytes, new));
    torn.map_or(Ok(()), |(name, bytes)| Err(format!("{name} is torn: {} bytes", bytes.len())))
}

/// Checks, by the calls of a run without a fault, that every file is on the disk before it gets its name, and its name before the end.
fn check_order(calls: &[(String, String)]) {
    let mut renames = 0;
    for (index, (call, path)) in calls.iter().enumerate() {
        let name = Path::new(path).file_name().unwrap().to_str().unwrap();
        assert!(call != "create" || name == UNFINISHED || is_temporary(name), "{path}");
        if call == "rename" {
            renames += 1;
            let before = calls[..index].iter().rev().find(|(call, of)| of == path && call != "rename").unwrap();
            assert_eq!(before.0, "fsync", "{path} is synced last before it is renamed");
            let folder = Path::new(path).parent().unwrap().display().to_string();
            let (synced, later) = (("fsync".to_owned(), folder), &calls[index + 1..]);
            assert_eq!(later.iter().find(|(call, _)| call != "open"), Some(&synced), "the folder is synced next");
        }
    }
    assert!(renames > 0, "{calls:?}");
}

/// At how many of its calls a long command fails in CI, spread evenly over all.
const LONG_PLACES: usize = 4;

/// Runs a command with every fault at every call, once with files to replace and once without. One that takes long fails only at some calls,
/// and only when there are files to replace.
fn survives(case: &Case) {
    survives_at(case, if case.is_long { LONG_PLACES } else { usize::MAX });
}

/// The same at so many `places`, or at every call if there are fewer.
fn survives_at(case: &Case, places: usize) {
    let Some(shim) = Shim::built() else { return };
    let folder = directory(&format!("fault-{}", case.name));
    // The shim compares what the kernel says, which is without links.
    let folder = folder.canonicalize().unwrap();
    let out = folder.join("out");
    let start = (case.prepare)(&folder);
    restore(&out, &start);
    let arguments = (case.arguments)(&folder);
    let unharmed = shim.run(&arguments, &out, Kind::None, 0);
    assert!(matches!(unharmed.status, Some(0 | 1)), "{}: {}", case.name, unharmed.told);
    check_order(&unharmed.calls);
    let stride = unharmed.calls.len().div_ceil(places);
    let new = content(&out);
    assert!(new.keys().all(|name| !is_temporary(name)), "{:?}", new.keys());
    let replaced = || new.iter().map(|(name, new)| (name.clone(), (case.old)(new))).collect();
    let olds = match (start.is_empty(), case.is_long) {
        (false, _) => vec![start],
        (true, false) => vec![start, replaced()],
        (true, true) => vec![replaced()],
    };
    for old in olds {
        for kind in [Kind::Kill, Kind::Full, Kind::Broken] {
            for at in (1..).step_by(stride) {
                restore(&out, &old);
                let ran = shim.run(&arguments, &out, kind, at);
                let found = content(&out);
                if ran.calls.len() < at {
                    assert_eq!(ran.status, unharmed.status, "{}: {}", case.name, ran.told);
                    break;
                }
                let place = format!("{}, {kind:?} at {at}, {:?}", case.name, ran.calls[at - 1]);
                if let Err(wrong) = check(&found, &old, &new, kind) {
                    panic!("{place}: {wrong}\n{}", ran.told);
                }
                match kind {
                    Kind::Kill => assert_eq!(ran.status, None, "{place}"),
                    // Where the disk is full, what needs no room goes on; a folder that is there is not made.
                    _ if ran.status == unharmed.status => {
                        assert!(kind == Kind::Full || ran.calls[at - 1].0 == "mkdir", "{place}: nothing was told");
                    }
                    _ => assert!(ran.status == Some(2) && ran.told.contains("error"), "{place}: {}", ran.told),
                }
            }
        }
    }
}

#[test]
fn fmt_leaves_a_policy_as_it_was_or_laid_out() {
    survives(&FMT);
}

#[test]
fn graph_leaves_the_old_chart_or_the_new_one() {
    survives(&GRAPH);
}

#[test]
fn compile_leaves_the_old_machine_or_the_new_one() {
    survives(&COMPILE);
}

#[test]
fn drive_leaves_the_old_recording_or_the_new_one() {
    survives(&DRIVE);
}

#[test]
fn keep_leaves_the_old_recording_or_the_new_one() {
    survives(&KEEP);
}

#[test]
fn run_leaves_old_reports_or_new_ones() {
    survives(&RUN);
}

#[cfg(feature = "render")]
#[test]
fn run_leaves_the_old_video_or_the_new_one() {
    if can_draw() {
        survives(&case::VIDEO);
    }
}

#[test]
fn test_leaves_old_reports_or_new_ones() {
    survives(&TEST);
}

#[test]
fn test_keeps_failing_cases_or_leaves_the_old_file() {
    survives(&REGRESSIONS);
}

#[test]
fn families_leaves_old_results_or_new_ones() {
    survives(&FAMILIES);
}

#[test]
fn calibrate_leaves_the_old_calibration_or_the_new_one() {
    survives(&CALIBRATE);
}

#[test]
fn bench_leaves_old_results_or_new_ones() {
    survives(&case::BENCH);
}

#[test]
fn services_leaves_old_files_or_new_ones() {
    survives(&case::SERVICES);
}

#[test]
#[ignore = "takes a quarter of an hour; `cargo test --release --test program long_commands -- --ignored` runs it"]
fn long_commands_leave_old_results_or_new_ones_at_every_call() {
    survives_at(&case::BENCH, usize::MAX);
    survives_at(&CALIBRATE, usize::MAX);
    #[cfg(feature = "sim")]
    survives_at(&case::PARETO, usize::MAX);
}

#[cfg(feature = "sim")]
#[test]
fn pareto_leaves_old_results_or_new_ones() {
    survives(&case::PARETO);
}

#[test]
fn merge_leaves_old_results_or_new_ones() {
    survives(&MERGE);
}

#[test]
fn a_sweep_keeps_every_line_that_it_has_written_and_goes_on() {
    let folder = directory("fault-sweep").canonicalize().unwrap();
    keeps_every_line(&folder, &["sweep", &case::sweep_in(&folder)], case::SWEEP_RUNS);
}

#[test]
fn tuning_keeps_every_line_that_it_has_written_and_goes_on() {
    let folder = directory("fault-tune").canonicalize().unwrap();
    let policy = case::tuned_in(&folder);
    let arguments =
        ["tune", &policy, "--scene", "polygon", "--count", "1", "--runs", "5", "--simulator", "quasistatic"];
    keeps_every_line(&folder, &arguments, case::TUNE_RUNS);
}

/// A command that adds to its results: whole lines stay, and the same command goes on with them.
fn keeps_every_line(folder: &Path, arguments: &[&str], runs: usize) {
    let Some(shim) = Shim::built() else { return };
    let out = folder.join("out");
    let arguments = [arguments, &["--jobs", "1", "--out", out.to_str().unwrap()]].concat();
    let arguments: Vec<String> = arguments.into_iter().map(str::to_owned).collect();
    restore(&out, &Content::new());
    let unharmed = shim.run(&arguments, &out, Kind::None, 0);
    // The machine fails, so tuned values do not pass either.
    let status = unharmed.status;
    assert!(matches!(status, Some(0 | 1)), "{}", unharmed.told);
    let lines = |content: &Content| {
        let text = content.get("results.jsonl").map(|bytes| String::from_utf8(bytes.clone()).unwrap());
        let text = text.unwrap_or_default();
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        whole.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let all = lines(&content(&out)).len();
    assert_eq!(all, runs + 1);
    // Behind every line that was written it is synced.
    let is_write = |call: &(String, String)| call.0 == "write" && call.1.ends_with("results.jsonl");
    let synced = unharmed.calls.windows(2).filter(|pair| is_write(&pair[0]) && pair[1].0 == "fdatasync").count();
    assert_eq!((synced, unharmed.calls.iter().filter(|call| is_write(call)).count()), (all, all));
    for kind in [Kind::Kill, Kind::Full, Kind::Broken] {
        for at in 1.. {
            restore(&out, &Content::new());
            let ran = shim.run(&arguments, &out, kind, at);
            if ran.calls.len() < at {
                break;
            }
            let kept = lines(&content(&out));
            let written = ran.calls[..at - 1].iter().filter(|call| is_write(call)).count();
            assert!(kept.len() >= written, "{kind:?} at {at}: {} lines of {written}", kept.len());
            let again = shim.run(&arguments, &out, Kind::None, 0);
            assert_eq!(again.status, status, "{kind:?} at {at}: {}", again.told);
            let now = lines(&content(&out));
            assert!(now.len() == all && now.starts_with(&kept), "{kind:?} at {at}: {} lines", now.len());
        }
    }
}
