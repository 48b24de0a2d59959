//! An elastic shaft.

/// An elastic shaft of round wire, straight at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaft {
    /// Length from the base to the tip (m).
    pub length: f64,
    /// Radius of the wire (m).
    pub radius: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Young's modulus (Pa).
    pub young_modulus: f64,
    /// Ratio of the material's damping to its stiffness (s).
    pub damping: f64,
    /// Rigid links that stand for the shaft in a simulation.
    pub links: usize,
}

impl Shaft {
    /// Bending stiffness `E I` (N m²) of the round wire, `I = π r⁴ / 4`.
    #[must_use]
    pub fn bending_stiffness(&self) -> f64 {
        self.young_modulus * std::f64::consts::FRAC_PI_4 * self.radius.powi(4)
    }

    /// Length of one link (m).
    #[must_use]
    pub fn link_length(&self) -> f64 {
        self.length / self.links as f64
    }

    /// Mass of one link (kg).
    #[must_use]
    pub fn link_mass(&self) -> f64 {
        self.density * std::f64::consts::PI * self.radius.powi(2) * self.link_length()
    }

    /// Stiffness of every joint between links (N m/rad), from the root to the tip.
    ///
    /// The trapezoid rule for the bending energy: `EI / l` at a joint between two links of length `l`, and `2 EI / l` at the
    /// root, where only half a link's length bends.
    pub fn joint_stiffnesses(&self) -> impl Iterator<Item = f64> {
        let between = self.bending_stiffness() / self.link_length();
        (0..self.links).map(move |joint| if joint == 0 { 2.0 * between } else { between })
    }
}

impl Default for Shaft {
    fn default() -> Self {
        Self { length: 0.1, radius: 0.125e-3, density: 6450.0, young_modulus: 100e9, damping: 1e-3, links: 16 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_joints_bend_as_much_as_the_shaft_but_for_the_last_half_link() {
        for links in [1, 2, 7, 16] {
            let shaft = Shaft { links, ..Shaft::default() };
            let compliance: f64 = shaft.joint_stiffnesses().map(f64::recip).sum();
            let bending = (shaft.length - 0.5 * shaft.link_length()) / shaft.bending_stiffness();
            assert!((compliance / bending - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_links_weigh_as_much_as_the_wire() {
        let shaft = Shaft::default();
        let mass = shaft.links as f64 * shaft.link_mass();
        assert!((mass - 6450.0 * std::f64::consts::PI * 0.125e-3_f64.powi(2) * 0.1).abs() < 1e-15);
    }
}
