//! The origin of results, in documents and on pages.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use super::program::{ROOT, directory, stderr, vibrissa};

/// The program at a fixed date.
fn dated(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_vibrissa");
    Command::new(program).args(arguments).current_dir(ROOT).env("SOURCE_DATE_EPOCH", "1764000000").output().unwrap()
}

/// A scenario with noise and a name of its own, which ends soon.
fn scenario(directory: &Path) -> String {
    let disk = fs::read_to_string(Path::new(ROOT).join("scenarios/disk.yaml")).unwrap();
    let disk = disk.replace("../policies", &format!("{ROOT}/policies")).replace("time: 120 s", "time: 4 s");
    let disk = disk.lines().filter(|line| !line.contains("loop_closed")).collect::<Vec<_>>().join("\n");
    let path = directory.join("short disk.yaml");
    fs::write(&path, disk).unwrap();
    path.display().to_string()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|cause| panic!("{}: {cause}", path.display()))
}

fn title(page: &str) -> &str {
    page.split_once("<title>").unwrap().1.split_once("</title>").unwrap().0
}

#[test]
fn the_command_on_the_page_of_a_comparison_repeats_it() {
    let directory = directory("provenance");
    let (scenario, out) = (scenario(&directory), directory.join("a comparison"));
    let policies = ["bang", "vibrissa"].map(|name| format!("{ROOT}/policies/{name}.fsm"));
    let policies = [policies[0].as_str(), &policies[1]];
    let arguments = |seeds| {
        let options =
            ["--seeds", seeds, "--jitter", "10 mm", "--simulator", "quasistatic", "--out", out.to_str().unwrap()];
        [&["compare"][..], &policies, &[&scenario], &options]
            .concat()
            .into_iter()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let run = |seeds| {
        let arguments = arguments(seeds);
        let output = dated(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let document = read(&out.join("comparison.json"));
        (document, read(&out.join("index.html")))
    };
    let (_, other) = run("3");
    let (first, page) = run("4");
    let document: Value = serde_json::from_str(&first).unwrap();
    let provenance = &document["provenance"];
    assert_eq!(provenance["date"], "2025-11-24T16:00:00Z");
    assert_eq!(provenance["simulators"][0]["name"], "quasistatic");
    assert_eq!(provenance["scenes"], serde_json::json!(["disk"]));
    assert_eq!(provenance["policies"].as_array().unwrap().len(), 2);
    assert_eq!(provenance["seeds"][0]["last"].as_u64().unwrap() - provenance["seeds"][0]["first"].as_u64().unwrap(), 3);
    assert_eq!(provenance["jitter"]["position_m"], 0.01);
    assert!(provenance["mismatches"].as_array().unwrap().is_empty());
    // The page has the same command, as it is quoted in HTML.
    let command = provenance["command"].as_str().unwrap();
    assert!(page.contains(&command.replace('&', "&amp;")), "{command}");
    assert!(page.contains("commit") && page.contains("quasistatic 0."));
    assert!(page.contains("95 % interval") && title(&page) != title(&other), "{}", title(&page));

    // It has the hashes of its inputs, which are those of the results.
    let results: Value = serde_json::from_str(&read(&out.join("results.json"))).unwrap();
    let hashes = &provenance["hashes"];
    assert_eq!(hashes["scenarios"], serde_json::json!([{"name": "disk", "hash": results[0]["hash"]["scenario"]}]));
    for (policy, run) in hashes["policies"].as_array().unwrap().iter().zip([&results[0], &results[4]]) {
        assert_eq!((&policy["name"], &policy["hash"]), (&run["policy"], &run["hash"]["policy"]));
        assert!(page.contains(policy["hash"].as_str().unwrap()));
    }
    assert!(page.contains("in the root of ") && page.contains(results[0]["hash"]["scenario"].as_str().unwrap()));

    let folder = Path::new(env!("CARGO_BIN_EXE_vibrissa")).parent().unwrap();
    let path = format!("{}:{}", folder.display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell.args(["-c", command]).current_dir(&directory).env("PATH", path).env("SOURCE_DATE_EPOCH", "1764000000");
    let output = shell.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let repeated = directory.join("repeated");
    assert_eq!(read(&repeated.join("comparison.json")), first);
    assert_eq!(read(&repeated.join("index.html")), page);
    assert!(out.join("index.html").is_file() && !command.contains("a comparison"), "{command}");
}

#[test]
fn only_the_first_line_of_a_file_has_the_origin() {
    let directory = directory("provenance-lines");
    let ticks = directory.join("ticks.jsonl");
    let scenario = scenario(&directory);
    vibrissa(&["run", &scenario, "--simulator", "quasistatic", "--ticks", ticks.to_str().unwrap()]);
    let lines: Vec<Value> = read(&ticks).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(lines.len() > 2 && lines[0]["provenance"]["scenes"][0] == "disk");
    assert!(lines[1..].iter().all(|line| line["provenance"].is_null()));
}

#[test]
fn random_scenes_end_in_a_page_with_rates_and_the_pictures_of_runs_that_did_not_pass() {
    let directory = directory("provenance-families");
    let policy = "machine blind\nwhisker r0\nparam speed = 50 mm/s in 10 mm/s .. 200 mm/s\ninitial Ahead\nstate Ahead {\n  \
                  steer body along direction(body.yaw) at speed turning 0 deg/s\n  after 1 s -> Failure(\"no <surface>\")\n}\n";
    let (path, out) = (directory.join("blind.fsm"), directory.join("out"));
    fs::write(&path, policy).unwrap();
    let fixed =
        ["families", "convex-corner", "--count", "2", "--simulator", "quasistatic", "--policy", path.to_str().unwrap()];
    let output = dated(&[&fixed[..], &["--out", out.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let page = read(&out.join("index.html"));
    assert!(page.contains("0 of 2 runs passed") && page.contains("no &lt;surface&gt;"), "{page}");
    let pictures: Vec<&str> = page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(!pictures.is_empty());
    for picture in pictures {
        assert!(read(&out.join(picture)).starts_with("<svg"), "{picture}");
    }
    assert!(page.contains("convex-corner, trials 0 to 1") && page.contains("--count 2"), "{page}");
}

#[test]
fn a_sweep_has_a_curve_with_a_band_over_each_axis_for_each_policy() {
    let directory = directory("provenance-sweep");
    let scenario = scenario(&directory);
    let text = format!(
        "name: curves\npolicies: [{ROOT}/policies/bang.fsm, {ROOT}/policies/thesis.fsm]\nscenes: [{{scenario: {scenario:?}}}]\nvary:\n  \
         scenario: {{world: [quasistatic], stop: [{{time: 1 s}}, {{time: 2 s}}]}}\n"
    );
    let (path, out) = (directory.join("curves.yaml"), directory.join("out"));
    fs::write(&path, text).unwrap();
    let output =
        dated(&["sweep", path.to_str().unwrap(), "--out", out.to_str().unwrap(), "--pictures", "none", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let curves = summary["curves"].as_array().unwrap();
    assert_eq!(curves.len(), 2);
    assert!(curves.iter().all(|curve| curve["axis"] == "stop" && curve["points"].as_array().unwrap().len() == 2));
    let page = read(&out.join("index.html"));
    assert!(page.contains("passed runs (%) over stop") && page.contains("fill-opacity=\"0.18\""), "{page}");
    assert!(page.contains("vibrissa sweep "));
    let first = read(&out.join("results.jsonl"));
    let header: Value = serde_json::from_str(first.lines().next().unwrap()).unwrap();
    assert_eq!(header["provenance"], summary["provenance"]);
}

#[test]
fn a_changed_policy_has_another_hash_on_the_page() {
    let directory = directory("provenance-hash");
    let (scenario, thesis) = (scenario(&directory), read(&Path::new(ROOT).join("policies/thesis.fsm")));
    let faster = thesis.replacen("= 50 mm/s ", "= 60 mm/s ", 1);
    assert!(faster != thesis);
    let path = directory.join("thesis.fsm");
    let page = |text: &str| {
        fs::write(&path, text).unwrap();
        let out = directory.join("out").display().to_string();
        let policy = path.to_str().unwrap();
        let output = dated(&["run", &scenario, "--policy", policy, "--simulator", "quasistatic", "--out", &out]);
        assert!(output.status.code() < Some(2), "{}", stderr(&output));
        let page = read(&directory.join("out/index.html"));
        page.split_once("hashes of policies").unwrap().1.split_once("</dd>").unwrap().0.to_owned()
    };
    assert_ne!(page(&thesis), page(&faster));
}

#[test]
fn a_page_has_seeds_of_a_mismatch_only_if_it_has_ranges() {
    let directory = directory("provenance-mismatch");
    let (scenario, path) = (scenario(&directory), directory.join("soft.yaml"));
    let seeds = |text: &str| {
        fs::write(&path, text).unwrap();
        let (out, mismatch) = (directory.join("out").display().to_string(), path.display().to_string());
        let command = ["run", &scenario, "--policy", "thesis", "--simulator", "quasistatic", "--uncalibrated"];
        let output = dated(&[&command[..], &["--mismatch", &mismatch, "--out", &out]].concat());
        assert!(output.status.code() < Some(2), "{}", stderr(&output));
        let page = read(&directory.join("out/index.html"));
        page.contains(&format!("{mismatch}, seeds 0"))
    };
    assert!(!seeds("stiffness: 5 %\n") && seeds("stiffness: [1 %, 5 %]\n"));
}
