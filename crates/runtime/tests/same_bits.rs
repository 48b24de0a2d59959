//! Commands, contacts and maps have the same bits on every target.
//!
//! Each case is reduced to one number. The numbers are compared with constants, and `cargo x test` runs this program for
//! x86-64 and for aarch64. A change of policies, perception or steering changes the numbers. The message of the failing
//! test has the new ones, and both targets must agree on them.

use std::sync::Arc;

use nalgebra::Point2;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::machine::{Artifact, ContactEstimatorKind};
use vibrissa_runtime::map::{MapSettings, RouteStatus};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample, TrueTip};

/// The compiled policies, and the numbers of their commands.
const POLICIES: [(&str, &[u8], &str); 3] = [
    ("bang", include_bytes!("../fixtures/bang.machine"), "23daaacac727e554"),
    ("thesis", include_bytes!("../fixtures/thesis.machine"), "75f0c6f89469f1ec"),
    ("vibrissa", include_bytes!("../fixtures/vibrissa.machine"), "ba1c78dbe3825898"),
];
/// The contact estimators, and the numbers of their contacts.
const ESTIMATORS: [(ContactEstimatorKind, &str); 6] = [
    (ContactEstimatorKind::OneChannel, "e5540758677f8575"),
    (ContactEstimatorKind::Sliding, "cf75cfb7c4b4aeda"),
    (ContactEstimatorKind::MomentAndShear, "001323918587fe98"),
    (ContactEstimatorKind::Recursive, "8bdf499a05af2b38"),
    (ContactEstimatorKind::Polynomial, "b077e9de38fe5c44"),
    (ContactEstimatorKind::Truth, "34974a36044bba92"),
];
/// The number of a map, its targets and its routes while `bang` traces.
const MAP: &str = "938238f5361f2bb5";

/// Number of ticks: 40 s.
const TICKS: u32 = 1200;
/// Number of samples in a tick.
const SAMPLES: u32 = 10;

/// A linear congruential generator (Knuth, The Art of Computer Programming 2, 3.3.4).
struct Noise(u64);

impl Noise {
    /// A number from −0.5 to 0.5.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.0 >> 32) as u32) / f64::from(u32::MAX) - 0.5
    }
}

/// The bits of a sequence of numbers as one number (FNV-1a).
struct Bits(u64);

impl Bits {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn shown(&self) -> String {
        format!("{:016x}", self.0)
    }

    fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// A platform that follows commands exactly, beside a disk that bends the whiskers in proportion to their overlap.
struct Robot {
    rig: Rig,
    pose: Pose,
    time: f64,
    noise: Noise,
}

/// Centre and radius of the disk (m).
const CENTRE: Point2<f64> = Point2::new(0.4, -0.05);
const RADIUS: f64 = 0.15;
/// Base angle per overlap (rad/m).
const BEND: f64 = 0.03;
/// Noise of a base angle (rad).
const NOISE: f64 = 1e-6;

impl Robot {
    fn new(rig: &Rig) -> Self {
        Self { rig: rig.clone(), pose: Pose::default(), time: 0.0, noise: Noise(1) }
    }

