//! Contacts at known positions with the counts of a sensor.

#[cfg(feature = "robot")]
use vibrissa_robot::array::Transducer;
#[cfg(feature = "robot")]
use vibrissa_runtime::calibration::ContactSet;
#[cfg(feature = "robot")]
use vibrissa_runtime::rig::Whisker;

#[cfg(feature = "robot")]
use super::hinge_fit::HingeFit;
use vibrissa_world::geometry::Vector2;

/// A contact at a known position, with the counts of the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountSet {
    /// Contact position on the surface (m, frame of the base).
    pub contact_base: Vector2,
    /// Counts of the sensor.
    pub counts: f64,
    /// Direction of the surface normal, towards the whisker (rad, frame of the base), if it is known.
    pub normal: Option<f64>,
    /// True for a contact of the shaft, false for a tip contact.
    pub on_shaft: bool,
}

#[cfg(feature = "robot")]
/// Steps of [`fit_field`]. A magnet without a cubic term needs two.
const STEPS: usize = 6;
#[cfg(feature = "robot")]
/// Relative change of the field per moment at which the fit ends.
const SETTLED: f64 = 1e-6;

#[cfg(feature = "robot")]
impl CountSet {
    /// The set with the base angle that the robot computes from these counts.
    #[must_use]
    pub fn converted(&self, transducer: &Transducer) -> ContactSet {
        let Self { contact_base, counts, normal, on_shaft } = *self;
        ContactSet { contact_base, base_angle: transducer.base_angle(counts), normal, on_shaft }
    }
}

#[cfg(feature = "robot")]
/// Fits the field per base moment of a whisker's magnet, with its sign. The whisker itself is the balance: at the position
/// of a tip contact, the mechanics have one base moment.
///
/// `first` has the settings of the sensor, the neutral value and the magnitude to start from. `None` if the sets do not
/// determine the value, or if it is not within a factor of five of that magnitude.
#[must_use]
pub fn fit_field(whisker: &Whisker, sets: &[CountSet], first: &Transducer) -> Option<Transducer> {
    let sets = || sets.iter().filter(|set| !set.on_shaft);
    // A bend to the left has a positive base angle, and its tip is on the left.
    let side: f64 = sets().map(|set| (set.counts - first.neutral) * set.contact_base.y).sum();
    let mut transducer = *first;
    transducer.magnet.field_per_moment = first.magnet.field_per_moment.abs() * side.signum();
    let hinge = HingeFit::new(whisker);
    for _ in 0..STEPS {
        let converted = sets().map(|set| set.converted(&transducer).to_left());
        let converted: Vec<_> = converted.filter(|set| set.base_angle > 0.0).collect();
        if converted.is_empty() {
            return None;
        }
        // The stiffness with which these base angles have the moments of the mechanics.
        let ratio = whisker.hinge.stiffness / hinge.fit(&converted)?;
        transducer.magnet.field_per_moment *= ratio;
        if (ratio - 1.0).abs() < SETTLED {
            break;
        }
    }
    let ratio = (transducer.magnet.field_per_moment / first.magnet.field_per_moment).abs();
    (0.2..=5.0).contains(&ratio).then_some(transducer)
}
