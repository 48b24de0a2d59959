//! The tree of a YAML text with spans.

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_yaml::{Location, Spanned};
use std::fmt;
use vibrissa_text::diagnostic::Span;

/// A value with its span. For a list or a mapping the span is at its beginning, for an alias at its use.
#[derive(Debug, Clone)]
pub struct Placed<T> {
    /// The value.
    pub value: T,
    /// Its span in the text.
    pub span: Span,
}

/// A YAML value.
#[derive(Debug, Clone)]
pub enum Node {
    /// Nothing, `null` or `~`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A number without a decimal point.
    Integer(i128),
    /// A number with a decimal point or an exponent.
    Float(f64),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Placed<Node>>),
    /// A mapping, in the order of the text.
    Mapping(Vec<Entry>),
}

/// A key of a mapping with its value.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The key.
    pub key: Placed<String>,
    /// Its value.
    pub value: Placed<Node>,
}

impl Node {
    /// The type of the value, with its article.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Null => "nothing",
            Self::Bool(_) => "true or false",
            Self::Integer(_) | Self::Float(_) => "a bare number",
            Self::Text(_) => "a text",
            Self::List(_) => "a list",
            Self::Mapping(_) => "a mapping",
        }
    }
}

impl Placed<Node> {
    /// The entry with this key. `None` if there is none, or if the value is no mapping.
    #[must_use]
    pub fn entry(&self, key: &str) -> Option<&Entry> {
        let Node::Mapping(entries) = &self.value else { return None };
        entries.iter().find(|entry| entry.key.value == key)
    }

    /// The value at a path such as `buses.0.device`, or the innermost value of this path that exists.
    #[must_use]
    pub fn find(&self, path: &str) -> &Self {
        let mut found = self;
        for name in path.split('.') {
            let next = match &found.value {
                Node::List(items) => name.parse().ok().and_then(|index: usize| items.get(index)),
                _ => found.entry(name).map(|entry| &entry.value),
            };
            match next {
                Some(next) => found = next,
                None => break,
            }
        }
        found
    }

    /// Moves all spans by `by` bytes.
    #[must_use]
    pub fn moved(mut self, by: usize) -> Self {
        self.move_on(by);
        self
    }

    fn move_on(&mut self, by: usize) {
        self.span = Span::new(self.span.start + by, self.span.end + by);
        match &mut self.value {
            Node::List(items) => items.iter_mut().for_each(|item| item.move_on(by)),
            Node::Mapping(entries) => {
                for Entry { key, value } in entries {
                    key.span = Span::new(key.span.start + by, key.span.end + by);
                    value.move_on(by);
                }
            }
            _ => {}
        }
    }
}

/// The span of a parser's location, empty at the start of the text if it is unknown.
pub(crate) fn span_of(location: Location) -> Span {
    let byte = |index: Option<u64>| index.and_then(|index| usize::try_from(index).ok()).unwrap_or(0);
    let start = byte(location.span().byte_offset());
    Span::new(start, start.saturating_add(byte(location.span().byte_len())))
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Placed<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Spanned { value, referenced, .. } = Spanned::deserialize(deserializer)?;
        Ok(Self { value, span: span_of(referenced) })
    }
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodeVisitor)
    }
}

struct NodeVisitor;

impl<'de> Visitor<'de> for NodeVisitor {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a YAML value")
    }

    fn visit_unit<E>(self) -> Result<Node, E> {
        Ok(Node::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Integer(value.into()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Node, E> {
        Ok(Node::Integer(value.into()))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Float(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Node, E> {
        Ok(Node::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Node, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = access.next_element()? {
            items.push(item);
        }
        Ok(Node::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Node, A::Error> {
        let mut entries = Vec::new();
        while let Some((key, value)) = access.next_entry()? {
            entries.push(Entry { key, value });
        }
        Ok(Node::Mapping(entries))
    }
}
