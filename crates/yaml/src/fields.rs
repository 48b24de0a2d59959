//! The keys of one mapping.

use crate::fault;
use crate::node::{Entry, Node, Placed};
use crate::reader::Reader;
use vibrissa_runtime::units::{Key, suggest};
use vibrissa_text::diagnostic::{Diagnostic, Span};

/// The keys of a mapping while it is read. A request for a key makes it known. [`finish`](Self::finish) reports unknown
/// keys, and required keys that are missing.
#[must_use = "unknown and missing keys are reported by `finish`"]
pub struct Fields<'n> {
    /// A description of the mapping, with its article.
    what: &'static str,
    /// The span that represents the whole mapping.
    place: Span,
    entries: &'n [Entry],
    known: Vec<&'static str>,
    /// Keys of an earlier notation, each with the new one.
    former: Vec<(&'static str, &'static str)>,
    missing: Vec<(&'static str, String)>,
}

impl<'n> Fields<'n> {
    /// The keys of `node`, which belongs to the key at `place`. `what` describes it, with its article.
    pub fn of(reader: &mut Reader<'_>, node: &'n Placed<Node>, what: &'static str, place: Span) -> Option<Self> {
        let Node::Mapping(entries) = &node.value else {
            let hint = format!("{what} is written as keys with values, `key: value`, indented below its own key");
            reader.wrong_type(node, "a mapping", hint);
            return None;
        };
        Some(Self { what, place, entries, known: Vec::new(), former: Vec::new(), missing: Vec::new() })
    }

    /// The value of a key, if it exists. The key does not become known by that.
    #[must_use]
    pub fn peek(&self, name: &str) -> Option<&'n Node> {
        self.entries.iter().find(|entry| entry.key.value == name).map(|entry| &entry.value.value)
    }

    /// The entry of a key, if it exists.
    pub fn entry(&mut self, name: &'static str) -> Option<&'n Entry> {
        self.known.push(name);
        self.entries.iter().find(|entry| entry.key.value == name)
    }

    /// Makes a key of an earlier notation known, so that its diagnostic says what to write instead.
    pub fn former(&mut self, name: &'static str, instead: &'static str) {
        self.former.push((name, instead));
    }

    /// The entry of a required key. `example` is a possible value.
    pub fn required(&mut self, name: &'static str, example: &str) -> Option<&'n Entry> {
        let entry = self.entry(name);
        if entry.is_none() {
            self.missing.push((name, format!("{name}: {example}")));
        }
        entry
    }

    /// The number of a required key.
    pub fn number(&mut self, reader: &mut Reader<'_>, key: &Key) -> Option<Placed<f64>> {
        let entry = self.required(key.name, key.example)?;
        reader.number(&entry.value, key)
    }

    /// Writes the number of an optional key into `target`, and returns its span.
    pub fn set(&mut self, reader: &mut Reader<'_>, key: &Key, target: &mut f64) -> Option<Span> {
        let entry = self.entry(key.name)?;
        let number = reader.number(&entry.value, key)?;
        *target = number.value;
        Some(number.span)
    }

    /// Reports unknown and missing keys.
    pub fn finish(mut self, reader: &mut Reader<'_>) {
        let is_there = |name: &str| self.entries.iter().any(|entry| entry.key.value == name);
        let absent: Vec<&str> = self.known.iter().copied().filter(|name| !is_there(name)).collect();
        for Entry { key, .. } in self.entries {
            if self.known.contains(&key.value.as_str()) {
                continue;
            }
            let message = format!("{} has no key `{}`", self.what, key.value);
            if let Some((_, instead)) = self.former.iter().find(|(name, _)| *name == key.value) {
                reader.report(Diagnostic::error(fault::UNKNOWN_KEY, message, key.span, "unknown key").hint(*instead));
                continue;
            }
            let mut diagnostic = Diagnostic::error(fault::UNKNOWN_KEY, message, key.span, "unknown key");
            // A colon without a blank behind it is a part of the key.
            let joined = key.value.split_once(':').filter(|(name, _)| absent.contains(&name.trim()));
            if let Some((name, value)) = joined {
                let (name, value) = (name.trim(), value.trim());
                diagnostic = diagnostic.hint(format!("write a blank after the colon: `{name}: {value}`"));
                self.missing.retain(|(missing, _)| *missing != name);
            } else if let Some(meant) = suggest(&key.value, absent.iter().copied()) {
                diagnostic = diagnostic.hint(format!("did you mean `{meant}`?"));
                // A misspelt key is not reported as missing, because the diagnostic of the unknown key already suggests
                // it.
                self.missing.retain(|(name, _)| *name != meant);
            }
            reader.report(diagnostic.hint(format!("the keys are {}", list(&self.known, "and"))));
        }
        for (name, example) in self.missing {
            let message = format!("{} needs `{name}`", self.what);
            let diagnostic =
                Diagnostic::error(fault::MISSING_KEY, message, self.place, format!("`{name}` is missing here"));
            reader.report(diagnostic.hint(format!("add it, such as `{example}`")));
        }
    }
}

/// Lists words in backticks for a sentence.
#[must_use]
pub fn list(words: &[impl AsRef<str>], conjunction: &str) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{}`", word.as_ref())).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((only, [])) => only.clone(),
        Some((last, rest)) => format!("{} {conjunction} {last}", rest.join(", ")),
    }
}
