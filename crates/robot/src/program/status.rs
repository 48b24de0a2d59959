//! `vibrissa-robot status`

use std::fmt;
use std::process::ExitCode;

use clap::Args;
use serde::Serialize;

use super::command_line::print_result;
use super::drive::Error;
use super::store_options::{KeyOptions, StoreOptions};
use crate::store::{Keys, KeysError, MachineHash, Store, VerifiedMachine};

const EXAMPLE: &str = "Example:\n  vibrissa-robot status";

/// The arguments of `vibrissa-robot status`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct StatusArguments {
    #[command(flatten)]
    store: StoreOptions,
    #[command(flatten)]
    keys: KeyOptions,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// The machines of a store.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Status {
    format: &'static str,
    version: u32,
    /// The last machine that was marked good.
    good: Option<MachineStatus>,
    /// The machine that was pushed last, until it is marked good or given up.
    tentative: Option<TentativeStatus>,
    /// The last machine that was given up.
    rejected: Option<RejectedStatus>,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct MachineStatus {
    /// SHA-256 of the artifact.
    hash: String,
    /// Name of the machine. `null` if there is a problem.
    name: Option<String>,
    /// Name of the file with the public key of the signer. `null` if there is a problem.
    signer: Option<String>,
    /// The comment that the signature covers. `null` if there is a problem.
    trusted_comment: Option<String>,
    /// The reason for which the machine or its signature cannot be verified now.
    problem: Option<String>,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct TentativeStatus {
    #[serde(flatten)]
    machine: MachineStatus,
    /// Number of its starts. After one start, the next start gives it up.
    starts: u32,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct RejectedStatus {
    /// SHA-256 of the artifact.
    hash: String,
    reason: String,
}

/// Prints the machines of the store.
pub(super) fn status(arguments: &StatusArguments) -> Result<ExitCode, Error> {
    let status = Status::of(&arguments.store.open()?, &Keys::from_folder(&arguments.keys.keys))?;
    print_result(&if arguments.json { serde_json::to_string_pretty(&status)? } else { status.to_string() });
    Ok(ExitCode::SUCCESS)
}

impl Status {
    fn of(store: &Store, keys: &Result<Keys, KeysError>) -> Result<Self, Error> {
        let state = store.status()?;
        let machine = |hash| MachineStatus::of(hash, store, keys);
        Ok(Self {
            format: "store",
            version: 1,
            good: state.good.map(machine),
            tentative: state
                .tentative
                .map(|tentative| TentativeStatus { machine: machine(tentative.hash), starts: tentative.starts }),
            rejected: state
                .rejected
                .map(|rejected| RejectedStatus { hash: rejected.hash.to_string(), reason: rejected.reason }),
        })
    }
}

impl MachineStatus {
    fn of(hash: MachineHash, store: &Store, keys: &Result<Keys, KeysError>) -> Self {
        let unverified =
            Self { hash: hash.to_string(), name: None, signer: None, trusted_comment: None, problem: None };
        match verified(hash, store, keys) {
            Ok(machine) => Self {
                name: Some(machine.artifact().program.name.clone()),
                signer: Some(machine.signer().to_owned()),
                trusted_comment: Some(machine.trusted_comment().to_owned()),
                ..unverified
            },
            Err(problem) => Self { problem: Some(problem), ..unverified },
        }
    }
}

/// Verifies a machine of the store with the keys that the robot trusts now.
fn verified(hash: MachineHash, store: &Store, keys: &Result<Keys, KeysError>) -> Result<VerifiedMachine, String> {
    let keys = keys.as_ref().map_err(ToString::to_string)?;
    let signed = store.signed(hash).map_err(|error| error.to_string())?;
    keys.verify(signed).map_err(|error| error.to_string())
}

/// Lines for a terminal.
impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.good {
            Some(machine) => write!(f, "good:      {machine}")?,
            None => write!(f, "good:      none")?,
        }
        if let Some(TentativeStatus { machine, starts }) = &self.tentative {
            let next = if *starts == 0 { "the next start runs it" } else { "started, and the next start gives it up" };
            write!(f, "\ntentative: {machine}\n           {next}")?;
        }
        if let Some(RejectedStatus { hash, reason }) = &self.rejected {
            write!(f, "\ngiven up:  {hash}\n           {reason}")?;
        }
        Ok(())
    }
}

impl fmt::Display for MachineStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.hash)?;
        match (&self.name, &self.signer, &self.trusted_comment) {
            (Some(name), Some(signer), Some(comment)) => {
                let comment = comment.replace('\t', " ");
                write!(f, "\n           {name}, signed by {signer} ({})", comment.escape_debug())
            }
            _ => write!(f, "\n           problem: {}", self.problem.as_deref().unwrap_or_default()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may panic and open files")]

    use super::*;

    #[test]
    fn the_output_is_as_its_schema_says() {
        let generator = schemars::generate::SchemaSettings::draft2020_12().for_serialize().into_generator();
        let mut schema = generator.into_root_schema_for::<Status>();
        schema.insert("title".to_owned(), "Vibrissa: store, version 1".into());
        for (key, value) in [("format", serde_json::json!("store")), ("version", serde_json::json!(1))] {
            *schema.pointer_mut(&format!("/properties/{key}")).unwrap() = serde_json::json!({ "const": value });
        }
        let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/schema/store.schema.json");
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            std::fs::write(path, &text).unwrap();
        }
        assert_eq!(
            std::fs::read_to_string(path).unwrap_or_default(),
            text,
            "run `INSTA_UPDATE=always cargo test --package vibrissa-robot --lib status`"
        );
    }
}
