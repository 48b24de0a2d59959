//! Reader of the lines of a file of results.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use serde::Deserialize;

use crate::results::{Document, Provenance};

use super::header::Header;
use super::results::ResultsError;

/// Largest size of a line in bytes. A header has the text of its sweep, up to 1 MiB, and names its inputs. The line of
/// a run has a few thousand bytes.
pub(super) const LINE_LIMIT: usize = 16 << 20;

/// The keys of a first line that are read before its version is known.
#[derive(Deserialize)]
struct Preamble {
    version: Option<u32>,
    #[serde(default)]
    provenance: Option<Provenance>,
}

/// A reader of results, from the first line on.
pub(super) struct Lines<'f> {
    path: &'f Path,
    reader: BufReader<&'f File>,
    /// Number of lines read.
    number: usize,
    /// Number of bytes of these lines.
    whole: u64,
    /// The origin of the results, after the header has been read.
    pub(super) provenance: Option<Provenance>,
}

impl<'f> Lines<'f> {
    /// A reader at the beginning of a file.
    pub(super) fn new(path: &'f Path, file: &'f File) -> Self {
        Self { path, reader: BufReader::new(file), number: 0, whole: 0, provenance: None }
    }

    /// The header. `None` if the first line is not complete.
    pub(super) fn header(&mut self) -> Result<Option<Header>, ResultsError> {
        let no_results = |cause: String| ResultsError::NoResults { path: self.path.to_owned(), cause };
        let text = self.read()?;
        let is_whole = text.ends_with(b"\n");
        if is_whole {
            let preamble: Preamble = serde_json::from_slice(&text).map_err(|cause| no_results(cause.to_string()))?;
            if preamble.version != Some(Header::VERSION) {
                let version = preamble.version.map_or("no version".to_owned(), |version| format!("version {version}"));
                let this = Header::VERSION;
                return Err(no_results(format!(
                    "it has {version} of the format, and this program reads version {this}"
                )));
            }
            self.provenance = preamble.provenance;
            let header = serde_json::from_slice(&text);
            return header.map(Some).map_err(|cause| no_results(cause.to_string()));
        }
        // Another kind of file without an end of line must not count as an incomplete header.
        let beginning = format!(r#"{{"format":"{}""#, Header::FORMAT).into_bytes();
        let is_torn = text.starts_with(&beginning) || beginning.starts_with(&text);
        if is_torn { Ok(None) } else { Err(no_results("it has no first line".to_owned())) }
    }

    /// The next line with its number. `None` at the end of the file or at an incomplete line.
    pub(super) fn next(&mut self) -> Result<Option<(usize, String)>, ResultsError> {
        let text = self.read()?;
        Ok(text.ends_with(b"\n").then(|| (self.number, String::from_utf8_lossy(&text).into_owned())))
    }

    /// Number of bytes of the complete lines, after everything has been read.
    pub(super) fn whole(&self) -> u64 {
        self.whole
    }

    fn read(&mut self) -> Result<Vec<u8>, ResultsError> {
        let mut text = Vec::new();
        let limit = LINE_LIMIT as u64 + 1;
        let read = self.reader.by_ref().take(limit).read_until(b'\n', &mut text);
        let length = read.map_err(ResultsError::file(self.path))?;
        self.number += 1;
        if length > LINE_LIMIT {
            return Err(ResultsError::LongLine { path: self.path.to_owned(), line: self.number });
        }
        if text.ends_with(b"\n") {
            self.whole += length as u64;
        }
        Ok(text)
    }
}
