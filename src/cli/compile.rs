//! `vibrissa compile`

use super::exit::{Exit, Failure};
use super::language_arguments::CompileArguments;
use super::{file, input, output};

pub(super) fn compile(arguments: &CompileArguments) -> Result<Exit, Failure> {
    let (policy, out) = (&arguments.policy, &arguments.out);
    let read = input::policy(policy)?;
    read.value.tell_warnings();
    let artifact = arguments.settings.of(read)?.value.artifact;
    let bytes = artifact.to_bytes().map_err(Failure::artifact(policy))?;
    if file::is_same(policy, out) {
        return Err(Failure::OntoItself { path: out.clone() });
    }
    file::write(out, &bytes)?;
    let (machine, size) = (&artifact.program.name, bytes.len());
    output::result(format_args!("{}: machine {machine}, {size} bytes", out.display()))?;
    Ok(Exit::Done)
}
