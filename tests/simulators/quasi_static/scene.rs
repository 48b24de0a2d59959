//! Scenes to drive about in.

use std::f64::consts::{FRAC_PI_2, PI};

use vibrissa::geometry::{Contour, Piece, Point2, Pose, Vector2, circle, polygon, rounded_rectangle};
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::solid::Solid;
use vibrissa::world::{Fault, World};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

pub(crate) const START: Pose = Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 };

/// The reference rig with forces, and only its right whisker.
pub(crate) fn one_whisker() -> Rig {
    let mut rig = Rig::default();
    rig.whiskers.truncate(1);
    rig.sensing.forces = true;
    rig
}

pub(crate) fn points(corners: &[(f64, f64)]) -> Vec<Point2> {
    corners.iter().map(|&(x, y)| Point2::new(x, y)).collect()
}

/// What is to the right of the start, its nearest points some 8 cm off: one thing of every kind.
pub(crate) fn outlines() -> Vec<(&'static str, Contour)> {
    let poly = |corners: &[(f64, f64)]| polygon(&points(corners)).unwrap();
    let half_pipe = Contour::closed(vec![
        Piece::segment(Point2::new(0.08, 0.16), Point2::new(0.2, 0.16)),
        Piece::segment(Point2::new(0.2, 0.16), Point2::new(0.2, 0.4)),
        Piece::segment(Point2::new(0.2, 0.4), Point2::new(0.08, 0.4)),
        Piece::segment(Point2::new(0.08, 0.4), Point2::new(0.08, 0.33)),
        Piece::arc(Point2::new(0.08, 0.28), 0.05, FRAC_PI_2, -PI),
        Piece::segment(Point2::new(0.08, 0.23), Point2::new(0.08, 0.16)),
    ]);
    vec![
        ("disk", circle(Point2::new(0.38, 0.3), 0.3).unwrap()),
        ("pin", circle(Point2::new(0.1, 0.16), 0.004).unwrap()),
        ("wall", poly(&[(0.08, 0.16), (0.2, 0.16), (0.2, 0.5), (0.08, 0.5)])),
        ("blade along", poly(&[(0.08, 0.2), (0.0805, 0.2), (0.0805, 0.4), (0.08, 0.4)])),
        ("blade across", poly(&[(0.07, 0.25), (0.3, 0.25), (0.3, 0.2505), (0.07, 0.2505)])),
        ("wedge", poly(&[(0.07, 0.25), (0.3, 0.2), (0.3, 0.3)])),
        ("octagon", vibrissa::geometry::regular_polygon(Point2::new(0.24, 0.3), 0.15, 8, 0.1).unwrap()),
        ("steps", poly(&[(0.1, 0.15), (0.3, 0.15), (0.3, 0.4), (0.06, 0.4), (0.06, 0.28), (0.1, 0.28)])),
        ("notch", poly(&[(0.08, 0.15), (0.3, 0.15), (0.3, 0.4), (0.08, 0.4), (0.08, 0.3), (0.11, 0.27), (0.08, 0.24)])),
        ("round corners", rounded_rectangle(Point2::new(0.2, 0.3), 0.22, 0.16, 0.01, 0.2).unwrap()),
        ("half pipe", half_pipe.unwrap()),
    ]
}

pub(crate) fn solids(outlines: impl IntoIterator<Item = Contour>) -> Vec<Solid> {
    outlines.into_iter().map(|outline| Solid::inside(outline).unwrap()).collect()
}

pub(crate) fn command(x: f64, y: f64, yaw_rate: f64) -> Command {
    Command { velocity_world: Vector2::new(x, y), yaw_rate }
}

/// The last sample of so many ticks under a command.
pub(crate) fn drive(world: &mut QuasiStaticWorld, command: &Command, ticks: usize) -> Result<Sample, Fault> {
    let mut last = None;
    for _ in 0..ticks {
        last = world.advance(command)?.last().copied();
    }
    Ok(last.unwrap())
}
