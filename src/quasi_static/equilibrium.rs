//! Newton steps towards the static equilibrium of a whisker among obstacles.
//!
//! Why: docs/decisions/quasi-static.md#one-solver-serves-all-contacts.

use crate::geometry::{Vector2, perpendicular};

use super::active_set::{Active, ActiveSet, CurvatureColumn, Weighted, held};
use super::bordered_tridiagonal::{BorderedTridiagonal, MAX_COLUMNS, SmallSystem};
use super::contact::{Contact, GapCurvature};
use super::friction::Edge;
use super::rod::{Rod, Shape};

/// Newton's method for the minimum bending energy without penetration, with an active set of contacts.
///
/// The unknowns are the directions of the links, for which the Hessian of the bending energy is tridiagonal. The moment
/// of a contact force changes with the rotation of the links before it. This adds only to the diagonal. Every active
/// contact, and the curvature of every surface, borders the matrix by a column. The cost of a step is therefore
/// proportional to the number of links.
///
/// With friction, the active set consists of edges of friction cones. One edge of a contact means that it slides: its gap
/// is zero, and its force is along the edge. Both edges mean that it sticks: its slip is zero too, and its force is
/// between the edges. An edge with a negative force is removed, so a contact that sticks begins to slide. A sliding
/// contact whose slip reverses gets its other edge.
#[derive(Debug)]
pub(super) struct EquilibriumSolver {
    /// The coefficient of friction.
    friction: f64,
    bordered: BorderedTridiagonal,
    kkt: SmallSystem,
    diagonal: Vec<f64>,
    /// The rotation of every link in this step (rad).
    rotations: Vec<f64>,
    /// The displacement (m) of the near end of every link, linearised in the rotations.
    displacements: Vec<Vector2>,
    active: ActiveSet,
}

/// The result of a step. [`EquilibriumSolver::active`] has its contact forces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// The largest displacement of a link end (m).
    pub(super) max_displacement: f64,
    /// True for a Newton step towards a stable equilibrium. Otherwise the step is only a descent direction.
    pub(super) is_newton: bool,
}

/// The largest tolerated penetration (m).
const TOLERANCE: f64 = 1e-10;
/// The largest number of changes of the active set in a step.
const MAX_ITERATIONS: usize = 24;

/// A contact is redundant only if the new contact takes over more than this share of its force.
const MIN_SHARE: f64 = 1e-9;

impl EquilibriumSolver {
    /// Creates the solver for a coefficient of friction.
    pub(super) fn new(friction: f64) -> Self {
        Self {
            friction,
            bordered: BorderedTridiagonal::default(),
            kkt: SmallSystem::default(),
            diagonal: Vec::new(),
            rotations: Vec::new(),
            displacements: Vec::new(),
            active: ActiveSet::default(),
        }
    }

    /// Returns a step from a shape, or `None` if there is none. That happens if a whisker is pressed along its shaft.
    pub(super) fn step(&mut self, rod: &Rod, shape: &Shape, contacts: &[Contact]) -> Option<Step> {
        let mut active = std::mem::take(&mut self.active);
        // Without the curvature columns, the equations always describe a minimum.
        let step = self
            .try_step(rod, shape, contacts, true, &mut active)
            .or_else(|| self.try_step(rod, shape, contacts, false, &mut active));
        self.active = active;
        step
    }

    /// The active edges of the last step.
    pub(super) fn active(&self) -> &[Active] {
        &self.active.edges
    }

    /// Rotates the links by a fraction of the last step.
    pub(super) fn take(&self, shape: &mut Shape, share: f64) {
        for (angle, turn) in shape.angles.iter_mut().zip(&self.rotations) {
            *angle += share * turn;
        }
    }

