//! Stress tests of a world.

use std::f64::consts::{FRAC_PI_2, PI};

use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{Contour, ContourError, Point2, Pose, ShapeError, Vector2, circle, polygon};
use vibrissa_world::physics::Physics;
use vibrissa_world::scene::{Scene, Stop, WorldKind};
use vibrissa_world::solid::{Solid, SolidError};

/// A stress test: a scene at the limits of a world, and a drive of the platform.
#[derive(Debug, Clone)]
pub struct StressCase {
    /// Name of the difficulty.
    pub name: String,
    /// The world.
    pub world: WorldKind,
    /// The scene.
    pub scene: Scene,
    /// The drive of the platform.
    pub drive: Drive,
}

/// The drive of the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// The default policy of the program.
    Policy,
    /// A constant forward speed (m/s) and yaw rate (rad/s), whatever the whiskers touch.
    Straight(f64, f64),
}

/// The error of a case that cannot be made, a fault of the list of cases.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// The shape is not valid.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The outline is not valid.
    #[error(transparent)]
    Contour(#[from] ContourError),
    /// The object cannot be simulated.
    #[error(transparent)]
    Solid(#[from] SolidError),
}

/// Default speed (m/s).
const SPEED: f64 = 0.05;
/// Lateral reach of the right whisker from the centre of the reference platform (m), and the overlap of an object
/// beside it with that reach.
const REACH: f64 = 0.1266;
const OVERLAP: f64 = 0.012;
/// An offset far from the origin (m).
const FAR_OFFSET: Vector2 = Vector2::new(1e4, -1e4);

/// All cases, each in both worlds.
///
/// # Errors
/// [`CaseError`] if a case cannot be made.
pub fn stress_cases() -> Result<Vec<StressCase>, CaseError> {
    let mut list = List(Vec::new());
    list.settings()?;
    list.speeds()?;
    list.positions()?;
    Ok(list.0)
}

/// A scene with the reference rig at the origin, heading along y, in front of an object. It ends after a time (s).
pub(super) fn scene(name: &str, object: Contour, time: f64) -> Result<Scene, CaseError> {
    Ok(Scene {
        name: name.to_owned(),
        description: String::new(),
        rig: Rig::default(),
        mismatch: None,
        self_calibration: None,
        physics: Physics::default(),
        solids: vec![Solid::inside(object.clone())?],
        truth: object.into(),
        start: Pose { position: Point2::origin(), heading: FRAC_PI_2 },
        stop: Stop::at(time),
        expect: Vec::new(),
        policy: None,
        world: None,
        seed: 0,
    })
}

/// A disk beside the platform that the right whisker is dragged along.
pub(super) fn disk_beside() -> Result<Contour, CaseError> {
    Ok(circle(Point2::new(REACH - OVERLAP + 0.2, 0.25), 0.2)?)
}

/// Sets the step of a scene (s). A step longer than a sample lengthens the samples.
pub(super) fn set_step(scene: &mut Scene, step: f64) {
    scene.physics.step = step;
    let sensing = &mut scene.rig.sensing;
    sensing.sample_rate = sensing.sample_rate.min(step.recip());
    sensing.filter_cutoff = sensing.filter_cutoff.min(0.4 * sensing.sample_rate);
}

/// Multiplies the stiffness of all shafts.
pub(super) fn stiffen(rig: &mut Rig, factor: f64) {
    for whisker in &mut rig.whiskers {
        whisker.shaft.young_modulus *= factor;
    }
}

pub(super) fn set_links(rig: &mut Rig, links: usize) {
    for whisker in &mut rig.whiskers {
        whisker.shaft.links = links;
    }
}

/// The list of cases in construction.
struct List(Vec<StressCase>);

impl List {
    fn add(&mut self, scene: &Scene, drive: Drive) {
        for world in WorldKind::ALL {
            self.0.push(StressCase { name: scene.name.clone(), world, scene: scene.clone(), drive });
        }
    }

    /// Adds a disk beside the path, with changed settings of the rig.
    fn settings_of(&mut self, name: String, change: impl FnOnce(&mut Scene)) -> Result<(), CaseError> {
        let mut scene = scene("", disk_beside()?, 6.0)?;
        scene.name = name;
        change(&mut scene);
        self.add(&scene, Drive::Straight(SPEED, 0.0));
        Ok(())
    }

    fn settings(&mut self) -> Result<(), CaseError> {
        for parts in [160_u32, 60, 30, 10, 5, 3, 2, 1] {
            let step = 1.0 / (30.0 * f64::from(parts));
            self.settings_of(format!("steps of {:.2} ms", 1e3 * step), |scene| set_step(scene, step))?;
        }
        for links in [4, 8, 40, 80] {
            self.settings_of(format!("{links} links"), |scene| set_links(&mut scene.rig, links))?;
        }
        for factor in [0.01, 0.1, 10.0, 100.0] {
            self.settings_of(format!("{factor} times as stiff"), |scene| stiffen(&mut scene.rig, factor))?;
            self.settings_of(format!("{factor} times as stiff, 80 links, steps of 33 ms"), |scene| {
                set_links(&mut scene.rig, 80);
                stiffen(&mut scene.rig, factor);
                set_step(scene, 1.0 / 30.0);
            })?;
        }
        self.settings_of("no damping".to_owned(), |scene| {
            for whisker in &mut scene.rig.whiskers {
                (whisker.shaft.damping, whisker.hinge.damping) = (0.0, 0.0);
            }
        })?;
        self.settings_of("contacts of 1 us".to_owned(), |scene| scene.physics.contact_time = 1e-6)?;
        self.settings_of("a friction of 1".to_owned(), |scene| scene.physics.friction = 1.0)
    }

    fn speeds(&mut self) -> Result<(), CaseError> {
        for speed in [0.2, 0.5, 1.0] {
            self.add(&scene(&format!("{speed} m/s past a disk"), disk_beside()?, 1.0)?, Drive::Straight(speed, 0.0));
        }
        for rate in [PI, -PI] {
            let turning = scene(&format!("turning at {rate:.1} rad/s beside a disk"), disk_beside()?, 3.0)?;
            self.add(&turning, Drive::Straight(SPEED, rate));
        }
        let ahead = |distance: f64| outline(&[(-0.5, distance), (0.5, distance), (0.5, 1.0), (-0.5, 1.0)]);
        for speed in [0.05, 0.2, 1.0] {
            let body = scene(&format!("the nose into a wall at {speed} m/s"), ahead(0.2)?, 3.0)?;
            self.add(&body, Drive::Straight(speed, 0.0));
            let mut tip = scene(&format!("a tip head-on into a wall at {speed} m/s"), ahead(0.3)?, 3.0)?;
            for whisker in &mut tip.rig.whiskers {
                (whisker.base_body.x, whisker.direction_body) = (0.108, 0.0);
            }
            self.add(&tip, Drive::Straight(speed, 0.0));
        }
        Ok(())
    }

    fn positions(&mut self) -> Result<(), CaseError> {
        for drive in [Drive::Straight(SPEED, 0.0), Drive::Policy] {
            let mut far = scene("10 km from the origin", disk_beside()?, 20.0)?;
            let moved = circle(Point2::new(REACH - OVERLAP + 0.2, 0.25) + FAR_OFFSET, 0.2)?;
            (far.solids, far.truth) = (vec![Solid::inside(moved.clone())?], moved.into());
            far.start.position += FAR_OFFSET;
            self.add(&far, drive);
        }
        // The near side of the object, and a line behind it.
        let (near, far) = (REACH - OVERLAP, REACH + 0.3);
        let half = 0.5 * 0.1_f64.to_radians();
        let rise = (far - near) * half;
        let shapes = [
            (
                "a blade of 0.5 mm along the path",
                outline(&[(near, 0.2), (near + 5e-4, 0.2), (near + 5e-4, 0.4), (near, 0.4)])?,
            ),
            ("a blade of 0.5 mm across the path", outline(&[(near, 0.2), (far, 0.2), (far, 0.2005), (near, 0.2005)])?),
            ("an edge of 0.1 deg", outline(&[(near, 0.25), (far, 0.25 - rise), (far, 0.25 + rise)])?),
            (
                "a corner of 179.9 deg",
                outline(&[(near, 0.25), (near + 0.2 * half, 0.05), (far, 0.25), (near + 0.2 * half, 0.45)])?,
            ),
        ];
        for (name, shape) in shapes {
            for (drive, time) in [(Drive::Straight(SPEED, 0.0), 8.0), (Drive::Policy, 20.0)] {
                self.add(&scene(name, shape.clone(), time)?, drive);
            }
        }
        self.add(&scene("a start inside an object", circle(Point2::origin(), 0.4)?, 1.0)?, Drive::Straight(SPEED, 0.0));
        self.add(
            &scene("a whisker that starts inside an object", circle(Point2::new(0.15, 0.0), 0.06)?, 1.0)?,
            Drive::Straight(SPEED, 0.0),
        );
        for time in [0.0, 1e-9] {
            self.add(&scene(&format!("a run of {time} s"), disk_beside()?, time)?, Drive::Policy);
        }
        Ok(())
    }
}

fn outline(positions: &[(f64, f64)]) -> Result<Contour, CaseError> {
    Ok(polygon(&positions.iter().map(|&(x, y)| Point2::new(x, y)).collect::<Vec<_>>())?)
}
