//! Newton steps towards the static equilibrium of a whisker among obstacles.

use crate::geometry::{Vector2, perpendicular};

use super::bordered_tridiagonal::{BorderedTridiagonal, MAX_COLUMNS, SmallSystem};
use super::contact::{Contact, GapCurvature};
use super::rod::{Rod, Shape};

/// Newton's method for the minimum bending energy without penetration, with an active set of contacts.
///
/// The unknowns are the directions of the links, for which the Hessian of the bending energy is tridiagonal. The moment
/// of a contact force changes with the rotation of the links before it. This adds only to the diagonal. Every active
/// contact, and the curvature of every surface, borders the matrix by a column. The cost of a step is therefore
/// proportional to the number of links.
#[derive(Debug, Default)]
pub(super) struct EquilibriumSolver {
    bordered: BorderedTridiagonal,
    kkt: SmallSystem,
    diagonal: Vec<f64>,
    /// The rotation of every link in this step (rad).
    rotations: Vec<f64>,
    /// The displacement (m) of the near end of every link, linearised in the rotations.
    displacements: Vec<Vector2>,
}

/// The result of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// The largest displacement of a link end (m).
    pub(super) max_displacement: f64,
    /// True for a Newton step towards a stable equilibrium. Otherwise the step is only a descent direction.
    pub(super) is_newton: bool,
    /// The active contacts by their indices, with their forces (N).
    pub(super) active: [(usize, f64); MAX_COLUMNS],
    pub(super) count: usize,
}

/// The largest tolerated penetration (m).
const TOLERANCE: f64 = 1e-10;
/// The largest number of changes of the active set in a step.
const MAX_ITERATIONS: usize = 24;

/// A contact is redundant only if the new contact takes over more than this share of its force.
const MIN_SHARE: f64 = 1e-9;

/// A border column for the curvature of a gap.
#[derive(Debug, Clone, Copy, Default)]
struct CurvatureColumn {
    column: usize,
    /// The column with which it forms a product; itself for a square.
    partner: usize,
    /// The inverse of the coefficient of this product.
    inverse: f64,
}

impl EquilibriumSolver {
    /// Returns a step from a shape, or `None` if there is none. That happens if a whisker is pressed along its shaft.
    pub(super) fn step(&mut self, rod: &Rod, shape: &Shape, contacts: &[Contact]) -> Option<Step> {
        // Without the curvature columns, the equations always describe a minimum.
        self.try_step(rod, shape, contacts, true).or_else(|| self.try_step(rod, shape, contacts, false))
    }

    /// Rotates the links by a fraction of the last step.
    pub(super) fn take(&self, shape: &mut Shape, share: f64) {
        for (angle, turn) in shape.angles.iter_mut().zip(&self.rotations) {
            *angle += share * turn;
        }
    }

