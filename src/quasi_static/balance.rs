//! Steps towards a whisker's equilibrium among what it must not enter.

use crate::geometry::{Vector2, perpendicular};

use super::bordered::{Bordered, MOST, Small};
use super::touch::{Contact, Curving};
use super::wire::{Shape, Wire};

/// Steps of Newton's method towards the least bending energy at which no gap is negative.
///
/// What is sought are the links' directions, for which the bending energy is tridiagonal. A force on a link adds to the diagonal
/// alone, as it turns with the links before it; every contact, and the curvature of every surface, adds a column at its side. So a
/// step takes time in proportion to the number of links.
#[derive(Debug, Default)]
pub(super) struct Balance {
    bordered: Bordered,
    small: Small,
    diagonal: Vec<f64>,
    /// How far every link is to turn (rad).
    turns: Vec<f64>,
    /// How far the end of every link then moves (m), in small turns.
    moves: Vec<Vector2>,
}

/// What a step has found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// How far the farthest link end would move (m).
    pub(super) farthest: f64,
    /// Whether the step is one of Newton's method proper, towards an equilibrium that would stay. Else it only leads downhill.
    pub(super) is_newtons: bool,
    /// The contacts that bear, with their forces (N).
    pub(super) bearing: [(usize, f64); MOST],
    pub(super) count: usize,
}

/// A gap may be this much below nothing (m).
const TOLERANCE: f64 = 1e-10;
/// Changes of the set of bearing contacts in one step.
const ROUNDS: usize = 24;

/// A contact that takes over less than this share of another one's force takes over nothing.
const LEAST_SHARE: f64 = 1e-9;

/// A column that has what the curvature of a gap adds.
#[derive(Debug, Clone, Copy, Default)]
struct Curve {
    column: usize,
    /// The column that it goes together with: itself, for a square.
    partner: usize,
    /// The inverse of the factor of the product of the two.
    inverse: f64,
}

impl Balance {
    /// One step from a shape; `None` if there is none, as where a whisker is pushed straight against its base.
    pub(super) fn step(&mut self, wire: &Wire, shape: &Shape, contacts: &[Contact]) -> Option<Step> {
        // Without the curvatures the equations are always those of a least energy.
        self.attempt(wire, shape, contacts, true).or_else(|| self.attempt(wire, shape, contacts, false))
    }

    /// Turns the links by a share of the last step.
    pub(super) fn take(&self, shape: &mut Shape, share: f64) {
        for (angle, turn) in shape.angles.iter_mut().zip(&self.turns) {
            *angle += share * turn;
        }
    }

    fn attempt(&mut self, wire: &Wire, shape: &Shape, contacts: &[Contact], is_newtons: bool) -> Option<Step> {
        self.fill(wire, shape, if is_newtons { contacts } else { &[] });
        self.bordered.factor(&self.diagonal, &wire.beside)?;
        let free = self.bordered.add(|column| unbalanced(wire, shape, column))?;
        let mut curves = [Curve::default(); MOST];
        let (mut curve_count, mut rising) = (0, 0);
        let mut bearing = [(0, 0.0); MOST];
        let mut columns = [0; MOST];
        let mut count = 0;
        for (index, contact) in contacts.iter().enumerate().filter(|(_, contact)| contact.force > 0.0) {
            if is_newtons {
                let (added, is_rising) = self.curve(wire, shape, contact)?;
                for curve in added.into_iter().flatten() {
                    *curves.get_mut(curve_count)? = curve;
                    curve_count += 1;
                }
                rising += usize::from(is_rising);
            }
            *bearing.get_mut(count)? = (index, contact.force);
            columns[count] = self.bordered.add(|column| levers(wire, shape, contact, contact.normal, column))?;
            count += 1;
        }
        let curves = &curves[..curve_count];
        for _ in 0..ROUNDS {
            self.fill_small(free, &columns[..count], &bearing[..count], contacts, curves)?;
            let Some((solution, positive)) = self.small.solve() else {
                let yields = self.yielding(&columns[..count], &bearing[..count]).filter(|_| !is_newtons)?;
                count -= 1;
                bearing.swap(yields, count);
                columns.swap(yields, count);
                continue;
            };
            let (forces, spreads) = solution.split_at(count);
            let worst = (0..count).min_by(|&a, &b| forces[a].total_cmp(&forces[b]));
            if let Some(worst) = worst.filter(|&worst| forces[worst] < -1e-12) {
                count -= 1;
                bearing.swap(worst, count);
                columns.swap(worst, count);
                continue;
            }
            for (bearing, &force) in bearing.iter_mut().zip(forces) {
                bearing.1 = force;
            }
            let weights = columns[..count].iter().zip(forces).map(|(&column, &force)| (column, force));
            let spreads = curves.iter().zip(spreads).map(|(curve, spread)| (curve.column, -spread));
            self.combine(free, weights.chain(spreads));
            let farthest = self.displace(wire, shape)?;
            let is_bearing = |index: usize| bearing[..count].iter().any(|&(bearing, _)| bearing == index);
            let gap_after = |contact: &Contact| contact.gap + contact.normal.dot(&self.moved(wire, shape, contact));
            let idle = contacts.iter().enumerate().filter(|(index, _)| !is_bearing(*index));
            let deepest =
                idle.map(|(index, contact)| (index, gap_after(contact))).min_by(|one, two| one.1.total_cmp(&two.1));
            let Some((index, _)) = deepest.filter(|&(_, gap)| gap < -TOLERANCE) else {
                // Sylvester's law: a least energy has as many positive eigenvalues here.
                let stays = positive + self.bordered.negative == count + rising;
                return (stays || !is_newtons).then_some(Step { farthest, is_newtons, bearing, count });
            };
            let contact = &contacts[index];
            *bearing.get_mut(count)? = (index, 0.0);
            columns[count] = self.bordered.add(|column| levers(wire, shape, contact, contact.normal, column))?;
            count += 1;
        }
        None
    }

