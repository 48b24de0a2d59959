//! The solids of all objects of a scenario, and their validation: separate from each other and clear of the rig.

use super::fault;
use super::object::Object;
use super::reader::Reader;
use crate::geometry::{Contour, ContourSet, Pose, Side, Tunnel, TunnelAxis, UnionError, unite};
use crate::scene::{Overlap, Truth, WorldKind, overlap};
use crate::solid::{PartsError, Solid, SolidError, convex_parts};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::Placed;

/// The solids of a scenario with the spans of their objects, and the reference. No solid overlaps another.
pub(super) struct Objects {
    solids: Vec<Placed<Solid>>,
    reference: Vec<Contour>,
    axes: Vec<TunnelAxis>,
}

impl Objects {
    /// True if one of the objects is a tunnel.
    pub(super) fn has_tunnel(&self) -> bool {
        !self.axes.is_empty()
    }

    /// Creates the solids of `objects`. Plain objects that touch become one solid with the span of the first.
    pub(super) fn of(reader: &mut Reader<'_>, objects: Vec<Placed<Object>>) -> Option<Self> {
        let mut all = Self { solids: Vec::new(), reference: Vec::new(), axes: Vec::new() };
        let mut separate = Vec::new();
        for Placed { value, span } in united(reader, objects)? {
            let solids = match value {
                Object::Plain { outline, texture } => {
                    all.reference.push(outline.clone());
                    vec![match texture {
                        Some(texture) => {
                            separate.push((all.solids.len(), "a rough object"));
                            Solid::textured(outline, &texture)
                        }
                        None => Solid::inside(outline),
                    }]
                }
                Object::Tunnel(tunnel) => {
                    let Tunnel { axis, left, right } = *tunnel;
                    // The inner side of a wall is its other side.
                    let sides = [(left, Side::Right), (right, Side::Left)];
                    all.reference.extend(sides.iter().map(|(wall, inner)| wall.side(*inner).clone()));
                    all.axes.push(axis);
                    separate.extend([0, 1].map(|wall| (all.solids.len() + wall, "a wall of a tunnel")));
                    sides.iter().map(|(wall, inner)| Solid::wall(wall, *inner)).collect()
                }
            };
            for solid in solids {
                let value = solid.map_err(|error| report(reader, &error, span)).ok()?;
                let place = reader.source().line_column(span.start);
                all.solids.push(Placed { value: value.at(place), span });
            }
        }
        (all.check_separate(reader, &separate) && all.check_parts(reader)).then_some(all)
    }

    /// The exact geometry for scores. `None` without objects.
    pub(super) fn truth(&self) -> Option<Truth> {
        let outlines = self.solids.iter().map(|solid| solid.value.outline().clone());
        Some(Truth {
            surfaces: ContourSet::new(outlines)?,
            reference: ContourSet::new(self.reference.iter().cloned())?,
            axes: self.axes.clone(),
        })
    }

    pub(super) fn into_solids(self) -> Vec<Solid> {
        self.solids.into_iter().map(|solid| solid.value).collect()
    }

    /// Reports a rig that overlaps an object at the start.
    pub(super) fn check_clearance(&self, reader: &mut Reader<'_>, rig: &Rig, start: &Placed<Pose>) {
        for Placed { value: solid, span } in &self.solids {
            let part = match overlap(rig, &start.value, solid.surface()) {
                None => continue,
                Some(Overlap::Platform) => "the platform".to_owned(),
                Some(Overlap::Whisker(index)) => {
                    let name = rig.whiskers.get(index).map_or("", |whisker| whisker.name.as_str());
                    format!("whisker `{name}`")
                }
            };
            let message = format!("{part} starts in the object");
            let fault = Diagnostic::error(fault::OVERLAP, message, start.span, "the rig starts here");
            reader.report(fault.note(*span, "inside or touching this").hint("move `position` away from the object"));
            return;
        }
    }

    /// Reports the first solid that MuJoCo cannot simulate, if the text states that simulator. Another one needs no convex
    /// parts.
    fn check_parts(&self, reader: &mut Reader<'_>) -> bool {
        if !reader.is_mujoco {
            return true;
        }
        let parts = convex_parts(self.solids.iter().map(|solid| &solid.value));
        let Err(PartsError { solid, fault: found, .. }) = parts else { return true };
        let span = self.solids[solid].span;
        let code = if found.is_of_all() { fault::TOO_LARGE } else { fault::SHAPE };
        let advice = format!("{}, or use the simulator `{}`", found.advice(), WorldKind::QuasiStatic.name());
        reader.report(Diagnostic::error(code, found.message(), span, found.label()).hint(advice));
        false
    }

