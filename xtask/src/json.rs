//! The JSON that the program prints, with all numbers as `f64`.

use serde_json::Value;

/// A value of JSON.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

impl Json {
    /// Reads a text that is one value. Returns `None` for any other text.
    pub(crate) fn read(text: &str) -> Option<Self> {
        serde_json::from_str::<Value>(text).ok().map(Self::from)
    }

    /// The value of a key of an object.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let Self::Object(entries) = self else { return None };
        entries.iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }

    /// The values of a list.
    pub(crate) fn items(&self) -> &[Self] {
        if let Self::List(values) = self { values } else { &[] }
    }
}

impl From<Value> for Json {
    fn from(value: Value) -> Self {
        match value {
            Value::Null => Self::Null,
            Value::Bool(is) => Self::Bool(is),
            Value::Number(number) => number.as_f64().map_or(Self::Null, Self::Number),
            Value::String(text) => Self::Text(text),
            Value::Array(values) => Self::List(values.into_iter().map(Self::from).collect()),
            Value::Object(map) => Self::Object(map.into_iter().map(|(key, value)| (key, Self::from(value))).collect()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_objects_in_lists_are_found() {
        let json = Json::read(r#"[{"a": {"b": -1.5e-3, "c": null}, "n": 3}]"#);
        let first = json.as_ref().and_then(|json| json.items().first());
        let value = |key| first.and_then(|first| first.get(key));
        assert_eq!(value("a").and_then(|a| a.get("b")), Some(&Json::Number(-0.0015)));
        assert_eq!((value("n"), value("f")), (Some(&Json::Number(3.0)), None));
        assert_eq!(Json::read("[1 2]"), None);
    }
}
