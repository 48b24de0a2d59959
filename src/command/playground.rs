//! `vibrissa playground`

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use crate::live::serve_folder;
use vibrissa_lab::load::LoadError;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  cargo x playground\n  vibrissa playground\n\nExit status: 2 unusable input; 3 internal error; 130 interrupted.";
/// The files of the playground.
const FILES: [&str; 5] = ["index.html", "playground.css", "playground.js", "worker.js", "vibrissa.wasm"];
/// Largest size of a file (bytes).
const FILE_LIMIT: usize = 64 << 20;

/// The arguments of `vibrissa playground`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct PlaygroundArguments {
    /// Folder that `cargo x playground` has built
    #[arg(value_name = "FOLDER", default_value = "target/playground")]
    folder: PathBuf,
    /// Port. By default, a free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
}

pub(super) fn playground(arguments: &PlaygroundArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let mut read = |name: &str| {
        let path = arguments.folder.join(name);
        let content = files.read(&path, FILE_LIMIT).map_err(LoadError::read(&path))?;
        Ok((name.to_owned(), content))
    };
    let contents = FILES.iter().map(|name| read(name)).collect::<Result<BTreeMap<_, _>, LoadError>>()?;
    let url = serve_folder(contents, arguments.port)?;
    output::result(format_args!("{url}"))?;
    loop {
        std::thread::park();
    }
}
