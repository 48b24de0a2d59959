//! Reading of numbers with units.

use crate::fault;
use crate::fields::list;
use crate::node::{Node, Placed};
use crate::reader::{Reader, written};
use vibrissa_runtime::geometry::Point2;
use vibrissa_runtime::units::{
    Dimension, Key, Quantity, QuantityError, UnitError, parse_quantity, unit_hint, units_of,
};
use vibrissa_text::diagnostic::{Diagnostic, Span};

impl Reader<'_> {
    /// Reads a number with the dimension and the range of its key, in SI units.
    pub fn number(&mut self, node: &Placed<Node>, key: &Key) -> Option<Placed<f64>> {
        let span = self.extent(node);
        let quantity = match &node.value {
            Node::Text(text) => match parse_quantity(text) {
                Ok(quantity) => quantity,
                Err(error) => {
                    self.report(self.bad_quantity(node, text, key, &error));
                    return None;
                }
            },
            Node::Integer(integer) => plain(*integer as f64),
            Node::Float(float) => plain(*float),
            other => {
                let expected = key.dimension.phrase();
                let message = format!("expected {expected} for `{}`, found {}", key.name, other.kind());
                let fault = Diagnostic::error(fault::TYPE, message, span, format!("must be {expected}"));
                self.report(fault.hint(example(key)));
                return None;
            }
        };
        if quantity.dimension != key.dimension {
            self.report(wrong_dimension(&node.value, span, &quantity, key));
            return None;
        }
        if !key.contains(quantity.value_si) {
            let message = format!("`{}` cannot be {}", key.name, written(&node.value));
            let label = format!("must be {}", key.range_text());
            self.report(Diagnostic::error(fault::RANGE, message, span, label).hint(example(key)));
            return None;
        }
        Some(Placed { value: quantity.value_si, span })
    }

    /// Reads a point: two numbers with the dimension and the range of the key.
    pub fn point(&mut self, node: &Placed<Node>, key: &Key) -> Option<Placed<Point2>> {
        let span = self.extent(node);
        match &node.value {
            Node::List(items) if let [x, y] = items.as_slice() => {
                let (x, y) = (self.number(x, key), self.number(y, key));
                Some(Placed { value: Point2::new(x?.value, y?.value), span })
            }
            other => {
                let found = match other {
                    Node::List(items) => format!("{} values", items.len()),
                    other => other.kind().to_owned(),
                };
                let message = format!("a point is two lengths, found {found}");
                let fault = Diagnostic::error(fault::TYPE, message, span, "must be two lengths in brackets");
                self.report(fault.hint(example(key)));
                None
            }
        }
    }

    fn bad_quantity(&self, node: &Placed<Node>, text: &str, key: &Key, error: &QuantityError) -> Diagnostic {
        let place = self.within(node, text, error);
        match error {
            QuantityError::Unit(UnitError::Unknown { name, .. }) => {
                let message = format!("there is no unit `{name}`");
                let fault = Diagnostic::error(fault::UNIT, message, place, "unknown unit");
                match unit_hint(name, key.dimension) {
                    Some(hint) => fault.hint(hint),
                    None => fault,
                }
                .hint(units_hint(key.dimension))
            }
            QuantityError::Unit(unit) => {
                Diagnostic::error(fault::UNIT, unit.to_string(), place, "in this unit").hint(unit.hint())
            }
            QuantityError::Number { .. } => {
                let message = format!("`{}` is {}, found `{text}`", key.name, key.dimension.phrase());
                let label = match text {
                    // The parser's notation of numbers that are not finite, independent of the notation in the
                    // scenario.
                    ".nan" | ".inf" | "-.inf" => "must be finite",
                    _ if key.dimension == Dimension::NUMBER => "must be a number",
                    _ => "must be a number with its unit",
                };
                Diagnostic::error(fault::QUANTITY, message, place, label).hint(example(key))
            }
            QuantityError::TooLarge { .. } => {
                let message = format!("`{}` is too large to be a number", key.name);
                let label = format!("must be {}", key.range_text());
                Diagnostic::error(fault::QUANTITY, message, place, label).hint(example(key))
            }
        }
    }

    /// The span of an error within a scalar, if the source contains the scalar verbatim. Otherwise the span of the
    /// whole scalar.
    fn within(&self, node: &Placed<Node>, text: &str, error: &QuantityError) -> Span {
        let written = self.source().slice(node.span);
        let quote = usize::from(written.starts_with(['"', '\'']));
        if written.get(quote..quote + text.len()) == Some(text) {
            let start = node.span.start + quote;
            Span::new(start + error.range().start, start + error.range().end)
        } else {
            node.span
        }
    }
}

fn plain(value_si: f64) -> Quantity {
    Quantity { value_si, dimension: Dimension::NUMBER, unit: None }
}

fn wrong_dimension(node: &Node, span: Span, quantity: &Quantity, key: &Key) -> Diagnostic {
    let (due, found) = (key.dimension.phrase(), quantity.dimension.phrase());
    if key.dimension == Dimension::NUMBER {
        let message = format!("`{}` is {due}, found {found}", key.name);
        return Diagnostic::error(fault::DIMENSION, message, span, "write it without a unit").hint(example(key));
    }
    if quantity.unit.is_none() {
        let number = written(node);
        let readings: Vec<String> = units_of(key.dimension).iter().map(|unit| format!("{number} {unit}")).collect();
        let message = format!("`{}` is {due} and needs its unit", key.name);
        return Diagnostic::error(fault::BARE_NUMBER, message, span, "a number without a unit")
            .hint(format!("write {}", list(&readings, "or")));
    }
    let message = format!("`{}` is {due}, found {found}", key.name);
    let fault = Diagnostic::error(fault::DIMENSION, message, span, format!("this is {found}"));
    fault.hint(units_hint(key.dimension)).hint(example(key))
}

fn example(key: &Key) -> String {
    format!("for example `{}: {}`", key.name, key.example)
}

fn units_hint(dimension: Dimension) -> String {
    format!("{} is written in {}", dimension.phrase(), list(&units_of(dimension), "or"))
}
