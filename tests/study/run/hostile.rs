//! Shipped policies in hostile scenes: whatever they feel, their commands are numbers.

use std::ops::ControlFlow;
use std::sync::Arc;

use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, Pose};
use vibrissa::policy::{compile, gather};
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::run::{Progress, Run, Trace, drive};
use vibrissa::scenario;
use vibrissa::scene::{Goal, Scene, Stop};
use vibrissa::world::{Fault, World};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Cause, Program};
use vibrissa_runtime::signal::{Command, Sample};

/// Every shipped policy.
const POLICIES: [&str; 9] =
    ["array", "bang", "baseline", "quick", "reverse", "several", "thesis", "tilted", "vibrissa"];

fn text(path: &str) -> Result<String, String> {
    std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).map_err(|cause| cause.to_string())
}

fn program(policy: &str) -> Program {
    let path = format!("policies/{policy}.fsm");
    let source = Source::new(&path, text(&path).unwrap());
    compile(&gather(&source, &mut |path| text(path))).unwrap()
}

/// A run of at most so long (s) in `world`; none if the rig cannot be perceived.
fn run(scene: &Scene, program: Program, world: &mut dyn World, time: f64) -> Option<Run> {
    let stop = Stop { stalled: scene.stop.stalled, ..Stop::at(time) };
    let control = Control::new(&scene.rig, Arc::new(program)).ok()?;
    let period = 1.0 / scene.rig.sensing.control_rate;
    drive(
        world,
        control,
        Goal { stop: &stop, tunnels: &[] },
        period,
        &mut Progress(|_: &Trace| ControlFlow::Continue(())),
    )
}

/// The state that gave a command that is not finite, if one did.
fn not_finite(run: &Run) -> Option<String> {
    let mut fallbacks = run.trace.fallbacks();
    let left = fallbacks.find(|(_, fallback)| matches!(fallback.cause, Cause::NotFinite(_)));
    let left = left.map(|(tick, fallback)| format!("{} at {} s", run.trace.states[fallback.left], tick.time));
    left.or_else(|| run.reason.clone().filter(|reason| reason.contains("not a finite number")))
}

/// A world whose samples are spoilt now and then; of every tick, at least one is whole.
struct Spoilt<'w> {
    world: &'w mut dyn World,
    samples: Vec<Sample>,
    /// Of so many samples, one is good.
    good: usize,
    count: usize,
}

impl World for Spoilt<'_> {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        assert!(command.is_finite());
        self.samples.clear();
        self.samples.extend_from_slice(self.world.advance(command)?);
        for sample in &mut self.samples {
            self.count += 1;
            if !self.count.is_multiple_of(self.good) {
                match self.count % 3 {
                    0 => sample.body = Pose::UNKNOWN,
                    1 => sample.whiskers.iter_mut().for_each(|reading| reading.base_angle = f64::NAN),
                    _ => sample.whiskers[0].base_angle = f64::INFINITY,
                }
            }
        }
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.world.body_touches()
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.world.snapped_off(whisker)
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }
}

/// What is before the rig. Some of it stands in its way, or begins where the whiskers touch it at once.
fn objects() -> impl Strategy<Value = String> {
    let size = || 1.0..400.0_f64;
    prop_oneof![
        (-0.3..0.3_f64, 0.2..0.7_f64, 0.005..0.3_f64)
            .prop_map(|(x, y, r)| format!("circle: {{centre: [{x} m, {y} m], radius: {r} m}}")),
        (-0.3..0.4_f64, 0.25..0.7_f64, size(), size(), 0..180_u32).prop_map(|(x, y, w, h, turn)| format!(
            "rounded_rectangle: {{centre: [{x} m, {y} m], width: {w} mm, height: {h} mm, corner_radius: 0 mm, heading: {turn} deg}}"
        )),
        // A hook that opens towards the start, as wide as the body or so.
        (0.02..0.2_f64, 0.05..0.3_f64, 0.002..0.03_f64, -0.1..0.1_f64).prop_map(|(width, depth, wall, aside)| {
            let (left, right) = (aside - width / 2.0, aside + width / 2.0);
            let corners = [
                (left - wall, 0.25), (left, 0.25), (left, 0.25 + depth), (right, 0.25 + depth), (right, 0.3),
                (right + wall, 0.3), (right + wall, 0.25 + depth + wall), (left - wall, 0.25 + depth + wall),
            ];
            // Clockwise as listed.
            let corners: Vec<_> = corners.iter().rev().map(|(x, y)| format!("[{x} m, {y} m]")).collect();
            format!("polygon: {{vertices: [{}]}}", corners.join(", "))
        }),
    ]
}

