//! Reader of the shapes in `objects`.

use super::reader::Reader;
use super::start::{HEADING, POSITION};
use super::{corner, fault, outline, path, polar, texture, tunnel};
use crate::geometry::{
    Contour, ContourError, Point2, ShapeError, Texture, Tunnel, circle, polygon, regular_polygon, rounded_rectangle,
};
use vibrissa_runtime::units::{Dimension, Key, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::{Entry, Fields, Node, Placed};

const CENTRE: Key = Key { name: "centre", example: "[40 cm, 40 cm]", ..POSITION };
const VERTICES: &str = "[[0 cm, 30 cm], [20 cm, 30 cm], [10 cm, 50 cm]]";
const VERTEX: Key = Key { name: "vertices", example: VERTICES, ..POSITION };
pub(super) const RADIUS: Key = Key::new("radius", Dimension::LENGTH, (1e-4, 100.0), "30 cm");
const CIRCUMRADIUS: Key = Key { name: "circumradius", ..RADIUS };
const WIDTH: Key = Key { name: "width", ..RADIUS };
const HEIGHT: Key = Key { name: "height", ..RADIUS };
const CORNER_RADIUS: Key = Key::new("corner_radius", Dimension::LENGTH, (0.0, 100.0), "20 mm");

const KINDS: [&str; 11] = [
    "circle",
    "rectangle",
    "rounded_rectangle",
    "polygon",
    "regular_polygon",
    "convex_corner",
    "concave_corner",
    "polar",
    "path",
    "outline",
    "tunnel",
];

/// The geometry of an object.
pub(super) enum Object {
    /// The interior of an outline, possibly with a texture.
    Plain { outline: Contour, texture: Option<Texture> },
    /// Two walls.
    Tunnel(Box<Tunnel>),
}

/// An example of `objects`.
pub(super) const EXAMPLE: &str = "[{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]";

/// Reads `objects`.
pub(super) fn read_all(reader: &mut Reader<'_>, entry: &Entry) -> Option<Vec<Placed<Object>>> {
    let items = reader.items(&entry.value, "a list of objects", &format!("objects: {EXAMPLE}"))?;
    if items.is_empty() {
        let fault = Diagnostic::error(fault::SHAPE, "there is no object", entry.key.span, "empty");
        reader.report(fault.hint(format!("add one, such as `objects: {EXAMPLE}`")));
    }
    let objects: Vec<_> = items.iter().map(|item| read(reader, item)).collect();
    Some(objects.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect())
}

/// Reads an object, or all objects of a file, with the span of the key of their kind.
fn read(reader: &mut Reader<'_>, item: &Placed<Node>) -> Option<Vec<Placed<Object>>> {
    let example = "circle: {centre: [40 cm, 40 cm], radius: 30 cm}";
    let (item, texture) = without_texture(item);
    let (kind, entry) = reader.variant(&item, "an object", &KINDS, example)?;
    let texture = match texture {
        Some(texture) if kind == "tunnel" => {
            let message = "a tunnel cannot have a texture";
            let fault = Diagnostic::error(fault::SHAPE, message, texture.key.span, "on a tunnel");
            reader.report(fault.hint("leave it out, or draw each wall as a `path` with a texture"));
            return None;
        }
        Some(texture) => Some(texture::read(reader, texture)?),
        None => None,
    };
    let contour = match kind {
        "circle" => read_circle(reader, entry),
        "rectangle" => read_rectangle(reader, entry),
        "rounded_rectangle" => read_rounded_rectangle(reader, entry),
        "polygon" => read_polygon(reader, entry),
        "regular_polygon" => read_regular_polygon(reader, entry),
        "convex_corner" => corner::read_convex(reader, entry),
        "concave_corner" => corner::read_concave(reader, entry),
        "polar" => polar::read(reader, entry),
        "path" => path::read(reader, entry),
        "outline" => {
            let contours: Vec<_> = outline::read(reader, entry)?.collect();
            return contours.into_iter().map(|contour| plain(reader, contour, texture, entry.key.span)).collect();
        }
        _ => {
            let tunnel = Object::Tunnel(Box::new(tunnel::read(reader, entry)?));
            return Some(vec![Placed { value: tunnel, span: entry.key.span }]);
        }
    };
    Some(vec![plain(reader, contour?, texture, entry.key.span)?])
}

/// Separates the key `texture` from the kind of an object.
fn without_texture(item: &Placed<Node>) -> (Placed<Node>, Option<&Entry>) {
    let Node::Mapping(entries) = &item.value else { return (item.clone(), None) };
    let (texture, kinds): (Vec<&Entry>, Vec<&Entry>) = entries.iter().partition(|entry| entry.key.value == "texture");
    let kinds = Node::Mapping(kinds.into_iter().cloned().collect());
    (Placed { value: kinds, span: item.span }, texture.first().copied())
}

/// Creates an object, and counts the pieces of its texture.
fn plain(reader: &mut Reader<'_>, outline: Contour, texture: Option<Texture>, span: Span) -> Option<Placed<Object>> {
    if let Some(texture) = texture {
        reader.make(texture.most_pieces(&outline), span)?;
    }
    Some(Placed { value: Object::Plain { outline, texture }, span })
}

fn read_circle(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a circle", entry.key.span)?;
    let centre = centre(reader, &mut fields);
    let radius = fields.number(reader, &RADIUS);
    fields.finish(reader);
    reader.make(1, entry.key.span)?;
    made(reader, circle(centre?, radius?.value), entry.key.span, &[])
}

fn read_rectangle(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a rectangle", entry.key.span)?;
    let centre = centre(reader, &mut fields);
    let width = fields.number(reader, &WIDTH);
    let height = fields.number(reader, &HEIGHT);
    let heading = heading(reader, &mut fields);
    fields.finish(reader);
    reader.make(4, entry.key.span)?;
    let shape = rounded_rectangle(centre?, width?.value, height?.value, 0.0, heading);
    made(reader, shape, entry.key.span, &[])
}

fn read_rounded_rectangle(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a rounded rectangle", entry.key.span)?;
    let centre = centre(reader, &mut fields);
    let width = fields.number(reader, &WIDTH);
    let height = fields.number(reader, &HEIGHT);
    let corner_radius = fields.number(reader, &CORNER_RADIUS);
    let heading = heading(reader, &mut fields);
    fields.finish(reader);
    let (width, height, corner_radius) = (width?, height?, corner_radius?);
    reader.make(8, entry.key.span)?;
    let shape = rounded_rectangle(centre?, width.value, height.value, corner_radius.value, heading);
    if let Err(ShapeError::CornerRadius { limit, .. }) = shape {
        let shorter = if width.value <= height.value { width.span } else { height.span };
        let label = format!("must be at most {}", format_si(limit, Dimension::LENGTH));
        let fault = Diagnostic::error(fault::SHAPE, "the rounded corners do not fit", corner_radius.span, label);
        reader.report(
            fault.note(shorter, "two of them share this side").hint("make the corners smaller or the side longer"),
        );
        return None;
    }
    made(reader, shape, entry.key.span, &[])
}

fn read_polygon(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a polygon", entry.key.span)?;
    let vertices = fields.required(VERTEX.name, VERTICES);
    fields.finish(reader);
    let vertices = vertices?;
    let items = reader.items(&vertices.value, "a list of points", VERTICES)?;
    let points: Vec<_> = items.iter().map(|item| reader.point(item, &VERTEX)).collect();
    let points: Vec<Placed<Point2>> = points.into_iter().collect::<Option<_>>()?;
    reader.make(points.len(), entry.key.span)?;
    let corners: Vec<Point2> = points.iter().map(|point| point.value).collect();
    let shape = polygon(&corners);
    match shape {
        Err(ShapeError::TooFewSides { sides }) => {
            let fault = Diagnostic::error(
                fault::SHAPE,
                "a polygon has at least 3 vertices",
                vertices.key.span,
                format!("{sides} here"),
            );
            reader.report(fault.hint(format!("add vertices: `vertices: {VERTICES}`")));
            None
        }
        Err(ShapeError::ZeroEdge { from, to }) if let (Some(from), Some(to)) = (points.get(from), points.get(to)) => {
            let (first, second) = if from.span.start < to.span.start { (from, to) } else { (to, from) };
            let fault =
                Diagnostic::error(fault::SHAPE, "two neighbouring vertices are the same", second.span, "this one");
            reader.report(
                fault
                    .note(first.span, "the same vertex")
                    .hint("remove one of them; the first vertex is not repeated at the end"),
            );
            None
        }
        shape => {
            let places: Vec<Span> = points.iter().map(|point| point.span).collect();
            made(reader, shape, entry.key.span, &places)
        }
    }
}

fn read_regular_polygon(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a regular polygon", entry.key.span)?;
    let centre = centre(reader, &mut fields);
    let circumradius = fields.number(reader, &CIRCUMRADIUS);
    let sides = fields.required("sides", "6").and_then(|entry| reader.count(&entry.value, "sides", 3_usize..=1000, 6));
    let heading = heading(reader, &mut fields);
    fields.finish(reader);
    let sides = sides?;
    reader.make(sides, entry.key.span)?;
    made(reader, regular_polygon(centre?, circumradius?.value, sides, heading), entry.key.span, &[])
}

pub(super) fn centre(reader: &mut Reader<'_>, fields: &mut Fields<'_>) -> Option<Point2> {
    let entry = fields.required(CENTRE.name, CENTRE.example)?;
    Some(reader.point(&entry.value, &CENTRE)?.value)
}

/// Reads the heading of an object, 0 by default.
fn heading(reader: &mut Reader<'_>, fields: &mut Fields<'_>) -> f64 {
    let mut heading = 0.0;
    fields.set(reader, &HEADING, &mut heading);
    heading
}

/// Returns the contour, or reports why it does not exist. `pieces` are the spans of its pieces, if they have individual
/// ones.
pub(super) fn made(
    reader: &mut Reader<'_>,
    shape: Result<Contour, ShapeError>,
    place: Span,
    pieces: &[Span],
) -> Option<Contour> {
    let error = match shape {
        Ok(contour) => return Some(contour),
        Err(error) => error,
    };
    let fault = match &error {
        ShapeError::Contour(ContourError::SelfIntersection { first, second, at }) => {
            let millimetres = |value: f64| format!("{} mm", format_si(value * 1e3, Dimension::NUMBER));
            let meeting = format!("at ({}, {})", millimetres(at.x), millimetres(at.y));
            let (first, second) = (pieces.get(*first).copied(), pieces.get(*second).copied());
            let message = "the outline crosses or touches itself";
            let label = format!("the side that begins here meets another side {meeting}");
            let fault = Diagnostic::error(fault::SHAPE, message, second.or(first).unwrap_or(place), label);
            let fault = if let (Some(first), Some(_)) = (first, second) {
                fault.note(first, "which begins here")
            } else {
                fault
            };
            fault.hint("trace the object once, without crossing an earlier side")
        }
        ShapeError::ShortStep { step, length } => {
            let place = pieces.get(*step).copied().unwrap_or(place);
            let label = format!("{} long", format_si(*length, Dimension::LENGTH));
            Diagnostic::error(fault::SHAPE, "a step of the path has no length", place, label)
                .hint("leave it out, or use `turn` to change the heading only")
        }
        _ => Diagnostic::error(fault::SHAPE, "a shape with these values is not possible", place, error.to_string())
            .hint("change the values of the shape"),
    };
    reader.report(fault);
    None
}
