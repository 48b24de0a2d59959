//! What one value is drawn from.

use super::super::fault;
use vibrissa_runtime::math;
use vibrissa_runtime::units::{Quantity, parse_quantity};
use vibrissa_text::diagnostic::Diagnostic;
use vibrissa_yaml::{Node, Placed};

/// The resolution of a drawn number, as a share of its range. It bounds the digits in the text of a scene.
const RESOLUTION: f64 = 1e-6;

/// What a value is drawn from.
#[derive(Debug, Clone)]
pub(super) enum Distribution {
    /// A number with a uniform density.
    Range {
        /// The ends, in the unit.
        ends: [f64; 2],
        /// The unit as it is written. Empty for a plain number.
        unit: String,
    },
    /// An integer, both ends included.
    Whole {
        /// The ends.
        ends: [i32; 2],
    },
    /// One of several values, each with the same probability.
    OneOf(Vec<Placed<Node>>),
}

impl Distribution {
    /// Reads what follows the `name` of a draw.
    ///
    /// # Errors
    /// What is neither a range nor a list of values.
    pub(super) fn of(name: &str, node: &Placed<Node>) -> Result<Self, Box<Diagnostic>> {
        let read = match &node.value {
            Node::List(items) if !items.is_empty() => Some(Self::OneOf(items.clone())),
            Node::Text(text) => range(text),
            _ => None,
        };
        read.ok_or_else(|| {
            let message = format!("`{name}` is drawn from a range or from a list of values");
            let fault = Diagnostic::error(fault::RANGE, message, node.span, "is neither of them");
            Box::new(
                fault.hint(
                    "write a range with its smaller end first, such as `30 .. 120 mm`, or a list: `[1 cm, 2 cm]`",
                ),
            )
        })
    }

    /// The value for a share of the range or of the list, from 0 to less than 1.
    pub(super) fn at(&self, share: f64) -> Node {
        match self {
            Self::Range { ends: [least, greatest], unit } => {
                let value = least + share * (greatest - least);
                let decimals = -math::log10(RESOLUTION * (greatest - least)).floor();
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
                let decimals = decimals.clamp(0.0, 17.0) as usize;
                Node::Text(format!("{value:.decimals$} {unit}").trim_end().to_owned())
            }
            Self::Whole { ends: [least, greatest] } => {
                let (least, greatest) = (i64::from(*least), i64::from(*greatest));
                #[expect(clippy::cast_possible_truncation, reason = "less than the number of integers")]
                let above = (share * (greatest - least + 1) as f64) as i64;
                Node::Integer((least + above).into())
            }
            Self::OneOf(items) => {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "less than the number")]
                let index = (share * items.len() as f64) as usize;
                items.get(index).map_or(Node::Null, |item| item.value.clone())
            }
        }
    }
}

/// The range of a text such as `30 .. 120 mm` or `2 .. 5`. An end without a unit has that of the other one.
fn range(text: &str) -> Option<Distribution> {
    let (low, high) = text.split_once("..")?;
    if let (Ok(low), Ok(high)) = (low.trim().parse(), high.trim().parse()) {
        return (low <= high).then_some(Distribution::Whole { ends: [low, high] });
    }
    let (least, greatest) = (parse_quantity(low).ok()?, parse_quantity(high).ok()?);
    let ends = [in_unit_of(&greatest, &least)?, in_unit_of(&greatest, &greatest)?];
    (ends[0] <= ends[1]).then(|| Distribution::Range { ends, unit: unit_text(high).to_owned() })
}

/// The number of `end` in the unit of `other`.
fn in_unit_of(other: &Quantity, end: &Quantity) -> Option<f64> {
    match (other.unit, end.unit) {
        (Some(unit), Some(_)) if end.dimension == other.dimension => Some(unit.from_si(end.value_si)),
        (_, None) => Some(end.value_si),
        _ => None,
    }
}

/// What follows the number in the text of a quantity.
fn unit_text(quantity: &str) -> &str {
    let quantity = quantity.trim();
    let ends = (0..=quantity.len()).rev().filter_map(|end| quantity.split_at_checked(end));
    ends.into_iter().find(|(number, _)| number.trim().parse::<f64>().is_ok()).map_or("", |(_, unit)| unit.trim())
}
