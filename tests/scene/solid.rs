//! The convex parts of a solid are the solid: nothing is missing, nothing sticks out.

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa::geometry::{
    CentreLine, Contour, Corners, Opening, Point2, Pose, Side, Texture, TextureKind, Tunnel, circle, polygon,
};
use vibrissa::solid::{Part, PartsFault, Solid, SolidError};

use crate::geometry::random;

/// How far (m) the chords of a wall lie from its two sides.
const FACE: f64 = 1.1e-5;
const BACK: f64 = 5.5e-5;
/// How far (m) a part of a wall reaches into its neighbour.
const LAP: f64 = 3e-2;

/// How far (m) the chords of a concave outline lie from its arcs.
fn chords(contour: &Contour) -> f64 {
    let radii =
        contour.pieces().iter().map(|piece| piece.curvature().abs().recip()).filter(|radius| radius.is_finite());
    6e-6 + 4.8e-6 * radii.fold(0.0, f64::max)
}

fn outline(part: &Part) -> &[Point2] {
    match part {
        Part::Prism { outline } => outline,
        Part::Cylinder { .. } => panic!("a prism"),
    }
}

fn area(corners: &[Point2]) -> f64 {
    let sides = (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
    sides.map(|(from, to)| 0.5 * from.coords.perp(&to.coords)).sum()
}

/// Whether a point is inside a convex polygon, and deeper than a rounding.
fn is_inside(corners: &[Point2], point: Point2) -> bool {
    (0..corners.len()).all(|k| {
        let side = corners[(k + 1) % corners.len()] - corners[k];
        side.perp(&(point - corners[k])) > 1e-9 * side.norm()
    })
}

fn are_convex(solid: &Solid) -> Result<(), TestCaseError> {
    let prisms = solid
        .parts()
        .unwrap()
        .iter()
        .filter_map(|part| if let Part::Prism { outline } = part { Some(outline) } else { None });
    for corners in prisms {
        for k in 0..corners.len() {
            let [a, b, c] = [0, 1, 2].map(|next| corners[(k + next) % corners.len()]);
            let (into, out) = (b - a, c - b);
            prop_assert!(into.norm() > 0.0 && into.perp(&out) > -1e-9 * into.norm(), "{a} {b} {c}");
        }
        prop_assert!(area(corners) > 1e-12);
    }
    Ok(())
}

/// Whether a point is inside as many parts as it should be, unless it is nearer to the outline than that can be told.
fn is_as_solid(solid: &Solid, point: Point2, tolerance: f64) -> Result<(), TestCaseError> {
    let inside = solid.parts().unwrap().iter().filter(|part| is_inside(outline(part), point)).count();
    prop_assert!(inside <= 1, "{inside} parts overlap at {point}");
    let depth = -solid.outline().signed_distance(point);
    // A point on an edge between two parts is in neither, but one beside it is.
    let found = [(0.0, 0.0), (1e-7, 0.0), (-1e-7, 0.0), (0.0, 1e-7), (0.0, -1e-7)].iter().any(|&(x, y)| {
        let beside = Point2::new(point.x + x, point.y + y);
        solid.parts().unwrap().iter().any(|part| is_inside(outline(part), beside))
    });
    prop_assert!(depth.abs() < tolerance + 2e-7 || found == (depth > 0.0), "{found} {depth} m deep");
    Ok(())
}

/// Whether a contour has spikes whose chords may cross.
fn has_cusps(contour: &Contour) -> bool {
    contour.corners().iter().any(|corner| corner.turn.abs() > PI - 1e-2)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn parts_of_a_concave_outline_fill_it(
        contour in random::closed(), points in prop::collection::vec(random::point(0.6), 60),
    ) {
        prop_assume!(!contour.is_convex());
        let solid = Solid::inside(contour.clone()).unwrap();
        if has_cusps(&contour) && solid.parts() == Err(&PartsFault::Chords) {
            return Ok(());
        }
        are_convex(&solid)?;
        let tolerance = chords(&contour);
        let whole: f64 = solid.parts().unwrap().iter().map(|part| area(outline(part))).sum();
        prop_assert!((whole - contour.area()).abs() < tolerance * contour.length());
        let centre = contour.bounding_box();
        let centre = nalgebra::center(&centre.min, &centre.max);
        for point in points {
            is_as_solid(&solid, centre + point.coords, tolerance)?;
        }
        for sample in contour.sample(0.02) {
            let aside = 2.0 * tolerance * Point2::new(sample.tangent.y, -sample.tangent.x).coords;
            is_as_solid(&solid, sample.point + aside, tolerance)?;
            is_as_solid(&solid, sample.point - aside, tolerance)?;
        }
    }

    #[test]
    fn parts_of_walls_fill_them(line in line(), width in 0.1..0.3_f64, thickness in 0.002..0.03_f64, pose in random::pose()) {
        let Ok(tunnel) = Tunnel::new(&line, width, thickness, &pose) else { return Ok(()) };
        for (strip, face) in [(&tunnel.left, Side::Right), (&tunnel.right, Side::Left)] {
            let Ok(solid) = Solid::wall(strip, face) else { continue };
            are_convex(&solid)?;
            let whole: f64 = solid.parts().unwrap().iter().map(|part| area(outline(part))).sum();
            let [inner, outer] = [face, face.opposite()].map(|side| strip.side(side));
            let exact = if inner.is_closed() { (inner.area() - outer.area()).abs() } else { solid.outline().area() };
            let tolerance = FACE * inner.length() + BACK * outer.length();
            let laps = solid.parts().unwrap().len() as f64 * LAP * thickness;
            prop_assert!(whole > exact - tolerance && whole < exact + tolerance + laps, "{whole} m² of {exact} m²");
            prop_assert!(solid.parts().unwrap().len() < 1200, "{} parts", solid.parts().unwrap().len());
            // Before its face there is nothing, behind it the wall, and nothing again beyond its back.
            let inwards = if face == Side::Left { 1.0 } else { -1.0 };
            for (side, aside) in [(inner, 2.0 * FACE), (inner, -2.0 * FACE), (outer, 1.5 * BACK), (outer, -1.5 * BACK)] {
                let wanted = std::ptr::eq(side, inner) == (aside < 0.0);
                for sample in side.sample(0.01).iter().skip(1).rev().skip(1) {
                    let left = Point2::new(-sample.tangent.y, sample.tangent.x).coords;
                    // A point on an edge between two parts is in neither, but one beside it is.
                    let found = [-1e-7, 1e-7].iter().any(|along| {
                        let point = sample.point + inwards * aside * left + *along * sample.tangent;
                        solid.parts().unwrap().iter().any(|part| is_inside(outline(part), point))
                    });
                    prop_assert_eq!(found, wanted, "{} m aside at {}", aside, sample.arc_length);
                }
            }
        }
    }
}

/// Centre lines of all kinds.
fn line() -> impl Strategy<Value = CentreLine> {
    let run = (0.2..0.5_f64, -0.6..0.6_f64);
    prop_oneof![
        (prop::collection::vec(run, 1..6), prop_oneof![Just(Corners::AtDistance), Just(Corners::Mitred)])
            .prop_map(|(runs, corners)| CentreLine::Polyline { runs, corners }),
        (-0.2..0.2_f64, 0.5..6.0_f64, 0.2..2.0_f64).prop_map(|(amplitude, wave_number, length)| CentreLine::Sine {
            amplitude,
            wave_number,
            length
        }),
        (0.4..0.9_f64, 0.0..0.1_f64, 0..6_u32, 0.0..0.3_f64, 0.0..0.06_f64).prop_map(
            |(radius, amplitude, waves, from, funnel_depth)| {
                let opening = Opening { from, to: from + 0.1, funnel_length: 0.1, funnel_depth };
                CentreLine::Polar { radius, amplitude, waves, opening }
            }
        ),
    ]
}

#[test]
fn what_is_open_has_no_inside() {
    let arc = vibrissa::geometry::Path::from(Pose::default()).arc(0.1, 1.0).open().unwrap();
    assert_eq!(Solid::inside(arc).unwrap_err(), SolidError::Open);
}

/// The engine takes all parts that there can be, however thin.
#[test]
fn clones_share_their_parts_whoever_asks_first() {
    let corners = [(0.0, 0.0), (0.2, 0.0), (0.05, 0.05), (0.0, 0.2)].map(|(x, y)| Point2::new(x, y));
    let solid = Solid::inside(polygon(&corners).unwrap()).unwrap();
    let clone = solid.clone();
    assert!(std::ptr::eq(clone.parts().unwrap(), solid.parts().unwrap()));
    assert!(clone.parts().unwrap().len() > 1);
}

#[cfg(feature = "sim")]
mod engine {
    use super::*;
    use vibrissa::mujoco::MujocoWorld;
    use vibrissa_runtime::rig::Rig;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn every_solid_can_be_simulated(contour in random::closed()) {
            let solid = Solid::inside(contour).unwrap();
            if solid.parts().is_ok() {
                MujocoWorld::new(&Rig::default(), &vibrissa::physics::Physics::default(), &[solid], Pose::default(), 0).unwrap();
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn parts_of_a_rough_solid_fill_it_up_to_its_surface(
        wavelength in 3e-3..1e-2_f64, ratio in 0.002..0.03_f64, is_round in any::<bool>(), seed in any::<u64>(),
    ) {
        let corners = [(0.0, 0.0), (0.15, 0.0), (0.05, 0.04), (0.0, 0.15)].map(|(x, y)| Point2::new(x, y));
        let smooth = if is_round { circle(Point2::origin(), 0.08) } else { polygon(&corners) }.unwrap();
        let amplitude = ratio * wavelength;
        let texture = Texture { kind: TextureKind::Random, amplitude, wavelength, seed };
        let solid = Solid::textured(smooth, &texture).unwrap();
        are_convex(&solid)?;
        let is_in_part = |point: Point2| solid.parts().unwrap().iter().any(|part| match part {
            Part::Prism { outline } => is_inside(outline, point),
            Part::Cylinder { centre, radius } => (point - centre).norm() < *radius,
        });
        for sample in solid.surface().sample(0.7e-3) {
            let outwards = Point2::new(sample.tangent.y, -sample.tangent.x).coords;
            for depth in [-0.2, 0.2, 4.0, 9.0, 20.0].map(|multiple| multiple * amplitude) {
                let point = sample.point - depth * outwards;
                // Under a crest, another side may be nearer. In a sharp corner, the layers of both sides may leave a gap.
                let is_near = (solid.surface().signed_distance(point) + depth).abs() < 0.05 * amplitude;
                let is_thick = solid.surface().signed_distance(sample.point - 2.5 * depth * outwards) < -2.0 * depth;
                if !is_near || (depth > 0.0 && !is_thick) {
                    continue;
                }
                // A point on an edge between two parts is in neither, but one beside it is.
                let found = [-1e-7, 1e-7].iter().any(|along| is_in_part(point + *along * sample.tangent));
                prop_assert_eq!(found, depth > 0.0, "{} m deep at {}", depth, sample.arc_length);
            }
        }
    }
}
