//! Reading values from the tree.

use super::fault;
use super::fields::list;
use super::key::Key;
use super::node::{Entry, Node, Placed};
use crate::diagnostic::{Diagnostic, Source, Span, suggest};
use crate::geometry::Point2;
use crate::units::{Dimension, Quantity, QuantityError, UnitError, parse_quantity, suggest_unit, units_of};
use std::fmt::Display;
use std::ops::RangeInclusive;

/// Reads values, and collects what is wrong with them. A value that cannot be used is `None`, and has been reported.
pub(super) struct Reader<'s> {
    source: &'s Source,
    faults: Vec<Diagnostic>,
}

impl<'s> Reader<'s> {
    /// A reader of the values of `source`, in which `faults` have been found so far.
    pub(super) fn new(source: &'s Source, faults: Vec<Diagnostic>) -> Self {
        Self { source, faults }
    }

    /// How many faults there are so far.
    pub(super) fn fault_count(&self) -> usize {
        self.faults.len()
    }

    /// Puts a fault on the list.
    pub(super) fn report(&mut self, fault: Diagnostic) {
        self.faults.push(fault);
    }

    /// The faults, in the order of the text.
    pub(super) fn into_faults(mut self) -> Vec<Diagnostic> {
        self.faults.sort_by_key(|fault| fault.primary.span.start);
        self.faults
    }

    /// Reports a value of the wrong type.
    pub(super) fn wrong_type(&mut self, node: &Placed<Node>, expected: &str, hint: impl Into<String>) {
        let message = format!("expected {expected}, found {}", node.value.kind());
        let label = format!("must be {expected}");
        self.report(Diagnostic::error(fault::TYPE, message, self.extent(node), label).hint(hint));
    }

