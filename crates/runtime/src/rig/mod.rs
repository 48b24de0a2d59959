//! The rig: a platform, its whiskers and its sensors.
//!
//! Body frame: origin at the platform's centre of mass, first axis forward (the heading), second axis to the left.

mod hinge;
mod platform;
mod sensing;
mod shaft;
mod whisker;

pub use hinge::Hinge;
pub use platform::{Platform, YawController};
pub use sensing::Sensing;
pub use shaft::Shaft;
pub use whisker::Whisker;

/// A platform with whiskers and sensors.
///
/// [`Rig::default`] is the reference rig: the thesis's platform with one whisker of 100 mm a side, swept back by 15°.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The body that carries the whiskers.
    pub platform: Platform,
    /// The whiskers, in the order in which samples list them.
    pub whiskers: Vec<Whisker>,
    /// What a sample reports, and how noisily.
    pub sensing: Sensing,
}

/// A whisker that a policy binds and the rig does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the policy binds the whisker `{name}`, which the rig does not have; the rig has {known}")]
pub struct UnknownWhisker {
    name: String,
    known: String,
}

impl Rig {
    /// The indices of the whiskers called `names`, in the order of the names.
    ///
    /// # Errors
    /// [`UnknownWhisker`] when the rig has none of a name.
    pub fn indices(&self, names: &[String]) -> Result<Vec<usize>, UnknownWhisker> {
        let index = |name: &String| {
            self.whiskers.iter().position(|whisker| whisker.name == *name).ok_or_else(|| {
                let known = self.whiskers.iter().map(|whisker| format!("`{}`", whisker.name)).collect::<Vec<_>>();
                UnknownWhisker { name: name.clone(), known: known.join(", ") }
            })
        };
        names.iter().map(index).collect()
    }

    /// The indices of the whiskers called `names`, in the order of the names; `None` for one that the rig does not have and, by its
    /// place in `optional`, may lack.
    ///
    /// # Errors
    /// [`UnknownWhisker`] when the rig lacks another.
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