    fn try_step(&mut self, rod: &Rod, shape: &Shape, contacts: &[Contact], is_newton: bool) -> Option<Step> {
        self.assemble_hessian(rod, shape, if is_newton { contacts } else { &[] });
        self.bordered.factor(&self.diagonal, &rod.off_diagonal)?;
        let free = self.bordered.add(|column| joint_moments(rod, shape, column))?;
        let mut curvature_columns = [CurvatureColumn::default(); MAX_COLUMNS];
        let (mut curvature_count, mut expected_positive) = (0, 0);
        let mut active = [(0, 0.0); MAX_COLUMNS];
        let mut columns = [0; MAX_COLUMNS];
        let mut count = 0;
        for (index, contact) in contacts.iter().enumerate().filter(|(_, contact)| contact.force > 0.0) {
            if is_newton {
                let (added, adds_positive) = self.add_curvature(rod, shape, contact)?;
                for curve in added.into_iter().flatten() {
                    *curvature_columns.get_mut(curvature_count)? = curve;
                    curvature_count += 1;
                }
                expected_positive += usize::from(adds_positive);
            }
            *active.get_mut(count)? = (index, contact.force);
            columns[count] =
                self.bordered.add(|column| displacement_gradient(rod, shape, contact, contact.normal, column))?;
            count += 1;
        }
        let curvature_columns = &curvature_columns[..curvature_count];
        for _ in 0..MAX_ITERATIONS {
            self.fill_kkt(free, &columns[..count], &active[..count], contacts, curvature_columns)?;
            let Some((solution, positive)) = self.kkt.solve() else {
                let redundant = self.redundant_contact(&columns[..count], &active[..count]).filter(|_| !is_newton)?;
                count -= 1;
                active.swap(redundant, count);
                columns.swap(redundant, count);
                continue;
            };
            let (forces, amplitudes) = solution.split_at(count);
            let worst = (0..count).min_by(|&a, &b| forces[a].total_cmp(&forces[b]));
            if let Some(worst) = worst.filter(|&worst| forces[worst] < -1e-12) {
                count -= 1;
                active.swap(worst, count);
                columns.swap(worst, count);
                continue;
            }
            for (active, &force) in active.iter_mut().zip(forces) {
                active.1 = force;
            }
            let weights = columns[..count].iter().zip(forces).map(|(&column, &force)| (column, force));
            let amplitudes =
                curvature_columns.iter().zip(amplitudes).map(|(curve, amplitude)| (curve.column, -amplitude));
            self.combine(free, weights.chain(amplitudes));
            let max_displacement = self.update_displacements(rod, shape)?;
            let is_active = |index: usize| active[..count].iter().any(|&(active, _)| active == index);
            let gap_after =
                |contact: &Contact| contact.gap + contact.normal.dot(&self.displacement_at(rod, shape, contact));
            let inactive = contacts.iter().enumerate().filter(|(index, _)| !is_active(*index));
            let deepest =
                inactive.map(|(index, contact)| (index, gap_after(contact))).min_by(|one, two| one.1.total_cmp(&two.1));
            let Some((index, _)) = deepest.filter(|&(_, gap)| gap < -TOLERANCE) else {
                // Sylvester's law of inertia: at a minimum, the system has exactly this number of positive eigenvalues.
                let stays = positive + self.bordered.negative == count + expected_positive;
                return (stays || !is_newton).then_some(Step { max_displacement, is_newton, active, count });
            };
            let contact = &contacts[index];
            *active.get_mut(count)? = (index, 0.0);
            columns[count] =
                self.bordered.add(|column| displacement_gradient(rod, shape, contact, contact.normal, column))?;
            count += 1;
        }
        None
    }

    /// Selects the contact to remove from a linearly dependent active set, for example three contacts of one link with
    /// a circle. The contact that was added last takes over forces of the others. Returns the contact whose force
    /// reaches zero first, or `None` if no force decreases.
    ///
    /// Source: the dual step of Goldfarb and Idnani, Mathematical Programming 27 (1983), 1.
    fn redundant_contact(&mut self, columns: &[usize], active: &[(usize, f64)]) -> Option<usize> {
        let (&last, others) = columns.split_last()?;
        let products = &self.bordered.products;
        self.kkt.size = others.len();
        for (row, &column) in others.iter().enumerate() {
            self.kkt.rhs[row] = products[column][last];
            for (at, &other) in others.iter().enumerate() {
                self.kkt.matrix[row][at] = products[column][other];
            }
        }
        let (shares, _) = self.kkt.solve()?;
        let taken = (0..others.len()).filter(|&at| shares[at] > MIN_SHARE);
        taken.min_by(|&a, &b| (active[a].1 / shares[a]).total_cmp(&(active[b].1 / shares[b])))
    }

    /// Assembles the diagonal of the Hessian: joint stiffnesses and the geometric stiffness of contact forces.
    fn assemble_hessian(&mut self, rod: &Rod, shape: &Shape, contacts: &[Contact]) {
        self.diagonal.clone_from(&rod.diagonal);
        for contact in contacts.iter().filter(|contact| contact.force > 0.0) {
            let force = contact.force * contact.normal;
            for (entry, along) in self.diagonal.iter_mut().zip(&shape.tangents).take(contact.link) {
                *entry += rod.link * force.dot(along);
            }
            let own = &mut self.diagonal[contact.link];
            *own += contact.along * force.dot(&shape.tangents[contact.link]);
            if let GapCurvature::Rolling(aside) = contact.curvature {
                *own -= force.dot(&shape.left(contact.link)) * aside;
            }
        }
    }

    /// Adds the border columns for the curvature of a gap. The flag is true if they add a positive eigenvalue.
    fn add_curvature(
        &mut self,
        rod: &Rod,
        shape: &Shape,
        contact: &Contact,
    ) -> Option<([Option<CurvatureColumn>; 2], bool)> {
        let link = contact.link;
        match contact.curvature {
            GapCurvature::None => Some(([None; 2], false)),
            // The near end of the first link is fixed. This link rotates about it without sliding.
            GapCurvature::Rolling(_) if link == 0 => Some(([None; 2], false)),
            GapCurvature::Circling(curvature) => {
                let tangent = perpendicular(contact.normal);
                let column = self.bordered.add(|column| displacement_gradient(rod, shape, contact, tangent, column))?;
                let inverse = -(contact.force * curvature).recip();
                Some(([Some(CurvatureColumn { column, partner: column, inverse }), None], inverse > 0.0))
            }
            GapCurvature::Rolling(_) => {
                let tangent = shape.tangents[link];
                let slide = self.bordered.add(|column| {
                    displacement_gradient(rod, shape, contact, tangent, column);
                    column[link] = 0.0;
                })?;
                let turn = self.bordered.add(|column| {
                    column.fill(0.0);
                    column[link] = 1.0;
                })?;
                let inverse = (contact.force * contact.normal.dot(&shape.left(link))).recip();
                let pair = [(slide, turn), (turn, slide)];
                Some((pair.map(|(column, partner)| Some(CurvatureColumn { column, partner, inverse })), true))
            }
        }
    }

