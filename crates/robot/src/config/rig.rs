//! The section `rig`: the differences from the reference rig, with the keys of the scenario format.

use std::collections::BTreeMap;

use serde::Deserialize;
use vibrissa_runtime::calibration::Calibration;
use vibrissa_runtime::geometry::Point2;
use vibrissa_runtime::rig::{Hinge, Platform, Rig, Sensing, Shaft, Whisker};

use super::check::Inconsistency;
use super::quantity;

/// Defines a section whose keys replace fields of a struct of the rig.
macro_rules! section {
    ($section:ident of $target:ident { $($key:ident: $reader:literal,)* }) => {
        #[derive(Debug, Default, Deserialize)]
        #[serde(deny_unknown_fields, default)]
        struct $section {
            $(#[serde(deserialize_with = $reader)] $key: Option<f64>,)*
        }

        impl $section {
            fn apply(&self, target: &mut $target) {
                $(if let Some(value) = self.$key { target.$key = value.into(); })*
            }
        }
    };
}

section!(PlatformSection of Platform {
    tail_width: "some::length",
    nose_width: "some::length",
    length: "some::length",
    centre_of_mass: "some::length",
    mass: "some::mass",
    inertia: "some::inertia",
    servo: "some::time",
    yaw_servo: "some::time",
    speed_limit: "some::speed",
    yaw_rate_limit: "some::angular_speed",
});

section!(ShaftSection of Shaft {
    length: "some::length",
    radius: "some::length",
    young_modulus: "some::pressure",
    damping: "some::time",
});

section!(HingeSection of Hinge {
    stiffness: "some::torsion_stiffness",
    armature: "some::inertia",
});

section!(SensingSection of Sensing {
    sample_rate: "some::frequency",
    control_rate: "some::frequency",
    filter_cutoff: "some::frequency",
    contact_threshold: "some::angle",
    angle_noise: "some::angle",
    surface_roughness: "some::length",
});

/// Readers of quantities that may be absent.
mod some {
    use super::quantity;
    use serde::Deserializer;

    macro_rules! optional {
        ($($name:ident)*) => { $(
            pub(super) fn $name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
                quantity::$name::deserialize(deserializer).map(Some)
            }
        )* };
    }

    optional! { length angle time mass speed angular_speed frequency inertia torsion_stiffness pressure }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct WhiskerSection {
    base: Option<Lengths>,
    #[serde(deserialize_with = "some::angle")]
    direction: Option<f64>,
    shaft: ShaftSection,
    hinge: HingeSection,
    calibration: Option<Calibration>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
struct Lengths(#[serde(deserialize_with = "quantity::two_lengths")] [f64; 2]);

/// The section `rig`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RigSection {
    platform: PlatformSection,
    whiskers: BTreeMap<String, WhiskerSection>,
    sensing: SensingSection,
}

impl RigSection {
    /// Returns an error for a whisker that nobody can place.
    pub(super) fn check(&self) -> Result<(), Inconsistency> {
        let known = Rig::default().whiskers;
        for (name, section) in &self.whiskers {
            let is_identifier = name.starts_with(|first: char| first.is_ascii_alphabetic())
                && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
            let missing = match (section.base, section.direction) {
                _ if !is_identifier => Some("a whisker's name has letters, digits and _, a letter first".to_owned()),
                _ if known.iter().any(|whisker| whisker.name == *name) => None,
                (None, _) => Some(format!("the whisker `{name}` needs `base`, such as `base: [53 mm, 30 mm]`")),
                (_, None) => Some(format!("the whisker `{name}` needs `direction`, such as `direction: 105 deg`")),
                _ => None,
            };
            if let Some(message) = missing {
                return Err(Inconsistency { path: format!("rig.whiskers.{name}"), message });
            }
        }
        Ok(())
    }

    /// The rig. Without `whiskers`, it has those of the reference rig.
    pub(super) fn rig(&self) -> Rig {
        let mut rig = Rig::default();
        self.platform.apply(&mut rig.platform);
        self.sensing.apply(&mut rig.sensing);
        if !self.whiskers.is_empty() {
            let known = std::mem::take(&mut rig.whiskers);
            let whisker = |(name, section): (&String, &WhiskerSection)| {
                let known = known.iter().find(|whisker| whisker.name == *name).cloned();
                section.whisker(Whisker { name: name.clone(), ..known.unwrap_or_else(Whisker::unfitted) })
            };
            rig.whiskers = self.whiskers.iter().map(whisker).collect();
        }
        rig
    }
}

impl WhiskerSection {
    fn whisker(&self, mut whisker: Whisker) -> Whisker {
        if let Some(Lengths([forward, left])) = self.base {
            whisker.base_body = Point2::new(forward, left);
        }
        whisker.direction_body = self.direction.unwrap_or(whisker.direction_body);
        self.shaft.apply(&mut whisker.shaft);
        self.hinge.apply(&mut whisker.hinge);
        whisker.calibration.clone_from(&self.calibration);
        whisker
    }
}
