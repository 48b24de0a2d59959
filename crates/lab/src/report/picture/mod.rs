//! One run as one picture.

mod curve;
mod error_class;
mod front;
mod growth;
mod histogram;
mod legend;
mod map;
mod pareto;
mod plotted;
mod profile;
mod scale;
mod shaft;
mod state_band;
mod strip;
mod timeline;
mod touched;

pub(super) use curve::{Axis, Curve, curve_picture};
pub(super) use error_class::colour_of;
pub use growth::growth_picture;
pub(super) use histogram::histogram;
pub use pareto::pareto_picture;
pub(super) use plotted::PlottedRun;
pub use profile::profile_picture;
pub(super) use state_band::state_band;
pub use strip::retrieval_picture;

use std::iter;
use std::ops::Range;

use svg::node::element::{TSpan, Text};

use self::legend::{Legend, ObjectEntries};
use self::map::Map;
use self::timeline::Timeline;
use super::shade::{define, shades};
use super::style::{self, Anchor, text};
use crate::results::{Ending, unmet};
use crate::run::{Run, Trace};
use crate::score::{COVERAGE_RESOLUTION, Estimate, Score, tips, traced};
use vibrissa_world::geometry::Contour;
use vibrissa_world::scene::Scene;

/// Width and height of a frame (px).
const FRAME: (f64, f64) = (800.0, 600.0);
/// Margin of a frame (px). It has no space for the numbers of the axes, which are too small for a video.
const FRAME_MARGIN: f64 = 10.0;
/// Width of the picture (px).
const WIDTH: f64 = 1200.0;
/// Width of the map (px).
const MAP_WIDTH: f64 = 800.0;
/// Least and greatest height of the map (px). The legend needs the least height.
const MAP_HEIGHT: (f64, f64) = (560.0, 820.0);
/// Additional height of the legend if there are marks (px).
const MARKS_HEIGHT: f64 = 110.0;
/// Additional height of the legend if there is a tunnel (px).
const TUNNEL_HEIGHT: f64 = 66.0;
/// Additional height of the legend if there is a map by touch (px).
const TOUCHED_HEIGHT: f64 = 127.0;
/// Left side of the map and the strips, and right side of the picture's content (px).
const SIDES: (f64, f64) = (66.0, 1170.0);
/// Left side of the legend (px).
const LEGEND: f64 = 898.0;
/// Characters in a line of the subtitle.
const LINE: usize = 130;

/// A picture of `run`, the run of `scene` under the policy named `policy`, with its `score`: a self-contained SVG.
///
/// The upper part shows the scene from above: the exact outlines, the tip estimates, the path of the platform and some
/// of its poses. Whiskers are bent according to their base angles and tips. The colour of an estimate is the class of
/// its error. The classes are equal in all pictures. The free and the blocked ground of a map by touch are areas. In a tunnel, its axis is dashed, and the estimated midpoints are dots. The lower part shows state, error and base angles over time. The
/// appearance of a state depends only on the machine.
///
/// The same run gives the same picture, byte for byte. Nothing in it depends on the clock.
#[must_use]
pub fn picture(scene: &Scene, policy: &str, run: &Run, score: &Score) -> String {
    plotted(scene, policy, run, score).svg
}

/// A frame of a video of a run of `scene`, after the last tick of `trace`: the map of a [`picture`], as a self-contained SVG of
/// 800 x 600 px. Of the platform, only the first pose, the last one and the path are drawn.
#[must_use]
pub fn frame(scene: &Scene, trace: &Trace) -> String {
    let (width, height) = (FRAME.0 - 2.0 * FRAME_MARGIN, FRAME.1 - 2.0 * FRAME_MARGIN);
    let corner = (FRAME_MARGIN, FRAME_MARGIN);
    let map = Map::new(scene, trace, corner, width, (height, height)).without_poses_between();
    let tips = tips(trace, &scene.truth.surfaces, &scene.rig);
    style::sheet(FRAME, &scene.name).add(map.draw(scene, trace, None, &untraced(scene, trace), &tips)).to_string()
}

