//! What the compiler says of machines that could go round within a tick.

use proptest::prelude::*;
use vibrissa_language::compile;
use vibrissa_runtime::machine::Failure;
use vibrissa_text::diagnostic::Source;

use super::oracle::{run_both, touches};
use super::tree::{Features, Tree, trees};

/// So few states that eight transitions come to one of them twice.
const FEW: Features = Features { states: 7, rules: 9, times: false, resume: false, always: false };
/// As few, with so many rules that most ways from state to state are ones that nothing leads along.
const CROWDED: Features = Features { rules: 24, ..FEW };

fn goes_round_in_no_tick(tree: &Tree, touches: &[[bool; 8]]) -> Result<(), TestCaseError> {
    let Ok(program) = compile(&Source::new("tree.fsm", tree.text())) else {
        return Err(TestCaseError::reject("goes round"));
    };
    let (machine, ..) = run_both(tree, program, touches)?;
    let goes_round = matches!(machine.failure(), Some(Failure::MicrostepLimit { .. }));
    prop_assert!(!goes_round, "{}", tree.text());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    #[test]
    fn what_compiles_goes_round_in_no_tick(tree in trees(FEW), touches in touches()) {
        goes_round_in_no_tick(&tree, &touches)?;
    }

    #[test]
    fn what_compiles_with_many_rules_goes_round_in_no_tick(tree in trees(CROWDED), touches in touches()) {
        goes_round_in_no_tick(&tree, &touches)?;
    }
}
