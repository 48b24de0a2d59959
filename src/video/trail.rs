//! The trail of a point.

use nalgebra::Point3;

/// The least distance (m) between two points of a new trail. Lines that are shorter than a pixel have gaps.
const SPACING: f64 = 4e-3;
/// The largest number of points of a trail. Beyond it, the spacing doubles.
const MOST_POINTS: usize = 1000;
/// A step that is longer than this (m) is no part of the trail, such as that from one contour to the next.
const GAP: f64 = 0.01;

/// The trail of a point, in pieces without gaps.
#[derive(Debug, Clone)]
pub(super) struct Trail {
    pieces: Vec<Vec<Point3<f64>>>,
    spacing: f64,
    /// The newest position.
    newest: Option<Point3<f64>>,
}

impl Default for Trail {
    fn default() -> Self {
        Self { pieces: Vec::new(), spacing: SPACING, newest: None }
    }
}

impl Trail {
    /// Adds a position (m, world frame). One that is not finite is left out.
    pub(super) fn add(&mut self, position: Point3<f64>) {
        if !position.iter().all(|coordinate| coordinate.is_finite()) {
            return;
        }
        let before = self.newest.replace(position);
        let has_gap = before.is_none_or(|before| (position - before).norm() > GAP);
        if has_gap && let Some(piece) = self.pieces.last_mut() {
            piece.extend(before.filter(|before| piece.last() != Some(before)));
        }
        match self.pieces.last_mut() {
            Some(piece) if !has_gap => {
                if piece.last().is_none_or(|last| (position - last).norm() >= self.spacing) {
                    piece.push(position);
                }
            }
            _ => self.pieces.push(vec![position]),
        }
        if self.pieces.iter().map(Vec::len).sum::<usize>() > MOST_POINTS {
            self.thin();
        }
    }

    /// The pieces, each with its points in order. The last piece ends at the newest position.
    pub(super) fn pieces(&self) -> Vec<Vec<Point3<f64>>> {
        let mut pieces = self.pieces.clone();
        if let Some(last) = pieces.last_mut() {
            last.extend(self.newest.filter(|newest| last.last() != Some(newest)));
        }
        pieces
    }

    /// Keeps every second point. A piece of one point is given up, except for the last one, which may go on.
    fn thin(&mut self) {
        self.spacing *= 2.0;
        let last = self.pieces.pop();
        self.pieces.retain(|piece| piece.len() > 1);
        self.pieces.extend(last);
        for piece in &mut self.pieces {
            *piece = piece.iter().step_by(2).copied().collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_trail_of_any_length_has_few_points_and_all_of_them_were_visited(
            steps in prop::collection::vec((-0.012..0.012, -0.012..0.012), 1..4000)
        ) {
            let mut trail = Trail::default();
            let mut visited = Vec::new();
            let mut position = Point3::origin();
            for (x, y) in steps {
                position += nalgebra::Vector3::new(x, y, 0.0);
                visited.push(position);
                trail.add(position);
            }
            let points = trail.pieces().concat();
            prop_assert!(points.len() <= MOST_POINTS + 1, "{} points", points.len());
            prop_assert!(points.iter().all(|point| visited.contains(point)));
            prop_assert!(points.is_empty() || points.last() == visited.last());
        }
    }

    #[test]
    fn a_trail_ends_at_a_gap_and_begins_behind_it() {
        let mut trail = Trail::default();
        for x in [0.0, 0.005, 0.01, 0.012, 0.1, 0.105, f64::NAN, 0.107] {
            trail.add(Point3::new(x, 0.0, 0.0));
        }
        let pieces = trail.pieces();
        let pieces: Vec<Vec<f64>> = pieces.iter().map(|piece| piece.iter().map(|point| point.x).collect()).collect();
        assert_eq!(pieces, [vec![0.0, 0.005, 0.01, 0.012], vec![0.1, 0.105, 0.107]]);
    }

    #[test]
    fn a_long_straight_trail_is_drawn_from_its_start_to_its_end() {
        let mut trail = Trail::default();
        for step in 0..20_000 {
            trail.add(Point3::new(0.002 * f64::from(step), 0.0, 0.0));
        }
        let pieces = trail.pieces();
        assert_eq!(pieces.len(), 1);
        let [first, .., last] = pieces[0][..] else { panic!("{pieces:?}") };
        assert!(first.x == 0.0 && (last.x - 39.998).abs() < 1e-9, "{first} to {last}");
    }
}
