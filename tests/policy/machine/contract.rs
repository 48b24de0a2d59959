//! What contracts mean: when they are evaluated, which of them are proved, and the margins of the others.
#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use vibrissa_language::compile_with_warnings;
use vibrissa_runtime::machine::ContractStatus;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Source;

use crate::common::{Feel, Script, run};

/// The contracts of a policy after a run: their states, texts, and what was observed.
fn observed(text: &str, script: &mut Script) -> Vec<(Option<String>, String, ContractStatus)> {
    let (machine, _) = run(text, script);
    let name = |state: usize| machine.program().states[state].name.to_string();
    let contracts = machine.contracts();
    contracts.map(|one| (one.state.map(name), one.contract.text.to_string(), *one.status)).collect()
}

/// The numbers of evaluations and violations of every contract of a state `A`, and of what else stands in the machine.
fn counts(contracts: &str, rest: &str, marks: &str) -> Vec<(u64, u64)> {
    let text = format!("machine m whisker w initial A {rest} state A {{ stop {contracts} }}");
    let observed = observed(&text, &mut Script::touches(marks));
    observed.into_iter().map(|(_, _, status)| (status.evaluations, status.violations)).collect()
}

/// The texts of the proved contracts of a policy.
fn proved(text: &str) -> Vec<String> {
    let compiled = compile_with_warnings(&Source::new("m.fsm", text)).unwrap();
    compiled.proved.into_iter().map(|contract| contract.text).collect()
}

#[test]
fn never_is_violated_in_every_tick_in_which_its_condition_holds() {
    assert_eq!(counts("never w.touching", "", ".xx.x"), [(5, 3)]);
    assert_eq!(counts("", "never w.touching", ".xx.x"), [(5, 3)]);
}

#[test]
fn a_time_has_to_pass_without_interruption() {
    // Four consecutive ticks of 1/30 s cover 100 ms.
    assert_eq!(counts("never w.touching for 100 ms", "", "xxx.xxxxx."), [(10, 2)]);
    assert_eq!(counts("always w.touching within 100 ms", "", "...x.....x"), [(10, 2)]);
}

#[test]
fn assume_is_evaluated_at_every_entry_and_only_then() {
    let rest = "state B { stop when w.touching -> A }";
    assert_eq!(counts("assume w.touching  when not w.touching -> B", rest, ".xx..xx"), [(3, 1)]);
    assert_eq!(counts("", "assume w.touching", ".xxx"), [(1, 1)]);
}

#[test]
fn a_contract_is_evaluated_after_the_transitions_and_before_the_statements() {
    // The transition leaves the state in the tick in which the contract would be violated.
    let rest = "state B { stop  never not w.touching }";
    let text = format!(
        "machine m whisker w initial A {rest} state A {{ stop when w.touching -> B }} never n > 0  var n = 0  set n = n + 1"
    );
    let statuses = observed(&text, &mut Script::touches(".x."));
    assert_eq!(
        statuses.iter().map(|(.., status)| (status.evaluations, status.violations)).collect::<Vec<_>>(),
        [(3, 2), (2, 1)]
    );
}

#[test]
fn an_entry_begins_the_time_anew() {
    let rest = "state B { stop when true -> A }";
    assert_eq!(counts("never w.touching for 100 ms  after 60 ms -> B", rest, "xxxxxxxxxxxxxxxx")[0].1, 0);
}

#[test]
fn a_tick_that_ends_the_run_evaluates_no_contract() {
    assert_eq!(counts("never w.touching  when w.touching for 10 ms -> Success(\"met\")", "", "..xx."), [(3, 1)]);
}

#[test]
fn the_margin_is_the_least_distance_of_compared_numbers_from_a_violation() {
    let deflected = |deflections: &[f64]| {
        let feel = |&base_angle: &f64| vec![Feel { base_angle, ..Feel::default() }];
        Script::new(deflections.iter().map(feel).collect())
    };
    for (condition, deflections, margin, at) in [
        ("never |w.base_angle| > 3 mrad", [1e-3, -2.5e-3, 2e-3], 0.5e-3, 1),
        ("never |w.base_angle| > 2 mrad", [1e-3, -2.5e-3, 2e-3], -0.5e-3, 1),
        ("never w.base_angle > 4 mrad or w.base_angle < -3 mrad", [1e-3, -2.5e-3, 2e-3], 0.5e-3, 1),
        ("never w.base_angle > 0 rad and w.base_angle < 5 mrad", [-1e-3, -2.5e-3, -2e-3], 1e-3, 0),
        ("always |w.base_angle| < 2 mrad within 1 s", [1e-3, -2.5e-3, 3e-3], -1e-3, 2),
        ("never not (w.base_angle < 4 mrad)", [1e-3, 2e-3, 3.5e-3], 0.5e-3, 2),
    ] {
        let text = format!("machine m whisker w initial A state A {{ stop {condition} }}");
        let [(_, _, status)] = &observed(&text, &mut deflected(&deflections))[..] else { panic!("{text}") };
        let smallest = status.smallest_margin.unwrap();
        assert!((smallest.margin - margin).abs() < 1e-12, "{condition}: {smallest:?}");
        assert!((smallest.time - f64::from(at) / 30.0).abs() < 1e-9, "{condition}: {smallest:?}");
    }
}

