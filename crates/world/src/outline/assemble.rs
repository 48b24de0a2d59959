//! Assembly of loose pieces to closed outlines.

use std::collections::HashMap;

use rstar::primitives::GeomWithData;
use rstar::{PointDistance, RTree};

use crate::geometry::{Piece, Point2};

use super::{OutlineError, OutlineFault, TOLERANCE};

/// The pieces of an outline, and the line of the first.
type Loop = (Vec<Piece>, Option<usize>);

/// A piece with its line in the file, if that is known.
pub(super) type LoosePiece = (Piece, Option<usize>);

/// Assembles loose pieces to outlines, in the order of travel, with the line of the first piece. The pieces may have
/// any order and direction. Two ends at the same point are joined. Other ends are joined with the nearest within the
/// tolerance.
///
/// # Errors
/// The position of an end without a neighbour, or with more than one.
pub(super) fn assemble(pieces: &[LoosePiece]) -> Result<Vec<Loop>, OutlineError> {
    let nodes = Nodes::of(pieces)?;
    let mut is_used: Vec<bool> =
        pieces.iter().zip(&nodes.ends).map(|((piece, _), &ends)| is_degenerate(piece, ends)).collect();
    let mut outlines = Vec::new();
    for (index, &(first, line)) in pieces.iter().enumerate() {
        if is_used[index] {
            continue;
        }
        let mut outline = vec![first];
        is_used[index] = true;
        // Continues at the end of the last piece until no unused piece starts there.
        let mut node = nodes.ends[index][1];
        while let Some(next) = nodes.pieces[node].into_iter().flatten().find(|&piece| !is_used[piece]) {
            is_used[next] = true;
            let is_forward = nodes.ends[next][0] == node;
            outline.push(if is_forward { pieces[next].0 } else { pieces[next].0.reversed() });
            node = nodes.ends[next][usize::from(is_forward)];
        }
        outlines.push((outline, line));
    }
    Ok(outlines)
}

/// True if a piece is so short that both ends are one node. It can be omitted without loss.
fn is_degenerate(piece: &Piece, [start, end]: [usize; 2]) -> bool {
    start == end && piece.length() <= 2.0 * TOLERANCE
}

/// The nodes at which pieces meet.
struct Nodes {
    /// The nodes of the start and the end of each piece.
    ends: Vec<[usize; 2]>,
    /// The two pieces of each node; the same piece twice if it is a loop.
    pieces: Vec<[Option<usize>; 2]>,
}

impl Nodes {
    fn of(pieces: &[LoosePiece]) -> Result<Self, OutlineError> {
        let (places, ends) = places(pieces);
        let same = merged(&places, &ends);
        let mut nodes = Self { ends: Vec::with_capacity(pieces.len()), pieces: vec![[None; 2]; places.len()] };
        for (index, ((piece, line), ends)) in pieces.iter().zip(ends).enumerate() {
            let ends = ends.map(|end| same[end]);
            nodes.ends.push(ends);
            if is_degenerate(piece, ends) {
                continue;
            }
            for (end, at) in ends.into_iter().zip([piece.start(), piece.end()]) {
                match nodes.pieces.get_mut(end) {
                    Some([free @ None, _] | [_, free @ None]) => *free = Some(index),
                    _ => return Err(OutlineFault::Branches { at }.at(*line)),
                }
            }
        }
        nodes.check(pieces, &places)?;
        Ok(nodes)
    }

    /// Reports an end without a neighbour, together with the nearest other such end.
    fn check(&self, pieces: &[LoosePiece], places: &[Point2]) -> Result<(), OutlineError> {
        let alone = self.pieces.iter().zip(places).filter_map(|(met, &place)| match met {
            [Some(piece), None] => Some((place, *piece)),
            _ => None,
        });
        let Some((from, piece)) = alone.clone().next() else { return Ok(()) };
        let others = alone.skip(1).map(|(place, _)| place);
        let nearest = others.min_by(|a, b| (a - from).norm().total_cmp(&(b - from).norm()));
        Err(OutlineFault::Open { from, to: nearest.unwrap_or(from) }.at(pieces[piece].1))
    }
}

/// The distinct positions of ends, and the indices of those of each piece.
fn places(pieces: &[LoosePiece]) -> (Vec<Point2>, Vec<[usize; 2]>) {
    let mut known: HashMap<[u64; 2], usize> = HashMap::new();
    let mut places = Vec::new();
    let ends = pieces.iter().map(|(piece, _)| {
        [piece.start(), piece.end()].map(|place| {
            // Negative zero equals zero.
            let bits = [place.x, place.y].map(|number| (number + 0.0).to_bits());
            *known.entry(bits).or_insert_with(|| {
                places.push(place);
                places.len() - 1
            })
        })
    });
    let ends = ends.collect();
    (places, ends)
}

