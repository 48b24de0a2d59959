//! Conditions of guards, evaluated over the registers of a running machine.

use vibrissa_runtime::machine::Register;
use vibrissa_runtime::units::Dimension;

/// A condition: comparisons and bools, joined by `and` and `or`. A `not` is part of its leaves.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// All of them must hold.
    All(Vec<Condition>),
    /// At least one of them must hold.
    Any(Vec<Condition>),
    /// A comparison or a bool.
    Leaf(Leaf),
}

/// A part of a condition without `and` and `or`.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaf {
    /// Its text in the policy or in a library, on one line. It says what has to hold.
    pub text: String,
    /// Register of the bool.
    pub(super) truth: Register,
    /// True if the bool has to be false.
    pub(super) is_negated: bool,
    /// The compared numbers, if it is a comparison of numbers.
    pub(super) compared: Option<Comparison>,
}

/// The registers of two compared numbers. `left` has to be less than, or equal to, `right`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Comparison {
    pub(super) left: Register,
    pub(super) right: Register,
    pub(super) is_equality: bool,
    pub(super) dimension: Dimension,
}

/// A leaf with the values of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged<'c> {
    /// The leaf.
    pub leaf: &'c Leaf,
    /// True if it holds.
    pub holds: bool,
    /// For a comparison of numbers, the distance (SI) of both sides from the value where the leaf changes. It is positive if the
    /// leaf holds, and negative by the amount that is missing.
    pub margin: Option<(f64, Dimension)>,
}

impl Leaf {
    fn judge(&self, registers: &[f64]) -> Judged<'_> {
        let value = |register: Register| registers.get(usize::from(register)).copied().unwrap_or(f64::NAN);
        let margin = self.compared.map(|Comparison { left, right, is_equality, dimension }| {
            let difference = value(right) - value(left);
            let margin = if is_equality { -difference.abs() } else { difference };
            (if self.is_negated { -margin } else { margin }, dimension)
        });
        Judged { leaf: self, holds: (value(self.truth) > 0.5) != self.is_negated, margin }
    }
}

impl Condition {
    /// All leaves in the order of the text.
    #[must_use]
    pub fn judge(&self, registers: &[f64]) -> Vec<Judged<'_>> {
        match self {
            Self::All(parts) | Self::Any(parts) => parts.iter().flat_map(|part| part.judge(registers)).collect(),
            Self::Leaf(leaf) => vec![leaf.judge(registers)],
        }
    }

    /// The smallest set of leaves that have to change so that the condition holds. It is empty if the condition holds. Of two such
    /// sets of an `or`, it is the first.
    #[must_use]
    pub fn missing(&self, registers: &[f64]) -> Vec<Judged<'_>> {
        match self {
            Self::All(parts) => parts.iter().flat_map(|part| part.missing(registers)).collect(),
            Self::Any(parts) => {
                let ways = parts.iter().map(|part| part.missing(registers));
                ways.min_by_key(Vec::len).unwrap_or_default()
            }
            Self::Leaf(leaf) => {
                let judged = leaf.judge(registers);
                if judged.holds { Vec::new() } else { vec![judged] }
            }
        }
    }
}
