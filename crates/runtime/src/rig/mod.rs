//! The rig: a platform with whiskers and sensors.
//!
//! Body frame: origin at the platform's centre of mass, first axis forward (the heading), second axis to the left.

mod estimation;
mod hinge;
mod platform;
mod sensing;
mod shaft;
mod thesis_array;
mod vibration;
mod whisker;

use serde::{Deserialize, Serialize};

pub use estimation::Estimation;
pub use hinge::Hinge;
pub use platform::{Platform, YawController};
pub use sensing::Sensing;
pub use shaft::Shaft;
pub use vibration::Vibration;
pub use whisker::Whisker;

/// A platform with whiskers and sensors.
///
/// [`Rig::default`] is the reference rig: the baseline's platform with one whisker of 100 mm per side, swept back by
/// 15°.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rig {
    /// The body that carries the whiskers.
    pub platform: Platform,
    /// The whiskers, in the order of the readings in a sample.
    pub whiskers: Vec<Whisker>,
    /// Rates and noise of the sensors.
    pub sensing: Sensing,
}

/// A whisker that a policy binds and the rig lacks.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the rig has no whisker `{name}`; it has {known}")]
pub struct UnknownWhisker {
    name: String,
    known: String,
}

impl Rig {
    /// The rig whose whiskers have [the masses and the damping](Whisker::vibrating) of their first modes.
    #[must_use]
    pub fn vibrating(&self) -> Self {
        Self { whiskers: self.whiskers.iter().map(Whisker::vibrating).collect(), ..self.clone() }
    }

    /// Returns the indices of the whiskers with these names, in their order.
    ///
    /// # Errors
    /// [`UnknownWhisker`] if the rig lacks one of them.
    pub fn indices(&self, names: &[String]) -> Result<Vec<usize>, UnknownWhisker> {
        let index = |name: &String| {
            self.whiskers.iter().position(|whisker| whisker.name == *name).ok_or_else(|| {
                let known = self.whiskers.iter().map(|whisker| format!("`{}`", whisker.name)).collect::<Vec<_>>();
                UnknownWhisker { name: name.clone(), known: known.join(", ") }
            })
        };
        names.iter().map(index).collect()
    }

    /// Returns the indices of the whiskers with these names, in their order. The result is `None` for a whisker that
    /// the rig lacks and that `optional` allows to be missing.
    ///
    /// # Errors
    /// [`UnknownWhisker`] if the rig lacks another one.
    pub fn fitted(&self, names: &[String], optional: &[bool]) -> Result<Vec<Option<usize>>, UnknownWhisker> {
        let optional = optional.iter().copied().chain(std::iter::repeat(false));
        let index = |(name, optional): (&String, bool)| match self.indices(std::slice::from_ref(name)) {
            Ok(found) => Ok(found.first().copied()),
            Err(_) if optional => Ok(None),
            Err(error) => Err(error),
        };
        names.iter().zip(optional).map(index).collect()
    }
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            platform: Platform::default(),
            whiskers: vec![Whisker::reference("r0", -1.0), Whisker::reference("l0", 1.0)],
            sensing: Sensing::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn the_reference_whiskers_are_mirror_images() {
        let [right, left] =
            <[Whisker; 2]>::try_from(Rig::default().whiskers).unwrap_or_else(|_| panic!("two whiskers"));
        assert_eq!(right.base_body, Point2::new(left.base_body.x, -left.base_body.y));
        assert!((right.direction_body + left.direction_body).abs() < 1e-15);
        assert!(right.side() < 0.0 && left.side() > 0.0);
        assert_eq!(right.shaft, left.shaft);
    }
}
