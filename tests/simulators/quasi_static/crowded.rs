//! Outlines of very many pieces.

use vibrissa::geometry::{Contour, Point2, polygon};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::world::World;
use vibrissa_runtime::math;

use super::scene::{START, command, one_whisker, solids};

const CENTRE: [f64; 2] = [0.38, 0.3];
const RADIUS: f64 = 0.3;

/// The base angles (rad) of a whisker that is dragged along an outline, and pressed against it.
fn base_angles(outline: Contour) -> Vec<f64> {
    let mut world = QuasiStaticWorld::new(&one_whisker(), &Physics::default(), &solids([outline]), START, 0).unwrap();
    let mut angles = Vec::new();
    for (ticks, command) in
        [(90, command(0.0, 0.05, 0.0)), (30, command(0.01, 0.04, 0.0)), (30, command(-0.01, 0.04, 0.0))]
    {
        for _ in 0..ticks {
            angles.extend(world.advance(&command).unwrap().iter().map(|sample| sample.whiskers[0].base_angle));
        }
    }
    angles
}

#[test]
fn a_polygon_of_very_many_sides_is_felt_as_its_circle() {
    let centre = Point2::new(CENTRE[0], CENTRE[1]);
    let circle = base_angles(vibrissa::geometry::circle(centre, RADIUS).unwrap());
    let most = circle.iter().fold(0.0, |most: f64, angle| most.max(angle.abs()));
    assert!(most > 3e-5, "{most} rad");
    for sides in [20_000_u32, 100_000] {
        let corner = |index: u32| {
            let angle = std::f64::consts::TAU * f64::from(index) / f64::from(sides);
            centre + RADIUS * Point2::new(math::cos(angle), math::sin(angle)).coords
        };
        let corners: Vec<Point2> = (0..sides).map(corner).collect();
        let felt = base_angles(polygon(&corners).unwrap());
        let apart = felt.iter().zip(&circle).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        assert!(apart < 2e-3 * most, "{sides} sides: {apart} rad of {most} rad");
    }
}
