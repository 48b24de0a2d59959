//! Files that were once read wrongly, or refused for no good reason.

use vibrissa::outline::{Format, Holes, OutlineError, OutlineFault, ReadOptions, read};

use super::folder;

/// The areas (mm²) of the outlines of a file in ascending order, rounded to a hundredth.
fn areas(file: &str, options: &ReadOptions<'_>) -> Result<Vec<f64>, OutlineError> {
    let bytes = std::fs::read(folder().join("cases").join(file)).unwrap();
    let contours = read(&bytes, Format::of(file).unwrap(), options)?;
    let mut areas: Vec<f64> = contours.iter().map(|contour| (contour.area() * 1e8).round() / 100.0).collect();
    areas.sort_by(f64::total_cmp);
    Ok(areas)
}

const MILLIMETRES: ReadOptions<'_> =
    ReadOptions { unit: Some(1e-3), element: None, height: 0.01, holes: Holes::Refuse };

#[test]
fn a_mesh_is_read_whoever_wrote_it() {
    assert_eq!(areas("two_solids.stl", &MILLIMETRES).unwrap(), [900.0, 5000.0]);
    for file in [
        "nan_normal.stl",
        "end_loop.stl",
        "end_solid.stl",
        "comment.stl",
        "leadsp.stl",
        "bom.stl",
        "upper.stl",
        "latin1.stl",
    ] {
        assert_eq!(areas(file, &MILLIMETRES).unwrap(), [5000.0], "{file}");
    }
    let error = areas("bin_count0.stl", &MILLIMETRES).unwrap_err().to_string();
    assert_eq!(error, "byte 80: the number of triangles is 0, but the file has the bytes of 12");
}

#[test]
fn a_drawing_has_only_what_can_be_seen() {
    let stated = ReadOptions::default();
    assert_eq!(areas("icon_touch.svg", &stated).unwrap(), [28800.0]);
    assert_eq!(areas("icon_in.svg", &stated).unwrap(), [20000.0]);
    assert_eq!(areas("nofill.svg", &stated).unwrap(), [5000.0]);
    let hidden = areas("hidden_by_block0.dxf", &stated).unwrap_err();
    assert_eq!(hidden.fault, OutlineFault::Invisible { unseen: 1 });
}

#[test]
fn polygons_are_separated_by_blank_lines_and_numbers_by_what_spreadsheets_write() {
    assert_eq!(areas("gap_merge.csv", &MILLIMETRES).unwrap(), [2500.0, 5000.0]);
    assert_eq!(areas("semicolon.csv", &MILLIMETRES).unwrap(), [5000.0]);
    assert_eq!(areas("bom.csv", &MILLIMETRES).unwrap(), [5000.0]);
}

#[test]
fn a_unit_that_a_file_states_is_used() {
    let stated = ReadOptions::default();
    // The drawing is fitted into its frame, which is higher than necessary.
    assert_eq!(areas("aniso.svg", &stated).unwrap(), [5000.0]);
    assert_eq!(areas("caps.svg", &stated).unwrap(), [5000.0]);
    let foot = 1200.0 / 3937.0;
    let area: f64 = 2.0 * foot * foot;
    assert_eq!(areas("unit21.dxf", &stated).unwrap(), [(area * 1e8).round() / 100.0]);
}

#[test]
fn a_drawing_in_blocks_is_read_and_one_with_a_point_too_but_none_of_hundred_kilometres() {
    let stated = ReadOptions::default();
    assert_eq!(areas("block.dxf", &stated).unwrap(), [20000.0]);
    assert_eq!(areas("onevertex.dxf", &stated).unwrap(), [20000.0]);
    assert_eq!(areas("bulge_huge.dxf", &stated).unwrap_err().fault, OutlineFault::FarOff);
    let tilted = areas("lwp_elev_tilt.dxf", &stated).unwrap_err();
    assert!(matches!(tilted.fault, OutlineFault::Unsupported { .. }) && tilted.line.is_some(), "{tilted}");
}

#[test]
fn a_hole_is_refused_or_left_out_as_the_scenario_says() {
    let refused = areas("hole.dxf", &ReadOptions::default()).unwrap_err();
    assert!(matches!(refused.fault, OutlineFault::Hole { .. }), "{refused}");
    let ignore = ReadOptions { holes: Holes::Ignore, ..ReadOptions::default() };
    assert_eq!(areas("hole.dxf", &ignore).unwrap(), [20000.0]);
}
