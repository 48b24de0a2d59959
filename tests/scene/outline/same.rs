//! A shape is the same in whatever format it is written.

use std::f64::consts::TAU;

use vibrissa::geometry::{Contour, Point2, polygon, rounded_rectangle, unit};

use super::{apart, outlines};

/// The shapes by the names of their files. In SVG y points down, so that a shape above the x axis is mirrored below it.
fn shapes() -> [(&'static str, Contour); 3] {
    let square = rounded_rectangle(Point2::new(0.05, 0.03), 0.04, 0.04, 0.01, 0.0).unwrap();
    let ell = [(0, 0), (60, 0), (60, 20), (20, 20), (20, 50), (0, 50)];
    let ell = ell.map(|(x, y)| Point2::new(1e-3 * f64::from(x), 1e-3 * f64::from(y)));
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { 0.04 } else { 0.016 };
        Point2::new(0.045, 0.045) + radius * unit(0.25 * TAU + TAU * f64::from(k) / 10.0)
    };
    let star: Vec<Point2> = (0..10).map(corner).collect();
    [("square", square), ("ell", polygon(&ell).unwrap()), ("star", polygon(&star).unwrap())]
}

fn only(file: &str) -> Contour {
    let [contour] = outlines(file).unwrap().try_into().unwrap();
    contour
}

#[test]
fn a_drawing_is_its_shape_to_a_micrometre() {
    for (name, shape) in shapes() {
        for (ending, within) in [("csv", 1e-6), ("dxf", 1e-11)] {
            let found = only(&format!("{name}.{ending}"));
            assert!(apart(&found, &shape) < within, "{name}.{ending}: {} m", apart(&found, &shape));
        }
    }
}

#[test]
fn a_mesh_is_its_shape_to_its_facets() {
    // Eight facets to a corner of 10 mm.
    let sagitta = 0.01 * (1.0 - (TAU / 64.0).cos());
    for ((name, shape), within) in shapes().into_iter().zip([sagitta + 1e-6, 1e-6, 1e-6]) {
        let found = only(&format!("{name}.stl"));
        assert!(apart(&found, &shape) < within, "{name}: {} m", apart(&found, &shape));
        let corners = found.pieces().iter().map(|piece| shape.nearest(piece.start()).distance);
        assert!(corners.fold(0.0, f64::max) < 1e-6, "{name}");
        // Every face of the prism is of two triangles, which leave a side each.
        let sides = match name {
            "square" => 4 + 4 * 8,
            _ => shape.pieces().len(),
        };
        assert_eq!(found.pieces().len(), sides, "{name}");
    }
}

#[test]
fn an_svg_is_its_shape_mirrored_and_exactly() {
    let [(_, square), (_, ell), (_, star)] = shapes();
    // The square is below the origin, the others are drawn above it.
    let below = rounded_rectangle(Point2::new(0.05, -0.03), 0.04, 0.04, 0.01, 0.0).unwrap();
    let found = only("square.svg");
    assert!(apart(&found, &below) < 1e-12 && found.pieces().len() == 8);
    assert!((found.area() - square.area()).abs() < 1e-15);
    assert!(apart(&only("ell.svg"), &ell) < 1e-12);
    assert!(apart(&only("star.svg"), &star) < 1e-12);
}
