//! Reader of `path`: an outline as a sequence of straights, turns and arcs.

use super::object::made;
use super::reader::Reader;
use super::start;
use crate::geometry::{Contour, Path};
use std::f64::consts::{PI, TAU};
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_text::diagnostic::Span;
use vibrissa_yaml::{Entry, Fields, Node, Placed};

const STRAIGHT: Key = Key::new("straight", Dimension::LENGTH, (1e-5, 100.0), "10 cm");
const TURN: Key = Key::new("turn", Dimension::ANGLE, (-PI, PI), "30 deg");
const RADIUS: Key = Key::new("radius", Dimension::LENGTH, (1e-5, 100.0), "5 cm");
const ANGLE: Key = Key::new("angle", Dimension::ANGLE, (-TAU, TAU), "90 deg");

const EXAMPLE: &str = "[{straight: 20 cm}, {turn: 120 deg}, {straight: 20 cm}]";

enum Move {
    Straight(f64),
    Turn(f64),
    Arc { radius: f64, angle: f64 },
}

/// Reads a path. A closed path that does not return to its start gets a straight closing side.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a path", entry.key.span)?;
    let start = fields.required("start", "{position: [0 cm, 30 cm], heading: 0 deg}");
    let start = start.and_then(|entry| start::pose(reader, entry, "the start of a path"));
    let moves = fields.required("moves", EXAMPLE);
    let moves = moves.and_then(|entry| reader.items(&entry.value, "a list of moves", EXAMPLE));
    let closed = fields.entry("closed").map_or(Some(true), |entry| reader.flag(&entry.value));
    fields.finish(reader);
    let moves = moves?;
    reader.make(moves.len() + 1, entry.key.span)?;
    let moves: Vec<_> = moves.iter().map(|item| read_move(reader, item)).collect();

    let mut path = Path::from(start?.value);
    let mut pieces: Vec<Span> = Vec::new();
    for step in moves {
        let Placed { value, span } = step?;
        path = match value {
            Move::Straight(length) => path.straight(length),
            Move::Turn(angle) => path.turn(angle),
            Move::Arc { radius, angle } => path.arc(radius, angle),
        };
        if !matches!(value, Move::Turn(_)) {
            pieces.push(span);
        }
    }
    made(reader, if closed? { path.close() } else { path.open() }, entry.key.span, &pieces)
}

fn read_move(reader: &mut Reader<'_>, item: &Placed<Node>) -> Option<Placed<Move>> {
    let kinds = [STRAIGHT.name, TURN.name, "arc"];
    let (kind, entry) = reader.variant(item, "a move", &kinds, "{straight: 10 cm}")?;
    let value = if kind == STRAIGHT.name {
        Move::Straight(reader.number(&entry.value, &STRAIGHT)?.value)
    } else if kind == TURN.name {
        Move::Turn(reader.number(&entry.value, &TURN)?.value)
    } else {
        let mut fields = Fields::of(reader, &entry.value, "an arc", entry.key.span)?;
        let radius = fields.number(reader, &RADIUS);
        let angle = fields.number(reader, &ANGLE);
        fields.finish(reader);
        Move::Arc { radius: radius?.value, angle: angle?.value }
    };
    Some(Placed { value, span: entry.key.span })
}
