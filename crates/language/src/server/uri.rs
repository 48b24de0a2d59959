//! Conversion between file paths and URIs.

use std::fmt::Write;

use gen_lsp_types::Uri;

const SCHEME: &str = "file://";

/// The path of the file that a URI names, if it is on this machine.
pub(super) fn path(uri: &Uri) -> Option<String> {
    let rest = uri.as_ref().strip_prefix(SCHEME)?;
    let rest = rest.strip_prefix("localhost").unwrap_or(rest);
    let path = decoded(rest).filter(|path| path.starts_with('/'))?;
    // `/C:/policies` is `C:/policies`.
    let is_drive = cfg!(windows) && path.get(2..3) == Some(":");
    Some(if is_drive { path[1..].to_owned() } else { path })
}

/// The URI of the file at an absolute path.
pub(super) fn of_path(path: &str) -> Option<Uri> {
    let root = match path.get(1..2) {
        _ if path.starts_with('/') => "",
        Some(":") => "/",
        _ => return None,
    };
    let mut uri = format!("{SCHEME}{root}");
    for &byte in path.as_bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            // Writing to a string cannot fail.
            let _ = write!(uri, "%{byte:02X}");
        }
    }
    Some(Uri::from(uri))
}

/// Decodes percent-encoding, such as `%41`.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..2).filter(|_| first == b'%').and_then(|digits| str::from_utf8(digits).ok());
        let byte = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(byte.unwrap_or(first));
        rest = if byte.is_some() { &behind[2..] } else { behind };
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_address_of_a_file_names_its_path() {
        for (uri, expected) in [
            ("file:///a/b.fsm", Some("/a/b.fsm")),
            ("file://localhost/a.fsm", Some("/a.fsm")),
            ("file:///my%20laws/%C3%BC%3a.fsm", Some("/my laws/\u{fc}:.fsm")),
            ("file:///100%.fsm", Some("/100%.fsm")),
            ("file:///%ff.fsm", None),
            ("file://elsewhere/a.fsm", None),
            ("untitled:Untitled-1", None),
        ] {
            assert_eq!(path(&Uri::from(uri)).as_deref(), expected, "{uri}");
        }
        assert_eq!(of_path("std.swipe"), None);
    }

    proptest! {
        #[test]
        fn a_path_is_that_of_its_address(name in "/\\PC{0,20}") {
            prop_assert_eq!(of_path(&name).and_then(|uri| path(&uri)), Some(name));
        }
    }
}