    /// Of contacts that cannot all bear by themselves, as three of one link on a circle, the last of which was added: the one that the
    /// others can do without, because the last takes over its force first. `None` if the last leaves them all theirs.
    ///
    /// Goldfarb and Idnani, Mathematical Programming 27 (1983), 1: the step in the dual space alone.
    fn yielding(&mut self, columns: &[usize], bearing: &[(usize, f64)]) -> Option<usize> {
        let (&last, others) = columns.split_last()?;
        let products = &self.bordered.products;
        self.small.size = others.len();
        for (row, &column) in others.iter().enumerate() {
            self.small.right[row] = products[column][last];
            for (at, &other) in others.iter().enumerate() {
                self.small.matrix[row][at] = products[column][other];
            }
        }
        let (shares, _) = self.small.solve()?;
        let taken = (0..others.len()).filter(|&at| shares[at] > LEAST_SHARE);
        taken.min_by(|&a, &b| (bearing[a].1 / shares[a]).total_cmp(&(bearing[b].1 / shares[b])))
    }

    /// The stiffness of the joints, and what forces that turn with the links add to it.
    fn fill(&mut self, wire: &Wire, shape: &Shape, contacts: &[Contact]) {
        self.diagonal.clone_from(&wire.diagonal);
        for contact in contacts.iter().filter(|contact| contact.force > 0.0) {
            let force = contact.force * contact.normal;
            for (entry, along) in self.diagonal.iter_mut().zip(&shape.along).take(contact.link) {
                *entry += wire.link * force.dot(along);
            }
            let own = &mut self.diagonal[contact.link];
            *own += contact.along * force.dot(&shape.along[contact.link]);
            if let Curving::Rolling(aside) = contact.curving {
                *own -= force.dot(&shape.left(contact.link)) * aside;
            }
        }
    }

    /// Adds the columns of a gap's curvature, if it has any; whether they add an eigenvalue above 0.
    fn curve(&mut self, wire: &Wire, shape: &Shape, contact: &Contact) -> Option<([Option<Curve>; 2], bool)> {
        let link = contact.link;
        match contact.curving {
            Curving::None => Some(([None; 2], false)),
            // The first link has its base where it is: it turns about that without sliding.
            Curving::Rolling(_) if link == 0 => Some(([None; 2], false)),
            Curving::Circling(curvature) => {
                let tangent = perpendicular(contact.normal);
                let column = self.bordered.add(|column| levers(wire, shape, contact, tangent, column))?;
                let inverse = -(contact.force * curvature).recip();
                Some(([Some(Curve { column, partner: column, inverse }), None], inverse > 0.0))
            }
            Curving::Rolling(_) => {
                let tangent = shape.along[link];
                let slide = self.bordered.add(|column| {
                    levers(wire, shape, contact, tangent, column);
                    column[link] = 0.0;
                })?;
                let turn = self.bordered.add(|column| {
                    column.fill(0.0);
                    column[link] = 1.0;
                })?;
                let inverse = (contact.force * contact.normal.dot(&shape.left(link))).recip();
                let pair = [(slide, turn), (turn, slide)];
                Some((pair.map(|(column, partner)| Some(Curve { column, partner, inverse })), true))
            }
        }
    }

