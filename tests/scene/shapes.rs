//! The outlines of the family `shapes`.

use vibrissa::family::Family;
use vibrissa::geometry::{Contour, Piece, perpendicular};

const TRIALS: u64 = 200;

/// The outlines with their descriptions.
fn drawn() -> Vec<(String, Contour)> {
    let family = Family::named("shapes").unwrap();
    let draw = |trial| family.draw(7, trial).unwrap().scene;
    (0..TRIALS)
        .map(draw)
        .map(|scene| {
            let [solid] = scene.solids.as_slice() else { panic!("{} objects in {}", scene.solids.len(), scene.name) };
            assert!(solid.outline().is_closed());
            (scene.description.clone(), solid.outline().clone())
        })
        .collect()
}

fn share(drawn: &[(String, Contour)], is_so: impl Fn(&Contour) -> bool) -> f64 {
    drawn.iter().filter(|(_, outline)| is_so(outline)).count() as f64 / drawn.len() as f64
}

#[test]
fn shapes_are_one_outline_of_30_to_90_cm_whose_length_is_bounded() {
    for (about, outline) in drawn() {
        let points: Vec<_> = outline.sample(4e-3).into_iter().map(|sample| sample.point).collect();
        let across = points.iter().flat_map(|a| points.iter().map(move |b| (a - b).norm())).fold(0.0, f64::max);
        // A rounded corner takes some millimetres from the largest distance.
        assert!((0.27..0.9001).contains(&across), "{about}: {across} m");
        assert!(outline.length() < 8.0 * across, "{about}: {} m", outline.length());
        // The chain of pieces meets itself nowhere: an outline that does is refused.
        assert!(Contour::closed(outline.pieces().to_vec()).is_ok(), "{about}");
    }
}

#[test]
fn shapes_have_no_thin_necks_and_no_narrow_gaps() {
    for (about, outline) in drawn() {
        // The outline itself is nearest to a point 0.5 mm beside it, unless another side is as near.
        let corners = outline.corners();
        for sample in outline.sample(2e-3) {
            let outwards = -perpendicular(sample.tangent);
            for distance in [-5e-4, 5e-4] {
                let point = sample.point + distance * outwards;
                let signed = outline.signed_distance(point);
                let is_near_corner = corners.iter().any(|corner| (corner.point - sample.point).norm() < 0.025);
                assert!(is_near_corner || (signed - distance).abs() < 1e-5, "{about}: {signed} at {point}");
            }
        }
    }
}

#[test]
fn shapes_mix_convex_and_concave_parts_arcs_and_small_radii() {
    let drawn = drawn();
    let has_corner =
        |sign: f64| move |outline: &Contour| outline.corners().iter().any(|corner| sign * corner.turn > 0.1);
    let has_arc = |least: f64, most: f64| {
        move |outline: &Contour| outline.pieces().iter().map(Piece::curvature).any(|bend| (least..most).contains(&bend))
    };
    let shares = [
        share(&drawn, |outline| !outline.is_convex()),
        share(&drawn, has_corner(1.0)),
        share(&drawn, has_corner(-1.0)),
        share(&drawn, has_arc(1e-3, 1e4)),
        share(&drawn, has_arc(-1e4, -1e-3)),
        // Radii up to 3 cm.
        share(&drawn, has_arc(1.0 / 0.03, 1e4)),
        share(&drawn, has_arc(-1e4, -1.0 / 0.03)),
    ];
    assert!(shares.iter().all(|share| *share > 0.3), "{shares:?}");
    assert!(shares[0] > 0.95, "{shares:?}");
    for kind in ["boss", "round boss", "notch", "bite", "slot", "teeth", "a disk", "a rectangle"] {
        let count = drawn.iter().filter(|(about, _)| about.contains(kind)).count();
        assert!(count > 20, "{kind}: {count}");
    }
}
