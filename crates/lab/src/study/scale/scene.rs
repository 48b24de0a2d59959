//! Scenarios of the axes, as texts.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use vibrissa_runtime::math;

/// The disk of the bench: its radius and both coordinates of its centre (m).
const RADIUS: f64 = 0.3;
const CENTRE: f64 = 0.4;
/// The end of a run round the disk.
const ROUND: &str = "{time: 120 s, loop_closed: {within: 5 mm, after: 5 s}}";
/// The name of the outline's file in [`with_outline`].
const OUTLINE: &str = "outline.csv";

/// A scenario with a rig, objects beside the platform, and a stop condition.
fn scenario(rig: &str, objects: &str, stop: &str) -> String {
    format!(
        "name: scale\nrig: {{{rig}}}\nobjects:\n{objects}start: {{position: [0 m, 72 mm], heading: 90 deg}}\nstop: {stop}\n"
    )
}

fn disk() -> String {
    format!("  - circle: {{centre: [{CENTRE} m, {CENTRE} m], radius: {RADIUS} m}}\n")
}

/// A disk beside the reference rig, for a time (s).
pub(super) fn lasting(seconds: usize) -> String {
    scenario("", &disk(), &format!("{{time: {seconds} s}}"))
}

/// A run round the disk.
pub(super) fn round() -> String {
    scenario("", &disk(), ROUND)
}

/// A run round the disk, with small disks that no whisker reaches.
pub(super) fn among(count: usize) -> String {
    /// Number of the disks in a row, and their distance (m) from each other and from the origin.
    const ROW: usize = 25;
    const GAP: f64 = 0.4;
    const FAR: f64 = 2.0;
    let far = (0..count).fold(disk(), |mut text, index| {
        let [x, y] = [index % ROW, index / ROW].map(|place| FAR + GAP * place as f64);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  - circle: {{centre: [{x:.1} m, {y:.1} m], radius: 30 mm}}");
        text
    });
    scenario("", &far, ROUND)
}

/// A run round a regular polygon, with the file of its corners.
pub(super) fn with_outline(pieces: usize) -> (String, String) {
    let corners = (0..pieces).fold(String::new(), |mut text, index| {
        let (sin, cos) = math::sin_cos(TAU * index as f64 / pieces as f64);
        let _ = writeln!(text, "{},{}", CENTRE + RADIUS * cos, CENTRE + RADIUS * sin);
        text
    });
    (scenario("", &format!("  - outline: {{file: {OUTLINE}, unit: 1 m}}\n"), ROUND), corners)
}

/// A disk beside whiskers of this number on both sides together, for a time (s).
pub(super) fn with_whiskers(count: usize, seconds: usize) -> String {
    /// Distance of neighbouring bases, of the first ones from the centre of mass, and of all from the axis (mm).
    const GAP: usize = 15;
    const FIRST: usize = 53;
    const BESIDE: i32 = 42;
    let whiskers = whiskers(count).into_iter().enumerate().map(|(index, name)| {
        let side = if name.starts_with('r') { -1 } else { 1 };
        let ahead = FIRST.saturating_sub(GAP * (index / 2));
        format!("{name}: {{base: [{ahead} mm, {} mm], direction: {} deg, length: 100 mm}}", side * BESIDE, side * 105)
    });
    let rig = format!("whiskers: {{{}}}", whiskers.collect::<Vec<_>>().join(", "));
    scenario(&rig, &disk(), &format!("{{time: {seconds} s}}"))
}

/// The names of this number of whiskers, from the front to the back.
pub(super) fn whiskers(count: usize) -> Vec<String> {
    (0..count).map(|index| format!("{}{}", if index % 2 == 0 { 'r' } else { 'l' }, index / 2)).collect()
}

/// A disk beside the reference rig whose whiskers have this number of links, for a time (s).
pub(super) fn with_links(links: usize, seconds: usize) -> String {
    let rig = format!("whiskers: {{r0: {{links: {links}}}, l0: {{links: {links}}}}}");
    scenario(&rig, &disk(), &format!("{{time: {seconds} s}}"))
}
