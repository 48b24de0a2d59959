//! The order of the modules: each imports only what the table in ARCHITECTURE.md allows.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::sources::rust_files;

/// The page with the table, and the heading above it.
const PAGE: &str = "ARCHITECTURE.md";
const HEADING: &str = "## Modules of `src`";
/// The entry of a module that may import all those above it.
const ALL: &str = "all above";
/// Files of `src` that are no module.
const ROOTS: [&str; 2] = ["lib.rs", "main.rs"];

/// An import that the table does not allow, or a table that does not fit the folders.
#[derive(Debug, Error)]
pub(crate) enum ImportsError {
    #[error("{}: {cause}", path.display())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("{PAGE} has no table below `{HEADING}`; write one with the columns module, content, imports")]
    NoTable,
    #[error("{} imports are not allowed; move the code, or change the table in {PAGE} with a reason:\n  {}", .0.len(), .0.join("\n  "))]
    Imports(Vec<String>),
}

/// The modules that each module may import, in the order of the table.
#[derive(Debug, Default)]
struct Table(Vec<(String, Vec<String>)>);

/// Checks all files in `src` of the checkout at `root`.
pub(crate) fn check(root: &Path) -> Result<(), ImportsError> {
    let page = read(&root.join(PAGE))?;
    let table = Table::parse(&page).ok_or(ImportsError::NoTable)?;
    let mut faults = table.faults();
    let source = root.join("src");
    let mut modules = BTreeSet::new();
    for (path, text) in rust_files(&source).map_err(|(path, cause)| ImportsError::Read { path, cause })? {
        let inside = path.strip_prefix(&source).unwrap_or(&path).to_path_buf();
        let first = inside.components().next().map(|part| part.as_os_str().to_string_lossy().into_owned());
        let Some(first) = first.filter(|first| !ROOTS.contains(&first.as_str())) else { continue };
        let module = first.trim_end_matches(".rs").to_owned();
        for (line, import) in imports(&text) {
            if let Some(fault) = table.fault(&module, &import) {
                faults.push(format!("src/{}:{line}: {fault}", inside.display()));
            }
        }
        modules.insert(module);
    }
    faults.extend(modules.iter().filter(|name| !table.has(name)).map(|name| format!("{PAGE}: src/{name} has no row")));
    let missing = table.0.iter().filter(|(name, _)| !modules.contains(name));
    faults.extend(missing.map(|(name, _)| format!("{PAGE}: there is no src/{name}")));
    if faults.is_empty() { Ok(()) } else { Err(ImportsError::Imports(faults)) }
}

impl Table {
    /// Reads the table below the heading. The first column has a module, the third those that it may import.
    fn parse(page: &str) -> Option<Self> {
        let rows = page.split_once(HEADING)?.1.lines().map(str::trim).skip_while(|line| !line.starts_with('|'));
        let rows = rows.take_while(|line| line.starts_with('|')).skip(2);
        let row = |line: &str| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let name = cells.first()?.trim_matches('`').to_owned();
            let imports = cells.get(2)?.split(',').map(|name| name.trim().trim_matches('`').to_owned());
            Some((name, imports.filter(|name| !name.is_empty()).collect()))
        };
        let mut rows: Vec<(String, Vec<String>)> = rows.filter_map(row).collect();
        for index in 0..rows.len() {
            if rows[index].1 == [ALL] {
                rows[index].1 = rows[..index].iter().map(|(name, _)| name.clone()).collect();
            }
        }
        (!rows.is_empty()).then_some(Self(rows))
    }

    fn has(&self, module: &str) -> bool {
        self.0.iter().any(|(name, _)| name == module)
    }

    /// Rows that allow an import of a module that is not above them: the order would not hold.
    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (index, (module, imports)) in self.0.iter().enumerate() {
            let is_above = |import: &String| self.0[..index].iter().any(|(name, _)| name == import);
            let upward = imports.iter().filter(|import| !is_above(import));
            faults.extend(
                upward.map(|import| format!("{PAGE}: `{module}` cannot import `{import}`, which is not above it")),
            );
        }
        faults
    }

    /// What is wrong with an import of a module.
    fn fault(&self, module: &str, import: &str) -> Option<String> {
        let allowed = self.0.iter().find(|(name, _)| name == module).map(|(_, imports)| imports)?;
        if import == module || !self.has(import) || allowed.iter().any(|name| name == import) {
            return None;
        }
        Some(format!("`{module}` may not import `{import}`"))
    }
}

