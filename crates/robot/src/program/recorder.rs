//! The recorder of the program.

use std::collections::BTreeMap;
use std::time::{SystemTime, UNIX_EPOCH};

use vibrissa_runtime::machine::Artifact;

use super::command_line::print_error;
use super::drive::Error;
use crate::config::Config;
use crate::recording::{Origin, Recorder, Setup, program_sha256};

/// The recorder that the configuration asks for. `text` is the file of the configuration.
pub(super) fn recorder(config: &Config, text: String, artifact: &Artifact) -> Result<Option<Recorder>, Error> {
    let Some(record) = &config.record else { return Ok(None) };
    let setup = Setup::new(config.clone(), Some(text), artifact.clone())?;
    // A clock before 1970 is not set.
    let started = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let origin = Origin {
        program: concat!("vibrissa-robot ", env!("CARGO_PKG_VERSION")).to_owned(),
        program_sha256: program_sha256(),
        details: BTreeMap::from([("started_unix_ns".to_owned(), started.as_nanos().to_string())]),
    };
    let warn = Box::new(|warning: &str| print_error(&format!("warning: {warning}")));
    Ok(Some(Recorder::new(record, setup, &origin, warn)?))
}
