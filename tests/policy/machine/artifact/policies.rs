//! Policies to make artifacts of.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use vibrissa_language::{compile_with_warnings, gather};
use vibrissa_runtime::machine::Artifact;
use vibrissa_text::diagnostic::{Colour, Source, terminal};

use crate::page::PAGES;

/// A policy that reads, computes and does a bit of everything.
pub(crate) const EVERYTHING: &str = r#"
machine everything
whisker a, b
needs control_rate in 20 .. 30 Hz
needs sample_rate in 200 .. 300 Hz
needs sample_age in 0 .. 10 ms
param fast = 50 mm/s in 1 .. 200 mm/s
param free = 2
let bend(w: whisker) = abs(w.base_angle) + turn(w.yaw, body.yaw) * sign(w.side) * w.sense
law touch(w: whisker, s: speed) {
  let v = w.contour.point(1 mm) + w.tip_deviation * (w.contour.normal + w.contour.tangent(exp(0) * 1 mm)) + w.tip_at(bend(w)) + w.tip_base - w.tip + rotate(w.base - body.position, 1 rad)
  if w.touching and not w.contour.ready or |v| < w.length { record w }
  else if w.contour.curvature == 0 rad/m { hold }
  else { steer w along v at s facing angle(w.contour.end - body.position) }
}
monitor felt(w: whisker) { var most = 0 rad  if w.touching { set most = max(most, w.base_angle) } }
monitor right is felt(a)
var farthest = 0 m
if a.touching { set farthest = max(farthest, |a.tip - a.base| + right.most * 1 m / 1 rad)  mark found a }
initial Start
state Start {
  var closest = 1 m
  var last = a
  entry { set closest = min(closest, |a.tip - body.position|)  record last }
  if b.touching { set last = b }
  set closest = lowpass(closest, 5 Hz) + pid(closest - 10 mm, 2, 1 Hz, 0.1 s, 50 mm)
  stop
  exit { record last  mark lost last }
  failsafe -> Touch(b, fast, vector(1, 0))
  when a.touching -> Touch(a, fast, vector(1, 2))  when b.touching for 100 ms -> Touch(b, -fast, vector(0, 1)) }
state Touch(w: whisker, s: speed, v: vector) {
  do touch(w, s)
  if w == b { steer w along unit(v) at s turning 1 rad/s * clamp(sqrt(free), 0, min(sin(body.yaw), cos(body.yaw))) }
  if free > 3 { steer body along w.contour.tangent at s turning dot(v, v) * 1 rad/s }
  when not w.touching for 50 ms -> Touch(a, 2 * s, rotate(v, 90 deg))
  after 1 s -> Start
}
failsafe -> Start
always when time > 2 s for 1 s -> Failure("too long")
always when cross(body.position - body.nose, vector(1, 0)) > 1e6 m + farthest -> Failure("too far")
"#;

/// A text's artifact.
pub(crate) fn artifact(name: &str, text: &str) -> Artifact {
    let file = &mut |path: &str| fs::read_to_string(path).map_err(|error| error.to_string());
    let source = gather(&Source::new(name, text), file);
    let compiled = compile_with_warnings(&source);
    compiled.unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain))).artifact
}

/// The artifact of [`EVERYTHING`].
pub(crate) fn everything() -> Artifact {
    artifact("everything.fsm", EVERYTHING)
}

/// The artifact of `thesis.fsm`.
pub(crate) fn thesis() -> Artifact {
    static THESIS: LazyLock<Artifact> =
        LazyLock::new(|| artifact("policies/thesis.fsm", include_str!("../../../../policies/thesis.fsm")));
    THESIS.clone()
}

/// The artifact of a policy that only swipes: small enough to be broken at every place.
pub(crate) fn swiping() -> Artifact {
    artifact("thesis.fsm", include_str!("../../../fixtures/editor/thesis.fsm"))
}

/// The artifact of three levels of states.
pub(crate) fn nested() -> Artifact {
    artifact("nested.fsm", include_str!("../../../fixtures/charts/nested.fsm"))
}

/// The artifacts of all policies of this project, of the examples of its language's pages, of [`nested`], and of [`EVERYTHING`].
pub(crate) fn all() -> Vec<Artifact> {
    let directory = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("policies");
    let files = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "fsm"));
    let files = files.map(|path| artifact(&path.display().to_string(), &fs::read_to_string(&path).unwrap()));
    let examples = PAGES.split("```fsm\n").skip(1).map(|behind| {
        let example = behind.split("```").next().unwrap();
        if example.starts_with("machine") {
            return artifact("language.md", example);
        }
        artifact(
            "language.md",
            &format!("machine example whisker bound {example} initial Still state Still {{ stop }}"),
        )
    });
    let all: Vec<Artifact> = files.chain(examples).chain([everything(), nested()]).collect();
    assert!(all.len() >= 4);
    all
}
