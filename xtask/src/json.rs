//! JSON, read without a library: this program is compiled before everything else.

use std::str::Chars;

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
    /// Reads a text that is one value; `None` if it is not.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let mut rest = text.chars();
        let value = value(&mut rest)?;
        rest.as_str().trim().is_empty().then_some(value)
    }

    /// The value of an object's key.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let Self::Object(entries) = self else { return None };
        entries.iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }

    /// The values of a list.
    pub(crate) fn items(&self) -> &[Self] {
        if let Self::List(values) = self { values } else { &[] }
    }
}

/// Takes a value off the front of a text.
fn value(rest: &mut Chars) -> Option<Json> {
    skip_blanks(rest);
    let text = rest.as_str();
    match text.chars().next()? {
        '{' => items(rest, '}', |rest| {
            let key = string(rest)?;
            take(rest, ':')?;
            Some((key, value(rest)?))
        })
        .map(Json::Object),
        '[' => items(rest, ']', value).map(Json::List),
        '"' => string(rest).map(Json::Text),
        _ => {
            let end = text.find(|letter: char| !letter.is_ascii_alphanumeric() && !"+-.".contains(letter));
            let (word, behind) = text.split_at(end.unwrap_or(text.len()));
            *rest = behind.chars();
            match word {
                "null" => Some(Json::Null),
                "true" => Some(Json::Bool(true)),
                "false" => Some(Json::Bool(false)),
                word => word.parse().ok().filter(|number: &f64| number.is_finite()).map(Json::Number),
            }
        }
    }
}

/// Takes what is between brackets, item by item.
fn items<T>(rest: &mut Chars, close: char, mut item: impl FnMut(&mut Chars) -> Option<T>) -> Option<Vec<T>> {
    rest.next();
    let mut items = Vec::new();
    while take(rest, close).is_none() {
        if !items.is_empty() {
            take(rest, ',')?;
        }
        items.push(item(rest)?);
    }
    Some(items)
}

fn string(rest: &mut Chars) -> Option<String> {
    take(rest, '"')?;
    let mut text = String::new();
    loop {
        match rest.next()? {
            '"' => return Some(text),
            '\\' => match rest.next()? {
                'n' => text.push('\n'),
                't' => text.push('\t'),
                'u' => {
                    let digits: String = rest.by_ref().take(4).collect();
                    text.push(char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?);
                }
                letter => text.push(letter),
            },
            letter => text.push(letter),
        }
    }
}

/// Takes a letter, with the blanks before it.
fn take(rest: &mut Chars, letter: char) -> Option<()> {
    skip_blanks(rest);
    *rest = rest.as_str().strip_prefix(letter)?.chars();
    Some(())
}

fn skip_blanks(rest: &mut Chars) {
    *rest = rest.as_str().trim_start().chars();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_read_into_its_values() {
        let text = r#" [ {"a": {"b": -1.5e-3, "c": null}, "d": "x\"\\y\n\u00b5", "e": [true, false, []]} ] "#;
        let json = Json::read(text);
        let first = json.as_ref().and_then(|json| json.items().first());
        let value = |key| first.and_then(|first| first.get(key));
        assert_eq!(value("a").and_then(|a| a.get("b")), Some(&Json::Number(-0.0015)));
        assert_eq!(value("a").and_then(|a| a.get("c")), Some(&Json::Null));
        assert_eq!(value("d"), Some(&Json::Text("x\"\\y\nµ".to_owned())));
        assert_eq!(value("e"), Some(&Json::List(vec![Json::Bool(true), Json::Bool(false), Json::List(Vec::new())])));
        assert_eq!(value("f"), None);
    }

    #[test]
    fn what_is_not_json_is_no_value() {
        for text in ["", "[1 2]", "{\"a\" 1}", "[1", "\"a", "1 2", "NaN", "nul"] {
            assert_eq!(Json::read(text), None, "{text}");
        }
    }
}
