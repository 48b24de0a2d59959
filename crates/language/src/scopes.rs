//! The colours of words in editors.

use std::collections::BTreeMap;

use super::builtins::FUNCTIONS;
use super::grammar::is_keyword;
use super::types::{DIMENSIONS, PLAIN_TYPES};
use super::word::Role;
use super::words::{WORDS, reserved};
use vibrissa_runtime::units::{Dimension, units_of};

/// The dimensions whose units are the factors of all others.
const BASES: [Dimension; 7] = [
    Dimension::LENGTH,
    Dimension::ANGLE,
    Dimension::TIME,
    Dimension::MASS,
    Dimension::FREQUENCY,
    Dimension::FORCE,
    Dimension::PRESSURE,
];

/// The words of the language by the scopes of a `TextMate` grammar, in which editors show them: keywords, types, units
/// and functions.
#[must_use]
pub fn scopes() -> BTreeMap<&'static str, Vec<String>> {
    let mut scopes: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    let types = PLAIN_TYPES.iter().copied().filter(|name| !is_keyword(name));
    let types = types.chain(DIMENSIONS.iter().map(|&(name, _)| name));
    scopes.insert("support.type.fsm", types.map(str::to_owned).collect());
    scopes.insert("keyword.other.unit.fsm", BASES.into_iter().flat_map(units_of).collect());
    scopes.insert("support.function.fsm", FUNCTIONS.iter().map(|&(name, ..)| name.to_owned()).collect());
    for word in WORDS.iter().filter(|&entry| reserved(entry.text) == Some(entry)) {
        let scope = match word.role() {
            Role::Declaration => "storage.type.fsm",
            Role::Control => "keyword.control.fsm",
            Role::Action => "keyword.other.fsm",
            Role::Operator => "keyword.operator.logical.fsm",
            Role::Constant => "constant.language.fsm",
            Role::Variable => "variable.language.fsm",
        };
        scopes.entry(scope).or_default().push(word.text.to_owned());
    }
    scopes
}
