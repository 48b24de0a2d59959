//! `vibrissa compile`

use crate::file::CommandFiles;

use super::exit::{Exit, Failure};
use super::language_arguments::CompileArguments;
use super::{input, output};

pub(super) fn compile(arguments: &CompileArguments) -> Result<Exit, Failure> {
    let (policy, out) = (&arguments.policy, &arguments.out);
    let mut files = CommandFiles::new();
    let read = input::policy(policy, &mut files)?;
    let file = files.output("--out", out)?;
    read.value.tell_warnings();
    let artifact = arguments.settings.of(read)?.value.artifact;
    let bytes = artifact.to_bytes().map_err(Failure::artifact(policy))?;
    file.write(&bytes)?;
    let (machine, size) = (&artifact.program.name, bytes.len());
    output::result(format_args!("{}: machine {machine}, {size} bytes", out.display()))?;
    Ok(Exit::Done)
}
