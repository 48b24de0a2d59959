//! Objects in a floor, with gaps that are closed or wide enough for the body.

use std::f64::consts::TAU;

use super::convex::Convex;
use super::floor::{Floor, WALLS, along, inwards};
use vibrissa_world::geometry::{Point2, Vector2, unit};

/// Distance (m) between the positions that are tried for an object.
const SPACING: f64 = 0.05;
/// Number of directions that are tried around an object.
const DIRECTIONS: u32 = 36;
/// The largest depth (m) to which objects overlap what they touch, so that their union is clear.
const DEEPEST: f64 = 0.01;
/// The depth of a small object, as a share of the root of its area.
const DEPTH: f64 = 0.2;
/// Number of bisections of a distance of some metres. Their result is exact to the rounding of numbers.
const BISECTIONS: u32 = 50;

/// A floor with objects.
pub(super) struct Furnished {
    pub(super) floor: Floor,
    /// The objects in the order in which they were placed.
    pub(super) objects: Vec<Convex>,
    /// The area that objects keep clear for the start.
    reserved: Convex,
    /// Least gap (m) between objects, walls and doors that do not touch.
    passage: f64,
}

/// What an object stands against.
#[derive(Debug, Clone, Copy)]
pub(super) enum Against {
    Nothing,
    Wall,
    Object,
}

/// What an object touches at a place, by its index.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Touched {
    Nothing,
    Wall(usize),
    Object(usize),
}

impl Furnished {
    /// An empty floor, with an area that is kept clear. Gaps are at least `passage` (m) wide.
    pub(super) fn new(floor: Floor, reserved: Convex, passage: f64) -> Self {
        Self { floor, objects: Vec::new(), reserved, passage }
    }

    /// Adds an object, given around the origin, at the possible place that is nearest to the wanted one. False if there is none.
    pub(super) fn add(&mut self, object: &Convex, wanted: Point2, against: Against) -> bool {
        let mut places = match against {
            Against::Nothing => self.free_places(wanted),
            Against::Wall => self.places_at_walls(object, wanted),
            Against::Object => self.places_at_objects(object),
        };
        places.sort_by(|(one, _), (other, _)| (one - wanted).norm().total_cmp(&(other - wanted).norm()));
        let placed = places.into_iter().find_map(|(place, touched)| {
            let placed = object.moved(place.coords);
            self.is_possible(&placed, touched).then_some(placed)
        });
        let is_placed = placed.is_some();
        self.objects.extend(placed);
        is_placed
    }

    /// The wanted place and those on a grid around it.
    fn free_places(&self, wanted: Point2) -> Vec<(Point2, Touched)> {
        let [columns, rows] = [0, 1].map(|wall| steps(self.floor.length(wall)));
        let place = |column: i32, row: i32| wanted + SPACING * Vector2::new(f64::from(column), f64::from(row));
        let places = (-columns..=columns).flat_map(|column| (-rows..=rows).map(move |row| place(column, row)));
        let is_inside = |place: &Point2| (0..WALLS).all(|wall| self.floor.gap(wall, &Convex::disk(*place, 0.0)) > 0.0);
        places.filter(is_inside).map(|place| (place, Touched::Nothing)).collect()
    }

    /// Positions at which the object overlaps a wall.
    fn places_at_walls(&self, object: &Convex, wanted: Point2) -> Vec<(Point2, Touched)> {
        let at_wall = |wall: usize| {
            let height = -self.floor.gap(wall, object) - depth(object);
            let count = steps(self.floor.length(wall));
            (-count..=count).map(move |step| {
                let s = along(wall).dot(&wanted.coords) + f64::from(step) * SPACING;
                (Point2::from(s * along(wall) + height * inwards(wall)), Touched::Wall(wall))
            })
        };
        (0..WALLS).flat_map(at_wall).collect()
    }

    /// Positions at which the object overlaps another one.
    fn places_at_objects(&self, object: &Convex) -> Vec<(Point2, Touched)> {
        let most = self.floor.length(0) + self.floor.length(1);
        let around = |(index, other): (usize, &Convex)| {
            let depth = depth(object).min(depth(other));
            let place = |k: u32| {
                let direction = unit(TAU * f64::from(k) / f64::from(DIRECTIONS));
                let at = |distance: f64| other.centre() + distance * direction;
                // The gap of convex objects grows with the distance of their centres.
                let halved = |(near, far): (f64, f64), _| {
                    let middle = 0.5 * (near + far);
                    if object.moved(at(middle).coords).gap(other) > 0.0 { (near, middle) } else { (middle, far) }
                };
                let (_, touching) = (0..BISECTIONS).fold((0.0, most), halved);
                (at(touching - depth), Touched::Object(index))
            };
            (0..DIRECTIONS).map(place).collect::<Vec<_>>()
        };
        self.objects.iter().enumerate().flat_map(around).collect()
    }

    /// True if an object keeps the reserved area clear, and has wide gaps to all that it does not touch.
    fn is_possible(&self, object: &Convex, touched: Touched) -> bool {
        let is_wide = |gap: f64| gap >= self.passage;
        (0..WALLS).all(|wall| touched == Touched::Wall(wall) || is_wide(self.floor.gap(wall, object)))
            && self.floor.closed_doors().all(|door| is_wide(object.gap(&door)))
            && object.gap(&self.reserved) >= 0.0
            && (self.objects.iter().enumerate())
                .all(|(index, other)| touched == Touched::Object(index) || is_wide(object.gap(other)))
    }
}

/// The depth (m) to which an object overlaps what it touches.
fn depth(object: &Convex) -> f64 {
    DEEPEST.min(DEPTH * object.area().sqrt())
}

/// The number of steps between positions in a length (m).
fn steps(length: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "a cast saturates")]
    let steps = (length / SPACING).ceil() as i32;
    steps
}
