//! DXF, entity by entity.

use vibrissa::geometry::{Contour, EllipticArc, Piece, Point2, Vector2, circle, rounded_rectangle};
use vibrissa::outline::{Format, OutlineError, OutlineFault, ReadOptions, read};

use super::{apart, folder};

/// A drawing with these entities, each in pairs separated by blanks; `before` is what stands before the section of entities.
fn drawing(before: &str, entities: &[&str]) -> String {
    let pairs = entities.join(" ").split_whitespace().collect::<Vec<_>>().join("\n");
    format!("{before}0\nSECTION\n2\nENTITIES\n{pairs}\n0\nENDSEC\n0\nEOF\n")
}

fn all(text: &str, element: Option<&str>) -> Result<Vec<Contour>, OutlineError> {
    read(
        text.as_bytes(),
        Format::Dxf,
        &ReadOptions { unit: Some(1e-3), element, height: 0.0, ..ReadOptions::default() },
    )
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
        "0 HELIX 70 8",
        "0 POLYLINE 70 9",
        "0 CIRCLE 40 1 210 1 230 1",
        "0 REGION 1 a",
        "0 ACAD_PROXY_ENTITY 90 1",
    ] {
        let error = all(&drawing("", &[circle, other]), None).unwrap_err();
        assert!(matches!(error.fault, OutlineFault::Unsupported { .. }) && error.line == Some(14), "{other}: {error}");
    }
}

/// A drawing with blocks, each in pairs separated by blanks.
fn with_blocks(blocks: &[&str], entities: &[&str]) -> String {
    let pairs = blocks.join(" ").split_whitespace().collect::<Vec<_>>().join("\n");
    drawing(&format!("0\nSECTION\n2\nBLOCKS\n{pairs}\n0\nENDSEC\n"), entities)
}

/// An `a` of 20 mm by 10 mm from its base point at (5 mm, 5 mm), with a half circle on top.
const BLOCK: &str =
    "0 BLOCK 2 A 10 5 20 5 0 LWPOLYLINE 8 0 70 1 10 5 20 5 10 25 20 5 10 25 20 15 42 1 10 5 20 15 0 ENDBLK";

/// The same, with its base point at a place, turned by an angle and mirrored.
fn block(place: [f64; 2], angle: f64, mirror: f64) -> Contour {
    let at = |x: f64, y: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        let x = mirror * x;
        Point2::new(1e-3 * (place[0] + cos * x - sin * y), 1e-3 * (place[1] + sin * x + cos * y))
    };
    let side = |from: (f64, f64), to: (f64, f64)| Piece::segment(at(from.0, from.1), at(to.0, to.1));
    let top = Piece::arc_between(at(20.0, 10.0), at(0.0, 10.0), mirror * std::f64::consts::PI);
    let pieces =
        vec![side((0.0, 0.0), (20.0, 0.0)), side((20.0, 0.0), (20.0, 10.0)), top, side((0.0, 10.0), (0.0, 0.0))];
    Contour::closed(pieces).unwrap()
}

#[test]
fn a_block_is_drawn_where_it_is_inserted() {
    let inserts = [
        ("0 INSERT 2 a 10 100 20 50", block([100.0, 50.0], 0.0, 1.0)),
        ("0 INSERT 2 A 10 100 20 50 50 30", block([100.0, 50.0], 30.0, 1.0)),
        ("0 INSERT 2 A 10 100 20 50 50 30 41 -1", block([100.0, 50.0], 30.0, -1.0)),
        // Seen from below: the x of the place is mirrored, and angles count the other way.
        ("0 INSERT 2 A 10 -100 20 50 50 -30 230 -1", block([100.0, 50.0], 30.0, -1.0)),
    ];
    for (insert, expected) in inserts {
        let [found] = all(&with_blocks(&[BLOCK], &[insert]), None).unwrap().try_into().unwrap();
        assert!(apart(&found, &expected) < 1e-9, "{insert}: {} m", apart(&found, &expected));
    }
    let scaled = all(&with_blocks(&[BLOCK], &["0 INSERT 2 A 41 2 42 3"]), None).unwrap();
    let area = 40.0 * 30.0 + 0.5 * std::f64::consts::PI * 20.0 * 30.0;
    assert!((scaled[0].area() * 1e6 - area).abs() < 0.1, "{}", scaled[0].area());
}

