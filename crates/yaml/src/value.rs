//! Reading of values from the tree of a text. Errors have the place of the value and words of the configuration.

use std::fmt::{self, Display};

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use vibrissa_runtime::units::suggest;

use vibrissa_text::diagnostic::Span;

use crate::node::{Entry, Node, Placed};
use crate::reader::{number_text, written};

/// Reads a value of any type from a tree.
///
/// # Errors
/// [`Fault`] with the first value that cannot be read.
pub fn read_value<T: DeserializeOwned>(tree: &Placed<Node>) -> Result<T, Fault> {
    T::deserialize(Reader(tree)).map_err(|fault| fault.at(tree.span))
}

/// A value that cannot be read. Its place and key are those of the innermost value that has them.
#[derive(Debug, thiserror::Error)]
pub struct Fault {
    span: Option<Span>,
    key: Option<String>,
    message: String,
}

impl Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.key {
            Some(key) => write!(formatter, "`{key}`: {}", self.message),
            None => formatter.write_str(&self.message),
        }
    }
}

impl Fault {
    /// The place of the value.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span.unwrap_or_default()
    }

    fn new(message: String) -> Self {
        Self { span: None, key: None, message }
    }

    /// The fault of a value at this place.
    fn at(mut self, span: Span) -> Self {
        self.span = self.span.or(Some(span));
        self
    }

    /// The fault of the value of this key.
    fn of(mut self, key: &str) -> Self {
        self.key = self.key.or_else(|| Some(key.to_owned()));
        self
    }
}

impl Error for Fault {
    fn custom<T: Display>(message: T) -> Self {
        Self::new(match message.to_string().as_str() {
            // The words of the standard library do not tell what to write.
            "invalid socket address syntax" => format!("must be {ADDRESS}"),
            other => other.to_owned(),
        })
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::new(format!("must be {}, found {}", expectation(&expected.to_string()), words(found)))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::new(format!("must be {}, found {length} values", expectation(&expected.to_string())))
    }

    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        Self::new(format!("cannot be `{variant}`; {}", advice(variant, expected, "it is")))
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        Self::new(format!("there is no key `{field}`; {}", advice(field, expected, "the keys are")))
    }

    fn missing_field(field: &'static str) -> Self {
        Self::new(format!("the key `{field}` is missing; add it"))
    }

    fn duplicate_field(field: &'static str) -> Self {
        Self::new(format!("the key `{field}` occurs twice; remove one of them"))
    }
}

/// How an address is written.
const ADDRESS: &str = "an IP address with a port, such as \"127.0.0.1:9750\"; names of hosts are not resolved";

fn advice(word: &str, known: &[&str], are: &str) -> String {
    let list = known.iter().map(|known| format!("`{known}`")).collect::<Vec<_>>().join(", ");
    match suggest(word, known.iter().copied()) {
        Some(meant) => format!("did you mean `{meant}`? {are} {list}"),
        None => format!("{are} {list}"),
    }
}

/// What a type of the program is called in a configuration.
fn expectation(expected: &str) -> String {
    let words = match expected {
        "u8" => "a whole number from 0 to 255",
        "u16" => "a whole number from 0 to 65535",
        "u32" | "u64" | "usize" => "a whole number that is not negative",
        "i32" | "i64" => "a whole number",
        "f64" | "f32" => "a number",
        "a boolean" => "true or false",
        "a string" => "a text",
        "path string" => "a path",
        "socket address" => ADDRESS,
        "a sequence" => "a list",
        "a map" => "keys with values",
        _ if expected.starts_with("struct ") => "keys with values",
        _ if expected.starts_with("enum ") => "one of its kinds, as a word or as `kind: {...}`",
        _ => match expected.strip_prefix("an array of length ") {
            Some(count) => return format!("a list of {count} values"),
            None if expected.contains("struct ") => "a value",
            None => return expected.to_owned(),
        },
    };
    words.to_owned()
}

/// A found value in a message.
fn words(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Unit | Unexpected::Option => "nothing".to_owned(),
        Unexpected::Bool(flag) => format!("`{flag}`"),
        Unexpected::Unsigned(number) => format!("`{number}`"),
        Unexpected::Signed(number) => format!("`{number}`"),
        // A whole number would be one without its point.
        Unexpected::Float(number) if number.fract() == 0.0 && number.abs() < 1e15 => format!("`{number:.1}`"),
        Unexpected::Float(number) => format!("`{}`", number_text(number)),
        Unexpected::Str(text) if looks_like_a_number(text) => format!("the text `{text}`"),
        Unexpected::Str(text) => format!("`{text}`"),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "keys with values".to_owned(),
        Unexpected::UnitVariant => "the word alone".to_owned(),
        _ => "another value".to_owned(),
    }
}

/// True for a text that would be a number without its quotes.
fn looks_like_a_number(text: &str) -> bool {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0o"));
    text.parse::<f64>().is_ok_and(f64::is_finite)
        || digits.is_some_and(|digits| u64::from_str_radix(digits, 16).is_ok())
}

