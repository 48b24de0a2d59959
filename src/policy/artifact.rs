//! Artifacts of programs.

use sha2::{Digest, Sha256};

use crate::diagnostic::{Position, Source};
use vibrissa_runtime::machine::{Artifact, Origin, Program, SourceMap, StatePosition};

use super::ast::{File, Guard, Transition};

/// The artifact of a program, with its source text and syntax tree.
pub(super) fn artifact(source: &Source, file: &File, program: Program) -> Artifact {
    let origin = Origin {
        // Without the folder, so that the same policy gives the same bytes everywhere.
        file: source.name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned(),
        // The hash covers all texts, including those of used files.
        text_sha256: Sha256::digest(&source.text).into(),
        compiler: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Artifact { origin, most_operations: program.most_operations(), program, positions: places(source, file) }
}

fn places(source: &Source, file: &File) -> SourceMap {
    let position = |transition: &Transition| -> Position {
        let (Guard::When { condition: expression, .. } | Guard::After(expression)) = &transition.guard;
        source.line_column(expression.span.start)
    };
    let states = file.states.iter().map(|state| StatePosition {
        name: source.line_column(state.name.span.start),
        transitions: state.transitions.iter().map(position).collect(),
    });
    SourceMap { always: file.always.iter().map(position).collect(), states: states.collect() }
}
