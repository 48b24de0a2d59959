//! Whether the body follows its commands, as policies can sense it.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use vibrissa::geometry::{Point2, Pose, Vector2, polygon, unit};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::machine::{BodyScalar, ContactEstimatorKind, Senses};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

const START: Pose = Pose { position: Point2::new(0.0, 0.0), heading: FRAC_PI_2 };

/// A plate 5 cm thick, its face towards the start at this height (m).
fn plate(height: f64) -> Solid {
    let corners = [(-1.0, height), (1.0, height), (1.0, height + 0.05), (-1.0, height + 0.05)];
    Solid::inside(polygon(&corners.map(|(x, y)| Point2::new(x, y))).unwrap()).unwrap()
}

/// The rig before these solids in every world that there is.
fn worlds(rig: &Rig, solids: &[Solid], start: Pose) -> Vec<Box<dyn World>> {
    #[cfg_attr(not(feature = "sim"), expect(unused_mut, reason = "there is one world only"))]
    let mut worlds: Vec<Box<dyn World>> =
        vec![Box::new(QuasiStaticWorld::new(rig, &Physics::default(), solids, start, 0).unwrap())];
    #[cfg(feature = "sim")]
    worlds.push(Box::new(vibrissa::mujoco::MujocoWorld::new(rig, &Physics::default(), solids, start, 0).unwrap()));
    worlds
}

/// A rig in a world, and what it perceives.
struct Loop {
    world: Box<dyn World>,
    perception: Perception,
    period: f64,
    /// What becomes of the samples of a tick before they are perceived.
    spoil: fn(usize, &mut Vec<Sample>),
    ticks: usize,
}

/// What a tick gave.
#[derive(Clone, Copy)]
struct Felt {
    blocked: bool,
    shortfall: f64,
    touches: bool,
}

impl Loop {
    fn new(rig: &Rig, world: Box<dyn World>) -> Self {
        let whiskers: Vec<_> = (0..rig.whiskers.len()).map(Some).collect();
        let kinds = vec![ContactEstimatorKind::OneChannel; whiskers.len()];
        Self {
            world,
            perception: Perception::new(rig, &whiskers, &kinds).unwrap(),
            period: 1.0 / rig.sensing.control_rate,
            spoil: |_, _| {},
            ticks: 0,
        }
    }

    fn tick(&mut self, command: Command) -> Felt {
        self.perception.command(command);
        let mut samples = self.world.advance(&command).unwrap().to_vec();
        (self.spoil)(self.ticks, &mut samples);
        self.ticks += 1;
        self.perception.update(&samples);
        Felt {
            blocked: self.perception.body(BodyScalar::Blocked) > 0.0,
            shortfall: self.perception.body(BodyScalar::Shortfall),
            touches: self.world.body_touches(),
        }
    }

    /// Ticks for so long (s).
    fn drive(&mut self, command: Command, time: f64) -> Vec<Felt> {
        let ticks = (time / self.period).round();
        let mut felt = Vec::new();
        while (felt.len() as f64) < ticks {
            felt.push(self.tick(command));
        }
        felt
    }
}

fn go(velocity_world: Vector2, yaw_rate: f64) -> Command {
    Command { velocity_world, yaw_rate }
}

/// Commands within the limits of the reference platform, each for some time (s).
fn commands() -> impl Strategy<Value = Vec<(Command, f64)>> {
    let command = (0.0..1.0_f64, -PI..PI, -PI..PI).prop_map(|(speed, way, rate)| go(speed * unit(way), rate));
    prop::collection::vec((command, 0.03..1.0_f64), 1..12)
}

/// In every tick but each seventh the pose is lost.
fn lose_poses(tick: usize, samples: &mut Vec<Sample>) {
    if !tick.is_multiple_of(7) {
        for sample in samples {
            sample.body = Pose::UNKNOWN;
        }
    }
}