    fn try_step(
        &mut self,
        rod: &Rod,
        shape: &Shape,
        contacts: &[Contact],
        is_newton: bool,
        ActiveSet { edges: active, curvatures }: &mut ActiveSet,
    ) -> Option<Step> {
        self.assemble_hessian(rod, shape, if is_newton { contacts } else { &[] });
        self.bordered.factor(&self.diagonal, &rod.off_diagonal)?;
        let free = self.bordered.add(|column| joint_moments(rod, shape, column))?;
        active.clear();
        curvatures.clear();
        let mut expected_positive = 0;
        for (index, contact) in contacts.iter().enumerate().filter(|(_, contact)| contact.force.acts()) {
            let first_curvature = curvatures.len();
            if is_newton {
                let (added, adds_positive) = self.add_curvature(rod, shape, contact)?;
                curvatures.extend(added.into_iter().flatten());
                expected_positive += usize::from(adds_positive);
            }
            let [normal, slip] = self.add_contact(rod, shape, contact)?;
            for curve in &mut curvatures[first_curvature..] {
                curve.push.other = normal;
            }
            for edge in Edge::BOTH.into_iter().filter(|&edge| contact.force.acts_along(edge)) {
                active.push(self.activate(index, edge, [normal, slip]));
            }
        }
        for _ in 0..MAX_ITERATIONS {
            self.fill_kkt(free, active, contacts, curvatures)?;
            let count = active.len();
            let Some((solution, positive)) = self.kkt.solve() else {
                let redundant = self.redundant_edge(active, contacts).filter(|_| !is_newton)?;
                active.swap_remove(redundant);
                continue;
            };
            let (forces, amplitudes) = solution.split_at(count);
            let worst = (0..count).min_by(|&a, &b| forces[a].total_cmp(&forces[b]));
            if let Some(worst) = worst.filter(|&worst| forces[worst] < -1e-12) {
                active.swap_remove(worst);
                continue;
            }
            for (active, &force) in active.iter_mut().zip(forces) {
                active.force = force;
            }
            self.combine(free, active, curvatures, amplitudes);
            let max_displacement = self.update_displacements(rod, shape)?;
            let Some(violated) = self.violation(rod, shape, contacts, active) else {
                // Sylvester's law of inertia: at a minimum, the system has exactly this number of positive eigenvalues.
                // With friction the system is not symmetric, and this is the continuation from small coefficients.
                let stays = positive + self.bordered.negative == count + expected_positive;
                return (stays || !is_newton).then_some(Step { max_displacement, is_newton });
            };
            let own = active.iter().find(|active| active.contact == violated);
            let (columns, edges) = if let Some(&Active { edge, push, .. }) = own {
                ([push.column, push.other], [Some(edge.opposite()), None])
            } else {
                let columns = self.add_contact(rod, shape, &contacts[violated])?;
                // A contact sticks first. Otherwise a whisker that locks would find no force.
                (columns, [Some(Edge::Left), (self.friction > 0.0).then_some(Edge::Right)])
            };
            active.extend(edges.into_iter().flatten().map(|edge| self.activate(violated, edge, columns)));
        }
        None
    }

    /// Adds the columns of a contact: the normal, and the slip if there is friction.
    fn add_contact(&mut self, rod: &Rod, shape: &Shape, contact: &Contact) -> Option<[usize; 2]> {
        let normal = self.bordered.add(|column| displacement_gradient(rod, shape, contact, contact.normal, column))?;
        if self.friction == 0.0 {
            return Some([normal; 2]);
        }
        let slip = self.bordered.add(|column| {
            displacement_gradient(rod, shape, contact, perpendicular(contact.normal), column);
            column[contact.link] -= contact.radius;
        })?;
        Some([normal, slip])
    }

    fn activate(&self, contact: usize, edge: Edge, [normal, slip]: [usize; 2]) -> Active {
        let push = Weighted { column: normal, other: slip, share: edge.sign() * self.friction };
        Active { contact, edge, force: 0.0, push }
    }