    /// Writes the equations of the bearing forces and of what spreads along the columns of curvature; `None` if there are too many.
    fn fill_small(
        &mut self,
        free: usize,
        columns: &[usize],
        bearing: &[(usize, f64)],
        contacts: &[Contact],
        curves: &[Curve],
    ) -> Option<()> {
        let (small, products) = (&mut self.small, &self.bordered.products);
        let forces = columns.len();
        small.size = forces + curves.len();
        if small.size > MOST {
            return None;
        }
        for (row, (&column, &(index, _))) in columns.iter().zip(bearing).enumerate() {
            small.right[row] = -contacts[index].gap - products[column][free];
            for (at, &other) in columns.iter().enumerate() {
                small.matrix[row][at] = products[column][other];
            }
            for (at, curve) in curves.iter().enumerate() {
                small.matrix[row][forces + at] = -products[column][curve.column];
                small.matrix[forces + at][row] = -products[column][curve.column];
            }
        }
        for (row, curve) in curves.iter().enumerate() {
            small.right[forces + row] = products[curve.column][free];
            for (at, other) in curves.iter().enumerate() {
                let own = if other.column == curve.partner { curve.inverse } else { 0.0 };
                small.matrix[forces + row][forces + at] = products[curve.column][other.column] + own;
            }
        }
        Some(())
    }

    /// The turns: those without any contact, and so much of other columns.
    fn combine(&mut self, free: usize, weights: impl Iterator<Item = (usize, f64)>) {
        self.turns.clear();
        self.turns.extend_from_slice(self.bordered.solved(free));
        for (column, weight) in weights {
            for (turn, solved) in self.turns.iter_mut().zip(self.bordered.solved(column)) {
                *turn += weight * solved;
            }
        }
    }

    /// Where the turns take the ends of the links; how far the farthest of them goes (m), `None` if that is no number.
    fn displace(&mut self, wire: &Wire, shape: &Shape) -> Option<f64> {
        self.moves.clear();
        let (mut end, mut farthest) = (Vector2::zeros(), 0.0_f64);
        for (along, turn) in shape.along.iter().zip(&self.turns) {
            self.moves.push(end);
            end += wire.link * turn * perpendicular(*along);
            farthest = farthest.max(end.norm_squared());
        }
        (end.x + end.y).is_finite().then(|| farthest.sqrt())
    }

    /// How far the turns take the place of a contact (m).
    fn moved(&self, wire: &Wire, shape: &Shape, contact: &Contact) -> Vector2 {
        debug_assert!(contact.along <= wire.link);
        self.moves[contact.link] + contact.along * self.turns[contact.link] * shape.left(contact.link)
    }
}

/// How fast a contact's place on the whisker moves along a direction when each link turns (m/rad).
fn levers(wire: &Wire, shape: &Shape, contact: &Contact, direction: Vector2, column: &mut [f64]) {
    let lever = |arm: f64, along: &Vector2| arm * along.perp(&direction);
    for (entry, along) in column.iter_mut().zip(&shape.along).take(contact.link) {
        *entry = lever(wire.link, along);
    }
    column[contact.link] = lever(contact.along, &shape.along[contact.link]);
    column[contact.link + 1..].fill(0.0);
}

/// The moment of the springs on every link (N m).
fn unbalanced(wire: &Wire, shape: &Shape, column: &mut [f64]) {
    let (mut before, mut behind) = (0.0, 0.0);
    for (joint, (&stiffness, &angle)) in wire.stiffnesses.iter().zip(&shape.angles).enumerate() {
        let moment = stiffness * (angle - before);
        if joint > 0 {
            column[joint - 1] = moment - behind;
        }
        (before, behind) = (angle, moment);
    }
    if let Some(last) = column.last_mut() {
        *last = 0.0 - behind;
    }
}
