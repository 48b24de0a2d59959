//! `vibrissa compile`

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::Settings;
use super::output;
use vibrissa_lab::load::{self, LoadError};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa compile policies/vibrissa.fsm --out vibrissa.machine\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa compile`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct CompileArguments {
    /// Policy file or name of a built-in policy such as `thesis`. Or a compiled machine, to set its parameters
    #[arg(value_name = "POLICY")]
    policy: PathBuf,
    /// File to write, usually NAME.machine
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    settings: Settings,
}

pub(super) fn compile(arguments: &CompileArguments) -> Result<Exit, Failure> {
    let (policy, out) = (&arguments.policy, &arguments.out);
    let mut files = CommandFiles::new();
    let read = load::policy(policy, &mut files)?;
    let file = files.output("--out", out)?;
    output::warnings(&read.value);
    let artifact = arguments.settings.of(read)?.value.artifact;
    let bytes = artifact.to_bytes().map_err(LoadError::artifact(policy))?;
    file.write(&bytes)?;
    let (machine, size, work) = (&artifact.program.name, bytes.len(), artifact.most_operations);
    let out = out.display();
    output::result(format_args!("{out}: machine {machine}, {size} bytes, at most {work} operations a tick"))?;
    Ok(Exit::Done)
}
