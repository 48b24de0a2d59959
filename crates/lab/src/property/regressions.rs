//! Cases that failed, in a file beside the policy.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

use serde::Deserialize;

use super::case::Case;
use vibrissa_declare::catalogue::Entry;
use vibrissa_language::ParameterRange;
use vibrissa_runtime::units::parse_quantity;
use vibrissa_text::file::{CommandFiles, replace};

/// The largest size of a file (bytes): some thousands of cases.
const SIZE_LIMIT: usize = 1 << 20;

/// The beginning of a new file.
const HEADING: &str =
    "# Cases that failed a property. `vibrissa test` runs them first. Keep this file with the policy.\n";

/// The error of a file with failed cases.
#[derive(Debug, thiserror::Error)]
pub enum RegressionsError {
    /// The file cannot be read.
    #[error("cannot read {}: {words}", path.display(), words = in_words(cause))]
    Read {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// The content of the file has errors.
    #[error("{}: {cause}; correct that line, or remove it", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: String,
    },
    /// The file cannot be written.
    #[error("cannot keep the failing case in {}: {words}; make the file writable, or give --no-keep", path.display(), words = in_words(cause))]
    Write {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
}

/// The failed cases of one policy.
#[derive(Debug)]
pub struct Regressions {
    path: PathBuf,
    text: String,
    lines: Vec<Line>,
}

/// A line of the file.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    property: String,
    family: String,
    values: BTreeMap<String, Written>,
}

/// A value as written: a plain number, or a number with its unit.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Written {
    Plain(f64),
    Text(String),
}

impl Regressions {
    /// Reads the cases of the policy at `policy`. A policy without a file has no cases.
    ///
    /// # Errors
    /// [`RegressionsError`] if the file cannot be used.
    pub fn read(policy: &Path, files: &mut CommandFiles) -> Result<Self, RegressionsError> {
        let path = policy.with_extension("regressions.yaml");
        let bytes = match files.read(&path, SIZE_LIMIT) {
            Ok(bytes) => bytes,
            Err(cause) if cause.kind() == ErrorKind::NotFound => Vec::new(),
            Err(cause) => return Err(RegressionsError::Read { path, cause }),
        };
        let content = |cause: String| RegressionsError::Content { path: path.clone(), cause };
        if bytes.len() > SIZE_LIMIT {
            return Err(content("the file is longer than 1 MiB".to_owned()));
        }
        let text = String::from_utf8(bytes).map_err(|cause| content(cause.to_string()))?;
        let has_content = text.lines().any(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let lines: Vec<Line> = if has_content {
            serde_yaml::from_str(&text).map_err(|cause| content(cause.to_string()))?
        } else {
            Vec::new()
        };
        Ok(Self { path, text, lines })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The cases of a property, each once. A case that lacks a parameter, or has a value outside of the ranges, belongs
    /// to an earlier version of the property and is omitted.
    pub fn cases<'r>(
        &'r self,
        property: &'r str,
        entry: &'r Entry,
        ranges: &'r [ParameterRange],
    ) -> impl Iterator<Item = Case> + 'r {
        let lines = self.lines.iter().filter(move |line| line.property == property && line.family == entry.name);
        lines.filter_map(|line| line.case(ranges))
    }

    /// Adds a case to the file.
    ///
    /// # Errors
    /// [`RegressionsError`] if the file cannot be written.
    pub fn keep(&mut self, property: &str, entry: &Entry, case: &Case) -> Result<(), RegressionsError> {
        if self.text.is_empty() {
            HEADING.clone_into(&mut self.text);
        } else if !self.text.ends_with('\n') {
            self.text.push('\n');
        }
        let values =
            case.values().iter().map(|(parameter, value)| format!("{}: {}", parameter.name, parameter.text(*value)));
        let values = values.collect::<Vec<_>>().join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.text,
            "- {{property: {}, family: {}, values: {{{values}}}}}",
            serde_json::Value::from(property),
            entry.name
        );
        replace(&self.path, self.text.as_bytes())
            .map_err(|cause| RegressionsError::Write { path: self.path.clone(), cause })
    }
}

impl Line {
    /// The case with its values in the order of the ranges.
    fn case(&self, ranges: &[ParameterRange]) -> Option<Case> {
        let value = |range: &ParameterRange| {
            let value = match self.values.get(range.parameter.name)? {
                Written::Plain(value) => *value,
                Written::Text(text) => parse_quantity(text).ok()?.value_si,
            };
            let rounding = 1e-6 * range.parameter.step;
            (range.low - rounding..=range.high + rounding).contains(&value).then_some((range.parameter, value))
        };
        ranges.iter().map(value).collect::<Option<_>>().map(Case::new)
    }
}
