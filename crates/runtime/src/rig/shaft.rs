//! An elastic shaft.

use serde::{Deserialize, Serialize};

use crate::math;

/// An elastic shaft of round wire, uniform or with a linear taper towards the tip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shaft {
    /// Length from the base to the tip (m).
    pub length: f64,
    /// Radius of the shaft (m), at the base if it tapers.
    pub radius: f64,
    /// Radius at the tip (m), above 0 and at most `radius`, if the shaft tapers.
    pub tip_radius: Option<f64>,
    /// Density (kg/m³).
    pub density: f64,
    /// Young's modulus (Pa).
    pub young_modulus: f64,
    /// Ratio of the material's damping to its stiffness (s).
    pub damping: f64,
    /// Ratio of the bending stiffness out of the plane of motion to that in the plane. 1 for round wire, more for a
    /// ribbon on edge. Only a spatial simulation uses it.
    pub out_of_plane: f64,
    /// Number of rigid links in the chain of links.
    pub links: usize,
    /// Curvature at rest (1/m), positive to the left seen from the base. Simulators bend the shaft by it. Perception
    /// assumes a straight shaft.
    #[serde(default)]
    pub curvature: f64,
}

impl Shaft {
    /// Ratio of the radii at the tip and at the base.
    #[must_use]
    pub fn taper(&self) -> f64 {
        self.tip_radius.map_or(1.0, |tip_radius| tip_radius / self.radius)
    }

    /// Radius (m) at a share of the length, 0 at the base and 1 at the tip.
    #[must_use]
    pub fn radius_at(&self, share: f64) -> f64 {
        self.radius * self.thickness(share)
    }

    /// Ratio of the radii at a share of the length and at the base.
    fn thickness(&self, share: f64) -> f64 {
        1.0 + (self.taper() - 1.0) * share
    }

    /// Bending stiffness `E I` (N m²) at the base, with `I = π r⁴ / 4`.
    #[must_use]
    pub fn bending_stiffness(&self) -> f64 {
        self.young_modulus * std::f64::consts::FRAC_PI_4 * math::powi(self.radius, 4)
    }

    /// Bending stiffness (N m²) of the uniform shaft whose tip rotates equally under a small tip force. For the taper
    /// `q` the tip rotates by `M L / (E I) (1 + 2 q) / (6 q²)` under a base moment `M`.
    #[must_use]
    pub fn tip_stiffness(&self) -> f64 {
        let taper = self.taper();
        self.bending_stiffness() * (3.0 * taper * taper / (1.0 + 2.0 * taper))
    }

    /// Length of one link (m).
    #[must_use]
    pub fn link_length(&self) -> f64 {
        self.length / self.links as f64
    }

    /// Mass of a link (kg), counted from 0 at the base. The link has the mass of its part of the shaft, which is a
    /// frustum of a cone.
    #[must_use]
    pub fn link_mass(&self, link: usize) -> f64 {
        let [a, b] = [link, link + 1].map(|end| self.thickness(end as f64 / self.links as f64));
        let uniform = self.density * std::f64::consts::PI * math::square(self.radius) * self.link_length();
        uniform * ((a * a + a * b + b * b) / 3.0)
    }

    /// Mean radius of a link (m), counted from 0 at the base.
    #[must_use]
    pub fn link_radius(&self, link: usize) -> f64 {
        self.radius_at((link as f64 + 0.5) / self.links as f64)
    }

    /// Angles of the joints at rest (rad), from the base to the tip, each relative to the link before it. A joint bends
    /// like the two half links beside it. The first joint has half a link.
    pub fn rest_angles(&self) -> impl Iterator<Item = f64> {
        let between = self.curvature * self.link_length();
        (0..self.links).map(move |joint| if joint == 0 { 0.5 * between } else { between })
    }

