//! Values of parameters.

use vibrissa_runtime::machine::ParameterValue;
use vibrissa_runtime::units::{Dimension, Quantity, parse_quantity};

use super::fault;
use vibrissa_text::diagnostic::Diagnostic;
use vibrissa_yaml::{Node, Placed, Reader};

/// Reads a value of a parameter of a policy, and its text: a quantity, or the name of a choice. The policy checks it later.
pub fn parameter(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<(ParameterValue, String)> {
    let choice = match &node.value {
        Node::Bool(truth) => Some(truth.to_string()),
        Node::Text(text) if let Ok(ParameterValue::Choice(choice)) = ParameterValue::parse(text) => Some(choice),
        _ => None,
    };
    if let Some(text) = choice {
        return Some((ParameterValue::Choice(text.clone()), text));
    }
    quantity(reader, node).map(|(value, text)| (ParameterValue::Quantity(value), text))
}

/// Reads a quantity, and its text. Its dimension is checked later.
pub fn quantity(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<(Quantity, String)> {
    let plain = |value_si| Quantity { value_si, dimension: Dimension::NUMBER, unit: None };
    match &node.value {
        Node::Integer(integer) => Some((plain(*integer as f64), integer.to_string())),
        Node::Float(float) => Some((plain(*float), float.to_string())),
        Node::Text(text) => match parse_quantity(text) {
            Ok(quantity) => Some((quantity, text.clone())),
            Err(error) => {
                let message = format!("`{text}` is not the value of a parameter");
                let fault = Diagnostic::error(fault::QUANTITY, message, reader.extent(node), error.to_string());
                reader.report(fault.hint(error.hint()));
                None
            }
        },
        _ => {
            reader.wrong_type(node, "a number with its unit", "for example `2 cm/s`");
            None
        }
    }
}
