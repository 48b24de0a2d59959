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

    /// The values of a list, or those of the only list of objects in an object. So a list may also stand beside its provenance.
    pub(crate) fn items(&self) -> &[Self] {
        match self {
            Self::List(values) => values,
            Self::Object(entries) => {
                let of_objects =
                    |value: &Self| matches!(value, Self::List(values) if matches!(values[..], [Self::Object(_), ..]));
                let mut lists = entries.iter().filter(|(_, value)| of_objects(value));
                match (lists.next(), lists.next()) {
                    (Some((_, list)), None) => list.items(),
                    _ => &[],
                }
            }
            _ => &[],
        }
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
    fn a_list_may_stand_beside_its_provenance() {
        let items = |text: &str| Json::read(text).map(|json| json.items().len());
        assert_eq!(items("[1, 2]"), Some(2));
        assert_eq!(items(r#"{"provenance": {"seeds": [1]}, "scenes": ["a"], "runs": [{"a": 1}, {"a": 2}]}"#), Some(2));
        assert_eq!(items(r#"{"policies": [{"a": 1}], "figures": [{"a": 1}]}"#), Some(0), "which of the two?");
    }

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
