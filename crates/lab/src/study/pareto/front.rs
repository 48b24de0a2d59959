//! Pareto-optimal points.

/// True for each Pareto-optimal point, such as a cost and an error. No other point is at most as large in all coordinates,
/// and smaller in one. `None` and points that are not numbers are never Pareto-optimal.
#[must_use]
pub fn front<const N: usize>(points: &[Option<[f64; N]>]) -> Vec<bool> {
    let known = |point: &Option<[f64; N]>| point.filter(|point| point.iter().all(|value| value.is_finite()));
    let is_better = |one: [f64; N], other: [f64; N]| {
        let pairs = || one.iter().zip(other);
        pairs().all(|(a, b)| *a <= b) && pairs().any(|(a, b)| *a < b)
    };
    let is_on = |point| !points.iter().filter_map(known).any(|other| is_better(other, point));
    points.iter().map(|point| known(point).is_some_and(is_on)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_point_cheaper_or_more_accurate_than_all_others_is_pareto_optimal() {
        let points = [Some([1.0, 5.0]), Some([2.0, 3.0]), Some([2.0, 4.0]), Some([3.0, 3.0]), Some([9.0, 1.0]), None];
        assert_eq!(front(&points), [true, true, false, false, true, false]);
        assert_eq!(front(&[Some([1.0, 1.0]), Some([1.0, 1.0]), Some([f64::NAN, 0.0])]), [true, true, false]);
    }

    #[test]
    fn a_point_that_is_best_by_a_third_coordinate_is_pareto_optimal() {
        let points = [Some([1.0, 1.0, 3.0]), Some([2.0, 2.0, 1.0]), Some([2.0, 2.0, 3.0])];
        assert_eq!(front(&points), [true, true, false]);
    }

    proptest! {
        /// In the order of their cost, the errors of Pareto-optimal points decrease.
        #[test]
        fn errors_of_pareto_optimal_points_decrease_with_cost(points in prop::collection::vec([0.0..9.0_f64, 0.0..9.0_f64].prop_map(Some), 1..40)) {
            let on = front(&points);
            let mut chosen: Vec<[f64; 2]> =
                points.iter().zip(&on).filter(|(_, on)| **on).filter_map(|(point, _)| *point).collect();
            chosen.sort_by(|a, b| a[0].total_cmp(&b[0]));
            prop_assert!(chosen.windows(2).all(|pair| pair[1][1] < pair[0][1]));
            // Every other point is dominated by a Pareto-optimal one.
            for [cost, error] in points.iter().zip(&on).filter(|(_, on)| !**on).filter_map(|(point, _)| *point) {
                prop_assert!(chosen.iter().any(|one| one[0] <= cost && one[1] <= error));
            }
        }
    }
}
