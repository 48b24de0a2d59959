//! DXF, entity by entity.

use vibrissa::geometry::{Contour, EllipticArc, Point2, Vector2, circle, rounded_rectangle};
use vibrissa::outline::{Format, OutlineError, OutlineFault, ReadOptions, read};

use super::{apart, folder};

/// A drawing with these entities, each in pairs separated by blanks; `before` is what stands before the section of entities.
fn drawing(before: &str, entities: &[&str]) -> String {
    let pairs = entities.join(" ").split_whitespace().collect::<Vec<_>>().join("\n");
    format!("{before}0\nSECTION\n2\nENTITIES\n{pairs}\n0\nENDSEC\n0\nEOF\n")
}

fn all(text: &str, element: Option<&str>) -> Result<Vec<Contour>, OutlineError> {
    read(text.as_bytes(), Format::Dxf, &ReadOptions { unit: Some(1e-3), element, height: 0.0 })
}

fn one(entities: &[&str]) -> Contour {
    let [contour] = all(&drawing("", entities), None).unwrap().try_into().unwrap();
    contour
}

#[test]
fn a_circle_is_a_circle_however_it_is_drawn() {
    let disk = circle(Point2::new(0.04, 0.05), 0.03).unwrap();
    let drawings: [&[&str]; 6] = [
        &["0 CIRCLE 10 40 20 50 40 30"],
        // Seen from below, its x counts the other way.
        &["0 CIRCLE 10 -40 20 50 40 30 210 0 220 0 230 -1"],
        &["0 ARC 10 40 20 50 40 30 50 10 51 130", "0 ARC 10 40 20 50 40 30 50 130 51 10"],
        &["0 ELLIPSE 10 40 20 50 11 0 21 30 40 1"],
        &["0 LWPOLYLINE 90 2 70 1 10 10 20 50 42 1 10 70 20 50 42 1"],
        &["0 POLYLINE 70 1 230 -1 0 VERTEX 10 -10 20 50 42 -1 0 VERTEX 10 -70 20 50 42 -1 0 SEQEND"],
    ];
    for entities in drawings {
        let found = one(entities);
        assert!(apart(&found, &disk) < 1e-9, "{entities:?}: {} m", apart(&found, &disk));
        assert!(found.pieces().iter().all(|piece| (piece.curvature() - 1.0 / 0.03).abs() < 1e-6), "{entities:?}");
    }
}

#[test]
fn an_ellipse_is_fitted_by_arcs() {
    let ellipse = one(&["0 ELLIPSE 10 40 20 50 11 30 21 0 40 0.5"]);
    let radii = [Vector2::new(0.03, 0.0), Vector2::new(0.0, 0.015)];
    let arc = EllipticArc { centre: Point2::new(0.04, 0.05), radii, start_angle: 0.0, sweep: std::f64::consts::TAU };
    let exact = Contour::closed(arc.pieces().unwrap()).unwrap();
    assert!(apart(&ellipse, &exact) < 1e-12);
    let half =
        one(&["0 ELLIPSE 10 40 20 50 11 30 21 0 40 0.5 41 0 42 3.14159265358979", "0 LINE 10 10 20 50 11 70 21 50"]);
    assert!((half.area() - 0.5 * exact.area()).abs() < 1e-7);
}

#[test]
fn layers_are_told_apart_and_lines_and_arcs_joined() {
    let text = std::fs::read_to_string(folder().join("layers.dxf")).unwrap();
    let [body] = all(&text, Some("Body")).unwrap().try_into().unwrap();
    let square = rounded_rectangle(Point2::new(0.05, 0.03), 0.04, 0.04, 0.01, 0.0).unwrap();
    assert!(apart(&body, &square) < 1e-9 && body.pieces().len() == 8);
    let both = all(&text, None).unwrap_err();
    assert!(matches!(both.fault, OutlineFault::Hole { .. }), "{both}");
    // A layer that is off or frozen is not looked at unless it is asked for.
    for state in ["62\n-7", "70\n1"] {
        let layers =
            format!("0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n0\nLAYER\n2\nHOLE\n{state}\n0\nENDTAB\n0\nENDSEC\n");
        assert_eq!(all(&format!("{layers}{text}"), None).unwrap().len(), 1);
        assert_eq!(all(&format!("{layers}{text}"), Some("hole")).unwrap().len(), 1);
    }
}

#[test]
fn the_drawing_says_its_unit_and_the_scenario_overrules_it() {
    let size = |code: &str, unit| {
        let header = format!("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{code}\n0\nENDSEC\n");
        let text = drawing(&header, &["0 CIRCLE 10 0 20 0 40 2"]);
        let outlines = read(text.as_bytes(), Format::Dxf, &ReadOptions { unit, ..ReadOptions::default() });
        outlines.map(|outlines| outlines[0].bounding_box().max.x)
    };
    for (code, metres) in [("1", 0.0254), ("4", 1e-3), ("5", 1e-2), ("6", 1.0)] {
        assert!((size(code, None).unwrap() - 2.0 * metres).abs() < 1e-15);
    }
    assert!((size("4", Some(0.5)).unwrap() - 1.0).abs() < 1e-15);
    assert_eq!(size("0", None).unwrap_err().fault, OutlineFault::NoUnit);
}

#[test]
fn what_is_no_outline_is_passed_over_and_what_may_be_one_is_not() {
    let circle = "0 CIRCLE 10 40 20 50 40 30";
    for other in [
        "0 TEXT 10 1 20 2 1 a",
        "0 POINT 10 1 20 2",
        "0 DIMENSION 10 1",
        "0 VIEWPORT 10 1",
        "0 HATCH 10 1",
        "0 LINE 67 1 10 0 20 0 11 9 21 9",
    ] {
        assert_eq!(all(&drawing("", &[circle, other]), None).unwrap().len(), 1, "{other}");
    }
    for other in [
        "0 SPLINE 70 8",
        "0 INSERT 2 a",
        "0 POLYLINE 70 9",
        "0 CIRCLE 40 1 210 1 230 1",
        "0 REGION 1 a",
        "0 ACAD_PROXY_ENTITY 90 1",
    ] {
        let error = all(&drawing("", &[circle, other]), None).unwrap_err();
        assert!(matches!(error.fault, OutlineFault::Unsupported { .. }) && error.line == Some(14), "{other}: {error}");
    }
}
