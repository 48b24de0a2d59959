//! Policies of the axes.

use std::fmt::Write as _;
use std::sync::Arc;

use vibrissa_language::{compile, gather};
use vibrissa_runtime::machine::Program;
use vibrissa_text::diagnostic::Source;

use super::error::ScaleError;
use super::scene;
use crate::built_in::POLICIES;

/// A policy that follows a contour without an end.
const BANG: &str = include_str!("../../../policies/bang.fsm");
/// The lines of it that name its whisker.
const WHISKER: &str = "whisker r0 by one_channel\n";
const RECORD: &str = "  record r0\n";

/// The policy that follows a contour without an end.
pub(super) fn bang() -> Result<Arc<Program>, ScaleError> {
    program(&Source::new("bang.fsm", BANG))
}

/// The same with this number of whiskers, all of which it records. The first one steers.
pub(super) fn with_whiskers(count: usize) -> Result<Arc<Program>, ScaleError> {
    let names = scene::whiskers(count);
    let lines =
        |before: &str, after: &str| names.iter().map(|name| [before, name, after, "\n"].concat()).collect::<String>();
    let text = BANG.replace(WHISKER, &lines("whisker ", " by one_channel")).replace(RECORD, &lines("  record ", ""));
    program(&Source::new("bang.fsm", text))
}

/// The built-in policy that traces a contour once.
pub(super) fn tracing() -> Source {
    Source::new(POLICIES[0].path, POLICIES[0].text)
}

/// The compiled policy of a text that uses the standard library alone.
pub(super) fn program(source: &Source) -> Result<Arc<Program>, ScaleError> {
    let source = gather(source, &mut |path| Err(format!("{path} is not built in")));
    let program = compile(&source).map_err(|faults| ScaleError::Text(format!("{}: {faults:?}", source.name)))?;
    Ok(Arc::new(program))
}

/// The text of a policy with a cycle of states.
pub(super) fn with_states(count: usize) -> Source {
    let head = "machine cycle\nparam speed = 30 mm/s in 1 .. 50 mm/s\nwhisker r0\ninitial S0\n".to_owned();
    let text = (0..count).fold(head, |mut text, state| {
        let (next, rate) = ((state + 1) % count, state % 10);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "state S{state} {{\n  steer body along direction(body.yaw) at speed turning {rate} deg/s\n  when r0.touching for 1 s -> S{next}\n}}"
        );
        text
    });
    Source::new("cycle.fsm", text)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn a_policy_with_more_whiskers_records_all_of_them() {
        for count in [2, 4, 8] {
            let program = with_whiskers(count).unwrap();
            assert_eq!(program.whiskers.len(), count);
            assert_eq!(program.contact_estimators, vec![bang().unwrap().contact_estimators[0]; count]);
        }
    }
}
