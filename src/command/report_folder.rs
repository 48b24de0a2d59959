//! The folder of `--out`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::options::Format;
use super::output;
use super::trials::make_directory;
use vibrissa_text::file::{CommandFiles, Output};

/// The name of the file of finished runs.
const UNFINISHED: &str = "unfinished.jsonl";

/// The files of a report. All of them are named before the runs, so that a refused name costs no run.
pub(super) struct ReportFolder {
    command: &'static str,
    files: BTreeMap<String, Output>,
    page: Output,
    unfinished: Output,
}

impl ReportFolder {
    /// Makes the folder for a page and files with these names, which a `command` writes. `None` without `--out`.
    pub(super) fn new(
        command: &'static str,
        directory: Option<&Path>,
        names: impl IntoIterator<Item = String>,
        files: &mut CommandFiles,
    ) -> Result<Option<Self>, Failure> {
        let Some(directory) = directory else { return Ok(None) };
        make_directory(Some(directory))?;
        let mut file = |name: &str| files.output("--out", &directory.join(name));
        let named = names.into_iter().map(|name| Ok((name.clone(), file(&name)?)));
        let named = named.collect::<Result<_, Failure>>()?;
        Ok(Some(Self { command, files: named, page: file("index.html")?, unfinished: file(UNFINISHED)? }))
    }

    /// The command that writes the report.
    pub(super) fn command(&self) -> &'static str {
        self.command
    }

    /// The path of the finished runs, of which there is a file until the report is there.
    pub(super) fn unfinished(&self) -> &Path {
        self.unfinished.path()
    }

    /// Writes one of the named files.
    pub(super) fn write(&mut self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        Ok(self.files.remove(name).map_or(Ok(()), |file| file.write(content))?)
    }

    /// Writes the page and returns its path. Files that were not written stay as they are.
    pub(super) fn finish(self, page: impl AsRef<[u8]>) -> Result<PathBuf, Failure> {
        let page = written(self.page, page)?;
        self.unfinished.remove()?;
        Ok(page)
    }
}

/// Writes a page and returns its path.
pub(super) fn written(file: Output, page: impl AsRef<[u8]>) -> Result<PathBuf, Failure> {
    let path = file.path().to_owned();
    file.write(page)?;
    Ok(path)
}

/// Says where the page is, unless JSON is printed.
pub(super) fn say(page: Option<PathBuf>, format: Format) -> Result<(), Failure> {
    match page {
        Some(page) if !format.json => output::result(format_args!("report: {}", page.display())),
        _ => Ok(()),
    }
}