    /// A number in the dimension and range of its key, in SI units.
    pub(super) fn number(&mut self, node: &Placed<Node>, key: &Key) -> Option<Placed<f64>> {
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
            self.report(self.wrong_dimension(span, &quantity, key));
            return None;
        }
        let (least, greatest) = key.range;
        if !(least..=greatest).contains(&quantity.value_si) {
            let message = format!("`{}` cannot be {}", key.name, self.source.slice(span));
            let label = format!("must be {}", key.range_text());
            self.report(Diagnostic::error(fault::RANGE, message, span, label).hint(example(key)));
            return None;
        }
        Some(Placed { value: quantity.value_si, span })
    }

    /// A point: two numbers, each in the dimension and range of the key.
    pub(super) fn point(&mut self, node: &Placed<Node>, key: &Key) -> Option<Placed<Point2>> {
        let span = self.extent(node);
        match &node.value {
            Node::List(items) if let [x, y] = items.as_slice() => {
                let (x, y) = (self.number(x, key), self.number(y, key));
                Some(Placed { value: Point2::new(x?.value, y?.value), span })
            }
            other => {
                let found = match other {
                    Node::List(items) => format!("{} numbers", items.len()),
                    other => other.kind().to_owned(),
                };
                let message = format!("`{}` is two lengths, found {found}", key.name);
                let fault = Diagnostic::error(fault::TYPE, message, span, "must be two lengths in brackets");
                self.report(fault.hint(format!("for example `{}: [0 mm, 72 mm]`", key.name)));
                None
            }
        }
    }

    /// A whole number in a range.
    pub(super) fn count<N>(&mut self, node: &Placed<Node>, name: &str, range: RangeInclusive<N>) -> Option<Placed<N>>
    where
        N: TryFrom<i128> + PartialOrd + Display,
    {
        let span = self.extent(node);
        if let Node::Integer(integer) = node.value
            && let Ok(value) = N::try_from(integer)
            && range.contains(&value)
        {
            return Some(Placed { value, span });
        }
        let message = format!("`{name}` cannot be {}", self.describe(node));
        let label = format!("must be a whole number from {} to {}", range.start(), range.end());
        let hint = format!("write a number such as `{name}: {}`", range.start());
        self.report(Diagnostic::error(fault::RANGE, message, span, label).hint(hint));
        None
    }

    /// The items of a list of any length.
    pub(super) fn items<'n>(
        &mut self,
        node: &'n Placed<Node>,
        expected: &str,
        example: &str,
    ) -> Option<&'n [Placed<Node>]> {
        if let Node::List(items) = &node.value {
            return Some(items);
        }
        self.wrong_type(node, expected, format!("for example `{example}`"));
        None
    }

    /// The items of a list of three.
    pub(super) fn triple<'n>(&mut self, node: &'n Placed<Node>, example: &str) -> Option<&'n [Placed<Node>; 3]> {
        let items = self.items(node, "a list of 3 numbers", example)?;
        let triple = items.try_into().ok();
        if triple.is_none() {
            let message = format!("expected 3 numbers, found {}", items.len());
            let fault = Diagnostic::error(fault::TYPE, message, self.extent(node), "must be 3 numbers in brackets");
            self.report(fault.hint(format!("for example `{example}`")));
        }
        triple
    }

    /// A truth value.
    pub(super) fn flag(&mut self, node: &Placed<Node>) -> Option<bool> {
        if let Node::Bool(flag) = node.value {
            return Some(flag);
        }
        self.wrong_type(node, "true or false", "write `true` or `false`, without quotes");
        None
    }

    /// A text.
    pub(super) fn text(&mut self, node: &Placed<Node>) -> Option<Placed<String>> {
        if let Node::Text(text) = &node.value {
            return Some(Placed { value: text.clone(), span: self.extent(node) });
        }
        self.wrong_type(node, "a text", "put it into quotes if it looks like something else");
        None
    }

    /// One of several words, with its index among them.
    pub(super) fn choice(&mut self, node: &Placed<Node>, what: &str, words: &[&str]) -> Option<usize> {
        let text = self.text(node)?;
        let index = words.iter().position(|word| *word == text.value);
        if index.is_none() {
            self.report(unknown_choice(&text, what, words));
        }
        index
    }

    /// The one entry of a mapping whose key says what its value is: `circle: {…}`.
    pub(super) fn variant<'n>(
        &mut self,
        node: &'n Placed<Node>,
        what: &str,
        kinds: &[&'static str],
        example: &str,
    ) -> Option<(&'static str, &'n Entry)> {
        let entries = match &node.value {
            Node::Mapping(entries) => entries.as_slice(),
            _ => &[],
        };
        let [entry] = entries else {
            let span = entries.get(1).map_or(self.extent(node), |second| second.key.span);
            let label = if entries.is_empty() { "one of the kinds is due here" } else { "this would be a second one" };
            let message = format!("{what} is exactly one of {}", list(kinds, "or"));
            self.report(Diagnostic::error(fault::TYPE, message, span, label).hint(format!("for example `{example}`")));
            return None;
        };
        let kind = kinds.iter().find(|kind| **kind == entry.key.value);
        if kind.is_none() {
            self.report(unknown_choice(&entry.key, what, kinds));
        }
        Some((kind?, entry))
    }

    /// The text of a value as a whole, a list or mapping up to its end or that of its first line.
    pub(super) fn extent(&self, node: &Placed<Node>) -> Span {
        let last = match &node.value {
            Node::List(items) => items.last(),
            Node::Mapping(entries) => entries.last().map(|entry| &entry.value),
            _ => return node.span,
        };
        let end = last.map_or(node.span.end, |last| self.extent(last).end).max(node.span.end);
        let behind = self.source.slice(Span::new(end, self.source.text.len()));
        let closing = if self.source.slice(node.span).starts_with(['[', '{']) {
            let space = behind.len() - behind.trim_start().len();
            if behind[space..].starts_with([']', '}']) { space + 1 } else { 0 }
        } else {
            0
        };
        let whole = Span::new(node.span.start, end + closing);
        let line = self.source.slice(whole).lines().next().unwrap_or_default();
        Span::new(whole.start, whole.start + line.trim_end().len())
    }

    /// A value in a message: scalars as written, others by kind.
    fn describe(&self, node: &Placed<Node>) -> String {
        match &node.value {
            Node::Integer(_) | Node::Float(_) => self.source.slice(node.span).to_owned(),
            Node::Text(text) => format!("`{text}`"),
            other => other.kind().to_owned(),
        }
    }

    fn wrong_dimension(&self, span: Span, quantity: &Quantity, key: &Key) -> Diagnostic {
        let written = self.source.slice(span);
        let due = key.dimension.phrase();
        if key.dimension == Dimension::NUMBER {
            let message = format!("`{}` is a plain number, found {}", key.name, quantity.dimension.phrase());
            return Diagnostic::error(fault::DIMENSION, message, span, "no unit is due here").hint(example(key));
        }
        if quantity.unit.is_none() {
            let number = written.trim_matches(['"', '\'']);
            let readings: Vec<String> = units_of(key.dimension).iter().map(|unit| format!("{number} {unit}")).collect();
            let message = format!("`{}` is {due} and needs its unit", key.name);
            return Diagnostic::error(fault::BARE_NUMBER, message, span, "a number without a unit")
                .hint(format!("write {}", list(&readings, "or")));
        }
        let message = format!("`{}` is {due}, found {}", key.name, quantity.dimension.phrase());
        let label = format!("this is {}", quantity.dimension.phrase());
        Diagnostic::error(fault::DIMENSION, message, span, label).hint(units_hint(key.dimension)).hint(example(key))
    }

    fn bad_quantity(&self, node: &Placed<Node>, text: &str, key: &Key, error: &QuantityError) -> Diagnostic {
        let place = self.within(node, text, error);
        match error {
            QuantityError::Unit(UnitError::Unknown { name, .. }) => {
                let message = format!("there is no unit `{name}`");
                let fault = Diagnostic::error(fault::UNIT, message, place, "unknown unit");
                match suggest_unit(name, key.dimension) {
                    Some(meant) => fault.hint(format!("did you mean `{meant}`?")),
                    None => fault,
                }
                .hint(units_hint(key.dimension))
            }
            QuantityError::Unit(unit) => {
                Diagnostic::error(fault::UNIT, unit.to_string(), place, "in this unit").hint(unit.hint())
            }
            QuantityError::Number { .. } => {
                let message = format!("`{}` is {}, found `{text}`", key.name, key.dimension.phrase());
                Diagnostic::error(fault::QUANTITY, message, place, "not a finite number").hint(example(key))
            }
            QuantityError::TooLarge { .. } => {
                let message = format!("`{}` is too large to be a number", key.name);
                Diagnostic::error(fault::QUANTITY, message, place, format!("must be {}", key.range_text()))
                    .hint(example(key))
            }
        }
    }

    /// The place of an error within a scalar, if the scalar stands in the source letter for letter; else the whole scalar.
    fn within(&self, node: &Placed<Node>, text: &str, error: &QuantityError) -> Span {
        let written = self.source.slice(node.span);
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

fn example(key: &Key) -> String {
    format!("for example `{}: {}`", key.name, key.example)
}

fn units_hint(dimension: Dimension) -> String {
    format!("{} is written in {}", dimension.phrase(), list(&units_of(dimension), "or"))
}

fn unknown_choice(word: &Placed<String>, what: &str, words: &[&str]) -> Diagnostic {
    let message = format!("{what} cannot be `{}`", word.value);
    let label = format!("must be {}", list(words, "or"));
    let fault = Diagnostic::error(fault::CHOICE, message, word.span, label);
    match suggest(&word.value, words.iter().copied()) {
        Some(meant) => fault.hint(format!("did you mean `{meant}`?")),
        None => fault.hint("write one of these"),
    }
}
