//! `vibrissa compile`

use super::exit::{Exit, Failure};
use super::input::Policy;
use super::language_arguments::CompileArguments;
use super::{file, input, output};

pub(super) fn compile(arguments: &CompileArguments) -> Result<Exit, Failure> {
    let (policy, out) = (&arguments.policy, &arguments.out);
    let Policy { artifact, text } = arguments.settings.of(input::policy(policy)?)?.value;
    if let Some(text) = &text {
        output::diagnostics(&text.source, &text.warnings);
    }
    let bytes = artifact.to_bytes().map_err(Failure::artifact(policy))?;
    if file::is_same(policy, out) {
        return Err(Failure::OntoItself { path: out.clone() });
    }
    file::write(out, &bytes)?;
    let (machine, size) = (&artifact.program.name, bytes.len());
    output::result(format_args!("{}: machine {machine}, {size} bytes", out.display()))?;
    Ok(Exit::Done)
}