#[test]
fn a_contract_of_bools_or_of_several_dimensions_has_no_margin() {
    for (condition, dimension) in [
        ("w.touching", None),
        ("|w.base_angle| > 1 rad or time > 100 s", None),
        ("time > 100 s", Some(Dimension::TIME)),
        ("|w.tip - w.base| > 100 m", Some(Dimension::LENGTH)),
    ] {
        let text = format!("machine m whisker w initial A state A {{ stop never {condition} }}");
        let (machine, _) = run(&text, &mut Script::touches("."));
        let contract = machine.contracts().next().unwrap().contract;
        assert_eq!(contract.margin.map(|(_, dimension)| dimension), dimension, "{condition}");
    }
}

#[test]
fn a_contract_says_its_text_and_its_state() {
    let text = "machine m whisker w initial A
        state A { stop  never w.touching
            and time > 3 s   # a comment
        }
        always w.touching within 2 s";
    let found: Vec<_> = observed(text, &mut Script::touches("."))
        .into_iter()
        .map(|(state, text, _)| (state.unwrap_or_default(), text))
        .collect();
    let expected = [("", "always w.touching within 2 s"), ("A", "never w.touching and time > 3 s")];
    assert_eq!(found, expected.map(|(state, text)| (state.to_owned(), text.to_owned())));
}

#[test]
fn a_behaviour_has_its_contracts_in_every_state_that_uses_it() {
    let text = "machine m whisker w initial A
        behaviour wait(most: time, probe: whisker) { assume most > 0 s  never time > most  stop  exit done  when probe.touching for 10 ms -> exit done }
        state A is wait(10 s, w) { on done -> B }
        state B is wait(20 ms, w) { on done -> Success(\"over\") }";
    let found: Vec<_> = observed(text, &mut Script::touches("xx..."))
        .into_iter()
        .map(|(state, text, status)| (state.unwrap_or_default(), text, status.violations))
        .collect();
    let names: Vec<_> =
        found.iter().map(|(state, text, violations)| (state.as_str(), text.as_str(), *violations)).collect();
    // The values of the argument are known, so that the assumption is proved.
    assert_eq!(names, [("A.wait", "never time > most", 0), ("B.wait", "never time > most", 4)]);
    assert_eq!(proved(text).len(), 2);
}

#[test]
fn what_no_value_can_violate_is_proved_and_not_watched() {
    let text = |contracts: &str| {
        format!(
            "machine m whisker w param p = 1 in 1 .. 2 initial A {contracts}
            state A {{ stop when w.touching -> B when time > 5 s for 1 s -> B }} state B {{ stop }}"
        )
    };
    let in_a = |contract: &str| text("").replacen("stop when", &format!("stop {contract} when"), 1);
    assert_eq!(proved(&text("never p > 2")), ["never p > 2"]);
    assert_eq!(proved(&text("always p >= 1 within 1 s  assume p < 3")), ["always p >= 1 within 1 s", "assume p < 3"]);
    assert_eq!(proved(&text("never p > 1.5")), [""; 0]);
    // A whisker that touches leaves the state, but only after the state was entered.
    assert_eq!(proved(&in_a("never w.touching")), ["never w.touching"]);
    assert_eq!(proved(&in_a("assume not w.touching")), [""; 0]);
    assert_eq!(proved(&text("never w.touching")), [""; 0]);
    // A guard with a time may hold for a while.
    assert_eq!(proved(&in_a("never time > 5 s")), [""; 0]);
    let (machine, _) = run(&in_a("never w.touching"), &mut Script::touches(".x"));
    assert_eq!(machine.contracts().count(), 0);
}