    /// Returns the inactive contact that penetrates deepest after the step, or the sliding contact whose slip is
    /// opposite to its direction and largest. `None` if there is neither.
    fn violation(&self, rod: &Rod, shape: &Shape, contacts: &[Contact], active: &[Active]) -> Option<usize> {
        let violation = |(index, contact): (usize, &Contact)| {
            let mut edges = active.iter().filter(|active| active.contact == index);
            let displacement = || self.displacement_at(rod, shape, contact);
            match (edges.next(), edges.next()) {
                (None, _) => Some((index, contact.gap + contact.normal.dot(&displacement()))),
                (Some(slides), None) if self.friction > 0.0 => {
                    let rolled = contact.radius * self.rotations[contact.link];
                    let slip = contact.slip + perpendicular(contact.normal).dot(&displacement()) - rolled;
                    Some((index, -slides.edge.sign() * slip))
                }
                _ => None,
            }
        };
        let deepest = contacts.iter().enumerate().filter_map(violation).min_by(|one, two| one.1.total_cmp(&two.1));
        deepest.filter(|&(_, gap)| gap < -TOLERANCE).map(|(index, _)| index)
    }

    /// Selects the edge to remove from a linearly dependent active set, for example three contacts of one link with
    /// a circle. The edge that was added last takes over forces of the others. Returns the edge whose force
    /// reaches zero first, or `None` if no force decreases.
    ///
    /// Source: the dual step of Goldfarb and Idnani, Mathematical Programming 27 (1983), 1.
    fn redundant_edge(&mut self, active: &[Active], contacts: &[Contact]) -> Option<usize> {
        let (last, others) = active.split_last()?;
        self.kkt.size = others.len();
        for (row, edge) in others.iter().enumerate() {
            let (held, _) = held(active, edge, contacts);
            self.kkt.rhs[row] = self.product(held, last.push);
            for (at, other) in others.iter().enumerate() {
                self.kkt.matrix[row][at] = self.product(held, other.push);
            }
        }
        let (shares, _) = self.kkt.solve()?;
        let taken = (0..others.len()).filter(|&at| shares[at] > MIN_SHARE);
        taken.min_by(|&a, &b| (active[a].force / shares[a]).total_cmp(&(active[b].force / shares[b])))
    }

    /// The product `lᵀ T⁻¹ r` of two weighted columns.
    fn product(&self, left: Weighted, right: Weighted) -> f64 {
        let products = &self.bordered.products;
        let with_right = |row: usize| {
            let own = products[row][right.column];
            if right.share == 0.0 { own } else { own + right.share * products[row][right.other] }
        };
        let own = with_right(left.column);
        if left.share == 0.0 { own } else { own + left.share * with_right(left.other) }
    }

    /// Assembles the diagonal of the Hessian: joint stiffnesses and the geometric stiffness of contact forces.
    fn assemble_hessian(&mut self, rod: &Rod, shape: &Shape, contacts: &[Contact]) {
        self.diagonal.clone_from(&rod.diagonal);
        for contact in contacts.iter().filter(|contact| contact.force.acts()) {
            let force = self.force(contact);
            for (entry, along) in self.diagonal.iter_mut().zip(&shape.tangents).take(contact.link) {
                *entry += rod.link * force.dot(along);
            }
            let own = &mut self.diagonal[contact.link];
            // The force on the first link rotates with it about its near end.
            if !(contact.link == 0 && matches!(contact.curvature, GapCurvature::Rolling(_))) {
                *own += contact.along * force.dot(&shape.tangents[contact.link]);
            }
            if let GapCurvature::Rolling(aside) = contact.curvature {
                *own -= force.dot(&shape.left(contact.link)) * aside;
            }
        }
    }

    /// The force of a contact on the whisker in the previous step (N, world frame).
    fn force(&self, contact: &Contact) -> Vector2 {
        contact.force.normal() * contact.normal
            + contact.force.tangential(self.friction) * perpendicular(contact.normal)
    }

