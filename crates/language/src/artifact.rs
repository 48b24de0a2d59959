//! Artifacts of programs.

use sha2::{Digest, Sha256};

use vibrissa_runtime::machine::{Artifact, Origin, Program, SourceMap, StatePosition};
use vibrissa_text::diagnostic::{Position, Source};

use super::ast::{Guard, Transition};
use super::load::Files;

/// The artifact of a program, with its source text and syntax tree.
pub(super) fn artifact(source: &Source, files: &Files, program: Program) -> Artifact {
    let origin = Origin {
        // Without the folder, so that the same policy gives the same bytes everywhere.
        file: source.name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned(),
        // The hash covers all texts, including those of used files.
        text_sha256: Sha256::digest(&source.text).into(),
        compiler: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Artifact { origin, most_operations: program.most_operations(), program, positions: places(source, files) }
}

/// Positions in the text of the policy. A copy of a behaviour of another file has the position of the state that uses it.
fn places(source: &Source, files: &Files) -> SourceMap {
    let position = |transition: &Transition| -> Position {
        let (Guard::When { condition: expression, .. } | Guard::After(expression)) = &transition.guard;
        source.line_column(expression.span.start)
    };
    let machine = &files.machine;
    let own = |state: usize| {
        let outward = std::iter::successors(Some(state), |&state| machine.states[state].parent);
        outward.into_iter().find(|&state| machine.instances[machine.states[state].instance].file == 0).unwrap_or(state)
    };
    let states = machine.states.iter().enumerate().map(|(index, state)| {
        let name = source.line_column(machine.states[own(index)].name.span.start);
        let is_own = own(index) == index;
        let position = |transition: &Transition| if is_own { position(transition) } else { name };
        StatePosition { name, transitions: state.transitions.iter().map(position).collect() }
    });
    SourceMap { always: files.main.always.iter().map(position).collect(), states: states.collect() }
}