#[test]
fn blocks_are_repeated_in_rows_and_columns_and_in_each_other() {
    let rows = all(&with_blocks(&[BLOCK], &["0 INSERT 2 A 70 3 71 2 44 50 45 -40 50 90 41 0.5 42 0.5"]), None).unwrap();
    let mut corners: Vec<_> = rows.iter().map(|contour| contour.bounding_box().max).collect();
    corners.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).unwrap());
    let expected = [0, 40].map(|x| [0, 50, 100].map(|y| Point2::new(1e-3 * f64::from(x), 1e-3 * f64::from(y + 10))));
    assert_eq!(corners.len(), 6);
    for (found, expected) in corners.iter().zip(expected.as_flattened()) {
        assert!((found - expected).norm() < 1e-9, "{found} for {expected}");
    }
    let outer = "0 BLOCK 2 B 0 INSERT 2 A 10 10 50 90 0 INSERT 2 A 10 -10 0 ENDBLK";
    let nested = all(&with_blocks(&[BLOCK, outer], &["0 INSERT 2 B 10 1 20 2 41 2 42 2"]), None).unwrap();
    assert_eq!(nested.len(), 2);
    let area = 4.0 * block([0.0, 0.0], 0.0, 1.0).area();
    assert!(nested.iter().all(|contour| (contour.area() - area).abs() < 1e-12));
}

#[test]
fn a_block_has_the_layer_of_its_insert_where_its_entities_have_none() {
    let other = "0 BLOCK 2 B 0 CIRCLE 8 holes 10 200 20 0 40 3 0 ENDBLK";
    let layers = |states: &str| {
        let pairs = states.split_whitespace().collect::<Vec<_>>().join("\n");
        format!("0\nSECTION\n2\nTABLES\n{pairs}\n0\nENDSEC\n")
    };
    let text = with_blocks(&[BLOCK, other], &["0 INSERT 8 body 2 A", "0 INSERT 8 body 2 B"]);
    assert_eq!(all(&text, None).unwrap().len(), 2);
    assert_eq!(all(&text, Some("Body")).unwrap().len(), 1);
    assert_eq!(all(&text, Some("holes")).unwrap().len(), 1);
    let missing = all(&text, Some("bodi")).unwrap_err();
    let meant = Some("body".to_owned());
    assert_eq!(missing.fault, OutlineFault::NoElement { element: "bodi".to_owned(), meant });
    // A layer that is off hides what is in it, one that is frozen also what is inserted there.
    let off = layers("0 LAYER 2 BODY 62 -7");
    assert_eq!(all(&format!("{off}{text}"), None).unwrap().len(), 1);
    let frozen = layers("0 LAYER 2 BODY 70 1");
    assert_eq!(all(&format!("{frozen}{text}"), None).unwrap_err().fault, OutlineFault::Invisible { unseen: 2 });
    let invisible = with_blocks(&[BLOCK], &["0 INSERT 2 A 60 1", "0 CIRCLE 40 9"]);
    assert_eq!(all(&invisible, None).unwrap().len(), 1);
}

#[test]
fn blocks_that_cannot_be_drawn_are_told() {
    let told = |blocks: &[&str], insert: &str| {
        let error = all(&with_blocks(blocks, &[insert]), None).unwrap_err();
        assert!(error.line.is_some(), "{error}");
        error.to_string()
    };
    assert!(told(&[BLOCK], "0 INSERT 2 gone").contains("the block `gone`, which is not there"));
    assert!(told(&["0 BLOCK 2 A 70 4 0 ENDBLK"], "0 INSERT 2 A").contains("of another file"));
    assert!(told(&[BLOCK], "0 INSERT 2 A 210 1").contains("tilted"));
    assert!(told(&[BLOCK], "0 INSERT 2 A 41 0").contains("the scale 0"));
    assert!(told(&["0 BLOCK 2 A 0 INSERT 2 a 0 ENDBLK"], "0 INSERT 2 A").contains("the block `a` contains itself"));
    let ring = ["0 BLOCK 2 A 0 INSERT 2 B 0 ENDBLK", "0 BLOCK 2 B 0 INSERT 2 A 0 ENDBLK"];
    assert!(told(&ring, "0 INSERT 2 B").contains("the block `B` contains itself"));
    let chain: Vec<String> = (0..40).map(|at| format!("0 BLOCK 2 c{at} 0 INSERT 2 c{} 0 ENDBLK", at + 1)).collect();
    let chain: Vec<&str> = chain.iter().map(String::as_str).collect();
    assert!(told(&chain, "0 INSERT 2 c0").contains("more than 32"));
    let rows = "0 INSERT 2 A 70 30000 71 30000 44 1 45 1";
    assert!(told(&["0 BLOCK 2 A 0 ENDBLK"], rows).contains("more than 500000"));
    // What no entity shows is not read.
    assert_eq!(all(&with_blocks(&["0 BLOCK 2 A 0 REGION 1 a 0 ENDBLK"], &["0 CIRCLE 40 1"]), None).unwrap().len(), 1);
}

