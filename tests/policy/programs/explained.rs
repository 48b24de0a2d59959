//! Explained guards of random programs agree with the machine.

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa_language::explain::{Explained, explain};
use vibrissa_runtime::machine::{Machine, Observer, TriedGuard};
use vibrissa_text::diagnostic::Source;

use super::generate::programs;
use super::side_by_side::{machine, scripts};

/// Compares each guard with its explanation.
struct Comparison<'e> {
    explained: &'e Explained,
    guards: usize,
    faults: Vec<String>,
}

impl Observer for Comparison<'_> {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        self.guards += 1;
        let transition = self.explained.transition(tried.transition).unwrap();
        let Some(condition) = &transition.condition else { return };
        let (leaves, missing) = (condition.judge(tried.registers), condition.missing(tried.registers));
        if missing.is_empty() != tried.standing.is_met || missing.iter().any(|leaf| leaf.holds) {
            self.faults.push(format!("{}: {:?}, {missing:?}", transition.text, tried.standing));
        }
        for leaf in leaves {
            let agrees =
                leaf.margin.is_none_or(|(margin, _)| !(margin > 0.0 && !leaf.holds || margin < 0.0 && leaf.holds));
            // Of an equality, all that is missing is the difference.
            if !agrees {
                self.faults.push(format!("{}: {leaf:?}", transition.text));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    /// A condition holds if no part of it is missing, and the sign of every margin says whether its comparison holds.
    #[test]
    fn an_explained_guard_misses_nothing_if_and_only_if_it_holds(program in programs(), script in scripts()) {
        let text = program.text();
        let Some(compiled) = machine(&text) else { return Err(TestCaseError::reject("goes round")) };
        let explained = explain(&Source::new("program.fsm", text.as_str())).unwrap();
        let (mut plain, mut inspected) =
            (Machine::new(Arc::new(compiled)), Machine::new(Arc::new(explained.program.clone())));
        let (mut script, mut same) = (script.clone(), script);
        let mut comparison = Comparison { explained: &explained, guards: 0, faults: Vec::new() };
        for now in 0..script.ticks.len() {
            (script.now, same.now) = (now, now);
            let (one, other) = (plain.tick(&mut script), inspected.tick_observed(&mut same, &mut comparison));
            prop_assert_eq!(one, other, "tick {} of\n{}", now, text);
        }
        prop_assert!(comparison.faults.is_empty(), "{:#?} in\n{}", comparison.faults, text);
    }
}
