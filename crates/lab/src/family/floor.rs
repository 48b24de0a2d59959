//! The plan of a rectangular floor: its walls and doors.

use std::f64::consts::FRAC_PI_2;

use super::convex::Convex;
use vibrissa_world::geometry::{Point2, Vector2, perpendicular, unit};

/// Least distance (m) between a door and a corner of the floor.
const JAMB: f64 = 0.05;

/// The number of walls. They are counted counter-clockwise from that at the bottom.
pub(super) const WALLS: usize = 4;

/// A floor around the origin, parallel to the axes.
pub(super) struct Floor {
    /// Its clear length and width (m).
    size: Vector2,
    doors: Vec<Door>,
}

/// A door in a wall.
#[derive(Debug, Clone, Copy)]
struct Door {
    wall: usize,
    /// Distance (m) of its middle from the start of the wall.
    middle: f64,
    /// Its clear width (m).
    width: f64,
}

impl Door {
    /// Its ends (m), from the start of the wall.
    fn ends(&self) -> [f64; 2] {
        [self.middle - 0.5 * self.width, self.middle + 0.5 * self.width]
    }
}

impl Floor {
    /// A floor of this clear length and width (m). A door is at a share of the length of all walls, and has a clear width (m). A
    /// second door in the same wall is moved to the opposite wall.
    pub(super) fn new(size: Vector2, doors: &[(f64, f64)]) -> Self {
        let mut floor = Self { size, doors: Vec::new() };
        for &(share, width) in doors {
            let mut s = share * 2.0 * (size.x + size.y);
            let mut wall = 0;
            while wall + 1 < WALLS && s > floor.length(wall) {
                s -= floor.length(wall);
                wall += 1;
            }
            if floor.doors.iter().any(|door| door.wall == wall) {
                wall = (wall + 2) % WALLS;
            }
            let most = floor.length(wall) - 0.5 * width - JAMB;
            floor.doors.push(Door { wall, middle: s.min(most).max(0.5 * width + JAMB), width });
        }
        floor.doors.sort_by_key(|door| door.wall);
        floor
    }

    /// The position with these shares of length and width, at least a `margin` (m) away from all walls.
    pub(super) fn position(&self, shares: [f64; 2], margin: f64) -> Point2 {
        let span = self.size - 2.0 * Vector2::new(margin, margin);
        Point2::new(span.x * (shares[0] - 0.5), span.y * (shares[1] - 0.5))
    }

    /// The clear length of a wall (m).
    pub(super) fn length(&self, wall: usize) -> f64 {
        if wall.is_multiple_of(2) { self.size.x } else { self.size.y }
    }

    /// The distance (m) of an object from a wall, negative for one that reaches into it.
    pub(super) fn gap(&self, wall: usize, object: &Convex) -> f64 {
        object.least(inwards(wall)) + 0.5 * self.length(wall + 1)
    }

    /// The doors as lines that close them.
    pub(super) fn closed_doors(&self) -> impl Iterator<Item = Convex> {
        self.doors.iter().map(|door| {
            let [from, to] = door.ends().map(|s| self.on_wall(door.wall, s, 0.0));
            Convex::line(from, to)
        })
    }

    /// The clear widths of the doors (m).
    pub(super) fn door_widths(&self) -> impl Iterator<Item = f64> {
        self.doors.iter().map(|door| door.width)
    }

    /// The corners of each part of the walls between doors, counter-clockwise. `thickness` is that of the walls (m).
    pub(super) fn walls(&self, thickness: f64) -> Vec<Vec<Point2>> {
        let next = self.doors.iter().cycle().skip(1);
        let part = |(from, to): (&Door, &Door)| {
            // A single door has all four corners between its ends.
            let passed = match (to.wall + WALLS - from.wall) % WALLS {
                0 => WALLS,
                passed => passed,
            };
            let side = |depth: f64| {
                let corners = (1..=passed).map(move |k| self.corner(from.wall + k, depth));
                let (first, last) =
                    (self.on_wall(from.wall, from.ends()[1], depth), self.on_wall(to.wall, to.ends()[0], depth));
                std::iter::once(first).chain(corners).chain([last]).collect::<Vec<_>>()
            };
            side(thickness).into_iter().chain(side(0.0).into_iter().rev()).collect()
        };
        self.doors.iter().zip(next).map(part).collect()
    }

    /// The point at this distance (m) along a wall, at this depth behind its clear side (m).
    fn on_wall(&self, wall: usize, s: f64, depth: f64) -> Point2 {
        let along = (s - 0.5 * self.length(wall)) * along(wall);
        Point2::from(along - (0.5 * self.length(wall + 1) + depth) * inwards(wall))
    }

    /// The corner at the start of a wall, at this depth behind the clear sides (m).
    fn corner(&self, wall: usize, depth: f64) -> Point2 {
        self.on_wall(wall, -depth, depth)
    }
}

/// The direction of a wall, counter-clockwise around the floor.
pub(super) fn along(wall: usize) -> Vector2 {
    // The remainder is below 4, so the conversion is exact.
    unit(FRAC_PI_2 * (wall % WALLS) as f64)
}

/// The direction from a wall into the floor.
pub(super) fn inwards(wall: usize) -> Vector2 {
    perpendicular(along(wall))
}
