//! From a policy's text to its artifact.

use sha2::{Digest, Sha256};

use crate::diagnostic::{Diagnostic, Position, Source};
use crate::machine::{Artifact, Origin, SourceMap, StatePlace};

use super::ast::{File, Guard, Transition};
use super::{lower, parse};

/// Compiles the text of a policy, and keeps where the result comes from.
///
/// # Errors
/// As those of [`compile`](super::compile).
pub fn compile_to_artifact(source: &Source) -> Result<Artifact, Vec<Diagnostic>> {
    let file = parse::parse(source).map_err(|diagnostic| vec![*diagnostic])?;
    let origin = Origin {
        // The same policy gives the same bytes wherever it lies.
        file: source.name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned(),
        text_sha256: Sha256::digest(&source.text).into(),
        compiler: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Ok(Artifact { origin, program: lower::lower(&file)?, places: places(source, &file) })
}

fn places(source: &Source, file: &File) -> SourceMap {
    let position = |transition: &Transition| -> Position {
        let (Guard::When { condition: expression, .. } | Guard::After(expression)) = &transition.guard;
        source.line_column(expression.span.start)
    };
    let states = file.states.iter().map(|state| StatePlace {
        name: source.line_column(state.name.span.start),
        transitions: state.transitions.iter().map(position).collect(),
    });
    SourceMap { always: file.always.iter().map(position).collect(), states: states.collect() }
}
