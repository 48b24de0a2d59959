//! The least energy of a whisker that enters nothing, by a penalty on depth and the method of Gauss and Newton: slow, and without a
//! notion of what touches where. Followed along the same way it must feel the same.

use nalgebra::{DMatrix, DVector};
use vibrissa::geometry::{Contour, Piece, Point2, Pose, Vector2, circle, polygon, unit};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::world::World;
use vibrissa_runtime::mechanics::Elastica;
use vibrissa_runtime::rig::Whisker;
use vibrissa_runtime::signal::Command;

use super::scene::{START, command, one_whisker, outlines, points, solids};

/// Force for a depth (N/m): what touches sinks in by some hundredths of a micrometre.
const PENALTY: f64 = 1e5;

const STEPS: usize = 3000;

struct Penalised<'s> {
    whisker: &'s Whisker,
    outlines: &'s [Contour],
    stiffnesses: Vec<f64>,
    /// Directions of the links, from the undeflected shaft's (rad).
    angles: DVector<f64>,
}

impl<'s> Penalised<'s> {
    fn new(whisker: &'s Whisker, outlines: &'s [Contour]) -> Self {
        let mut stiffnesses: Vec<f64> = whisker.shaft.joint_stiffnesses().collect();
        stiffnesses[0] = (stiffnesses[0].recip() + whisker.hinge.stiffness.recip()).recip();
        Self { whisker, outlines, angles: DVector::zeros(stiffnesses.len()), stiffnesses }
    }

    /// Places on the whisker with what is nearest to them: so many on every link, and beside every corner.
    fn places(&self, base: Pose, angles: &DVector<f64>) -> Vec<(usize, f64, Point2)> {
        let link = self.whisker.shaft.link_length();
        let mut start = base.position;
        let mut places = Vec::new();
        for (index, angle) in angles.iter().enumerate() {
            let along = unit(base.heading + angle);
            let corners = self.outlines.iter().flat_map(Contour::corners).map(|corner| corner.point);
            let centres = self.outlines.iter().flat_map(Contour::pieces).filter_map(|piece| match piece {
                Piece::Arc(arc) => Some(arc.centre),
                Piece::Segment(_) => None,
            });
            let beside = corners.chain(centres).map(|point| (point - start).dot(&along));
            let beside = beside.filter(|arm| (0.0..link).contains(arm));
            let evenly = (1..=8).map(|step| link * f64::from(step) / 8.0);
            places.extend(evenly.chain(beside).map(|arm| (index, arm, start + arm * along)));
            start += link * along;
        }
        places
    }

    /// The energy, its slope, and the matrix of its curvature but for what turning makes of forces.
    fn energy(&self, base: Pose, angles: &DVector<f64>, with_slope: bool) -> (f64, DVector<f64>, DMatrix<f64>) {
        let (count, link, radius) = (angles.len(), self.whisker.shaft.link_length(), self.whisker.shaft.radius);
        let (mut energy, mut slope, mut curvature) = (0.0, DVector::zeros(count), DMatrix::zeros(count, count));
        for (joint, stiffness) in self.stiffnesses.iter().enumerate() {
            let bend = angles[joint] - if joint > 0 { angles[joint - 1] } else { 0.0 };
            energy += 0.5 * stiffness * bend * bend;
            slope[joint] += stiffness * bend;
            curvature[(joint, joint)] += stiffness;
            if joint > 0 {
                slope[joint - 1] -= stiffness * bend;
                curvature[(joint - 1, joint - 1)] += stiffness;
                curvature[(joint, joint - 1)] -= stiffness;
                curvature[(joint - 1, joint)] -= stiffness;
            }
        }
        for (index, arm, place) in self.places(base, angles) {
            for outline in self.outlines {
                let height = outline.signed_distance(place);
                let depth = radius - height;
                if depth <= 0.0 {
                    continue;
                }
                energy += 0.5 * PENALTY * depth * depth;
                if with_slope {
                    let outwards: Vector2 = (place - outline.nearest(place).point) / height;
                    let lever = DVector::from_fn(count, |row, _| match row {
                        row if row > index => 0.0,
                        row => {
                            (if row == index { arm } else { link }) * unit(base.heading + angles[row]).perp(&outwards)
                        }
                    });
                    slope -= PENALTY * depth * &lever;
                    curvature += PENALTY * &lever * lever.transpose();
                }
            }
        }
        (energy, slope, curvature)
    }

