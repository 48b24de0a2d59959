//! Reader of `convex_corner` and `concave_corner`: objects with one corner that is given by its angle.

use super::object::made;
use super::reader::Reader;
use super::start::{HEADING, POSITION};
use crate::geometry::{Contour, Point2, Vector2, concave_corner, convex_corner, polygon, rotate};
use std::f64::consts::PI;
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_yaml::{Entry, Fields};

const CORNER: Key = Key { name: "corner", example: "[20 cm, 40 cm]", ..POSITION };
const CONVEX_ANGLE: Key = Key::new("angle", Dimension::ANGLE, (PI / 180.0, 175.0 / 180.0 * PI), "60 deg");
const SIDE: Key = Key::new("side", Dimension::LENGTH, (1e-4, 100.0), "30 cm");
const BACK: Key = Key { name: "back", example: "10 cm", ..SIDE };
const CONCAVE_ANGLE: Key = Key::new("angle", Dimension::ANGLE, (-150.0 / 180.0 * PI, 150.0 / 180.0 * PI), "45 deg");
const FIRST: Key = Key { name: "first", example: "40 cm", ..SIDE };
const SECOND: Key = Key { name: "second", ..SIDE };
const THICKNESS: Key = Key { name: "thickness", example: "20 cm", ..SIDE };

pub(super) fn read_convex(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a convex corner", entry.key.span)?;
    let (corner, heading) = place(reader, &mut fields);
    let angle = fields.number(reader, &CONVEX_ANGLE);
    let (side, back) = (fields.number(reader, &SIDE), fields.number(reader, &BACK));
    fields.finish(reader);
    let vertices = convex_corner(angle?.value, side?.value, back?.value);
    outline(reader, entry, corner?, heading, &vertices)
}

pub(super) fn read_concave(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a concave corner", entry.key.span)?;
    let (corner, heading) = place(reader, &mut fields);
    let angle = fields.number(reader, &CONCAVE_ANGLE);
    let (first, second) = (fields.number(reader, &FIRST), fields.number(reader, &SECOND));
    let thickness = fields.number(reader, &THICKNESS);
    fields.finish(reader);
    let vertices = concave_corner(angle?.value, first?.value, second?.value, thickness?.value);
    outline(reader, entry, corner?, heading, &vertices)
}

/// Reads the position of the corner, and the heading of the shape, 0 by default.
fn place(reader: &mut Reader<'_>, fields: &mut Fields<'_>) -> (Option<Point2>, f64) {
    let corner = fields.required(CORNER.name, CORNER.example);
    let corner = corner.and_then(|entry| reader.point(&entry.value, &CORNER)).map(|point| point.value);
    let mut heading = 0.0;
    fields.set(reader, &HEADING, &mut heading);
    (corner, heading)
}

fn outline(
    reader: &mut Reader<'_>,
    entry: &Entry,
    corner: Point2,
    heading: f64,
    vertices: &[Vector2],
) -> Option<Contour> {
    reader.make(vertices.len(), entry.key.span)?;
    let vertices: Vec<Point2> = vertices.iter().map(|&vertex| corner + rotate(vertex, heading)).collect();
    made(reader, polygon(&vertices), entry.key.span, &[])
}