    /// The direction of an edge of the friction cone (world frame). Its normal component is 1.
    pub(super) fn direction(&self, edge: Edge, contact: &Contact) -> Vector2 {
        contact.normal + edge.sign() * self.friction * perpendicular(contact.normal)
    }

    /// Adds the border columns for the curvature of a gap. The flag is true if they add a positive eigenvalue.
    fn add_curvature(
        &mut self,
        rod: &Rod,
        shape: &Shape,
        contact: &Contact,
    ) -> Option<([Option<CurvatureColumn>; 2], bool)> {
        let link = contact.link;
        let (normal, tangential) = (contact.force.normal(), contact.force.tangential(self.friction));
        match contact.curvature {
            GapCurvature::None => Some(([None; 2], false)),
            // The near end of the first link is fixed. This link rotates about it without sliding.
            GapCurvature::Rolling(_) if link == 0 => Some(([None; 2], false)),
            GapCurvature::Circling(curvature) => {
                let tangent = perpendicular(contact.normal);
                let column = self.bordered.add(|column| displacement_gradient(rod, shape, contact, tangent, column))?;
                let inverse = -(normal * curvature).recip();
                let push = Weighted { column, other: column, share: -tangential / normal };
                Some(([Some(CurvatureColumn { column, push, partner: column, inverse }), None], inverse > 0.0))
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
                let inverse = (normal * contact.normal.dot(&shape.left(link))).recip();
                let pair = [(slide, turn, tangential * inverse), (turn, slide, 0.0)];
                let column = |(column, partner, share)| {
                    let push = Weighted { column, other: column, share };
                    Some(CurvatureColumn { column, push, partner, inverse })
                };
                Some((pair.map(column), true))
            }
        }
    }

    /// Assembles the equations of the contact forces and of the amplitudes of the curvature columns. Returns `None` if
    /// there are too many.
    fn fill_kkt(
        &mut self,
        free: usize,
        active: &[Active],
        contacts: &[Contact],
        curvature_columns: &[CurvatureColumn],
    ) -> Option<()> {
        let forces = active.len();
        let size = forces + curvature_columns.len();
        if size > MAX_COLUMNS {
            return None;
        }
        self.kkt.size = size;
        let single = |column: usize| Weighted { column, other: column, share: 0.0 };
        let free = single(free);
        for (row, edge) in active.iter().enumerate() {
            let (held, gap) = held(active, edge, contacts);
            self.kkt.rhs[row] = -gap - self.product(held, free);
            for (at, other) in active.iter().enumerate() {
                self.kkt.matrix[row][at] = self.product(held, other.push);
            }
            for (at, curve) in curvature_columns.iter().enumerate() {
                self.kkt.matrix[row][forces + at] = -self.product(held, curve.push);
                self.kkt.matrix[forces + at][row] = -self.product(single(curve.column), edge.push);
            }
        }
        for (row, curve) in curvature_columns.iter().enumerate() {
            self.kkt.rhs[forces + row] = self.product(single(curve.column), free);
            for (at, other) in curvature_columns.iter().enumerate() {
                let own = if other.column == curve.partner { curve.inverse } else { 0.0 };
                self.kkt.matrix[forces + row][forces + at] = self.product(single(curve.column), other.push) + own;
            }
        }
        Some(())
    }

    /// Computes the rotations: the free solution plus weighted solutions of other columns.
    fn combine(&mut self, free: usize, active: &[Active], curvature_columns: &[CurvatureColumn], amplitudes: &[f64]) {
        self.rotations.clear();
        self.rotations.extend_from_slice(self.bordered.solved(free));
        let forces = active.iter().map(|active| (active.push, active.force));
        let curvatures = curvature_columns.iter().zip(amplitudes).map(|(curve, amplitude)| (curve.push, -amplitude));
        for (push, weight) in forces.chain(curvatures) {
            for (column, share) in push.terms() {
                for (turn, solved) in self.rotations.iter_mut().zip(self.bordered.solved(column)) {
                    *turn += share * weight * solved;
                }
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