/// The modules that a text names behind `crate::`, with their lines. Comments do not count.
fn imports(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut list = None;
    for (number, line) in (1..).zip(text.lines()) {
        let code = line.split("//").next().unwrap_or_default();
        if let Some(depth) = list {
            list = listed(code, depth, number, &mut found);
        }
        for (start, prefix) in code.match_indices("crate::") {
            // `$crate::`, or the end of another name.
            let before = code[..start].chars().next_back();
            if before.is_some_and(|letter| letter.is_alphanumeric() || matches!(letter, '_' | '$')) {
                continue;
            }
            let rest = &code[start + prefix.len()..];
            if let Some(rest) = rest.strip_prefix('{') {
                list = listed(rest, 0, number, &mut found);
            } else {
                found.push((number, name(rest)));
            }
        }
    }
    found.retain(|(_, name)| !name.is_empty());
    found
}

/// Takes the modules of a list in braces at `depth`; the depth at the end of the line, or `None` where the list ends.
fn listed(code: &str, mut depth: usize, number: usize, found: &mut Vec<(usize, String)>) -> Option<usize> {
    let mut is_start = depth == 0;
    for (start, letter) in code.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth == 0 => return None,
            '}' => depth -= 1,
            ',' if depth == 0 => is_start = true,
            letter if is_start && letter.is_alphabetic() => {
                found.push((number, name(&code[start..])));
                is_start = false;
            }
            _ => {}
        }
    }
    Some(depth)
}

fn name(text: &str) -> String {
    text.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect()
}

fn read(path: &Path) -> Result<String, ImportsError> {
    fs::read_to_string(path).map_err(|cause| ImportsError::Read { path: path.to_owned(), cause })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    const TABLE: &str = "## Modules of `src`\n\ntext\n\n| module | content | imports |\n|---|---|---|\n\
                         | `low` | a | |\n| `middle` | b | `low` |\n| `high` | c | `low`, `middle` |\n\nmore";

    /// A checkout with this table and these files in `src`.
    fn checked(name: &str, table: &str, sources: &[(&str, &str)]) -> Result<(), ImportsError> {
        let root = std::env::temp_dir().join(format!("vibrissa-imports-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&root);
        for module in ["low", "middle", "high"] {
            fs::create_dir_all(root.join("src").join(module)).unwrap();
            fs::write(root.join("src").join(module).join("mod.rs"), "").unwrap();
        }
        fs::write(root.join("src/lib.rs"), "pub mod low; use crate::low;").unwrap();
        fs::write(root.join(PAGE), table).unwrap();
        for (path, text) in sources {
            fs::write(root.join("src").join(path), text).unwrap();
        }
        let checked = check(&root);
        fs::remove_dir_all(&root).unwrap();
        checked
    }

    #[test]
    fn a_downward_import_passes() {
        let text = "use crate::{low::A, middle::{B, C}};\n// crate::nothing\nfn f() { crate::high::g(); }";
        checked("down", TABLE, &[("high/file.rs", text)]).unwrap();
    }

    #[test]
    fn an_upward_import_is_named_with_its_file_and_line() {
        for text in ["\nuse crate::high::A;", "\nfn f() { crate::high::g(); }", "use crate::{\n    high::A,\n};"] {
            let error = checked("up", TABLE, &[("low/file.rs", text)]).unwrap_err().to_string();
            assert!(error.contains("src/low/file.rs:2: `low` may not import `high`"), "{error}");
        }
    }

    #[test]
    fn a_table_out_of_order_or_without_a_module_fails() {
        let upward = TABLE.replace("| `low` | a | |", "| `low` | a | `high` |");
        assert!(checked("order", &upward, &[]).unwrap_err().to_string().contains("`low` cannot import `high`"));
        let short = TABLE.replace("| `middle` | b | `low` |\n", "").replace(", `middle`", "");
        assert!(checked("short", &short, &[]).unwrap_err().to_string().contains("src/middle has no row"));
        assert!(matches!(checked("none", "", &[]), Err(ImportsError::NoTable)));
    }
}
