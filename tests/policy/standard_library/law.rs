//! Laws at work.

use std::sync::Arc;

use vibrissa_language::compile;
use vibrissa_runtime::geometry::{Point2, Vector2};
use vibrissa_runtime::machine::{Action, Machine, Mover, Turn};
use vibrissa_text::diagnostic::{Colour, Source, terminal};

use super::felt::Felt;

/// A machine that does one thing, with the whisker `w` of the one side and `v` of the other.
pub(crate) fn machine(whisker: usize, does: &str) -> Machine {
    let (right, left) = if whisker == 0 { ("w", "v") } else { ("v", "w") };
    let text = format!(
        "machine m use std.guards use std.mounting use std.retrieval use std.swipe use std.tunnel whisker {right}, {left}
        initial Doing state Doing {{ {does} }}"
    );
    let source = Source::new("m.fsm", text);
    let program = compile(&source).unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain)));
    Machine::new(Arc::new(program))
}

/// What a law commands: along, speed, and the heading or the rate of turning.
pub(crate) fn commanded(whisker: usize, does: &str, felt: &Felt) -> (Mover, Vector2, f64, Turn) {
    match machine(whisker, does).tick(&mut { *felt }).action {
        Action::Steer { mover, along_world, speed, turn } => (mover, along_world, speed, turn),
        other => panic!("{other:?}"),
    }
}

pub(crate) fn unit_vector(vector: Vector2) -> String {
    format!("unit(vector({:?}, {:?}))", vector.x, vector.y)
}

pub(crate) fn place(place: Point2) -> String {
    format!("position({:?} m, {:?} m)", place.x, place.y)
}

pub(crate) fn is_near(a: Vector2, b: Vector2) -> bool {
    (a - b).norm() < 1e-9
}
