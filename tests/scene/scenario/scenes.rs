//! The geometry of the baseline's scenes, compared with independent calculations.

use std::f64::consts::{PI, SQRT_2, TAU};
use std::path::Path;

use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::geometry::{Contour, Point2, Pose, Vector2};
use vibrissa::scenario;
use vibrissa::scene::Scene;

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(name).with_extension("yaml");
    let source = Source::new(name, std::fs::read_to_string(path).unwrap());
    let scene = scenario::read(&source).map_err(|faults| terminal(&source, &faults, Colour::Plain)).unwrap();
    assert_eq!(scene.name, name);
    assert_eq!(scene.start, Pose { position: Point2::new(0.0, 0.072), heading: 0.5 * PI });
    scene
}

/// The outline of a scene's only object.
fn outline(name: &str) -> Contour {
    let scene = scene(name);
    assert_eq!((scene.solids.len(), scene.truth.reference.contours().count()), (1, 1));
    assert!(scene.stop.loop_closed.is_some() && scene.truth.axes.is_empty());
    scene.solids[0].outline().clone()
}

/// Whether the contour has its corners, within a distance (m), just there.
fn has_corners(contour: &Contour, places: &[(f64, f64)], within: f64) {
    let corners = contour.corners();
    assert_eq!(corners.len(), places.len());
    for &(x, y) in places {
        let nearest =
            corners.iter().map(|corner| (corner.point - Point2::new(x, y)).norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < within, "({x}, {y}): {nearest} m");
    }
}

#[test]
fn the_rounded_rectangle_is_of_its_size() {
    let contour = outline("rounded-rectangle");
    assert!((contour.area() - (0.52 * 1.02 - (4.0 - PI) * 0.11 * 0.11)).abs() < 1e-12);
    assert!((contour.length() - (2.0 * (0.30 + 0.80) + TAU * 0.11)).abs() < 1e-12);
    let bounds = contour.bounding_box();
    assert!((bounds.min - Point2::new(0.115, 0.29)).norm() + (bounds.max - Point2::new(0.635, 1.31)).norm() < 1e-12);
}

#[test]
fn the_complex_outline_has_its_half_circles_and_four_corners() {
    let contour = outline("complex");
    let places = [(0.39925, 0.42482), (0.30870, 0.58165), (0.0087, 0.84518), (0.09925, 0.68835)];
    has_corners(&contour, &places, 2e-5);
    let turns = contour.corners().into_iter().map(|corner| corner.turn.to_degrees());
    assert!(
        turns.clone().all(|turn| (turn.abs() - 30.0).abs() < 1e-9) && turns.filter(|turn| *turn < 0.0).count() == 2
    );
    for (centre, way) in [(Point2::new(0.24925, 0.3), -1.0), (Point2::new(0.1587, 0.97), 1.0)] {
        for share in 0..=10 {
            let (sin, cos) = (way * PI * f64::from(share) / 10.0).sin_cos();
            assert!(contour.nearest(centre + 0.15 * Vector2::new(cos, sin)).distance < 2e-5);
        }
    }
    // Two half disks, and a band between them of a width of 0.3, but less by 0.09055 where the right side has gone in and the
    // left one has not yet gone out.
    let band = 0.3 * 0.67 - 0.09055 * (0.68835 - 0.42482);
    assert!((contour.area() - (PI * 0.15 * 0.15 + band)).abs() < 1e-5);
    assert!(!contour.is_convex());
}

#[test]
fn the_octagon_has_a_corner_on_its_right() {
    let contour = outline("octagon");
    let d = 0.3 / SQRT_2;
    let around = [(0.3, 0.0), (d, d), (0.0, 0.3), (-d, d), (-0.3, 0.0), (-d, -d), (0.0, -0.3), (d, -d)];
    has_corners(&contour, &around.map(|(x, y)| (0.32 + x, 0.4 + y)), 1e-12);
    assert!((contour.area() - 2.0 * SQRT_2 * 0.09).abs() < 1e-12);
}

#[test]
fn the_box_is_a_square_turned_by_ten_degrees() {
    let contour = outline("box");
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    let corner = |x: f64, y: f64| (0.32 + 0.2 * (cos * x - sin * y), 0.2 + 0.2 * (sin * x + cos * y));
    has_corners(&contour, &[corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)], 1e-12);
}