/// A value of the text in a message.
fn quoted(node: &Node) -> String {
    match node {
        Node::Mapping(entries) if entries.is_empty() => "no key".to_owned(),
        Node::Mapping(entries) => {
            entries.iter().map(|entry| format!("`{}`", entry.key.value)).collect::<Vec<_>>().join(" and ")
        }
        Node::Null | Node::List(_) => node.kind().to_owned(),
        scalar => format!("`{}`", written(scalar)),
    }
}

/// The reader of one value.
#[derive(Clone, Copy)]
struct Reader<'t>(&'t Placed<Node>);

impl Reader<'_> {
    fn text<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        let read = match &self.0.value {
            Node::Text(text) => visitor.visit_str(text),
            // A quantity without a unit is refused with better words by its own reader.
            Node::Integer(integer) => visitor.visit_str(&integer.to_string()),
            Node::Float(float) => visitor.visit_str(&number_text(*float)),
            _ => return self.any(visitor),
        };
        read.map_err(|fault: Fault| fault.at(self.0.span))
    }

    fn any<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        let read = match &self.0.value {
            Node::Null => visitor.visit_unit(),
            Node::Bool(flag) => visitor.visit_bool(*flag),
            Node::Integer(integer) => match (u64::try_from(*integer), i64::try_from(*integer)) {
                (Ok(integer), _) => visitor.visit_u64(integer),
                (_, Ok(integer)) => visitor.visit_i64(integer),
                _ => visitor.visit_f64(*integer as f64),
            },
            Node::Float(float) => visitor.visit_f64(*float),
            Node::Text(text) => visitor.visit_str(text),
            Node::List(items) => visitor.visit_seq(Items(items.iter())),
            Node::Mapping(entries) => visitor.visit_map(Entries { entries: entries.iter(), value: None }),
        };
        read.map_err(|fault: Fault| fault.at(self.0.span))
    }

    /// A section without content is one without keys.
    fn mapping<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match &self.0.value {
            Node::Null => {
                let read = visitor.visit_map(Entries { entries: [].iter(), value: None });
                read.map_err(|fault: Fault| fault.at(self.0.span))
            }
            // A list has no keys.
            Node::List(_) => Err(Fault::invalid_type(Unexpected::Seq, &visitor).at(self.0.span)),
            _ => self.any(visitor),
        }
    }
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.any(visitor)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.text(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.text(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.mapping(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        self.mapping(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        if matches!(self.0.value, Node::Null) { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        kinds: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        let read = match &self.0.value {
            Node::Text(text) => {
                let word: StrDeserializer<'_, Fault> = text.as_str().into_deserializer();
                visitor.visit_enum(word)
            }
            Node::Mapping(entries) if let [Entry { key, value }] = entries.as_slice() => {
                visitor.visit_enum(Kind { key, value })
            }
            other => {
                let list = kinds.iter().map(|kind| format!("`{kind}`")).collect::<Vec<_>>().join(" or ");
                Err(Fault::new(format!("must be exactly one of {list}, found {}", quoted(other))))
            }
        };
        read.map_err(|fault| fault.at(self.0.span))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char bytes byte_buf unit unit_struct seq tuple tuple_struct
        identifier ignored_any
    }
}

/// The items of a list.
struct Items<'t>(std::slice::Iter<'t, Placed<Node>>);

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Fault;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Fault> {
        self.0.next().map(|item| seed.deserialize(Reader(item))).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The entries of a mapping.
struct Entries<'t> {
    entries: std::slice::Iter<'t, Entry>,
    value: Option<(&'t str, &'t Placed<Node>)>,
}

impl<'de> MapAccess<'de> for Entries<'_> {
    type Error = Fault;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Fault> {
        let Some(Entry { key, value }) = self.entries.next() else { return Ok(None) };
        self.value = Some((&key.value, value));
        let word: StrDeserializer<'_, Fault> = key.value.as_str().into_deserializer();
        seed.deserialize(word).map(Some).map_err(|fault| fault.at(key.span))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Fault> {
        let (key, value) = self.value.take().ok_or_else(|| Fault::new("a value has no key".to_owned()))?;
        seed.deserialize(Reader(value)).map_err(|fault| fault.at(value.span).of(key))
    }
}

/// A kind with its keys: `udp: {address: ...}`.
struct Kind<'t> {
    key: &'t Placed<String>,
    value: &'t Placed<Node>,
}

impl<'de> EnumAccess<'de> for Kind<'_> {
    type Error = Fault;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Fault> {
        let word: StrDeserializer<'_, Fault> = self.key.value.as_str().into_deserializer();
        Ok((seed.deserialize(word).map_err(|fault| fault.at(self.key.span))?, self))
    }
}

impl<'de> VariantAccess<'de> for Kind<'_> {
    type Error = Fault;

    fn unit_variant(self) -> Result<(), Fault> {
        match &self.value.value {
            Node::Null => Ok(()),
            Node::Mapping(entries) if entries.is_empty() => Ok(()),
            _ => Err(Fault::new("has no keys".to_owned()).at(self.value.span).of(&self.key.value)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Fault> {
        seed.deserialize(Reader(self.value)).map_err(|fault| fault.at(self.value.span).of(&self.key.value))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Fault> {
        Reader(self.value).any(visitor).map_err(|fault| fault.of(&self.key.value))
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Fault> {
        Reader(self.value).mapping(visitor).map_err(|fault| fault.of(&self.key.value))
    }
}
