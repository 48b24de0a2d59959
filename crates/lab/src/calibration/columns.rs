//! The columns of a file of comma-separated values.

use csv::StringRecord;
use vibrissa_runtime::units::suggest;

/// Checks the names of columns: all that are `needed`, each once, and besides only those that are `optional`. `advice` may add to the
/// message about another column.
///
/// # Errors
/// The reason why the header cannot be used.
pub(super) fn check_columns(
    header: &StringRecord,
    needed: &[&str],
    optional: &[&str],
    advice: impl Fn(&str) -> &'static str,
) -> Result<(), String> {
    let known: Vec<&str> = needed.iter().chain(optional).copied().collect();
    if let Some(name) = header.iter().find(|name| !known.contains(name)) {
        if name.contains([';', '\t']) {
            return Err("the columns must be separated by commas".to_owned());
        }
        let meant =
            suggest(name, known.iter().copied()).map_or_else(String::new, |meant| format!("did you mean `{meant}`? "));
        return Err(format!("there is no column `{name}`; {meant}columns are {}{}", known.join(", "), advice(name)));
    }
    if let Some(name) = needed.iter().find(|needed| !header.iter().any(|found| found == **needed)) {
        return Err(format!("the column `{name}` is missing"));
    }
    let repeated =
        header.iter().enumerate().find(|(index, name)| header.iter().take(*index).any(|before| before == *name));
    match repeated {
        Some((_, name)) => Err(format!("the column `{name}` occurs twice; remove one")),
        None => Ok(()),
    }
}
