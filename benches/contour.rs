//! Queries of contours: the exact ones, which scores ask for the distance of every tip, and the local one behind a tip.

#![allow(missing_docs, reason = "criterion's macros write undocumented items")]

mod stage;

use std::error::Error;
use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, Throughput};
use stage::Stage;
use vibrissa::geometry::{ContourSet, Point2, perpendicular, unit};
use vibrissa_runtime::percept::LocalContour;

/// Points that are asked for, all along a contour.
const POINTS: usize = 512;
/// How far off a contour they are (m), by turns: as far as tips.
const OFF: [f64; 4] = [3e-5, -2e-5, 1e-3, -4e-4];

fn main() -> Result<(), Box<dyn Error>> {
    let (disk, tunnel) = (Stage::disk()?, Stage::tunnel()?);
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("exact_contour");
    group.throughput(Throughput::Elements(POINTS as u64));
    for (name, stage) in [("disk", &disk), ("tunnel", &tunnel)] {
        let surfaces = &stage.scene.truth.surfaces;
        let tips = tips(surfaces);
        group.bench_function(format!("{name} distance"), |bencher| {
            bencher.iter(|| tips.iter().map(|&tip| surfaces.distance(black_box(tip))).sum::<f64>());
        });
        group.bench_function(format!("{name} nearest"), |bencher| {
            bencher.iter(|| tips.iter().map(|&tip| surfaces.nearest(black_box(tip)).arc_length).sum::<f64>());
        });
    }
    group.finish();

    // Every one of these points becomes a keypoint.
    let points: Vec<Point2> =
        (0..POINTS).map(|step| Point2::from(0.3 * unit(TAU * step as f64 / POINTS as f64))).collect();
    let mut group = criterion.benchmark_group("local_contour");
    group.throughput(Throughput::Elements(POINTS as u64));
    group.bench_function("keypoint", |bencher| {
        let mut contour = LocalContour::default();
        bencher.iter(|| points.iter().for_each(|&point| contour.add(black_box(point))));
    });
    let mut contour = LocalContour::default();
    for &point in &points {
        contour.add(point);
    }
    group.throughput(Throughput::Elements(1));
    group.bench_function("tangent", |bencher| bencher.iter(|| black_box(&contour).tangent_at(black_box(5e-3))));
    group.bench_function("point", |bencher| bencher.iter(|| black_box(&contour).point_at(black_box(5e-3))));
    group.bench_function("curvature", |bencher| bencher.iter(|| black_box(&contour).curvature()));
    group.finish();
    criterion.final_summary();
    Ok(())
}

/// Points beside contours, evenly along all of them.
fn tips(contours: &ContourSet) -> Vec<Point2> {
    let step = contours.length() / POINTS as f64;
    let mut tips = Vec::with_capacity(POINTS);
    for contour in contours.contours() {
        let mut way = 0.0;
        while way < contour.length() {
            let along = contour.tangent_at(way);
            let off = OFF[tips.len() % OFF.len()];
            tips.push(contour.point_at(way) + off * perpendicular(along));
            way += step;
        }
    }
    tips.truncate(POINTS);
    tips
}
