//! The standard library: laws, derived values, behaviours and monitors that are built into the program.

/// The prefix of the modules' names.
pub(super) const ROOT: &str = "std";

/// The modules with their texts, in alphabetical order.
pub(super) const MODULES: [(&str, &str); 19] = [
    ("contact", include_str!("../std/contact.fsm")),
    ("convexity", include_str!("../std/convexity.fsm")),
    ("corridor", include_str!("../std/corridor.fsm")),
    ("explore", include_str!("../std/explore.fsm")),
    ("feelers", include_str!("../std/feelers.fsm")),
    ("first_contact", include_str!("../std/first_contact.fsm")),
    ("following", include_str!("../std/following.fsm")),
    ("guards", include_str!("../std/guards.fsm")),
    ("mounting", include_str!("../std/mounting.fsm")),
    ("object", include_str!("../std/object.fsm")),
    ("obstacle", include_str!("../std/obstacle.fsm")),
    ("platform", include_str!("../std/platform.fsm")),
    ("retrieval", include_str!("../std/retrieval.fsm")),
    ("search", include_str!("../std/search.fsm")),
    ("senses", include_str!("../std/senses.fsm")),
    ("shaft", include_str!("../std/shaft.fsm")),
    ("sweep", include_str!("../std/sweep.fsm")),
    ("swipe", include_str!("../std/swipe.fsm")),
    ("tunnel", include_str!("../std/tunnel.fsm")),
];

/// The text of a module.
pub(super) fn text(module: &str) -> Option<&'static str> {
    MODULES.iter().find(|(name, _)| *name == module).map(|&(_, text)| text)
}

/// The module that contains a law, derived value, behaviour, monitor or type of this name.
pub(super) fn module_with(name: &str) -> Option<&'static str> {
    let gives = |line: &str| {
        let rest = ["law ", "let ", "behaviour ", "monitor ", "type "].iter().find_map(|word| line.strip_prefix(word));
        rest.and_then(|rest| rest.strip_prefix(name)).is_some_and(|rest| rest.starts_with(['(', ' ']))
    };
    MODULES.iter().find(|(_, text)| text.lines().any(gives)).map(|&(module, _)| module)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Checked, check};
    use vibrissa_text::diagnostic::Source;

    #[test]
    fn no_module_has_a_fault_since_compiling_what_uses_it_does_not_look_for_one() {
        for (module, text) in MODULES {
            let checked = check(&Source::new(module, text));
            assert!(matches!(checked, Ok(Checked::Library { .. })), "{module}: {checked:?}");
        }
    }
}
