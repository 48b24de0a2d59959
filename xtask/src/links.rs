//! The links between the pages of the documentation: every one leads to a file, and to a heading or anchor that it has.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use std::{fs, io};

use thiserror::Error;

/// Folders with pages. The first is searched without the folders in it, the others with them.
const FOLDERS: [&str; 4] = ["", BOOK, "deploy", "editors"];
/// The folder of the book. Links of its pages must not lead out of it, since other files are not in the book.
const BOOK: &str = "docs";
/// The book's table of contents. It must list all other pages of the book.
const CONTENTS: &str = "docs/SUMMARY.md";
/// Folders of other programs.
const LEFT_OUT: &str = "node_modules";

/// Why links are not as they should be.
#[derive(Debug, Error)]
pub(crate) enum LinkError {
    #[error("cannot read {}: {cause}", path.display())]
    Read { path: PathBuf, cause: io::Error },
    #[error("correct these links of the documentation:\n  {0}")]
    Findings(String),
}

/// Follows every link of every page of the checkout at `root`.
pub(crate) fn check(root: &Path) -> Result<(), LinkError> {
    let mut paths = Vec::new();
    for folder in FOLDERS {
        collect(root, Path::new(folder), !folder.is_empty(), &mut paths)?;
    }
    let mut pages = BTreeMap::new();
    for path in paths {
        let text =
            fs::read_to_string(root.join(&path)).map_err(|cause| LinkError::Read { path: path.clone(), cause })?;
        pages.insert(path, Page::new(&text));
    }
    let findings = findings(&pages, &|path| root.join(path).exists());
    if findings.is_empty() { Ok(()) } else { Err(LinkError::Findings(findings.join("\n  "))) }
}

/// Adds the pages of a folder, by their paths from the root.
fn collect(root: &Path, folder: &Path, with_folders: bool, pages: &mut Vec<PathBuf>) -> Result<(), LinkError> {
    let read = |cause| LinkError::Read { path: folder.to_path_buf(), cause };
    for entry in fs::read_dir(root.join(folder)).map_err(read)? {
        let entry = entry.map_err(read)?;
        let path = folder.join(entry.file_name());
        if entry.file_type().map_err(read)?.is_dir() {
            if with_folders && entry.file_name() != LEFT_OUT {
                collect(root, &path, true, pages)?;
            }
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
    Ok(())
}

/// What links need to know of a page.
#[derive(Debug, Default, PartialEq)]
struct Page {
    /// The links to files, each with its line.
    links: Vec<(usize, String)>,
    /// The names after `#` that lead into this page.
    anchors: BTreeSet<String>,
}

impl Page {
    fn new(text: &str) -> Self {
        let mut page = Self::default();
        let mut is_code = false;
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim_start().starts_with("```") {
                is_code = !is_code;
            } else if !is_code {
                page.read(number, line);
            }
        }
        page
    }

    /// Takes up what a line outside of code has.
    fn read(&mut self, number: usize, line: &str) {
        if let Some(title) = line.trim_start_matches('#').strip_prefix(' ').filter(|_| line.starts_with('#')) {
            self.add_heading(title);
        }
        let prose: String = line.split('`').step_by(2).collect();
        let is_file = |target: &&str| !target.contains("://") && !target.starts_with("mailto:");
        let targets = behind(&prose, "](", ')').filter(is_file);
        self.links.extend(targets.map(|target| (number, target.to_owned())));
        self.anchors.extend(behind(&prose, "<a id=\"", '"').map(str::to_owned));
    }

    /// A heading's anchor, as forges and mdBook form it. A second heading of the same text gets a number.
    fn add_heading(&mut self, title: &str) {
        let mut anchor = String::new();
        for letter in linkless(title).trim().chars() {
            match letter {
                ' ' => anchor.push('-'),
                letter if letter.is_alphanumeric() || "-_".contains(letter) => anchor.extend(letter.to_lowercase()),
                _ => {}
            }
        }
        let numbered = (1..).map(|number| format!("{anchor}-{number}"));
        let mut names = std::iter::once(anchor.clone()).chain(numbered);
        self.anchors.extend(names.find(|name| !self.anchors.contains(name)));
    }
}

/// The texts between each `start` and the next `end`.
fn behind<'a>(text: &'a str, start: &'a str, end: char) -> impl Iterator<Item = &'a str> {
    text.split(start).skip(1).filter_map(move |rest| rest.split_once(end).map(|(inside, _)| inside))
}

/// A heading with the texts of its links only.
fn linkless(title: &str) -> String {
    let mut parts = title.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once(')').map_or(part, |(_, rest)| rest))
}