    /// Stiffness of every joint between links (N m/rad), from the base to the tip.
    ///
    /// It is the trapezoid rule for the bending energy. A joint bends like the two half links beside it: `EI / l` for
    /// links of length `l`, and `2 EI / l` at the base, where only half a link bends. For a tapered shaft, `1 / EI` is
    /// averaged over the two half links.
    pub fn joint_stiffnesses(&self) -> impl Iterator<Item = f64> {
        let between = self.bending_stiffness() / self.link_length();
        (0..self.links).map(move |joint| {
            let [a, b] = [math::max(joint as f64 - 0.5, 0.0), joint as f64 + 0.5]
                .map(|end| self.thickness(end / self.links as f64));
            // The mean of 1 / r⁴ along a frustum, for radii over that at the base.
            let softness = (a * a + a * b + b * b) / (3.0 * math::powi(a * b, 3));
            if joint == 0 { 2.0 * between / softness } else { between / softness }
        })
    }
}

impl Default for Shaft {
    fn default() -> Self {
        Self {
            length: 0.1,
            radius: 0.125e-3,
            tip_radius: None,
            density: 6450.0,
            young_modulus: 100e9,
            damping: 1e-3,
            out_of_plane: 1.0,
            links: 16,
            curvature: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shafts that are uniform, tapered, and with almost no radius at the tip.
    fn shafts() -> impl Iterator<Item = Shaft> {
        let tips = [None, Some(0.125e-3), Some(0.06e-3), Some(0.01e-3)];
        let shaft = |tip_radius, links| Shaft { tip_radius, links, ..Shaft::default() };
        tips.into_iter().flat_map(move |tip_radius| [1, 2, 7, 16].map(|links| shaft(tip_radius, links)))
    }

    /// The integral of a function of the radius along the shaft, from the base to a share of the length, by the
    /// midpoint rule.
    fn integral(shaft: &Shaft, to: f64, of: impl Fn(f64) -> f64) -> f64 {
        let width = to / 1e5;
        (0..100_000).map(|index| of(shaft.radius_at((f64::from(index) + 0.5) * width)) * width * shaft.length).sum()
    }

    #[test]
    fn the_joints_bend_as_much_as_the_shaft_but_for_the_last_half_link() {
        for shaft in shafts() {
            let compliance: f64 = shaft.joint_stiffnesses().map(f64::recip).sum();
            let stiffness = |radius: f64| shaft.bending_stiffness() * math::powi(radius / shaft.radius, 4);
            let bending = integral(&shaft, 1.0 - 0.5 / shaft.links as f64, |radius| stiffness(radius).recip());
            assert!((compliance / bending - 1.0).abs() < 1e-6, "{shaft:?}");
        }
    }

    #[test]
    fn the_links_weigh_as_much_as_the_wire() {
        for shaft in shafts() {
            let mass: f64 = (0..shaft.links).map(|link| shaft.link_mass(link)).sum();
            let wire = integral(&shaft, 1.0, |radius| shaft.density * std::f64::consts::PI * radius * radius);
            assert!((mass / wire - 1.0).abs() < 1e-6, "{shaft:?}");
        }
    }

    #[test]
    fn a_chain_at_rest_ends_where_the_arc_of_its_curvature_ends() {
        for (curvature, links) in [(0.2, 16), (-0.2, 16), (1.0, 64)] {
            let shaft = Shaft { links, curvature, ..Shaft::default() };
            let (mut direction, mut end) = (0.0, [0.0; 2]);
            for turn in shaft.rest_angles() {
                direction += turn;
                end[0] += shaft.link_length() * math::cos(direction);
                end[1] += shaft.link_length() * math::sin(direction);
            }
            let turn = curvature * shaft.length;
            let arc = [math::sin(turn) / curvature, (1.0 - math::cos(turn)) / curvature];
            assert!(math::hypot(end[0] - arc[0], end[1] - arc[1]) < 1e-5 * shaft.length, "{end:?} and {arc:?}");
        }
    }

    #[test]
    fn a_taper_to_the_same_radius_is_none() {
        let shaft = Shaft { tip_radius: Some(0.125e-3), ..Shaft::default() };
        assert!(shaft.joint_stiffnesses().eq(Shaft::default().joint_stiffnesses()));
        for link in 0..shaft.links {
            assert_eq!(shaft.link_mass(link).to_bits(), Shaft::default().link_mass(link).to_bits());
            assert_eq!(shaft.link_radius(link).to_bits(), shaft.radius.to_bits());
        }
    }
}
