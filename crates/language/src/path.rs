//! Resolution of the paths in `use`.

use std::path::Path;

use vibrissa_text::diagnostic::Diagnostic;

use super::ast::{From, Use};
use super::standard::{ROOT, modules, text};
use super::suggestion::did_you_mean;

/// The name of the file that `used` means in the file `using`: `std.` and a module, or a path.
///
/// Paths are compared as text. Symbolic links are not resolved.
pub(super) fn resolve(using: &str, used: &Use) -> Result<String, Box<Diagnostic>> {
    match &used.from {
        From::Path(path) => match fault(path) {
            None => Ok(join(using, path)),
            Some(fault) => {
                let message = format!("`{path}` is not the path of a library");
                let fault = Diagnostic::error("P0601", message, used.span, fault);
                Err(Box::new(fault.hint(
                    "a path is relative to the folder of this file, such as \"laws/corner.fsm\" or \"../corner.fsm\"",
                )))
            }
        },
        From::Module(names) => {
            let known: Vec<String> = modules().iter().map(|(module, _)| format!("{ROOT}.{module}")).collect();
            let written = names.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join(".");
            if known.contains(&written) {
                return Ok(written);
            }
            let message = format!("there is no module `{written}`");
            let diagnostic = Diagnostic::error("P0601", message, used.span, "unknown module");
            let diagnostic = did_you_mean(diagnostic, &written, known.iter().map(String::as_str));
            let list = known.iter().map(|module| format!("`{module}`")).collect::<Vec<_>>().join(", ");
            let has = if list.is_empty() {
                "this program has no standard library: it needs the feature `standard-library`".to_owned()
            } else {
                format!("the standard library has {list}")
            };
            Err(Box::new(diagnostic.hint(has).hint("your own files are in quotes: `use \"laws/corner.fsm\"`")))
        }
    }
}

/// The text of the standard module with this name.
pub(super) fn standard(name: &str) -> Option<&'static str> {
    text(name.strip_prefix(ROOT)?.strip_prefix('.')?)
}

/// The reason for which a path is not allowed.
fn fault(path: &str) -> Option<&'static str> {
    if path.contains(['\\', ':']) || path.contains(char::is_control) {
        Some("separate folders by `/`, without `\\` or `:`")
    } else if path.starts_with('/') {
        Some("use a path that is relative to the folder of this file")
    } else if path.split('/').any(|part| part.trim() != part || part.is_empty()) {
        Some("a name in the path is empty, or has spaces around it")
    } else if Path::new(path).extension().is_none_or(|extension| extension != "fsm") {
        Some("the name of a library's file ends in `.fsm`")
    } else {
        None
    }
}

/// The path `path` of the file `using`, relative to the folder to which `using` is relative.
fn join(using: &str, path: &str) -> String {
    let (root, using) = using.strip_prefix('/').map_or(("", using), |rest| ("/", rest));
    let folder = using.rsplit_once('/').map_or("", |(folder, _)| folder);
    format!("{root}{}", plain(folder.split('/').chain(path.split('/'))))
}

/// True if two names mean the same file.
pub(super) fn is_same(name: &str, other: &str) -> bool {
    plain(name.split('/')) == plain(other.split('/'))
}

/// Normalises a path: removes `.`, and every `..` that follows a folder.
fn plain<'p>(parts: impl Iterator<Item = &'p str>) -> String {
    let mut plain: Vec<&str> = Vec::new();
    for part in parts {
        match (part, plain.last()) {
            ("" | ".", _) => {}
            ("..", Some(&last)) if last != ".." => {
                plain.pop();
            }
            _ => plain.push(part),
        }
    }
    plain.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_from_the_file_that_it_stands_in() {
        for (using, path, joined) in [
            ("a.fsm", "b.fsm", "b.fsm"),
            ("policies/a.fsm", "laws/b.fsm", "policies/laws/b.fsm"),
            ("policies/a.fsm", "../b.fsm", "b.fsm"),
            ("policies/a.fsm", "../../b.fsm", "../b.fsm"),
            ("../a.fsm", "../b.fsm", "../../b.fsm"),
            ("./a.fsm", "./b.fsm", "b.fsm"),
            ("/home/a.fsm", "laws/b.fsm", "/home/laws/b.fsm"),
            ("standard input", "b.fsm", "b.fsm"),
        ] {
            assert_eq!(join(using, path), joined);
        }
    }

    #[test]
    fn what_is_no_plain_path_is_refused() {
        for path in
            ["", "/b.fsm", "a//b.fsm", "a\\b.fsm", "https://a/b.fsm", "C:/b.fsm", " b.fsm", "b", "a/", "b\t.fsm"]
        {
            assert!(fault(path).is_some(), "{path}");
        }
        for path in ["b.fsm", "../b.fsm", "./b.fsm", "my laws/b.fsm", "\u{fc}ber.fsm"] {
            assert!(fault(path).is_none(), "{path}");
        }
    }
}
