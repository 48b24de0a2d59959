//! Pages whose stamps differ from what is in the checkout, and their renewal.

use std::fs;
use std::path::Path;

use thiserror::Error;

use super::pages::{PAGES, Page};
use super::stamp::{Stamp, StampError};
use super::{Press, ResultsError, Selection, readme, selected, write_readme};

/// Published figures that are not those of the checkout.
#[derive(Debug, Error)]
pub(crate) enum StaleError {
    #[error(
        "published figures are not those of this checkout, because these inputs changed:\n{0}\nRenew them. The command can be interrupted, \
         and goes on when it is called again:\n  cargo x results --stale\nIf stored figures of the bench have changed too, store them before:\n  \
         INSTA_UPDATE=always cargo test --test program metrics"
    )]
    Stale(String),
    #[error(transparent)]
    Results(#[from] ResultsError),
}

/// A page with the names of its inputs that changed.
struct Stale {
    page: &'static Page,
    changes: Vec<String>,
}

impl Stale {
    /// Those of the pages that are stale, in their order.
    fn among(root: &Path, pages: impl Iterator<Item = &'static Page>) -> Result<Vec<Self>, StampError> {
        let changes = pages.map(|page| Ok(Self { page, changes: changes(root, page)? }));
        let mut stale = changes.collect::<Result<Vec<_>, _>>()?;
        stale.retain(|stale| !stale.changes.is_empty());
        Ok(stale)
    }

    fn line(&self) -> String {
        format!("{}: {}", self.page.path(), self.changes.join(", "))
    }
}

/// What differs from the stamp of a published page.
fn changes(root: &Path, page: &Page) -> Result<Vec<String>, StampError> {
    let stamp = Stamp::of(root, page)?;
    let published = fs::read_to_string(root.join(page.path())).ok().and_then(|text| Stamp::read(&text));
    Ok(published.map_or_else(|| vec!["it has no stamp".to_owned()], |published| stamp.changes(&published)))
}

/// What differs from the stamp of the published page with this name.
pub(crate) fn changes_of(root: &Path, name: &str) -> Result<Vec<String>, ResultsError> {
    let page = PAGES.iter().find(|page| page.name == name).ok_or_else(|| ResultsError::NoPage(name.to_owned()))?;
    Ok(changes(root, page)?)
}

/// Compares the stamps of all pages, and the table of README.md, with what they are made from.
pub(crate) fn check(root: &Path) -> Result<(), StaleError> {
    let stale = Stale::among(root, PAGES.iter()).map_err(ResultsError::from)?;
    let mut lines: Vec<_> = stale.iter().map(Stale::line).collect();
    let [made, present] = readme(root)?;
    if made != present {
        lines.push("README.md: its table is not that of docs/results/bench.md and docs/results/real.md".to_owned());
    }
    let text = lines.iter().fold(String::new(), |text, line| text + "  " + line + "\n");
    if lines.is_empty() { Ok(()) } else { Err(StaleError::Stale(text)) }
}

