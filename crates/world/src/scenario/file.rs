//! Paths of files.

use std::path::Path;

use super::fault;
use crate::scene::FileReference;
use vibrissa_text::diagnostic::Diagnostic;
use vibrissa_yaml::{Node, Placed, Reader};

/// Reads a path, relative to the referring text. The name of the file is its last component without the extension.
pub fn reference(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<FileReference> {
    let path = reader.text(node)?;
    let Some(name) = Path::new(&path.value).file_stem().and_then(|name| name.to_str()) else {
        let message = match path.value.as_str() {
            "" => "the path of a file is empty".to_owned(),
            other => format!("`{other}` is not the path of a file"),
        };
        let fault =
            Diagnostic::error(fault::NAME, message, path.span, "must be a path relative to the folder of this file");
        reader.report(fault.hint("for example `../policies/vibrissa.fsm`"));
        return None;
    };
    Some(FileReference { name: name.to_owned(), path: path.value.into(), span: path.span })
}

/// The diagnostic for a file that cannot be read, at the reference to it.
#[must_use]
pub fn unreadable(file: &FileReference, reason: &str) -> Diagnostic {
    let message = format!("cannot read `{}`", file.path.display());
    let fault = Diagnostic::error(fault::FILE, message, file.span, reason);
    fault.hint("a path is relative to the folder of this file")
}
