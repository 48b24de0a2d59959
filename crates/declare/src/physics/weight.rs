//! The weight of a whisker.

use vibrissa_runtime::rig::{Shaft, Whisker};

/// Acceleration of gravity (m/s²).
pub const GRAVITY: f64 = 9.81;

/// Moment (N m) about a joint of a level shaft, counted from 0 at the base, of the weight of the links beyond it.
#[must_use]
pub fn weight_moment(shaft: &Shaft, joint: usize) -> f64 {
    let moment =
        |link: usize| (link as f64 + 0.5 - joint as f64) * shaft.link_length() * shaft.link_mass(link) * GRAVITY;
    (joint..shaft.links).map(moment).sum()
}

/// Angle (rad) by which gravity lowers the tip of a level whisker, seen from its base. With this pitch, the tip is in the plane of
/// motion. The angles of the joints are small.
#[must_use]
pub fn sag(whisker: &Whisker) -> f64 {
    let shaft = &whisker.shaft;
    let lowered = shaft.joint_stiffnesses().enumerate().map(|(joint, in_plane)| {
        let beyond = (shaft.links - joint) as f64 / shaft.links as f64;
        weight_moment(shaft, joint) / (shaft.out_of_plane * in_plane) * beyond
    });
    weight_moment(shaft, 0) / whisker.hinge.stiffness + lowered.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa_runtime::math;

    #[test]
    fn a_uniform_shaft_sags_like_a_cantilever() {
        let mut whisker = Whisker::unfitted();
        whisker.shaft.links = 400;
        let shaft = &whisker.shaft;
        let weight = shaft.density * std::f64::consts::PI * math::square(shaft.radius) * GRAVITY;
        let cantilever = weight * math::powi(shaft.length, 3) / (8.0 * shaft.bending_stiffness());
        let hinge = weight * math::square(shaft.length) / (2.0 * whisker.hinge.stiffness);
        assert!((sag(&whisker) / (cantilever + hinge) - 1.0).abs() < 1e-3);
    }
}