/// The heading comes within one turn, as many platforms give it.
fn wrap_headings(_: usize, samples: &mut Vec<Sample>) {
    for sample in samples {
        sample.body.heading = sample.body.heading.sin().atan2(sample.body.heading.cos());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_body_in_free_air_is_never_blocked(
        commands in commands(), servo in prop::sample::select(vec![5e-3, 0.05, 0.3]),
        yaw_servo in prop::option::of(prop::sample::select(vec![5e-3, 0.3])),
        control_rate in prop::sample::select(vec![10.0, 30.0, 100.0]),
        spoil in prop::sample::select(vec![(|_, _| {}) as fn(usize, &mut Vec<Sample>), lose_poses, wrap_headings]),
    ) {
        let mut rig = Rig::default();
        (rig.platform.servo, rig.platform.yaw_servo) = (servo, yaw_servo);
        rig.sensing.control_rate = control_rate;
        for world in worlds(&rig, &[], START) {
            let mut run = Loop { spoil, ..Loop::new(&rig, world) };
            for &(command, time) in &commands {
                for felt in run.drive(command, time) {
                    prop_assert!(!felt.blocked && !felt.touches, "lacks {} m/s under {command:?}", felt.shortfall);
                }
            }
        }
    }

    #[test]
    fn whiskers_that_are_pressed_do_not_block_a_body(
        gap in 2e-3..35e-3_f64, side in prop::sample::select(vec![-1.0, 1.0]), speed in 1e-3..0.1_f64, stiff in 0.5..3.0_f64,
    ) {
        // Along a plate at the side, which bends the whisker of that side by up to a milliradian.
        let mut rig = Rig::default();
        for whisker in &mut rig.whiskers {
            whisker.shaft.young_modulus *= stiff;
        }
        let start = Pose { position: Point2::origin(), heading: if side > 0.0 { 0.0 } else { PI } };
        for world in worlds(&rig, &[plate(0.13)], start) {
            let mut run = Loop::new(&rig, world);
            let (near, along) = (go(Vector2::new(0.0, gap / 1.0), 0.0), go(speed * unit(start.heading), 0.0));
            let motions = [(near, 1.0), (along, 1.0), (Command::STOP, 1.0), (go(Vector2::zeros(), 0.1), 0.5)];
            for (command, time) in motions {
                for felt in run.drive(command, time) {
                    prop_assert!(!felt.blocked || felt.touches, "lacks {} m/s under {command:?}", felt.shortfall);
                }
            }
        }
    }

    #[test]
    fn a_body_that_meets_a_wall_is_blocked_soon_and_free_soon_after_it_turns_back(
        speed in 0.01..0.15_f64, slant in -0.5..0.5_f64, way in -0.7..0.7_f64,
    ) {
        let rig = Rig { whiskers: Vec::new(), ..Rig::default() };
        let start = Pose { heading: FRAC_PI_2 + slant, ..START };
        for world in worlds(&rig, &[plate(0.13)], start) {
            let mut run = Loop::new(&rig, world);
            let ahead = go(speed * unit(FRAC_PI_2 + way), 0.0);
            while !run.tick(ahead).touches {}
            // A nose that slides off sideways still lacks what leads into the wall, at most 45 deg off.
            prop_assert!(run.drive(ahead, 0.4).iter().any(|felt| felt.blocked));
            prop_assert!(run.drive(ahead, 0.5).iter().all(|felt| felt.blocked), "and stays so");
            run.drive(go(-ahead.velocity_world, 0.0), 0.4);
            for felt in run.drive(go(-ahead.velocity_world, 0.0), 1.0) {
                prop_assert!(!felt.blocked, "lacks {} m/s", felt.shortfall);
            }
        }
    }

    #[test]
    fn a_body_whose_tail_meets_a_wall_as_it_turns_is_blocked(rate in 0.3..1.0_f64) {
        // Between two walls, 6 mm from either.
        let rig = Rig { whiskers: Vec::new(), ..Rig::default() };
        let start = Pose { heading: 0.0, ..START };
        for world in worlds(&rig, &[plate(0.066), plate(-0.116)], start) {
            let mut run = Loop::new(&rig, world);
            prop_assert!(run.drive(go(Vector2::zeros(), rate), 2.0).iter().any(|felt| felt.blocked));
        }
    }
}

#[test]
fn a_body_that_stands_against_a_wall_without_a_command_is_not_blocked() {
    let rig = Rig { whiskers: Vec::new(), ..Rig::default() };
    for world in worlds(&rig, &[plate(0.13)], START) {
        let mut run = Loop::new(&rig, world);
        let last = run.drive(go(Vector2::new(0.0, 0.05), 0.0), 2.0).pop().unwrap();
        assert!(last.blocked && (last.shortfall - 0.05).abs() < 1e-3, "{}", last.shortfall);
        assert!(!run.drive(Command::STOP, 1.0).pop().unwrap().blocked);
    }
}
