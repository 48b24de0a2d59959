//! Texts of policies with other defaults of their parameters.

use std::collections::BTreeMap;

use vibrissa_text::diagnostic::{Diagnostic, Source};

use super::{format, parse};

/// The text of a policy with other defaults. `values` has the new text of a value by the name of its parameter. The result is formatted.
///
/// # Errors
/// The first syntax error.
///
/// ```
/// use std::collections::BTreeMap;
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::with_defaults;
/// let source = Source::new("m.fsm", "machine m\nparam speed = 50 mm/s in 1 .. 200 mm/s  # of the body\n");
/// let values = BTreeMap::from([("speed".to_owned(), "62 mm/s".to_owned())]);
/// let text = with_defaults(&source, &values)?;
/// assert_eq!(text, "machine m\nparam speed = 62 mm/s in 1 .. 200 mm/s  # of the body\n");
/// # Ok::<(), Vec<vibrissa_text::diagnostic::Diagnostic>>(())
/// ```
pub fn with_defaults(source: &Source, values: &BTreeMap<String, String>) -> Result<String, Vec<Diagnostic>> {
    let file = parse::parse(source, 0).map_err(|fault| vec![*fault])?;
    let mut text = String::with_capacity(source.text.len());
    let mut written = 0;
    for parameter in &file.parameters {
        let Some(value) = values.get(&parameter.name.text) else { continue };
        let span = parameter.value.span();
        text += source.text.get(written..span.start).unwrap_or_default();
        text += value;
        written = span.end;
    }
    text += source.text.get(written..).unwrap_or_default();
    format(&Source::new(source.name.clone(), text))
}