/// Makes the pages that are stale. A page that cannot be made does not stop the others. The output of every command is kept, so that a
/// second call after an interruption repeats at most one command.
pub(crate) fn renew(root: &Path, selection: &Selection) -> Result<(), ResultsError> {
    let pages = if selection.names.is_empty() { PAGES.iter().collect() } else { selected(&selection.names)? };
    let stale = Stale::among(root, pages.into_iter())?;
    if stale.is_empty() {
        println!("No page is stale.");
        return write_readme(root);
    }
    for stale in &stale {
        eprintln!("{}", stale.line());
    }
    let press = Press::new(root, selection.program.as_deref())?;
    let mut unmade = Vec::new();
    for (index, Stale { page, .. }) in stale.iter().enumerate() {
        let left: Vec<_> = stale[index..].iter().map(|stale| stale.page.name).collect();
        eprintln!("\n[{} of {}] left: {}", index + 1, stale.len(), left.join(", "));
        if let Err(error) = press.make(page, true) {
            eprintln!("error: {error}");
            unmade.push(format!("{}: {error}", page.name));
        }
    }
    write_readme(root)?;
    if unmade.is_empty() { Ok(()) } else { Err(ResultsError::Unmade(unmade.join("\n  "))) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::results::inputs::LIBRARY;

    /// A copy of all that pages are made from, with pages that have nothing but the stamps of it.
    fn copy(name: &str) -> std::path::PathBuf {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let to = std::env::temp_dir().join(format!("vibrissa-{name}-{}", std::process::id()));
        let code = PAGES.iter().flat_map(|page| page.code.iter().copied());
        for path in ["policies", "scenarios", "sweeps", "snapshots/metrics", "README.md"].into_iter().chain(code) {
            copied(&from.join(path), &to.join(path));
        }
        for page in &PAGES {
            let path = to.join(page.path());
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, format!("# Page\n\n{}", Stamp::of(&to, page).unwrap().text())).unwrap();
        }
        write_readme(&to).unwrap();
        to
    }

    fn copied(from: &Path, to: &Path) {
        if from.is_dir() {
            fs::create_dir_all(to).unwrap();
            for entry in fs::read_dir(from).unwrap() {
                let name = entry.unwrap().file_name();
                copied(&from.join(&name), &to.join(name));
            }
        } else {
            fs::create_dir_all(to.parent().unwrap()).unwrap();
            fs::copy(from, to).unwrap();
        }
    }

    /// Changes a text of a file, and gives what the check says.
    fn mutated(root: &Path, file: &str, from: &str, to: &str) -> String {
        let text = fs::read_to_string(root.join(file)).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(root.join(file), text.replacen(from, to, 1)).unwrap();
        let said = check(root).map_or_else(|error| error.to_string(), |()| String::new());
        fs::write(root.join(file), text).unwrap();
        said
    }

    #[test]
    fn a_changed_threshold_fails_the_check_which_names_the_pages_the_file_and_the_command() {
        let root = copy("threshold");
        assert_eq!(check(&root).map_err(|error| error.to_string()), Ok(()));
        let file = format!("{LIBRARY}/following.fsm");
        let text = fs::read_to_string(root.join(&file)).unwrap();
        let threshold =
            text.lines().find(|line| line.trim_start().starts_with("when ") && line.contains(" > ")).unwrap();
        let said = mutated(&root, &file, threshold, &threshold.replacen(" > ", " > 1.01 * ", 1));
        assert!(said.contains(&format!("docs/results/bench.md: {file}\n")), "{said}");
        for page in ["docs/results/mismatch.md", "docs/results/families.md", "docs/results/timing.md"] {
            assert!(said.contains(&format!("{page}: ")), "{page}: {said}");
        }
        assert!(said.contains("\n  cargo x results --stale\n"), "{said}");
        // They run other policies.
        assert!(
            !said.contains("calibration.md") && !said.contains("cable.md") && !said.contains("docs/disk.svg"),
            "{said}"
        );
        assert_eq!(mutated(&root, &file, threshold, &format!("# Why.\n{threshold}  # why")), "");
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn every_kind_of_input_makes_its_pages_stale() {
        let root = copy("inputs");
        for (file, from, to, page) in [
            ("scenarios/disk.yaml", "radius: 0.3 m", "radius: 0.31 m", "docs/disk.svg"),
            ("scenarios/mismatch/hard.yaml", "stiffness: ", "stiffness: 1", "docs/results/mismatch.md"),
            ("sweeps/turns.yaml", "30 deg", "31 deg", "docs/results/reproduction.md"),
            ("policies/lib/contact.fsm", "let ", "let x = 1 let ", "docs/results/policies.md"),
            ("snapshots/metrics/thesis-mujoco.txt", "completed", "timeout", "docs/results/cable.md"),
            ("crates/lab/src/family/draw.rs", "fn ", "fn x() {} fn ", "docs/results/families.md"),
            ("docs/results/stress.md", "commands ", "commands 0", "docs/results/stress.md"),
            ("docs/results/worlds.md", "<!--", "", "docs/results/worlds.md"),
            ("README.md", "| – |", "| 0.1 |", "README.md"),
        ] {
            let said = mutated(&root, file, from, to);
            assert!(said.contains(&format!("  {page}: ")), "{file}: {said}");
        }
        fs::remove_file(root.join("docs/results/pareto.md")).unwrap();
        assert!(check(&root).is_err_and(|error| error.to_string().contains("docs/results/pareto.md: it has no stamp")));
        fs::remove_dir_all(root).unwrap();
    }
}
