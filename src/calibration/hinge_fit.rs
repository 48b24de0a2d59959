//! The stiffness of a base hinge, from touches in known places.

use crate::geometry::{Vector2, rotate, unit};
use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::percept::TipTable;
use vibrissa_runtime::rig::Whisker;

/// The mechanics of a whisker, for hinges of any stiffness.
pub(super) struct HingeFit {
    table: TipTable,
    tip_radius: f64,
    /// The stiffness that the table is for (N m/rad).
    stiffness: f64,
}

/// The least and the greatest stiffness that is tried, over that of the rig.
const SPAN: (f64, f64) = (0.2, 5.0);
/// Logarithms as near to those of an end as this are at the end.
const AT_END: f64 = 1e-3;
/// Values that are tried over that span, and steps of the golden section, which narrows what is between neighbours to a millionth.
const TRIES: u32 = 16;
const STEPS: usize = 27;
/// Directions of the normal (degrees) among which the nearest is sought where none is known.
const DIRECTIONS: std::ops::RangeInclusive<u32> = 60..=220;
/// Steps of the Gauss-Newton method from there.
const ITERATIONS: usize = 4;

impl HingeFit {
    pub(super) fn new(whisker: &Whisker) -> Self {
        Self {
            table: TipTable::new(whisker),
            tip_radius: whisker.shaft.radius_at(1.0),
            stiffness: whisker.hinge.stiffness,
        }
    }

    /// The stiffness (N m/rad) by which the mechanics come nearest to sets of touches by the tip, bent to the left. `None` if that is
    /// beyond all that are tried.
    pub(super) fn fit(&self, sets: &[ContactSet]) -> Option<f64> {
        // A set beyond the mechanics is as bad as one that is off by a centimetre.
        let worst = 1e-2;
        let cost = |log: f64| -> f64 {
            let stiffness = self.stiffness * log.exp();
            sets.iter().map(|set| self.miss(set, stiffness).unwrap_or(worst).min(worst).powi(2)).sum()
        };
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        // With a hinge that is far off, sets beyond the mechanics all cost the same, and nothing says which way to go.
        let step = (SPAN.1 / SPAN.0).ln() / f64::from(TRIES);
        let tried = (0..=TRIES).map(|index| SPAN.0.ln() + step * f64::from(index));
        let best = tried.map(|log| (log, cost(log))).min_by(|(_, a), (_, b)| a.total_cmp(b))?.0;
        let (mut low, mut high) = ((best - step).max(SPAN.0.ln()), (best + step).min(SPAN.1.ln()));
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
        let is_within = found - SPAN.0.ln() > AT_END && SPAN.1.ln() - found > AT_END;
        is_within.then(|| self.stiffness * found.exp())
    }

    /// How far the place of a set is from where the mechanics have it (m): under its normal, or the nearest if that is not known.
    pub(super) fn miss(&self, set: &ContactSet, stiffness: f64) -> Option<f64> {
        let off = |normal| Some((self.place(set.base_angle, normal, stiffness)? - set.contact_base).norm());
        if let Some(normal) = set.normal {
            return off(normal);
        }
        let normals = DIRECTIONS.step_by(4).map(|degrees| f64::from(degrees).to_radians());
        let tried = normals.filter_map(|normal| Some((normal, off(normal)?)));
        let (mut normal, mut least) = tried.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        for _ in 0..ITERATIONS {
            let turn = 1e-5;
            let here = self.place(set.base_angle, normal, stiffness)?;
            let slope = (self.place(set.base_angle, normal + turn, stiffness)? - here) / turn;
            normal -= slope.dot(&(here - set.contact_base)) / slope.norm_squared();
            least = off(normal)?.min(least);
        }
        Some(least)
    }

    /// Where the tip touches (m, frame of the base) on a surface with this normal (rad), if the hinge has this stiffness.
    fn place(&self, base_angle: f64, normal: f64, stiffness: f64) -> Option<Vector2> {
        // The same moment turns another hinge by another angle, and the bent shaft with it.
        let as_in_table = base_angle * stiffness / self.stiffness;
        let turn = base_angle - as_in_table;
        let tip = self.table.at(as_in_table, normal - turn)?.tip_base;
        Some(rotate(tip, turn) - self.tip_radius * unit(normal))
    }
}
