//! The calibrations of drawn arrays: how often the 95 % ellipsoid has the true parameters.

use crate::json::Json;
use crate::results::{NoKey, number, value};

/// The calibrations of arrays that are drawn from the ranges of tolerances, in the quasi-static simulator.
pub(super) const CALIBRATIONS: &str =
    "calibrate --self --mismatch scenarios/mismatch/array.yaml --simulator quasistatic --arrays 100 --json";

/// The shares of arrays with their true parameters within the ellipsoids that are right.
const RIGHT: [f64; 2] = [0.90, 0.99];

/// The counts of a campaign of calibrations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Ellipsoids {
    /// Number of whiskers.
    pub(super) whiskers: u64,
    /// Those that were accepted.
    pub(super) accepted: u64,
    /// Those of the accepted ones whose true parameters are within the ellipsoid.
    pub(super) within: u64,
    /// Most touches of a whisker.
    pub(super) touches: u64,
}

impl Ellipsoids {
    /// The counts, from the output of the program.
    pub(super) fn of(whiskers: &[Json]) -> Result<Self, NoKey> {
        whiskers.iter().try_fold(Self::default(), |counts, whisker| {
            let verdict = value(whisker, "within_ellipsoid")?;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
            let touches = number(whisker, "touches")? as u64;
            Ok(Self {
                whiskers: counts.whiskers + 1,
                accepted: counts.accepted + u64::from(*verdict != Json::Null),
                within: counts.within + u64::from(*verdict == Json::Bool(true)),
                touches: counts.touches.max(touches),
            })
        })
    }

    /// True if the share of the ellipsoids that have the true parameters is from 90 to 99 %.
    pub(super) fn are_right(&self) -> bool {
        let share = self.within as f64 / self.accepted.max(1) as f64;
        (RIGHT[0]..=RIGHT[1]).contains(&share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(within: usize, outside: usize, refused: usize) -> Option<Ellipsoids> {
        let whisker = |verdict: &str| format!(r#"{{"within_ellipsoid": {verdict}, "touches": 17}}"#);
        let all = [("true", within), ("false", outside), ("null", refused)];
        let all: Vec<_> = all.iter().flat_map(|(verdict, count)| vec![whisker(verdict); *count]).collect();
        Ellipsoids::of(Json::read(&format!("[{}]", all.join(",")))?.items()).ok()
    }

    #[test]
    fn refused_whiskers_do_not_count_and_too_many_or_too_few_within_are_wrong() {
        let right = Ellipsoids { whiskers: 22, accepted: 20, within: 19, touches: 17 };
        assert_eq!(counts(19, 1, 2), Some(right));
        assert!(right.are_right());
        assert!(counts(17, 3, 0).is_some_and(|counts| !counts.are_right()));
        assert!(counts(200, 1, 0).is_some_and(|counts| !counts.are_right()));
        assert!(counts(0, 0, 5).is_some_and(|counts| !counts.are_right()));
        let unknown = Json::read(r#"[{"touches": 3}]"#).unwrap_or(Json::Null);
        assert!(Ellipsoids::of(unknown.items()).is_err());
    }
}