    /// Checks that none of these solids overlaps another one, and reports the first overlap. They are given by their
    /// indices, with a description.
    fn check_separate(&self, reader: &mut Reader<'_>, separate: &[(usize, &str)]) -> bool {
        let mut pairs = separate.iter().flat_map(|&(index, what)| {
            let others = self.solids.iter().enumerate().filter(move |&(other, _)| other != index);
            others.map(move |(_, other)| (&self.solids[index], what, other))
        });
        let met = pairs.find(|(solid, _, other)| solid.value.surface().overlaps(other.value.surface()));
        let Some((solid, what, other)) = met else { return true };
        report_meeting(reader, what, solid.span, other.span);
        false
    }
}

/// Reports a wall or a rough object that overlaps or touches another one.
fn report_meeting(reader: &mut Reader<'_>, what: &str, span: Span, other: Span) {
    let message = format!("{what} overlaps or touches another object");
    let is_wall = what.ends_with("tunnel");
    let label = if is_wall { "this tunnel" } else { "this object" };
    let fault = Diagnostic::error(fault::SHAPE, message, span, label);
    let fault = if other == span { fault } else { fault.note(other, "and this object") };
    reader.report(fault.hint(if is_wall {
        "move them apart: walls of a tunnel are not united with objects"
    } else {
        "move them apart, or draw them as one outline with a texture: rough objects are not united with others"
    }));
}

/// Unites plain objects that touch. Reports a rough object that touches another one.
fn united(reader: &mut Reader<'_>, objects: Vec<Placed<Object>>) -> Option<Vec<Placed<Object>>> {
    let (mut outlines, mut spans) = (Vec::new(), Vec::new());
    for object in &objects {
        if let Object::Plain { outline, .. } = &object.value {
            if !outline.is_closed() {
                report(reader, &SolidError::Open, object.span);
                return None;
            }
            outlines.push(outline.clone());
            spans.push(object.span);
        }
    }
    let mut found = match unite(&outlines) {
        Ok(found) => found.into_iter().peekable(),
        Err(error) => {
            report_union(reader, &error, &spans);
            return None;
        }
    };
    let mut united = Vec::with_capacity(objects.len());
    let mut plain = 0;
    for Placed { value, span } in objects {
        let Object::Plain { outline, texture } = value else {
            united.push(Placed { value, span });
            continue;
        };
        let mut is_alone = false;
        while let Some(next) = found.next_if(|next| next.first == plain) {
            is_alone = next.outline.pieces() == outline.pieces();
            united.push(Placed { value: Object::Plain { outline: next.outline, texture }, span });
        }
        if texture.is_some() && !is_alone {
            report_meeting(reader, "a rough object", span, span);
            return None;
        }
        plain += 1;
    }
    Some(united)
}

/// Reports why objects cannot be united.
fn report_union(reader: &mut Reader<'_>, error: &UnionError, spans: &[Span]) {
    let (&first, &second, message, label, hint) = match error {
        UnionError::Hole { first, second, at } => {
            let [x, y] = [at.x, at.y].map(|metres| format_si(metres * 1e3, Dimension::NUMBER));
            let label = format!("the hole is at ({x} mm, {y} mm)");
            let hint = "leave a gap that the platform can enter, or fill the hole with an object";
            (first, second, "objects that meet enclose a hole", label, hint)
        }
        UnionError::Crossings { first, second, limit } => {
            let label = format!("more than {limit} possible crossings");
            let hint = "draw them as one outline, or with fewer sides";
            (first, second, "objects cross or touch each other too often", label, hint)
        }
        UnionError::Unclear { first, second } => {
            let label = "this object, or one that touches it".to_owned();
            let hint = "let them overlap by a millimetre, move them apart by one, or draw them as one outline";
            (first, second, "objects touch too closely to be united", label, hint)
        }
    };
    let (Some(&one), Some(&other)) = (spans.get(first), spans.get(second)) else { return };
    let fault = Diagnostic::error(fault::SHAPE, message, other, label);
    let fault = if one == other { fault } else { fault.note(one, "the other object") };
    reader.report(fault.hint(hint));
}

/// Reports why an object has no solid.
fn report(reader: &mut Reader<'_>, error: &SolidError, place: Span) {
    let (message, label, hint) = match error {
        SolidError::Open => (
            "the object has an open outline, and cannot be solid",
            "the outline is open".to_owned(),
            "close it with `closed: true`",
        ),
        SolidError::Texture(error) => (
            "the object cannot have this texture",
            error.to_string(),
            "use a smaller amplitude, or move sides of the object apart",
        ),
        SolidError::Strip(error) => ("a wall of the tunnel meets itself", error.to_string(), "make the tunnel wider"),
    };
    reader.report(Diagnostic::error(fault::SHAPE, message, place, label).hint(hint));
}
