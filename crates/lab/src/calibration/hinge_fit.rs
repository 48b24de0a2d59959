//! Stiffness of a base hinge from contacts at known positions.

use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::math;
use vibrissa_runtime::percept::TipTable;
use vibrissa_runtime::rig::Whisker;
use vibrissa_world::geometry::{Vector2, rotate, unit};

/// Statics of a whisker with a hinge of any stiffness.
pub(super) struct HingeFit {
    table: TipTable,
    tip_radius: f64,
    /// The stiffness of the table (N m/rad).
    stiffness: f64,
}

/// The least and the greatest tried stiffness, as multiples of that of the rig.
const SPAN: (f64, f64) = (0.2, 5.0);
/// A result within this difference of the logarithm from an end of the range counts as at the end.
const AT_END: f64 = 1e-3;
/// Number of tried values in that range, and of golden-section steps, which reduce the interval between neighbours to a
/// millionth.
const TRIED_VALUES: u32 = 16;
const STEPS: usize = 27;
/// Directions of the normal (degrees) among which the best is searched if it is not known.
const DIRECTIONS: std::ops::RangeInclusive<u32> = 60..=220;
/// Steps of the Gauss-Newton method from the best direction.
const ITERATIONS: usize = 4;

impl HingeFit {
    pub(super) fn new(whisker: &Whisker) -> Self {
        Self {
            table: TipTable::new(whisker),
            tip_radius: whisker.shaft.radius_at(1.0),
            stiffness: whisker.hinge.stiffness,
        }
    }

    /// The stiffness (N m/rad) with the least error for tip contacts, bent to the left. `None` at an end of the range.
    pub(super) fn fit(&self, sets: &[ContactSet]) -> Option<f64> {
        // A set beyond the range of the statics counts as an error of a centimetre.
        let worst = 1e-2;
        let cost = |log: f64| -> f64 {
            let stiffness = self.stiffness * math::exp(log);
            sets.iter().map(|set| math::square(self.error(set, stiffness).unwrap_or(worst).min(worst))).sum()
        };
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        // With a wrong hinge, all sets beyond the range have the same error, and the gradient is zero.
        let step = math::ln(SPAN.1 / SPAN.0) / f64::from(TRIED_VALUES);
        let tried = (0..=TRIED_VALUES).map(|index| math::ln(SPAN.0) + step * f64::from(index));
        let best = tried.map(|log| (log, cost(log))).min_by(|(_, a), (_, b)| a.total_cmp(b))?.0;
        let (mut low, mut high) = ((best - step).max(math::ln(SPAN.0)), (best + step).min(math::ln(SPAN.1)));
        let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
        let (mut cost_a, mut cost_b) = (cost(a), cost(b));
        for _ in 0..STEPS {
            if cost_a < cost_b {
                (high, b, cost_b) = (b, a, cost_a);
                a = high - ratio * (high - low);
                cost_a = cost(a);
            } else {
                (low, a, cost_a) = (a, b, cost_b);
                b = low + ratio * (high - low);
                cost_b = cost(b);
            }
        }
        let found = f64::midpoint(low, high);
        let is_within = found - math::ln(SPAN.0) > AT_END && math::ln(SPAN.1) - found > AT_END;
        is_within.then(|| self.stiffness * math::exp(found))
    }

    /// Distance between the position of a set and the computed position (m), with its normal, or with the best normal
    /// if it is not known.
    pub(super) fn error(&self, set: &ContactSet, stiffness: f64) -> Option<f64> {
        let off = |normal| Some((self.position(set.base_angle, normal, stiffness)? - set.contact_base).norm());
        if let Some(normal) = set.normal {
            return off(normal);
        }
        let normals = DIRECTIONS.step_by(4).map(|degrees| f64::from(degrees).to_radians());
        let tried = normals.filter_map(|normal| Some((normal, off(normal)?)));
        let (mut normal, mut least) = tried.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        for _ in 0..ITERATIONS {
            let turn = 1e-5;
            let here = self.position(set.base_angle, normal, stiffness)?;
            let slope = (self.position(set.base_angle, normal + turn, stiffness)? - here) / turn;
            normal -= slope.dot(&(here - set.contact_base)) / slope.norm_squared();
            least = off(normal)?.min(least);
        }
        Some(least)
    }

    /// The computed position of the tip (m, frame of the base) on a surface with this normal (rad), for a hinge of this
    /// stiffness.
    fn position(&self, base_angle: f64, normal: f64, stiffness: f64) -> Option<Vector2> {
        // The same moment rotates another hinge by another angle, and the bent shaft with it.
        let as_in_table = base_angle * stiffness / self.stiffness;
        let turn = base_angle - as_in_table;
        let tip = self.table.at(as_in_table, normal - turn)?.tip_base;
        Some(rotate(tip, turn) - self.tip_radius * unit(normal))
    }
}