#[test]
fn the_prism_is_equilateral() {
    let contour = outline("prism");
    has_corners(&contour, &[(0.15, 0.2), (0.0206, 0.6830), (0.5036, 0.5536)], 1e-4);
    assert!((contour.length() - 1.5).abs() < 1e-12 && (contour.area() - 0.25 * 3_f64.sqrt() * 0.25).abs() < 1e-12);
}

#[test]
fn the_wall_stands_to_the_left_of_its_long_side() {
    let contour = outline("wall");
    let (sin, cos) = 100_f64.to_radians().sin_cos();
    let (along, left) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let near = Point2::new(0.15, 0.2);
    let corners = [near, near + 0.3 * along, near + 0.01 * left, near + 0.3 * along + 0.01 * left];
    has_corners(&contour, &corners.map(|corner| (corner.x, corner.y)), 1e-12);
    assert!((corners[1] - Point2::new(0.0979, 0.4954)).norm() < 1e-4);
    assert!((contour.area() - 0.003).abs() < 1e-12);
}

/// How far a point is from the nearest face of a tunnel's walls, and whether it is within a wall.
fn at(scene: &Scene, point: Point2) -> (f64, bool) {
    let solid = scene.solids.iter().any(|solid| solid.outline().contains(point));
    (scene.truth.reference.nearest(point).distance, solid)
}

/// Whether the place that a tunnel's run is to reach is on its axis, at its end if it has one.
fn leads_to_the_end(scene: &Scene, end: Option<Point2>) {
    let reached = scene.stop.reached.unwrap();
    let axis = scene.truth.axes[0].line();
    assert!(axis.nearest(reached.place).distance < 3e-3, "off the axis");
    if let Some(end) = end {
        assert!((reached.place - end).norm() < 1e-3);
    }
}

#[test]
fn the_smooth_tunnel_is_even_along_its_sine() {
    let scene = scene("smooth-tunnel");
    let frame = Pose { position: Point2::new(0.0, 0.2), heading: 70_f64.to_radians() };
    let line = |x: f64, aside: f64| {
        let normal = Vector2::new(-0.4 * (4.0 * x).cos(), 1.0).normalize();
        frame.point_to_world(Point2::new(x, 0.1 * (4.0 * x).sin()) + aside * normal)
    };
    let axis = scene.truth.axes[0].line();
    for k in 1..1000 {
        let x = 1.5 * f64::from(k) / 1000.0;
        assert!(axis.nearest(line(x, 0.0)).distance < 2e-6);
        let (to_face, solid) = at(&scene, line(x, 0.0));
        assert!((to_face - 0.1025).abs() < 3e-6 && !solid, "half of the clear width of 205 mm");
        for side in [-1.0, 1.0] {
            let (to_face, solid) = at(&scene, line(x, side * 0.1125));
            assert!((to_face - 0.01).abs() < 3e-6 && solid, "the middle of a wall");
        }
    }
    // Two walls of 20 mm along parallels, whose lengths differ as the line turns.
    let along: f64 =
        (0..100_000).map(|k| (0.4 * (4.0 * 1.5 * (f64::from(k) + 0.5) / 1e5).cos()).hypot(1.0) * 1.5e-5).sum();
    let turn = (0.4 * 6_f64.cos()).atan() - 0.4_f64.atan();
    let areas = scene.solids.iter().map(|solid| solid.outline().area());
    for (area, side) in areas.zip([1.0, -1.0]) {
        assert!((area - 0.02 * (along - side * 0.1125 * turn)).abs() < 1e-6);
    }
    leads_to_the_end(&scene, Some(line(1.5, 0.0)));
}

