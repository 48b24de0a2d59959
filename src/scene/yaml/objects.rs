//! The objects of a scenario together: solid, apart from each other, clear of the rig.

use super::fault;
use super::node::Placed;
use super::object::Object;
use super::reader::Reader;
use crate::diagnostic::{Diagnostic, Span};
use crate::geometry::{Contour, ContourSet, Pose, Side, Tunnel, TunnelAxis};
use crate::rig::Rig;
use crate::scene::clearance::{Overlap, overlap};
use crate::scene::solid::{Solid, SolidError};
use crate::scene::truth::Truth;

/// The solids of a scenario with the places of their objects, none overlapping another; and what there is to be traced.
pub(super) struct Objects {
    solids: Vec<Placed<Solid>>,
    reference: Vec<Contour>,
    axes: Vec<TunnelAxis>,
}

impl Objects {
    /// The solids that `objects` are.
    pub(super) fn of(reader: &mut Reader<'_>, objects: Vec<Placed<Object>>) -> Option<Self> {
        let mut all = Self { solids: Vec::new(), reference: Vec::new(), axes: Vec::new() };
        let mut is_sound = true;
        for Placed { value, span } in objects {
            let solids = match value {
                Object::Plain(contour) => {
                    all.reference.push(contour.clone());
                    vec![Solid::inside(contour)]
                }
                Object::Tunnel(tunnel) => {
                    let Tunnel { axis, left, right } = *tunnel;
                    // The inner side of a wall is its other side.
                    let walls = [(left, Side::Right), (right, Side::Left)];
                    all.reference.extend(walls.iter().map(|(wall, inner)| wall.side(*inner).clone()));
                    all.axes.push(axis);
                    walls.iter().map(|(wall, inner)| Solid::wall(wall, *inner)).collect()
                }
            };
            for solid in solids {
                match solid {
                    Ok(value) => all.solids.push(Placed { value, span }),
                    Err(error) => {
                        is_sound = false;
                        report(reader, &error, span);
                    }
                }
            }
        }
        (is_sound && all.are_apart(reader)).then_some(all)
    }

    /// What runs are measured against; `None` if there is no object.
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

    /// Reports a rig that starts in an object.
    pub(super) fn check_clearance(&self, reader: &mut Reader<'_>, rig: &Rig, start: &Placed<Pose>) {
        for Placed { value: solid, span } in &self.solids {
            let part = match overlap(rig, &start.value, solid.outline()) {
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

    /// Whether no two solids overlap; the first that do are reported.
    fn are_apart(&self, reader: &mut Reader<'_>) -> bool {
        let pairs = self
            .solids
            .iter()
            .enumerate()
            .flat_map(|(index, second)| self.solids[..index].iter().map(move |first| (first, second)));
        let is_met =
            |(first, second): &(&Placed<Solid>, &Placed<Solid>)| first.value.outline().overlaps(second.value.outline());
        let Some((first, second)) = pairs.into_iter().find(is_met) else { return true };
        let fault = Diagnostic::error(fault::SHAPE, "two objects overlap or touch", second.span, "this one");
        let fault = fault.note(first.span, "and this one").hint("move them apart, or draw them as one outline");
        reader.report(fault);
        false
    }
}

/// Reports why an object has no solid.
fn report(reader: &mut Reader<'_>, error: &SolidError, place: Span) {
    let (message, label, hint) = match error {
        SolidError::Open => ("the object has no inside", "an open contour".to_owned(), "close it with `closed: true`"),
        SolidError::Corners { count, limit } => (
            "the object has too many corners to be simulated",
            format!("{count} corners, must be at most {limit}"),
            "leave out vertices that hardly turn, or use arcs",
        ),
        SolidError::Parts { count, limit } => (
            "the tunnel is too long to be simulated",
            format!("{count} parts, must be at most {limit}"),
            "make it shorter, or less bent",
        ),
        SolidError::Chords => (
            "the object comes within micrometres of itself",
            "too near to itself to be simulated".to_owned(),
            "move its sides apart",
        ),
        SolidError::Strip(error) => ("a wall of the tunnel meets itself", error.to_string(), "make the tunnel wider"),
    };
    reader.report(Diagnostic::error(fault::SHAPE, message, place, label).hint(hint));
}