/// The [`picture`] of a run, with the positions of its tip estimates and of its times.
pub(super) fn plotted(scene: &Scene, policy: &str, run: &Run, score: &Score) -> PlottedRun {
    let trace = &run.trace;
    let tips = tips(trace, &scene.truth.surfaces, &scene.rig);
    let untraced = untraced(scene, trace);
    let violations = unmet(&scene.expect, run, score);
    let ending = Ending::new(run.outcome, &violations);
    let missing =
        if ending == Ending::Ended { violations.iter().map(ToString::to_string).collect() } else { Vec::new() };
    let (head, map_top) = heading(scene, policy, ending, missing.iter().chain(&run.reason));
    let marks = if trace.marks.is_empty() { 0.0 } else { MARKS_HEIGHT };
    let tunnel = if scene.truth.axes.is_empty() { 0.0 } else { TUNNEL_HEIGHT };
    let touched = if run.map.is_some() { TOUCHED_HEIGHT } else { 0.0 };
    let least = MAP_HEIGHT.0 + marks + tunnel + touched;
    let map = Map::new(scene, trace, (SIDES.0, map_top), MAP_WIDTH, (least, MAP_HEIGHT.1.max(least)));
    let object = ObjectEntries {
        untraced: !untraced.is_empty(),
        axis: !scene.truth.axes.is_empty(),
        touched: run.map.is_some(),
    };
    let legend = Legend::draw((LEGEND, map_top), SIDES.1 - LEGEND, map.scale, trace, score, object);
    let strips_top = map_top + map.height + 62.0;
    let (strips, bottom) = Timeline::draw(trace, &tips, score.error.as_ref(), SIDES, strips_top);
    let height = bottom + 20.0;
    let mut document = style::sheet((WIDTH, height), &format!("{}, policy {policy}: {ending}", scene.name));
    let shades = shades(&trace.parents);
    let shown = trace.ticks.iter().filter_map(|tick| shades.get(tick.state?).copied());
    document = define(document, shown);
    for line in head {
        document = document.add(line);
    }
    let svg =
        document.add(map.draw(scene, trace, run.map.as_deref(), &untraced, &tips)).add(legend).add(strips).to_string();
    PlottedRun::new(svg, trace, &tips, &map, SIDES, (strips_top, bottom))
}

/// The sections of a reference contour (arc lengths in m) that a run did not trace.
struct Untraced<'s> {
    contour: &'s Contour,
    stretches: Vec<Range<f64>>,
}

fn untraced<'s>(scene: &'s Scene, trace: &Trace) -> Vec<Untraced<'s>> {
    let estimate = Estimate::new(trace);
    let of_contour = |contour: &'s Contour| {
        let traced = traced(&estimate, contour);
        let starts = iter::once(0.0).chain(traced.iter().map(|stretch| stretch.end));
        let ends = traced.iter().map(|stretch| stretch.start).chain(iter::once(contour.length()));
        let gaps = starts.zip(ends).map(|(start, end)| start..end);
        Untraced { contour, stretches: gaps.filter(|gap| gap.end - gap.start > COVERAGE_RESOLUTION).collect() }
    };
    scene.truth.reference.contours().map(of_contour).filter(|untraced| !untraced.stretches.is_empty()).collect()
}

/// The title with the outcome of the run and its `reasons`, and the upper side of the map.
fn heading<'r>(
    scene: &Scene,
    policy: &str,
    ending: Ending,
    reasons: impl Iterator<Item = &'r String>,
) -> (Vec<Text>, f64) {
    let left = SIDES.0;
    let colour = if ending == Ending::Completed { style::INK } else { style::ALARM };
    let outcome = TSpan::new(ending.name()).set("fill", colour).set("font-weight", 600);
    let policy = format!("policy {policy} · ");
    let mut lines = vec![
        text(left, 40.0, Anchor::Start, 22.0, style::INK, &scene.name).set("font-weight", 600),
        text(left, 64.0, Anchor::Start, 14.0, style::GREY, &policy).add(outcome),
    ];
    let mut y = 64.0;
    for line in reasons.flat_map(|reason| wrapped(reason)) {
        y += 20.0;
        lines.push(text(left, y, Anchor::Start, 14.0, colour, &line));
    }
    (lines, y + 40.0)
}

/// A text in lines of at most [`LINE`] characters, broken at spaces if possible.
fn wrapped(content: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in content.split_whitespace() {
        for part in word.chars().collect::<Vec<_>>().chunks(LINE) {
            let part: String = part.iter().collect();
            match lines.last_mut() {
                Some(line) if line.is_empty() => *line = part,
                Some(line) if line.chars().count() + 1 + part.chars().count() <= LINE => {
                    line.push(' ');
                    line.push_str(&part);
                }
                _ => lines.push(part),
            }
        }
    }
    lines
}
