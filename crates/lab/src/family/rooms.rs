//! Rooms with walls, doors and several objects.

use super::convex::Convex;
use super::floor::Floor;
use super::furnished::{Against, Furnished};
use super::layout::{Aim, FORWARD_FACING, Layout, polygon};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::rooms::{
    ASPECTS, AT_HEADING, AT_X, AT_Y, CONTACTS, CORNERS, DOOR_PLACES, DOOR_WIDTHS, DOORS, KINDS, LENGTH, OBJECTS,
    PHASES, SIZES, THICKNESS, TURN, WIDTH, XS, YS,
};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{Point2, Pose, Vector2, rotate};

/// Distance (m) from the centre of mass within which the rig is at all starts: 182 mm to the tips before the nose, and the
/// largest displacement of a start, 40 mm along both axes.
const START_RADIUS: f64 = 0.24;
/// The smallest and the largest radius (m) of the circle around an object that is no pole.
const RADII: (f64, f64) = (0.06, 0.28);
/// Those of a pole.
const POLE_RADII: (f64, f64) = (0.01, 0.03);
/// Factor of an object's size, each time that the floor has no place for it, not even one without contact.
const SMALLER: f64 = 0.8;
/// The largest number of these reductions. An object without a place is left out.
const REDUCTIONS: i32 = 8;

/// An object as it is sampled.
struct Wanted {
    kind: u32,
    size: f64,
    aspect: f64,
    corners: u32,
    phase: f64,
    place: [f64; 2],
    against: Against,
}

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let size = Vector2::new(sampler.number(&LENGTH), sampler.number(&WIDTH));
    let (thickness, turn) = (sampler.number(&THICKNESS), sampler.number(&TURN));
    let doors = [0, 1].map(|k| (sampler.number(&DOOR_PLACES[k]), sampler.number(&DOOR_WIDTHS[k])));
    let door_count = sampler.whole(&DOORS) as usize;
    let floor = Floor::new(size, doors.get(..door_count).unwrap_or(&doors));
    let start = floor.position([sampler.number(&AT_X), sampler.number(&AT_Y)], START_RADIUS);
    let heading = turn + sampler.number(&AT_HEADING);
    let rig = Rig::default();
    let mut room = Furnished::new(floor, Convex::disk(start, START_RADIUS), passage(&rig));
    let objects = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| wanted(sampler, k));
    for object in objects.iter().take(sampler.whole(&OBJECTS) as usize) {
        let place = room.floor.position(object.place, 0.0);
        let sizes = (0..=REDUCTIONS).map(|count| math::powi(SMALLER, count));
        let tries = sizes.flat_map(|size| [(size, object.against), (size, Against::Nothing)]);
        let _ = tries
            .map(|(size, against)| (object.outline(size), against))
            .any(|(outline, against)| room.add(&outline, place, against));
    }
    let turned = |corner: &Point2| Point2::from(rotate(corner.coords, turn));
    let walls = room.floor.walls(thickness);
    let walls = walls.iter().map(|wall| polygon(&wall.iter().map(turned).collect::<Vec<_>>()));
    let widths: Vec<_> = room.floor.door_widths().map(|width| format!("{:.0}", 1e3 * width)).collect();
    Layout {
        about: format!(
            "{:.2} by {:.2} m, {} objects, doors of {} mm",
            size.x,
            size.y,
            room.objects.len(),
            widths.join(" and ")
        ),
        objects: walls.chain(room.objects.iter().map(|object| object.text(turn))).collect(),
        start: Pose { position: turned(&start), heading },
        aim: Aim::Everything,
        path_length: path_length(&rig, size, thickness, &room.objects),
        rig: FORWARD_FACING,
    }
}

fn wanted(sampler: &mut Sampler<'_>, k: usize) -> Wanted {
    let (kind, size) = (sampler.whole(&KINDS[k]), sampler.number(&SIZES[k]));
    let (aspect, corners, phase) =
        (sampler.number(&ASPECTS[k]), sampler.whole(&CORNERS[k]), sampler.number(&PHASES[k]));
    let place = [sampler.number(&XS[k]), sampler.number(&YS[k])];
    // Half of the random objects stand free.
    let against = sampler.number_or(&CONTACTS[k], |sampler| [0.0, 0.0, 1.0, 2.0][sampler.count(0, 3) as usize]);
    let against = match against.round() {
        1.0 => Against::Wall,
        2.0 if k > 0 => Against::Object,
        2.0 => Against::Wall,
        _ => Against::Nothing,
    };
    Wanted { kind, size, aspect, corners, phase, place, against }
}

impl Wanted {
    /// Its outline around the origin, larger by a factor.
    fn outline(&self, factor: f64) -> Convex {
        let radius = |(least, most): (f64, f64)| factor * (least + self.size * (most - least));
        match self.kind {
            1 => Convex::rectangle(radius(RADII), self.aspect, self.phase),
            2 => Convex::regular(radius(RADII), self.corners, self.phase),
            3 => Convex::disk(Point2::origin(), radius(POLE_RADII)),
            _ => Convex::disk(Point2::origin(), radius(RADII)),
        }
    }
}

/// Width (m) of the narrowest gap: the body turns in it about its centre of mass.
fn passage(rig: &Rig) -> f64 {
    let corners = rig.platform.outline_body();
    2.0 * corners.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max)
}

/// The larger of two lengths (m): that of all outlines, and that of a path which shows the whole floor. The body stays on ground
/// that is known to be free, so each lane adds what its whiskers reach beyond the body on one side.
fn path_length(rig: &Rig, size: Vector2, thickness: f64, objects: &[Convex]) -> f64 {
    let tips = rig
        .whiskers
        .iter()
        .map(|whisker| (whisker.base_body.y + whisker.shaft.length * math::sin(whisker.direction_body)).abs());
    let lane = tips.fold(0.0, f64::max) - 0.5 * rig.platform.tail_width;
    let area = size.x * size.y - objects.iter().map(Convex::area).sum::<f64>();
    let walls = 4.0 * (size.x + size.y) + 8.0 * thickness;
    let outlines = walls + objects.iter().map(Convex::length).sum::<f64>();
    outlines.max(area / lane)
}