    /// Goes downhill to the least energy, by steps that are as small as they must be; the base angle there (rad).
    fn settle(&mut self, base: Pose) -> f64 {
        let (mut damping, mut calm) = (1e-6, 0);
        for _ in 0..STEPS {
            let (energy, slope, curvature) = self.energy(base, &self.angles, true);
            loop {
                let damped = &curvature + DMatrix::from_diagonal(&(damping * curvature.diagonal()));
                let step = damped.cholesky().unwrap().solve(&slope);
                let angles = &self.angles - &step;
                if step.amax() < 1e-13 {
                    calm = 3;
                    break;
                }
                if step.amax() < 0.01 && self.energy(base, &angles, false).0 <= energy {
                    calm = if step.amax() < 1e-8 && damping < 1e-3 { calm + 1 } else { 0 };
                    self.angles = angles;
                    damping = (0.3 * damping).max(1e-9);
                    break;
                }
                damping *= 4.0;
            }
            if calm >= 3 {
                break;
            }
        }
        self.stiffnesses[0] * self.angles[0] / self.whisker.hinge.stiffness
    }
}

/// Drives along a way in both and gives the base angles (µrad) at every so many samples.
fn both(outlines: &[Contour], way: &[(Command, usize)]) -> Vec<(f64, f64)> {
    let mut rig = one_whisker();
    rig.whiskers[0].hinge.damping = 0.0;
    let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids(outlines.to_vec()), START, 0).unwrap();
    let whisker = &rig.whiskers[0];
    let mut penalised = Penalised::new(whisker, outlines);
    let mut angles = Vec::new();
    for (command, ticks) in way {
        for _ in 0..*ticks {
            for sample in world.advance(command).unwrap().iter().skip(4).step_by(5) {
                let position = sample.body.point_to_world(whisker.base_body);
                let base = Pose { position, heading: sample.body.heading + whisker.direction_body };
                angles.push((1e6 * sample.whiskers[0].base_angle, 1e6 * penalised.settle(base)));
            }
        }
    }
    angles
}

/// Whether both felt the same nearly all the time: where a whisker springs off, one may do so a little earlier.
fn agree(name: &str, angles: &[(f64, f64)]) {
    let apart = |&&(one, other): &&(f64, f64)| (one - other).abs() > 0.05 + 2e-3 * other.abs();
    let far: Vec<_> = angles.iter().filter(apart).collect();
    let most = angles.iter().map(|(one, _)| one.abs()).fold(0.0, f64::max);
    assert!(most > 20.0, "{name}: hardly touched, {most} urad");
    assert!(
        50 * far.len() <= angles.len(),
        "{name}: {} of {}, such as {:?}",
        far.len(),
        angles.len(),
        &far[..far.len().min(8)]
    );
}

#[test]
fn every_kind_of_surface_is_felt_as_the_least_energy_says() {
    let along = [(command(0.0, 0.08, 0.0), 60), (command(0.0, 0.03, 0.2), 20), (command(0.0, -0.04, 0.0), 20)];
    // A penalty does not keep out what goes through a blade or a point in one step.
    for (name, outline) in outlines().into_iter().filter(|(name, _)| !name.contains("blade") && *name != "wedge") {
        agree(name, &both(&[outline], &along));
    }
}

#[test]
fn two_things_at_once_are_felt_as_the_least_energy_says() {
    let wall = polygon(&points(&[(0.11, 0.16), (0.2, 0.16), (0.2, 0.5), (0.11, 0.5)])).unwrap();
    let pin = circle(Point2::new(0.075, 0.22), 0.004).unwrap();
    agree("wall and pin", &both(&[wall, pin], &[(command(0.0, 0.05, 0.0), 75)]));
    let slit = polygon(&points(&[(0.07, 0.24), (0.3, 0.24), (0.3, 0.3), (0.07, 0.3)])).unwrap();
    let below = polygon(&points(&[(0.08, 0.16), (0.3, 0.16), (0.3, 0.215), (0.08, 0.215)])).unwrap();
    agree("slit", &both(&[slit, below], &[(command(0.0, 0.05, 0.0), 70)]));
}

#[test]
fn what_is_touched_is_where_the_exact_elastica_says() {
    let mut rig = one_whisker();
    rig.whiskers[0].shaft.links = 64;
    rig.whiskers[0].hinge.damping = 0.0;
    let elastica = Elastica::new(&rig.whiskers[0]);
    for (name, outline) in outlines().into_iter().filter(|(name, _)| ["disk", "wall", "pin", "wedge"].contains(name)) {
        let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &solids([outline.clone()]), START, 0).unwrap();
        let (mut guess, mut checked) = (elastica.straight(), 0);
        for tick in 0..65 {
            let sample = *world.advance(&command(0.0, 0.08, 0.0)).unwrap().last().unwrap();
            let (whisker, reading) = (&rig.whiskers[0], sample.whiskers[0]);
            if reading.base_angle.abs() < 2e-5 {
                continue;
            }
            let position = sample.body.point_to_world(whisker.base_body);
            let base = Pose { position, heading: sample.body.heading + whisker.direction_body };
            guess = elastica.locate(reading.base_angle, reading.shear.unwrap(), &guess).unwrap();
            let height = outline.signed_distance(base.point_to_world(guess.contact_base.into()));
            assert!((height - whisker.shaft.radius).abs() < 1e-5, "{name}, tick {tick}: {height} m");
            checked += 1;
        }
        assert!(checked > 10, "{name}: {checked}");
    }
}
