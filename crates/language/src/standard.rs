//! The standard library: laws, derived values, behaviours and monitors that every policy can use.

use std::sync::OnceLock;

/// The prefix of the modules' names.
pub(super) const ROOT: &str = "std";

/// The name and the text of a module.
pub type Module = (&'static str, &'static str);

/// The modules that are a part of this crate.
#[cfg(any(test, feature = "standard-library"))]
const OWN: &[Module] = &include!("../std/modules.rs");
#[cfg(not(any(test, feature = "standard-library")))]
const OWN: &[Module] = &[];

static MODULES: OnceLock<&'static [Module]> = OnceLock::new();

/// Gives the program its standard library. Only a program without the feature `standard-library` needs it.
///
/// Such a program is built again in seconds after a change of these texts, because no library contains them. The first
/// texts stay, also those that the feature gave to a compilation before this call.
pub fn install(modules: &'static [Module]) {
    MODULES.get_or_init(|| modules);
}

/// The modules with their texts, in alphabetical order.
pub(super) fn modules() -> &'static [Module] {
    MODULES.get_or_init(|| OWN)
}

/// The text of a module.
pub(super) fn text(module: &str) -> Option<&'static str> {
    modules().iter().find(|(name, _)| *name == module).map(|&(_, text)| text)
}

/// The module that contains a law, derived value, behaviour, monitor or type of this name.
pub(super) fn module_with(name: &str) -> Option<&'static str> {
    let gives = |line: &str| {
        let rest = ["law ", "let ", "behaviour ", "monitor ", "type "].iter().find_map(|word| line.strip_prefix(word));
        rest.and_then(|rest| rest.strip_prefix(name)).is_some_and(|rest| rest.starts_with(['(', ' ']))
    };
    modules().iter().find(|(_, text)| text.lines().any(gives)).map(|&(module, _)| module)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Checked, check};
    use vibrissa_text::diagnostic::Source;

    #[test]
    fn no_module_has_a_fault_since_compiling_what_uses_it_does_not_look_for_one() {
        for (module, text) in modules() {
            let checked = check(&Source::new(*module, *text));
            assert!(matches!(checked, Ok(Checked::Library { .. })), "{module}: {checked:?}");
        }
    }
}
