//! `vibrissa push`

use std::ffi::OsString;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use vibrissa_robot::store::{self, Keys, PushCommand, Role, SignedMachine};

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::provenance::provenance;
use vibrissa_lab::results::Document;

const EXAMPLE: &str = "Example:\n  vibrissa compile policies/thesis.fsm --out thesis.machine\n  minisign -Sm thesis.machine\n  vibrissa push vibrissa@robot thesis.machine\n\nExit status: 0 the robot has the machine; 2 unusable input, or the robot did not take the machine; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa push`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct PushArguments {
    /// The robot, by its name for ssh, such as vibrissa@robot
    #[arg(value_name = "HOST")]
    host: String,
    /// Compiled machine
    #[arg(value_name = "MACHINE")]
    machine: PathBuf,
    /// Signature of the machine. By default, MACHINE.minisig, which `minisign -Sm MACHINE` writes
    #[arg(long, value_name = "FILE")]
    signature: Option<PathBuf>,
    /// Public key of the signer, to verify the signature before the machine is sent. The robot verifies it with its own keys
    /// in any case
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
    /// Program to run in place of ssh. Its arguments are HOST and the command for the robot
    #[arg(long, value_name = "PROGRAM")]
    via: Option<OsString>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// The answer of a robot to a push.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Pushed {
    host: String,
    /// The file of the machine.
    file: String,
    /// SHA-256 of the file, by which the robot names the machine.
    hash: String,
    /// `tentative`, or `good` if the robot has marked this machine good before.
    state: &'static str,
}

impl Document for Pushed {
    const FORMAT: &'static str = "push";
}

pub(super) fn push(arguments: &PushArguments) -> Result<Exit, Failure> {
    let signed = match &arguments.signature {
        Some(signature) => SignedMachine::from_files(&arguments.machine, signature),
        None => SignedMachine::from_file(&arguments.machine),
    }?;
    let signed = match &arguments.key {
        Some(key) => Keys::from_file(key)?.verify(signed)?.signed().clone(),
        None => signed,
    };
    let command = match &arguments.via {
        Some(program) => PushCommand::via(program, &arguments.host),
        None => PushCommand::ssh(&arguments.host),
    };
    let answer = store::push(&command, &signed)?;
    let (host, file) = (arguments.host.clone(), arguments.machine.display().to_string());
    let (state, next) = match answer.state {
        Role::Tentative => ("tentative", "; the next start of the robot's service drives it"),
        Role::Good => ("good", ""),
    };
    if arguments.json {
        output::json(&provenance(), &Pushed { host, file, hash: answer.hash.to_string(), state })?;
    } else {
        output::result(format_args!("{host}: {file} is {state}{next}\n{}", answer.hash))?;
    }
    Ok(Exit::Done)
}