#[test]
fn a_spline_is_its_curve() {
    // A circle of four quarters, by a closed spline with weights.
    let half = 0.5_f64.sqrt();
    let corners = [(70, 50), (70, 80), (40, 80), (10, 80), (10, 50), (10, 20), (40, 20), (70, 20), (70, 50)];
    let points: String = corners.map(|(x, y)| format!("10 {x} 20 {y} ")).concat();
    let weights = format!("{}41 1 ", format!("41 1 41 {half} ").repeat(4));
    let knots: String = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(|knot| format!("40 {knot} ")).concat();
    let circle_of_quarters = one(&[&format!("0 SPLINE 70 5 71 2 {knots}{weights}{points}")]);
    assert!(apart(&circle_of_quarters, &circle(Point2::new(0.04, 0.05), 0.03).unwrap()) < 1e-6);
    // A cubic without weights between lines: an arch of two thirds of its control polygon's height.
    let arch = "0 SPLINE 70 8 71 3 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 10 0 20 0 10 0 20 40 10 60 20 40 10 60 20 0";
    let found = one(&[arch, "0 LINE 10 60 20 0 11 0 21 0"]);
    assert!((found.bounding_box().max.y - 0.03).abs() < 1.1e-6, "{}", found.bounding_box().max.y);
    // A spline of degree 1 is a polygon; the last point is the first.
    let polygon = "0 SPLINE 70 1 71 1 40 0 40 0 40 1 40 2 40 3 40 3 10 0 20 0 10 60 20 0 10 0 20 40 10 0 20 0";
    assert!((one(&[polygon]).area() - 1.2e-3).abs() < 1e-12);
    let fitted = all(&drawing("", &["0 SPLINE 70 8 71 3 11 0 21 0 11 1 21 1"]), None).unwrap_err();
    assert!(matches!(fitted.fault, OutlineFault::Unsupported { .. }), "{fitted}");
    let short = all(&drawing("", &["0 SPLINE 71 3 40 0 40 1 10 0 20 0"]), None).unwrap_err();
    assert!(matches!(short.fault, OutlineFault::Syntax { .. }) && short.line == Some(6), "{short}");
}

#[test]
fn what_has_no_size_is_left_out() {
    for point in [
        "0 LWPOLYLINE 90 1 70 1 10 3 20 4",
        "0 LWPOLYLINE 90 0 70 1",
        "0 LWPOLYLINE 90 2 70 1 10 3 20 4 10 3 20 4",
        "0 LWPOLYLINE 90 1 70 0 10 3 20 4 42 1",
        "0 POLYLINE 70 1 0 VERTEX 10 3 20 4 0 SEQEND",
        "0 LINE 10 3 20 4 11 3 21 4",
        "0 SPLINE 70 1 71 1 40 0 40 0 40 1 40 1 10 3 20 4 10 3 20 4",
    ] {
        assert_eq!(all(&drawing("", &["0 CIRCLE 10 40 20 50 40 30", point]), None).unwrap().len(), 1, "{point}");
    }
}

#[test]
fn an_arc_that_reaches_too_far_is_refused() {
    for far in [
        "0 LWPOLYLINE 70 1 10 0 20 0 42 3000 10 0 20 100",
        "0 CIRCLE 10 99999 20 0 40 2",
        "0 ARC 10 0 20 99990 40 20 50 0 51 180",
    ] {
        let closed = [far, "0 LINE 10 -20 20 99990 11 20 21 99990"];
        let error = all(&drawing("", &closed[..if far.contains("ARC") { 2 } else { 1 }]), None).unwrap_err();
        assert_eq!((error.fault, error.line), (OutlineFault::FarOff, Some(6)), "{far}");
    }
}

#[test]
fn every_unit_of_the_format_is_known() {
    let survey = 1200.0 / 3937.0;
    let metres = [
        (1, 0.0254),
        (2, 0.3048),
        (3, 1609.344),
        (4, 1e-3),
        (5, 1e-2),
        (6, 1.0),
        (7, 1e3),
        (8, 25.4e-9),
        (9, 25.4e-6),
        (10, 0.9144),
        (11, 1e-10),
        (12, 1e-9),
        (13, 1e-6),
        (14, 0.1),
        (15, 10.0),
        (16, 100.0),
        (17, 1e9),
        (18, 149_597_870_700.0),
        (19, 9.460_730_472_580_8e15),
        (20, 3.085_677_581_491_367e16),
        (21, survey),
        (22, survey / 12.0),
        (23, 3.0 * survey),
        (24, 5280.0 * survey),
    ];
    let radius = |code: i32, unit: f64| {
        let header = format!("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{code}\n0\nENDSEC\n");
        let text = drawing(&header, &[&format!("0 CIRCLE 40 {:e}", 0.02 / unit)]);
        let outlines = read(text.as_bytes(), Format::Dxf, &ReadOptions::default());
        outlines.map(|outlines| outlines[0].bounding_box().max.x)
    };
    for (code, unit) in metres {
        assert!((radius(code, unit).unwrap() - 0.02).abs() < 1e-12, "{code}");
    }
    assert_eq!(radius(0, 1.0).unwrap_err().fault, OutlineFault::NoUnit);
    let unknown = OutlineFault::UnknownUnit { stated: "25".to_owned() };
    assert_eq!(radius(25, 1.0).unwrap_err().fault, unknown);
}