/// What is unusual of the rig.
fn rigs() -> impl Strategy<Value = String> {
    let usual = "whiskers: {r0: {}, l0: {}}".to_owned();
    let length = || prop::sample::select(vec![10.0, 40.0, 100.0, 300.0]);
    let radius = || prop::sample::select(vec![0.02, 0.125, 0.5]);
    prop_oneof![
        Just(usual),
        Just("preset: peer_cable".to_owned()),
        (length(), radius(), length(), radius()).prop_map(|(l, r, m, s)| format!(
            "whiskers: {{r0: {{length: {l} mm, radius: {r} mm}}, l0: {{length: {m} mm, radius: {s} mm}}}}"
        )),
        (-170..170_i32, 20..170_u32).prop_map(|(right, left)| format!(
            "whiskers: {{r0: {{direction: {right} deg}}, l0: {{direction: {left} deg}}}}"
        )),
        Just(
            "whiskers: {r0: {}, l0: {}, feeler_r: {base: [100 mm, -14 mm], direction: -30 deg, length: 75 mm}}"
                .to_owned()
        ),
        Just("platform: {servo: 1 s, speed_limit: 20 mm/s}".to_owned()),
        Just("sensing: {angle_noise: 30 urad, contact_threshold: 1 urad}".to_owned()),
    ]
}

/// The policies that a rig has the whiskers for; `array.fsm` has six.
fn policies() -> impl Strategy<Value = (&'static str, String)> {
    let six = "whiskers: {r0: {}, l0: {}, r1: {base: [33 mm, -35 mm], direction: -105 deg}, l1: {base: [33 mm, 35 mm], direction: 105 deg}, \
        r2: {base: [13 mm, -40 mm], direction: -105 deg}, l2: {base: [13 mm, 40 mm], direction: 105 deg}}";
    prop_oneof![
        1 => Just(("array", six.to_owned())),
        7 => (prop::sample::select(POLICIES[1..].to_vec()), rigs()),
    ]
}

fn scenario(objects: &[String], rig: &str) -> String {
    let objects: Vec<_> = objects.iter().map(|object| format!("  - {object}\n")).collect();
    format!(
        "name: hostile\nrig:\n  {rig}\nobjects:\n{}start: {{position: [0 mm, 72 mm], heading: 90 deg}}\nstop: {{time: 60 s}}\n",
        objects.concat()
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, max_global_rejects: 4000, ..ProptestConfig::default() })]

    #[test]
    fn no_shipped_policy_gives_a_command_that_is_not_a_number(
        objects in prop::collection::vec(objects(), 1..3), (policy, rig) in policies(),
        ends in prop::collection::vec(prop::option::weighted(0.3, 0.0..=1.0_f64), 64), good in 1_usize..8,
    ) {
        // Objects that overlap, and starts within one, are another matter.
        let scene = scenario::read(&Source::new("hostile.yaml", scenario(&objects, &rig)));
        prop_assume!(scene.is_ok());
        let scene = scene.unwrap();
        let mut program = program(policy);
        for (index, (parameter, end)) in program.parameters.iter().zip(&ends).enumerate() {
            if let (Some((low, high)), Some(end)) = (parameter.range, end) {
                program.initial_registers[index] = low + end.round() * (high - low);
            }
        }
        let world = QuasiStaticWorld::new(&scene.rig, &scene.physics, &scene.solids, scene.start, 1);
        prop_assume!(world.is_ok());
        let mut world = world.unwrap();
        let mut world = Spoilt { world: &mut world, samples: Vec::new(), good, count: 0 };
        let run = run(&scene, program, &mut world, 60.0);
        prop_assume!(run.is_some());
        prop_assert_eq!(not_finite(&run.unwrap()), None, "{} in\n{}", policy, scenario(&objects, &rig));
    }
}

/// The peer's cables on the box: `thesis.fsm` whisks back there and feels nothing on the way.
#[cfg(feature = "sim")]
#[test]
fn no_shipped_policy_does_so_with_the_peers_cables() {
    let path = "scenarios/box.yaml";
    let mut scene = scenario::read(&Source::new(path, text(path).unwrap())).unwrap();
    vibrissa::physics::Preset::PeerCable.apply(&mut scene.rig, &mut scene.physics);
    for policy in ["thesis", "vibrissa"] {
        let mut world =
            vibrissa::mujoco::MujocoWorld::pruned(&scene.rig, &scene.physics, &scene.solids, scene.start, 0).unwrap();
        let run = run(&scene, program(policy), &mut world, 60.0).unwrap();
        assert_eq!(not_finite(&run), None, "{policy}");
    }
}
