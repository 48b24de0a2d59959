//! Reading of values from the tree.

use crate::fault;
use crate::fields::list;
use crate::node::{Entry, Node, Placed};
use std::borrow::Cow;
use std::fmt::Display;
use std::ops::RangeInclusive;
use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::{Diagnostic, FAULT_LIMIT, Source, Span};

/// Returns the bytes of a file for a path relative to the text, or the reason why it cannot be read.
pub type Files<'f> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'f;

/// The largest total size of the files to which a text refers (bytes).
const MAX_FILE_BYTES: usize = 64 << 20;

/// Reads values and collects diagnostics. An invalid value is returned as `None` and has been reported.
pub struct Reader<'s> {
    source: &'s Source,
    files: &'s mut Files<'s>,
    faults: Vec<Diagnostic>,
    /// Bytes of the files so far.
    file_bytes: usize,
}

impl<'s> Reader<'s> {
    /// Creates a reader for `source` with the diagnostics that exist so far. Referenced files are in `files`.
    pub fn new(source: &'s Source, files: &'s mut Files<'s>, faults: Vec<Diagnostic>) -> Self {
        Self { source, files, faults, file_bytes: 0 }
    }

    /// The bytes of the file with this `path`.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn file(&mut self, path: &str) -> Result<Vec<u8>, String> {
        if self.file_bytes > MAX_FILE_BYTES {
            return Err(format!("the files before it have more than {} MiB together", MAX_FILE_BYTES >> 20));
        }
        let bytes = (self.files)(path)?;
        self.file_bytes += bytes.len();
        Ok(bytes)
    }

    /// The number of diagnostics so far.
    #[must_use]
    pub fn fault_count(&self) -> usize {
        self.faults.len()
    }

    /// The text.
    #[must_use]
    pub fn source(&self) -> &'s Source {
        self.source
    }

    /// Adds a diagnostic, unless the list is full.
    pub fn report(&mut self, fault: Diagnostic) {
        if self.faults.len() < FAULT_LIMIT {
            self.faults.push(fault);
        }
    }

    /// Returns the result, or the diagnostics in the order of the text.
    ///
    /// # Errors
    /// All diagnostics, if there are any.
    pub fn finish<T>(mut self, read: Option<T>) -> Result<T, Vec<Diagnostic>> {
        self.faults.sort_by_key(|fault| fault.primary.span.start);
        read.filter(|_| self.faults.is_empty()).ok_or(self.faults)
    }

    /// Reports a value of the wrong type.
    pub fn wrong_type(&mut self, node: &Placed<Node>, expected: &str, hint: impl Into<String>) {
        let message = format!("expected {expected}, found {}", node.value.kind());
        let label = format!("must be {expected}");
        self.report(Diagnostic::error(fault::TYPE, message, self.extent(node), label).hint(hint));
    }

    /// Reads an integer within a range.
    pub fn count<N>(&mut self, node: &Placed<Node>, name: &str, range: RangeInclusive<N>, example: N) -> Option<N>
    where
        N: TryFrom<i128> + PartialOrd + Display + Copy,
    {
        if let Node::Integer(integer) = node.value
            && let Ok(value) = N::try_from(integer)
            && range.contains(&value)
        {
            return Some(value);
        }
        let place = self.extent(node);
        let shown = self.as_written(node);
        let fault = match &node.value {
            Node::Text(text) if let Some(value) = in_range(text.trim().parse().ok(), &range) => {
                let message = format!("`{name}` is a whole number, found a text");
                Diagnostic::error(fault::TYPE, message, place, "a text, because it is in quotes or marked as one")
                    .hint(format!("write it without: `{name}: {value}`"))
            }
            // YAML 1.1 and 1.2 read it differently.
            Node::Float(float) if has_leading_zero(&shown) => {
                let message = format!("`{name}` has a leading zero, which other programs take for an octal number");
                let fault = Diagnostic::error(fault::RANGE, message, place, "must begin with another digit");
                match in_range(whole(*float), &range) {
                    Some(value) => fault.hint(format!("write `{name}: {value}`")),
                    None => fault.hint(format!("for example `{name}: {example}`")),
                }
            }
            Node::Float(float) if let Some(value) = in_range(whole(*float), &range) => {
                let message = format!("`{name}` is a whole number, found one with a point or an exponent");
                let label = format!("must be a whole number from {} to {}", range.start(), range.end());
                Diagnostic::error(fault::RANGE, message, place, label).hint(format!("write `{name}: {value}`"))
            }
            _ => {
                let message = format!("`{name}` cannot be {shown}");
                let label = format!("must be a whole number from {} to {}", range.start(), range.end());
                Diagnostic::error(fault::RANGE, message, place, label).hint(format!("for example `{name}: {example}`"))
            }
        };
        self.report(fault);
        None
    }

    /// A value in a message, as [`written`], but a number or a truth value in the notation of the text.
    fn as_written<'n>(&self, node: &'n Placed<Node>) -> Cow<'n, str>
    where
        's: 'n,
    {
        let text = self.source.slice(node.span).trim();
        // At an alias, the text has only its name.
        let is_verbatim = matches!(node.value, Node::Bool(_) | Node::Integer(_) | Node::Float(_));
        if is_verbatim && !text.is_empty() && !text.starts_with(['*', '&', '!']) && !text.contains('\n') {
            Cow::Borrowed(text)
        } else {
            Cow::Owned(written(&node.value))
        }
    }

    /// The items of a list of any length.
    pub fn items<'n>(&mut self, node: &'n Placed<Node>, expected: &str, example: &str) -> Option<&'n [Placed<Node>]> {
        if let Node::List(items) = &node.value {
            return Some(items);
        }
        self.wrong_type(node, expected, format!("for example `{example}`"));
        None
    }

    /// The items of a list of three.
    pub fn triple<'n>(&mut self, node: &'n Placed<Node>, example: &str) -> Option<&'n [Placed<Node>; 3]> {
        let items = self.items(node, "a list of 3 numbers", example)?;
        let triple = items.try_into().ok();
        if triple.is_none() {
            let message = format!("expected 3 numbers, found {}", items.len());
            let fault = Diagnostic::error(fault::TYPE, message, self.extent(node), "must be 3 numbers in brackets");
            self.report(fault.hint(format!("for example `{example}`")));
        }
        triple
    }

    /// Reads a boolean.
    pub fn flag(&mut self, node: &Placed<Node>) -> Option<bool> {
        if let Node::Bool(flag) = node.value {
            return Some(flag);
        }
        self.wrong_type(node, "true or false", "write `true` or `false`, without quotes");
        None
    }

    /// Reads a text.
    pub fn text(&mut self, node: &Placed<Node>) -> Option<Placed<String>> {
        if let Node::Text(text) = &node.value {
            return Some(Placed { value: text.clone(), span: self.extent(node) });
        }
        let hint = match &node.value {
            Node::Null => "write a text, or leave the key out if it is optional".to_owned(),
            Node::List(_) | Node::Mapping(_) => "write a text on the line of its key".to_owned(),
            _ => format!("put it into quotes: \"{}\"", self.as_written(node)),
        };
        self.wrong_type(node, "a text", hint);
        None
    }

    /// Reads one of several words, and returns its index among them.
    pub fn choice(&mut self, node: &Placed<Node>, what: &str, words: &[&str]) -> Option<usize> {
        let text = self.text(node)?;
        let index = words.iter().position(|word| *word == text.value);
        if index.is_none() {
            self.report(unknown_choice(&text, what, words));
        }
        index
    }

    /// The single entry of a mapping whose key is the kind of its value: `circle: {…}`.
    pub fn variant<'n>(
        &mut self,
        node: &'n Placed<Node>,
        what: &str,
        kinds: &[&'static str],
        example: &str,
    ) -> Option<(&'static str, &'n Entry)> {
        let Node::Mapping(entries) = &node.value else {
            self.wrong_type(node, what, format!("write it as `{example}`"));
            return None;
        };
        let [entry] = entries.as_slice() else {
            let (span, label) = match entries.get(1) {
                Some(second) => (second.key.span, "a second kind"),
                None => (self.extent(node), "none here"),
            };
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

    /// The span of a complete value. For a list or a mapping, it ends at its end or at the end of its first line.
    #[must_use]
    pub fn extent(&self, node: &Placed<Node>) -> Span {
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

/// An integer, if it is in the range.
fn in_range<N: TryFrom<i128> + PartialOrd>(integer: Option<i128>, range: &RangeInclusive<N>) -> Option<N> {
    N::try_from(integer?).ok().filter(|value| range.contains(value))
}

/// A number without a fraction as an integer.
fn whole(number: f64) -> Option<i128> {
    /// Beyond it, not every integer is a number.
    const EXACT: f64 = 9e15;
    #[expect(clippy::cast_possible_truncation, reason = "it is an integer within the exact ones")]
    let integer = (number.fract() == 0.0 && number.abs() <= EXACT).then_some(number as i128);
    integer
}

/// True for digits that begin with a zero, such as `017`.
fn has_leading_zero(text: &str) -> bool {
    let digits = text.trim_start_matches(['+', '-']);
    digits.len() > 1 && digits.starts_with('0') && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// A value in a message: a scalar in YAML notation, a list or a mapping by its type.
#[must_use]
pub fn written(node: &Node) -> String {
    match node {
        Node::Bool(flag) => flag.to_string(),
        Node::Integer(integer) => integer.to_string(),
        Node::Float(float) => number_text(*float),
        Node::Text(text) => text.clone(),
        other => other.kind().to_owned(),
    }
}

/// A number in a message, with all its digits. A very large or a very small one has an exponent instead of its zeros.
#[must_use]
pub fn number_text(number: f64) -> String {
    if number == 0.0 || (1e-6..1e16).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}
