//! Texts of bounded size.

use std::io::{Error, ErrorKind};
use std::path::Path;

use vibrissa_runtime::units::suggest;

use super::LoadError;
use vibrissa_text::diagnostic::{NotUtf8, Source, utf8};
use vibrissa_text::file::CommandFiles;
use vibrissa_text::system::in_words;

/// Largest size of a text in bytes, as for the largest scenario.
pub(super) const SIZE_LIMIT: usize = 1 << 20;

/// The name of a file in messages. It is exactly the path, because paths within a text are relative to it.
pub(super) fn name(path: &Path) -> Result<String, LoadError> {
    path.to_str().map(str::to_owned).ok_or_else(|| LoadError::Name { path: path.to_owned() })
}

/// Reads a text.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn read(path: &Path, files: &mut CommandFiles) -> Result<Source, LoadError> {
    let name = name(path)?;
    let text = files.read(path, SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(LoadError::read(path))?;
    Ok(Source::new(name, text))
}

pub(super) fn text(bytes: &[u8]) -> Result<String, Error> {
    let unusable = |cause: &str| Error::new(ErrorKind::InvalidData, cause);
    if bytes.len() > SIZE_LIMIT {
        return Err(unusable(
            "it is larger than 1 MiB; a scenario or policy is a short text; check that this is the right file",
        ));
    }
    let text = utf8(bytes).map_err(|fault| unusable(&format!("{fault}; {}", NotUtf8::ADVICE)))?;
    Ok(text.to_owned())
}

/// Reads standard input.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn read_standard(files: &mut CommandFiles) -> Result<Source, LoadError> {
    let name = "standard input";
    let text =
        files.read_standard(SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(LoadError::read(Path::new(name)))?;
    Ok(Source::new(name, text))
}

/// The reason for a file that cannot be read. For a missing file it suggests a similar name.
pub(super) fn reason(path: &Path, cause: &Error) -> String {
    if cause.kind() != ErrorKind::NotFound {
        return in_words(cause);
    }
    let siblings = siblings(path);
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    match suggest(name, siblings.iter().map(String::as_str).filter(|sibling| *sibling != name)) {
        Some(meant) => format!("{}; did you mean `{meant}`?", in_words(cause)),
        None => in_words(cause),
    }
}

/// The names of the files in the folder of a path, in order. The first of several equally similar names is suggested, and a folder
/// has no order of its own.
pub(super) fn siblings(path: &Path) -> Vec<String> {
    let siblings = path.parent().map(|folder| if folder == Path::new("") { Path::new(".") } else { folder });
    let siblings = siblings.and_then(|folder| folder.read_dir().ok()).into_iter().flatten().flatten();
    let mut siblings: Vec<String> = siblings.filter_map(|sibling| sibling.file_name().into_string().ok()).collect();
    siblings.sort_unstable();
    siblings
}