    /// The samples of one control period under a command. A few readings and samples are missing.
    fn advance(&mut self, command: Command) -> Vec<Sample> {
        let period = self.rig.sensing.sample_rate.recip();
        let mut samples = Vec::new();
        for _ in 0..SAMPLES {
            self.time += period;
            self.pose.position += command.velocity_world * period;
            self.pose.heading += command.yaw_rate * period;
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            for (reading, whisker) in whiskers.iter_mut().zip(&self.rig.whiskers) {
                let along = vibrissa_runtime::geometry::unit(whisker.direction_body) * whisker.shaft.length;
                let tip = self.pose.point_to_world(whisker.base_body + along);
                let overlap = RADIUS - (tip - CENTRE).norm();
                let bend = if overlap > 0.0 { whisker.side() * BEND * overlap } else { 0.0 };
                reading.base_angle = bend + NOISE * self.noise.next();
                let arm = whisker.shaft.length * (1.0 + 0.2 * self.noise.next());
                reading.shear = Some(whisker.hinge.stiffness * reading.base_angle / arm);
                let point_world = CENTRE + (tip - CENTRE).normalize() * RADIUS;
                reading.true_tip = Some(TrueTip { point_world, touches: overlap > 0.0 });
                if self.noise.next() > 0.498 {
                    reading.base_angle = f64::NAN;
                }
            }
            if self.noise.next() < 0.49 {
                samples.push(Sample { time: self.time, body: self.pose, whiskers });
            }
        }
        samples
    }
}

#[test]
fn commands_have_the_same_bits_on_every_target() -> Result<(), Box<dyn std::error::Error>> {
    let mut found = Vec::new();
    for (name, bytes, _) in POLICIES {
        let rig = Rig::default();
        let mut control = Control::new(&rig, Arc::new(Artifact::from_bytes(bytes)?.program))?;
        let (mut robot, mut bits, mut command) = (Robot::new(&rig), Bits::new(), Command::STOP);
        let mut states = Vec::new();
        for _ in 0..TICKS {
            command = control.tick(&robot.advance(command)).0;
            for value in [command.velocity_world.x, command.velocity_world.y, command.yaw_rate] {
                bits.add(value);
            }
            let state = control.machine().state_name().to_owned();
            if !states.contains(&state) {
                states.push(state);
            }
        }
        assert!(states.len() >= 2, "{name} only was in {states:?}, so the case says little");
        found.push((name, bits.shown()));
    }
    assert_eq!(found, POLICIES.map(|(name, _, bits)| (name, bits.to_owned())));
    Ok(())
}

#[test]
fn contacts_have_the_same_bits_on_every_target() -> Result<(), Box<dyn std::error::Error>> {
    let mut rig = Rig::default();
    rig.sensing.forces = true;
    let along = Command { velocity_world: nalgebra::Vector2::new(0.1, 0.0), yaw_rate: 0.02 };
    let mut found = Vec::new();
    for (kind, _) in ESTIMATORS {
        let mut perception = Perception::new(&rig, &[Some(0), Some(1)], &[kind; 2])?;
        let (mut robot, mut bits, mut contacts) = (Robot::new(&rig), Bits::new(), 0);
        robot.pose.position = Point2::new(0.25, 0.2);
        for _ in 0..72 {
            perception.update(&robot.advance(along));
            perception.command(along);
            for contact in [0, 1].iter().filter_map(|whisker| perception.contact(*whisker)) {
                contacts += 1;
                contact.point_world.iter().chain(&contact.covariance_world).for_each(|value| bits.add(*value));
                bits.add(contact.deviation);
                bits.add(contact.contact_length);
            }
        }
        assert!(contacts > 10, "{kind:?} had {contacts} contacts, so the case says little");
        found.push((kind, bits.shown()));
    }
    assert_eq!(found, ESTIMATORS.map(|(kind, bits)| (kind, bits.to_owned())));
    Ok(())
}

#[test]
fn maps_have_the_same_bits_on_every_target() -> Result<(), Box<dyn std::error::Error>> {
    let rig = Rig::default();
    let settings = MapSettings { extent: 1.2, ..MapSettings::for_rig(&rig) };
    let mut control =
        Control::new(&rig, Arc::new(Artifact::from_bytes(POLICIES[0].1)?.program))?.with_map(&rig, settings)?;
    let (mut robot, mut bits, mut command, mut routes) = (Robot::new(&rig), Bits::new(), Command::STOP, 0);
    for tick in 0..TICKS {
        command = control.tick(&robot.advance(command)).0;
        let map = control.map_mut().ok_or("no map")?;
        let target = map.next_target().map(|target| target.pose);
        if tick % 60 == 0 {
            map.seek_route(target);
        }
        for pose in target.into_iter().chain(map.route().iter().map(|step| step.pose)) {
            for value in [pose.position.x, pose.position.y, pose.heading] {
                bits.add(value);
            }
        }
        routes += u32::from(map.route_status() == RouteStatus::Found);
        bits.add(map.free_area());
        bits.add(map.unknown_area());
    }
    let map = control.map().ok_or("no map")?;
    for point in map.free_cells().chain(map.contours().map(|point| point.place)) {
        bits.add(point.x);
        bits.add(point.y);
    }
    let (ends, length) = (map.contour_ends().count(), map.contour_length());
    assert!(routes > 0 && ends > 0 && length > 0.0, "{routes} routes, {ends} ends, {length} m: the case says little");
    assert_eq!(bits.shown(), MAP);
    Ok(())
}
