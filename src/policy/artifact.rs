//! Where a program comes from, for its artifact.

use sha2::{Digest, Sha256};

use crate::diagnostic::{Position, Source};
use vibrissa_runtime::machine::{Artifact, Origin, Program, SourceMap, StatePlace};

use super::ast::{File, Guard, Transition};

/// The artifact of a program and of the text and its syntax tree that it comes from.
pub(super) fn artifact(source: &Source, file: &File, program: Program) -> Artifact {
    let origin = Origin {
        // The same policy gives the same bytes wherever it lies.
        file: source.name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned(),
        // All texts: those of the files that it uses too.
        text_sha256: Sha256::digest(&source.text).into(),
        compiler: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Artifact { origin, program, places: places(source, file) }
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
