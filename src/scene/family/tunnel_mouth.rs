//! The way into a tunnel.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Contact, Layout, tunnel};
use crate::geometry::{Point2, Pose, unit};

pub(super) const FAMILY: Family = Family {
    name: "tunnel-mouth",
    about: "a straight tunnel, 18 to 26 cm clear, entered aslant by up to 20°, between walls of 5 to 40 mm",
    lay,
};

fn lay(dice: &mut Dice) -> Layout {
    let (clear, thickness) = (dice.between(0.18, 0.26), dice.between(5e-3, 0.04));
    let length = dice.between(0.5, 0.9);
    let slant = dice.between(-20.0, 20.0) / 180.0 * PI;
    let from = Pose { position: Point2::new(0.0, dice.between(0.22, 0.3)), heading: FRAC_PI_2 + slant };
    Layout {
        about: format!(
            "{:.0} mm clear, walls of {:.0} mm, aslant by {:.1}°",
            1e3 * clear,
            1e3 * thickness,
            slant.to_degrees()
        ),
        objects: vec![tunnel(&from, &[(length, 0.0)], clear + thickness, thickness)],
        physics: Contact::Facing,
        start: Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 },
        aim: Aim::Place(from.position + length * unit(from.heading)),
        way: length,
    }
}
