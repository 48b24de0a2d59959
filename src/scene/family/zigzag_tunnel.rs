//! Tunnels of straight runs to and fro.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Contact, Layout, tunnel};
use crate::geometry::{Point2, Pose, Vector2, unit};

pub(super) const FAMILY: Family = Family {
    name: "zigzag-tunnel",
    about: "a tunnel of straight runs with turns of 10° to 60° to and fro, 18 to 26 cm clear",
    lay,
};

const THICKNESS: f64 = 0.02;

fn lay(dice: &mut Dice) -> Layout {
    let turn = dice.between(10.0, 60.0) / 180.0 * PI;
    let clear = dice.between(0.18, 0.26);
    // At corners the middles of the walls lie at half the width on the bisector, which is aslant to both runs.
    let width = (clear + THICKNESS) / (0.5 * turn).cos();
    let (length, hand) = (dice.between(0.22, 0.35), dice.side());
    let runs: Vec<_> =
        (0..dice.count(4, 6)).map(|run| (length, 0.5 * turn * if run % 2 == 0 { hand } else { -hand })).collect();
    let from = Pose { position: Point2::new(0.0, 0.2), heading: FRAC_PI_2 };
    let along: Vector2 = runs.iter().map(|&(length, heading)| length * unit(FRAC_PI_2 + heading)).sum();
    Layout {
        about: format!("turns of {:.1}°, {:.0} mm clear", turn.to_degrees(), 1e3 * clear),
        objects: vec![tunnel(&from, &runs, width, THICKNESS)],
        physics: Contact::Facing,
        start: Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 },
        aim: Aim::Place(from.position + along),
        way: runs.iter().map(|run| run.0).sum(),
    }
}
