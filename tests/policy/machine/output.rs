//! What `plot` and `log` show.

use std::sync::Arc;

use vibrissa_language::compile;
use vibrissa_runtime::machine::{Machine, Program};
use vibrissa_text::diagnostic::Source;

use crate::common::Script;

/// What every tick of a run shows: the plots as `name = value`, and the messages with their values.
fn shown(text: &str, marks: &str) -> Vec<Vec<String>> {
    let program: Arc<Program> = Arc::new(compile(&Source::new("m.fsm", text)).unwrap());
    let (mut machine, mut script) = (Machine::new(Arc::clone(&program)), Script::touches(marks));
    let mut shown = Vec::new();
    for now in 0..marks.len() {
        script.now = now;
        machine.tick(&mut script);
        let outputs = &program.outputs;
        let plots = machine.plotted().map(|(plot, value)| {
            let plot = &outputs.plots[plot];
            format!("{} = {}", plot.name, plot.kind.read(&[value], &[]).unwrap())
        });
        let messages = machine.logged().map(|logged| {
            let message = &outputs.messages[logged.message];
            let state = message.state.map_or("", |state| &program.states[state].name);
            format!("{state}: {}", message.shown(&logged.numbers, &program.whiskers))
        });
        shown.push(plots.chain(messages).collect());
    }
    shown
}

#[test]
fn a_tick_shows_what_its_statements_show_and_nothing_else() {
    let text = "machine m whisker w initial A state A { stop if w.touching { plot bend = 2 mm log \"touched\", w } }";
    assert_eq!(shown(text, ".x."), [vec![], vec!["bend = 2 mm", "A: touched: w = w"], vec![]]);
}

#[test]
fn messages_are_in_the_order_of_their_execution() {
    let text = "machine m whisker w initial A \
        state A { stop log \"in A\" exit { log \"out of A\" } when w.touching -> B } \
        state B { stop log \"in B\" entry { log \"into B\" } }";
    let expected = [vec!["A: in A"], vec!["A: out of A", "B: into B", "B: in B"], vec!["B: in B"]];
    assert_eq!(shown(text, ".xx"), expected);
}

#[test]
fn every_kind_of_value_is_shown_with_its_unit() {
    let text = "machine m whisker w type Side = left or right param gain = 2 in 1 .. 3 initial A \
        state A { stop log \"all\", gain, 20 mm * gain, w.touching, Side.right, vector(1 mm, 2 mm), w }";
    let expected = "A: all: gain = 2, 20 mm * gain = 40 mm, w.touching = true, Side.right = right, \
        vector(1 mm, 2 mm) = (1 mm, 2 mm), w = w";
    assert_eq!(shown(text, "x"), [[expected]]);
}

#[test]
fn a_value_is_that_of_the_statement_even_if_it_changes_later() {
    let text = "machine m whisker w initial A state A { stop var n = 1 plot k = n log \"n\", n set n = n + 1 }";
    let line = |n: u8| vec![format!("k = {n}"), format!("A: n: n = {n}")];
    assert_eq!(shown(text, ".."), [line(1), line(2)]);
}

#[test]
fn a_name_keeps_the_component_of_memory_that_is_set_behind_it() {
    let text = "machine m whisker w initial A \
        state A { stop var k = vector(1, 2) let y = k.y set k = vector(0, 0) plot p = y }";
    assert_eq!(shown(text, "."), [["p = 2"]]);
}

#[test]
fn an_event_keeps_the_values_that_it_was_told() {
    let text = "machine m whisker w monitor b { var k = vector(1, 2) on e(y: number) { set k = vector(3, 4) plot p = y } } \
        initial A state A { stop tell b.e(b.k.y) }";
    assert_eq!(shown(text, ".."), [["p = 2"], ["p = 4"]]);
}

#[test]
fn a_name_and_a_law_keep_the_memory_of_a_monitor_that_an_event_sets_behind_them() {
    let text = "machine m whisker w monitor b { var k = 2 on e { set k = 3 } } law l(n: number, to: b) { tell to.e plot of_law = n } \
        initial A state A { stop let before = b.k do l(b.k, b) plot named = before }";
    assert_eq!(shown(text, "."), [["of_law = 2", "named = 2"]]);
}

#[test]
fn the_last_statement_of_a_tick_gives_a_plot_its_value() {
    let text = "machine m whisker w initial A plot k = 1 state A { stop plot k = 2 state B { plot k = 3 } initial B }";
    assert_eq!(shown(text, "."), [["k = 3"]]);
}

#[test]
fn a_law_shows_in_the_state_that_uses_it() {
    let text =
        "machine m whisker w law tell(n: number) { log \"law\", n } initial A state A { stop do tell(4) do tell(5) }";
    assert_eq!(shown(text, "."), [["A: law: n = 4", "A: law: n = 5"]]);
}

#[test]
fn a_machine_that_has_ended_shows_nothing_more() {
    let text = "machine m whisker w initial A state A { stop exit { log \"out\" } when w.touching -> B } \
        state B { stop when w.touching -> Success(\"done\") }";
    assert_eq!(shown(text, ".xx"), [vec![], vec!["A: out".to_owned()], vec![]]);
}