#[test]
fn the_zigzag_tunnel_has_its_walls_on_the_mean_normals() {
    let scene = scene("zigzag-tunnel");
    let headings = [90.0, 60.0, 90.0, 60.0, 90.0, 60.0_f64].map(f64::to_radians);
    let mut vertices = vec![Point2::new(0.0, 0.2)];
    for heading in headings {
        vertices.push(vertices[vertices.len() - 1] + 0.25 * Vector2::new(heading.cos(), heading.sin()));
    }
    for side in [-0.1125, 0.1125] {
        let middles: Vec<Point2> = (0..=6_usize)
            .map(|k| {
                let mean = 0.5 * (headings[k.saturating_sub(1)] + headings[k.min(5)]);
                vertices[k] + side * Vector2::new(-mean.sin(), mean.cos())
            })
            .collect();
        for run in middles.windows(2) {
            for share in [0.2, 0.5, 0.8] {
                let (to_face, solid) = at(&scene, run[0] + share * (run[1] - run[0]));
                assert!((to_face - 0.01).abs() < 1e-9 && solid);
            }
        }
    }
    // Between runs that are displaced as a whole: the mean normal is 15° off their own.
    let middle = nalgebra::center(&vertices[2], &vertices[3]);
    let (to_face, solid) = at(&scene, middle);
    assert!((to_face - (0.1125 * 15_f64.to_radians().cos() - 0.01)).abs() < 1e-9 && !solid);
    assert_eq!(scene.solids.iter().map(|solid| solid.parts().unwrap().len()).collect::<Vec<_>>(), [6, 6]);
    leads_to_the_end(&scene, vertices.last().copied());
}

#[test]
fn the_round_tunnel_goes_round_its_star_and_opens_where_the_platform_starts() {
    let scene = scene("round-tunnel");
    let frame = Pose { position: Point2::new(-0.55, 1.0), heading: -85_f64.to_radians() };
    let outer = |angle: f64| 1.0 + 0.1 * (5.0 * angle).sin();
    let place =
        |angle: f64, radius: f64| frame.point_to_world(Point2::from(radius * Vector2::new(angle.cos(), angle.sin())));
    let axis = scene.truth.axes[0].line();
    let mut off_the_axis = 0.0_f64;
    for k in 0..1000 {
        let angle = TAU * f64::from(k) / 1000.0;
        let (to_face, solid) = at(&scene, place(angle, outer(angle) - 0.22));
        assert!((to_face - 0.01).abs() < 3e-6 && solid, "the inner wall goes all the way round");
        assert!(axis.nearest(place(angle, outer(angle) - 0.11)).distance < 2e-6);
        assert!(!at(&scene, place(angle, outer(angle) - 0.11)).1);
        off_the_axis = off_the_axis.max(scene.truth.axes[0].distance(place(angle, outer(angle) - 0.11)).unwrap());
    }
    assert!((2e-3..4e-3).contains(&off_the_axis), "walls at a distance along the radius are not parallel");
    // Arc lengths of the outer wall by many chords.
    let steps = 100_000_u32;
    let angles: Vec<f64> = (0..=steps).map(|k| TAU * f64::from(k) / f64::from(steps)).collect();
    let mut shares = vec![0.0];
    for ends in angles.windows(2) {
        let chord = (place(ends[1], outer(ends[1])) - place(ends[0], outer(ends[0]))).norm();
        shares.push(shares[shares.len() - 1] + chord);
    }
    let length = shares[shares.len() - 1];
    assert!((length - 6.66).abs() < 1e-3);
    for (angle, along) in angles.iter().zip(&shares).step_by(100) {
        let (share, middle) = (along / length, place(*angle, outer(*angle)));
        let (to_face, solid) = at(&scene, middle);
        if share > 0.201 && share < 0.959 {
            assert!((to_face - 0.01).abs() < 3e-6 && solid, "the wall at {share}");
        } else if share > 0.061 && share < 0.099 {
            assert!(!solid && !at(&scene, place(*angle, outer(*angle) + 0.08)).1, "the opening at {share}");
        }
    }
    // The ends of the wall, bent outwards by 80 mm.
    for share in [0.0605, 0.0995] {
        let index = shares.partition_point(|along| along / length < share);
        let beside = shares.partition_point(|along| along / length < if share < 0.08 { 0.059 } else { 0.101 });
        assert!(!at(&scene, place(angles[index], outer(angles[index]) + 0.08)).1);
        assert!(at(&scene, place(angles[beside], outer(angles[beside]) + 0.078)).1, "the funnel at {share}");
    }
    leads_to_the_end(&scene, None);
    assert!(scene.stop.reached.unwrap().after > 30.0, "the start is near the end");
}
