//! `vibrissa lsp`

use super::exit::Exit;
use super::failure::Failure;

/// Serves an editor. The protocol requires exit status 1 if the editor ends without a shutdown request.
#[cfg(feature = "lsp")]
pub(super) fn lsp() -> Result<Exit, Failure> {
    use vibrissa_language::server::{Ended, serve};

    let (input, output) = (std::io::BufReader::new(std::io::stdin()), std::io::stdout());
    match serve(input, &mut output.lock(), &vibrissa_lab::load::library_for_editor).map_err(Failure::Editor)? {
        Ended::Orderly => Ok(Exit::Done),
        Ended::Abrupt => Ok(Exit::Unexpected),
    }
}

#[cfg(not(feature = "lsp"))]
pub(super) fn lsp() -> Result<Exit, Failure> {
    Err(Failure::NoLsp)
}