/// A line for each link that leads nowhere or out of the book, and for each page that the book does not list.
fn findings(pages: &BTreeMap<PathBuf, Page>, exists: &dyn Fn(&Path) -> bool) -> Vec<String> {
    let mut findings = Vec::new();
    let mut listed = BTreeSet::from([PathBuf::from(CONTENTS)]);
    for (path, page) in pages {
        for (line, link) in &page.links {
            let (file, anchor) = link.split_once('#').map_or((link.as_str(), None), |(file, name)| (file, Some(name)));
            let target = if file.is_empty() { path.clone() } else { beside(path, file) };
            let fault = if path.starts_with(BOOK) && !target.starts_with(BOOK) {
                Some(format!("leads out of `{BOOK}`, and so out of the book"))
            } else if !exists(&target) {
                Some(format!("there is no `{}`", target.display()))
            } else {
                let unknown =
                    anchor.filter(|&name| !pages.get(&target).is_some_and(|page| page.anchors.contains(name)));
                unknown.map(|name| format!("`{}` has no heading or anchor `#{name}`", target.display()))
            };
            findings.extend(fault.map(|fault| format!("{}:{line}: `{link}`: {fault}", path.display())));
            if path == Path::new(CONTENTS) {
                listed.insert(target);
            }
        }
    }
    let unlisted = pages.keys().filter(|path| path.starts_with(BOOK) && !listed.contains(*path));
    findings.extend(unlisted.map(|path| format!("{}: `{CONTENTS}` does not list it", path.display())));
    findings
}

/// The path of a link's file, seen from the root.
fn beside(page: &Path, file: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(Path::new("")).to_path_buf();
    for component in Path::new(file).components() {
        match component {
            // Nothing is above the root: a link that leads there leads nowhere.
            Component::ParentDir if !path.pop() => path.push(".."),
            Component::ParentDir | Component::CurDir => {}
            component => path.push(component),
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The findings of pages, given as path and text.
    fn found(texts: &[(&str, &str)]) -> Vec<String> {
        let pages: BTreeMap<_, _> = texts.iter().map(|(path, text)| (PathBuf::from(path), Page::new(text))).collect();
        let folders = ["docs/decisions", "docs/picture.svg"].map(Path::new);
        findings(&pages, &|path| pages.contains_key(path) || folders.contains(&path))
    }

    #[test]
    fn links_to_files_headings_and_anchors_are_followed() {
        let a = "# A\n\n[b](b.md), [its part](b.md#the-rigs-x_1---y), [here](#a), ![p](picture.svg)\n";
        let b = "## The rig's `x_1` - [y](a.md#a)\n\n<a id=\"old\"></a>\n[up](../README.md)\n";
        let readme = "[a](docs/a.md#a) [old](docs/b.md#old) [folder](docs/decisions)\n";
        let contents = "- [A](a.md)\n  - [B](b.md)\n";
        let pages = [("README.md", readme), ("docs/a.md", a), ("docs/b.md", b), ("docs/SUMMARY.md", contents)];
        let findings = found(&pages);
        assert_eq!(findings, ["docs/b.md:4: `../README.md`: leads out of `docs`, and so out of the book"]);
    }

    #[test]
    fn what_leads_nowhere_is_found_with_its_line() {
        let findings = found(&[("README.md", "# R\n\n[a](a.md)\n[b](#b) [c](../c.md) [d](https://a.b/c.md)\n")]);
        assert_eq!(
            findings,
            [
                "README.md:3: `a.md`: there is no `a.md`",
                "README.md:4: `#b`: `README.md` has no heading or anchor `#b`",
                "README.md:4: `../c.md`: there is no `../c.md`",
            ]
        );
    }

    #[test]
    fn code_has_neither_links_nor_headings() {
        let page = Page::new("`[a](b.md)`\n\n```yaml\n# a comment\n[a](b.md)\n```\n\n[`code`](c.md)\n");
        assert_eq!(page, Page { links: vec![(8, "c.md".to_owned())], anchors: BTreeSet::new() });
    }

    #[test]
    fn headings_of_the_same_text_are_numbered() {
        let page = Page::new("# Limits\n\n## Limits\n\n#hash\n");
        assert_eq!(page.anchors, BTreeSet::from(["limits".to_owned(), "limits-1".to_owned()]));
    }

    #[test]
    fn a_page_that_the_book_does_not_list_is_found() {
        let findings = found(&[("docs/SUMMARY.md", "[A](a.md)\n"), ("docs/a.md", ""), ("docs/b.md", "")]);
        assert_eq!(findings, ["docs/b.md: `docs/SUMMARY.md` does not list it"]);
    }
}