    /// Assembles the equations of the contact forces and of the amplitudes of the curvature columns. Returns `None` if
    /// there are too many.
    fn fill_kkt(
        &mut self,
        free: usize,
        columns: &[usize],
        active: &[(usize, f64)],
        contacts: &[Contact],
        curvature_columns: &[CurvatureColumn],
    ) -> Option<()> {
        let (kkt, products) = (&mut self.kkt, &self.bordered.products);
        let forces = columns.len();
        kkt.size = forces + curvature_columns.len();
        if kkt.size > MAX_COLUMNS {
            return None;
        }
        for (row, (&column, &(index, _))) in columns.iter().zip(active).enumerate() {
            kkt.rhs[row] = -contacts[index].gap - products[column][free];
            for (at, &other) in columns.iter().enumerate() {
                kkt.matrix[row][at] = products[column][other];
            }
            for (at, curve) in curvature_columns.iter().enumerate() {
                kkt.matrix[row][forces + at] = -products[column][curve.column];
                kkt.matrix[forces + at][row] = -products[column][curve.column];
            }
        }
        for (row, curve) in curvature_columns.iter().enumerate() {
            kkt.rhs[forces + row] = products[curve.column][free];
            for (at, other) in curvature_columns.iter().enumerate() {
                let own = if other.column == curve.partner { curve.inverse } else { 0.0 };
                kkt.matrix[forces + row][forces + at] = products[curve.column][other.column] + own;
            }
        }
        Some(())
    }

    /// Computes the rotations: the free solution plus weighted solutions of other columns.
    fn combine(&mut self, free: usize, weights: impl Iterator<Item = (usize, f64)>) {
        self.rotations.clear();
        self.rotations.extend_from_slice(self.bordered.solved(free));
        for (column, weight) in weights {
            for (turn, solved) in self.rotations.iter_mut().zip(self.bordered.solved(column)) {
                *turn += weight * solved;
            }
        }
    }

    /// Computes the displacements of the link ends. Returns the largest (m), or `None` if it is not finite.
    fn update_displacements(&mut self, rod: &Rod, shape: &Shape) -> Option<f64> {
        self.displacements.clear();
        let (mut end, mut max_displacement) = (Vector2::zeros(), 0.0_f64);
        for (along, turn) in shape.tangents.iter().zip(&self.rotations) {
            self.displacements.push(end);
            end += rod.link * turn * perpendicular(*along);
            max_displacement = max_displacement.max(end.norm_squared());
        }
        (end.x + end.y).is_finite().then(|| max_displacement.sqrt())
    }

    /// Returns the displacement of a contact point on the whisker (m).
    fn displacement_at(&self, rod: &Rod, shape: &Shape, contact: &Contact) -> Vector2 {
        debug_assert!(contact.along <= rod.link);
        self.displacements[contact.link] + contact.along * self.rotations[contact.link] * shape.left(contact.link)
    }
}

/// Writes the derivative of a contact point's position along `direction` with respect to the rotation of every link
/// (m/rad).
fn displacement_gradient(rod: &Rod, shape: &Shape, contact: &Contact, direction: Vector2, column: &mut [f64]) {
    let lever = |arm: f64, along: &Vector2| arm * along.perp(&direction);
    for (entry, along) in column.iter_mut().zip(&shape.tangents).take(contact.link) {
        *entry = lever(rod.link, along);
    }
    column[contact.link] = lever(contact.along, &shape.tangents[contact.link]);
    column[contact.link + 1..].fill(0.0);
}

/// Writes the moment of the joint springs on every link (N m).
fn joint_moments(rod: &Rod, shape: &Shape, column: &mut [f64]) {
    let (mut before, mut behind) = (0.0, 0.0);
    for (joint, (&stiffness, &angle)) in rod.stiffnesses.iter().zip(&shape.angles).enumerate() {
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
