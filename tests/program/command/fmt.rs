//! `vibrissa fmt`

use super::program::{directory, stderr, stdout, vibrissa, vibrissa_reading};

const UGLY: &str = "machine m\ninitial S\nstate S{stop}\n";
const LAID_OUT: &str = "machine m\ninitial S\nstate S { stop }\n";

#[test]
fn fmt_lays_out_files_in_place_and_leaves_alone_those_that_are() {
    let directory = directory("fmt");
    let [ugly, laid_out] = ["ugly.fsm", "laid_out.fsm"].map(|name| directory.join(name).display().to_string());
    std::fs::write(&ugly, UGLY).unwrap();
    std::fs::write(&laid_out, LAID_OUT).unwrap();
    let output = vibrissa(&["fmt", &ugly, &laid_out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
    assert_eq!(stderr(&output), format!("formatted {ugly}\n"));
    assert_eq!(std::fs::read_to_string(&ugly).unwrap(), LAID_OUT);
    assert_eq!(std::fs::read_to_string(&laid_out).unwrap(), LAID_OUT);
}

#[test]
fn fmt_check_shows_what_would_change_and_changes_nothing() {
    let directory = directory("fmt_check");
    let ugly = directory.join("ugly.fsm").display().to_string();
    std::fs::write(&ugly, UGLY).unwrap();
    let output = vibrissa(&["fmt", "--check", &ugly]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("\n-state S{stop}\n+state S { stop }\n"), "{}", stdout(&output));
    assert_eq!(std::fs::read_to_string(&ugly).unwrap(), UGLY);
    let output = vibrissa(&["fmt", "--check", "policies/thesis.fsm"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stdout(&output), "");
}

#[test]
fn fmt_reads_standard_input_and_prints() {
    let output = vibrissa_reading(&["fmt", "-"], UGLY);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), LAID_OUT);
    let output = vibrissa_reading(&["fmt", "-"], "machine");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("standard input:1:"), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
}

#[test]
fn fmt_leaves_a_text_that_cannot_be_read_and_goes_on_with_the_others() {
    let directory = directory("fmt_bad");
    let [bad, ugly] = ["bad.fsm", "ugly.fsm"].map(|name| directory.join(name).display().to_string());
    std::fs::write(&bad, "machine   m state {").unwrap();
    std::fs::write(&ugly, UGLY).unwrap();
    let output = vibrissa(&["fmt", &bad, &ugly]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains(&format!("{bad}:1:")), "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(&bad).unwrap(), "machine   m state {");
    assert_eq!(std::fs::read_to_string(&ugly).unwrap(), LAID_OUT);
    assert_eq!(vibrissa(&["fmt", "--check", &bad, &ugly]).status.code(), Some(2));
}

#[test]
fn fmt_check_says_what_nobody_sees() {
    let directory = directory("fmt_unseen");
    let file = directory.join("unseen.fsm").display().to_string();
    let shown = |text: &str| {
        std::fs::write(&file, text).unwrap();
        let output = vibrissa(&["fmt", "--check", &file]);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        stdout(&output)
    };
    // Line ends alone: no line is shown as removed and added again.
    assert_eq!(
        shown(&LAID_OUT.replace('\n', "\r\n")),
        format!("{file}: 3 lines end with CR LF, as on Windows; `vibrissa fmt` writes LF alone\n")
    );
    let both = shown("machine m\r\ninitial S\nstate S{stop}\n");
    assert!(both.starts_with(&format!("{file}: 1 line ends with CR LF")), "{both}");
    assert!(both.ends_with("\n-state S{stop}\n+state S { stop }\n") && !both.contains("-machine"), "{both}");
    assert!(
        shown("machine m\ninitial S \t \nstate S { stop }\n")
            .contains("\n-initial S\u{b7}\u{2192}\u{b7}\n+initial S\n")
    );
    assert!(shown("machine m\ninitial S\nstate S {\n\tstop }\n").contains("\n-\u{2192}stop }\n"));
}
