//! Where names are known, and which may be the same.
#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use vibrissa_language::index::{Index, Role};
use vibrissa_language::{compile, compile_with_warnings};
use vibrissa_runtime::machine::Action;
use vibrissa_text::diagnostic::Source;

use crate::common::{Script, run};

/// A command that tells a number.
fn tell(number: &str) -> String {
    format!("steer body along vector(1, 0) at ({number}) * 1 m/s turning 0 rad/s")
}

/// The numbers that a machine tells, tick by tick.
fn told(text: &str, marks: &str) -> Vec<f64> {
    let speed = |action| if let Action::Steer { speed, .. } = action { speed } else { f64::NAN };
    run(text, &mut Script::touches(marks)).1.into_iter().map(|(_, action)| speed(action)).collect()
}

/// The faults of a policy: their codes, and the words that they point at.
fn faults(text: &str) -> Vec<(&'static str, String)> {
    let source = Source::new("test.fsm", text);
    let faults = compile(&source).err().unwrap_or_default();
    faults.iter().map(|fault| (fault.code, source.slice(fault.primary.span).to_owned())).collect()
}

#[test]
fn an_argument_may_have_the_name_of_memory_that_it_cannot_see() {
    let text = format!(
        "machine m whisker w initial A  var n = 1
        let twice(n: number) = 2 * n
        law say(n: number) {{ let m = n  {} }}
        state A {{ var m = 7  do say(twice(m) + n) }}",
        tell("m + 1000")
    );
    assert_eq!(told(&text, "."), [1015.0]);
}

#[test]
fn a_states_memory_and_arguments_hide_those_of_what_is_around_it() {
    let text = format!(
        "machine m whisker w initial A  var n = 1  var k = 1000
        set n = n + 1
        state A {{
          initial B(5)
          var k = 10
          set k = k + 10
          state B(n: number) {{
            var k = 100
            set k = k + 100
            {}
            when w.touching -> C
          }}
          state C {{ {} }}
        }}
        always when k > 1000 -> Failure(\"the machine's own was set\")",
        tell("n + k"),
        tell("n + k")
    );
    // In `B` there are its argument and its own memory, in `C` the machine's `n` and the `k` of `A`.
    assert_eq!(told(&text, "..x"), [205.0, 305.0, 4.0 + 40.0]);
}

#[test]
fn what_begins_anew_by_a_failsafe_or_an_exit_means_the_states_own_too() {
    let text = format!(
        "machine m whisker w initial A  var n = 0
        state A {{
          initial B  var n = 10
          exit {{ set n = 50 }}
          state B {{ var n = 100  entry {{ set n = n + 1 }}  exit {{ set n = 500 }}  {}  when w.touching -> D(n) }}
        }}
        state D(before: number) {{ {} }}",
        tell("n"),
        tell("before + n")
    );
    // The values of the target are computed behind the exits.
    assert_eq!(told(&text, ".x"), [101.0, 500.0]);
}

#[test]
fn what_would_confuse_stays_an_error() {
    let twice = |name: &str| ("P0202", name.to_owned());
    for (text, expected) in [
        // The same state.
        ("state S { var n = 1 var n = 2 stop }", vec![twice("n")]),
        ("state S(n: number) { var n = 2 stop }", vec![twice("n")]),
        ("state S(n: number, n: number) { stop }", vec![twice("n")]),
        // An item is known everywhere.
        ("param n = 1 state S { var n = 2 stop }", vec![twice("n")]),
        ("let n = 1 state S(n: number) { stop }", vec![twice("n")]),
        ("law n() { stop } state S { let n = 2 stop }", vec![twice("n")]),
        ("param n = 1 let f(n: number) = n state S { stop }", vec![twice("n")]),
        ("var n = 1 param n = 2 state S { stop }", vec![twice("n")]),
        ("state S { var T = 2 stop } state T { stop }", vec![twice("T")]),
        ("state S { var clamp = 2 stop }", vec![twice("clamp")]),
        // A `let` hides nothing.
        ("var n = 1 state S { let n = 2 stop }", vec![twice("n")]),
        ("state S { var n = 1 stop state T { let n = 2 stop } }", vec![("P0404", "S".to_owned()), twice("n")]),
        ("state S { let n = 1 if true { let n = 2 } stop }", vec![twice("n")]),
        ("law l(n: number) { let n = 2 stop } state S { stop }", vec![twice("n")]),
        // What is hidden cannot be read, nor set in place of what hides it.
        ("var n = 1 state S { var n = n stop }", vec![("P0201", "n".to_owned())]),
        ("var n = 1 state S { var k = n var n = 2 stop }", vec![("P0201", "n".to_owned())]),
        ("var n = 1 state S(n: number) { set n = 2 stop }", vec![("P0406", "n".to_owned())]),
    ] {
        let text = format!("machine m whisker w initial Begin state Begin {{ stop }} {text}");
        assert_eq!(faults(&text), expected, "{text}");
    }
}

#[test]
fn hidden_memory_that_nothing_reads_is_never_used() {
    let text = "machine m initial A  var n = 1
        let f(n: number) = n
        state A { var n = f(3)  stop  after n * 1 s -> Failure(\"late\") }";
    let warnings = compile_with_warnings(&Source::new("test.fsm", text)).unwrap().warnings;
    let told: Vec<_> = warnings.iter().map(|warning| (warning.code, warning.primary.span.start)).collect();
    assert_eq!(told, [("P0507", text.find("n = 1").unwrap())]);
}

/// One name for three things: the machine's memory, an argument, and a state's memory.
const HIDING: &str = "machine m\nvar n = 1\nlet f(n: number) = n + 1\ninitial A\nset n = 2\nstate A {\n  set n = f(n)\n  var n = 3\n  \
                      stop\n  after n * 1 s -> B(n)\n}\nstate B(x: number) {\n  set n = x\n  stop\n}\n";

#[test]
fn an_editor_tells_what_hides_from_what_is_hidden() {
    use Role::{Declares, Reads, Writes};
    assert!(faults(HIDING).is_empty());
    let index = Index::new(&Source::new("test.fsm", HIDING), None);
    let lines = |place: &str| -> Vec<(usize, Role)> {
        let references = index.references(HIDING.find(place).unwrap());
        references.into_iter().map(|(span, role)| (index.source().line_column(span.start).line, role)).collect()
    };
    assert_eq!(lines("n = 1"), [(2, Declares), (5, Writes), (13, Writes)]);
    assert_eq!(lines("n: number"), [(3, Declares), (3, Reads)]);
    assert_eq!(lines("n = 3"), [(7, Writes), (7, Reads), (8, Declares), (10, Reads), (10, Reads)]);
    for place in ["n = 1", "n: number", "n = 3"] {
        let at = HIDING.find(place).unwrap();
        let mut renamed = HIDING.to_owned();
        for span in index.rename(at, "other").unwrap().into_iter().rev() {
            renamed.replace_range(span.start..span.end, "other");
        }
        let programs = [HIDING, &renamed].map(|text| compile(&Source::new("test.fsm", text)).unwrap());
        assert_eq!(programs[0], programs[1], "{renamed}");
    }
    let at = HIDING.find("f(n)\n").unwrap();
    let labels: Vec<String> = index.candidates(at).1.into_iter().map(|candidate| candidate.label).collect();
    assert_eq!(labels.iter().filter(|label| *label == "n").count(), 1, "{labels:?}");
}