/// The node of each position. A position at which exactly two ends coincide is a node of its own, however near others
/// are. Any other position belongs to the nearest such node within the tolerance.
fn merged(places: &[Point2], ends: &[[usize; 2]]) -> Vec<usize> {
    let mut counts = vec![0_usize; places.len()];
    for &end in ends.as_flattened() {
        counts[end] += 1;
    }
    let mut tree: RTree<GeomWithData<[f64; 2], usize>> = RTree::new();
    let node = |(index, (place, count)): (usize, (&Point2, usize))| {
        let place = [place.x, place.y];
        if count == 2 {
            return index;
        }
        let near = tree.locate_within_distance(place, TOLERANCE * TOLERANCE);
        if let Some(node) = near.min_by(|a, b| a.distance_2(&place).total_cmp(&b.distance_2(&place))) {
            return node.data;
        }
        tree.insert(GeomWithData::new(place, index));
        index
    };
    places.iter().zip(counts).enumerate().map(node).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;
    use vibrissa_runtime::math;

    use super::*;
    use crate::geometry::{Contour, regular_polygon};

    /// The sides of two polygons.
    fn sides() -> Vec<LoosePiece> {
        let polygons =
            [(0.0, 5), (1.0, 7)].map(|(x, sides)| regular_polygon(Point2::new(x, 0.0), 0.3, sides, 0.1).unwrap());
        polygons.iter().flat_map(Contour::pieces).zip(1..).map(|(&side, line)| (side, Some(line))).collect()
    }

    proptest! {
        #[test]
        fn sides_in_any_order_and_direction_are_joined(
            order in Just(sides()).prop_shuffle(), turned in prop::collection::vec(any::<bool>(), 12),
            moved in prop::collection::vec(-2e-7..2e-7_f64, 12),
        ) {
            let moved = moved.into_iter().map(|by| nalgebra::Vector2::new(by, -by));
            let loose: Vec<LoosePiece> = order
                .into_iter()
                .zip(turned)
                .zip(moved)
                .map(|(((side, line), turned), by)| {
                    let side = Piece::segment(side.start() + by, side.end() + by);
                    (if turned { side.reversed() } else { side }, line)
                })
                .collect();
            let mut found = assemble(&loose).unwrap();
            found.sort_by_key(|(pieces, _)| pieces.len());
            prop_assert_eq!(found.iter().map(|(pieces, _)| pieces.len()).collect::<Vec<_>>(), vec![5, 7]);
            for (pieces, _) in found {
                let next = pieces.iter().cycle().skip(1);
                prop_assert!(pieces.iter().zip(next).all(|(a, b)| (b.start() - a.end()).norm() < 1e-6));
            }
        }
    }

    proptest! {
        #[test]
        fn sides_that_meet_exactly_are_joined_however_short_they_are(
            order in Just((0..24).collect::<Vec<usize>>()).prop_shuffle(),
            turned in prop::collection::vec(any::<bool>(), 24),
        ) {
            // The corners are 0.7 µm apart, so that each has two others within the tolerance.
            let turn = std::f64::consts::TAU / 24.0;
            let radius = 0.35e-6 / math::sin(0.5 * turn);
            let angles = (0_u8..24).map(|k| turn * f64::from(k));
            let corners: Vec<Point2> =
                angles.map(|angle| Point2::new(radius * math::cos(angle), radius * math::sin(angle))).collect();
            let loose: Vec<LoosePiece> = order
                .into_iter()
                .zip(turned)
                .map(|(k, turned)| {
                    let side = Piece::segment(corners[k], corners[(k + 1) % 24]);
                    (if turned { side.reversed() } else { side }, None)
                })
                .collect();
            let found = assemble(&loose).unwrap();
            prop_assert_eq!(found.len(), 1);
            let sides = &found[0].0;
            prop_assert_eq!(sides.len(), 24);
            let next = sides.iter().cycle().skip(1);
            prop_assert!(sides.iter().zip(next).all(|(a, b)| b.start() == a.end()));
        }
    }

    #[test]
    fn an_end_alone_and_a_third_end_are_told() {
        let mut loose = sides();
        let (gone, _) = loose.remove(2);
        let open = OutlineFault::Open { from: gone.start(), to: gone.end() };
        assert_eq!(assemble(&loose).unwrap_err(), open.at(Some(2)));
        let mut loose = sides();
        let (first, _) = loose[0];
        loose.push((Piece::segment(first.start(), Point2::new(2.0, 2.0)), Some(99)));
        assert_eq!(assemble(&loose).unwrap_err(), OutlineFault::Branches { at: first.start() }.at(Some(99)));
    }
}
