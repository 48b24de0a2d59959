//! The recorded contours of surfaces, as pieces of ordered points.

use crate::geometry::{Point2, Vector2, perpendicular};

/// Most points of all pieces. At the first spacing they are 32 m of contour.
pub(super) const MOST_POINTS: usize = 16_384;
/// Most pieces.
pub(super) const MOST_PIECES: usize = 512;
/// Distance (m) of successive points before any thinning. It is one cell, and much less than the features that a tip can
/// follow.
const SPACING: f64 = 2e-3;
/// Distance (m) of two tips of one whisker that are on one piece. A tip that jumps farther has been lifted.
const CONTINUED: f64 = 8e-3;
/// Ticks without a recorded tip after which a piece has ended.
const INTERRUPTED: u8 = 6;

/// A recorded point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContourPoint {
    /// Position (m, world frame).
    pub place: Point2,
    /// Standard deviation (m) of the position from the surface.
    pub deviation: f64,
    /// Unit normal (world frame) on the side of the whisker. It is zero for the only point of a piece.
    pub normal: Vector2,
    /// Index in the policy of the whisker that recorded it.
    pub whisker: usize,
    /// Number of the piece. The points of a piece come in the order in which they were recorded.
    pub piece: usize,
}

/// A point in memory.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stored {
    pub(super) place: Point2,
    pub(super) normal: [f32; 2],
    pub(super) deviation: f32,
    pub(super) piece: u16,
}

/// One of the two ends of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    First,
    Last,
}

/// A piece of contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) whisker: u8,
    /// The first and the last point, and the unit vectors (world frame) at them that point out of the piece.
    pub(super) ends: [Stored; 2],
    pub(super) outwards: [Vector2; 2],
    /// Number of points.
    pub(super) count: u32,
    /// Length (m) along its points.
    pub(super) length: f64,
    /// Length (m) since the newest stored point.
    beyond: f64,
}

/// A whisker that is recording.
#[derive(Debug, Clone, Copy)]
struct Recording {
    piece: u16,
    newest: Point2,
    silent_for: u8,
}

/// All pieces, in memory of a fixed size.
///
/// When the memory is full, every second inner point of each piece is dropped and the spacing is doubled. A ring would forget
/// the oldest positions instead, but an old one is as good as a new one for routes, and ends are needed for targets.
#[derive(Debug, Clone)]
pub(super) struct Contours {
    points: Vec<Stored>,
    pieces: Vec<Piece>,
    recordings: Vec<Option<Recording>>,
    spacing: f64,
    /// Number of tips that were not recorded because no further piece was available.
    lost: u64,
}

impl Contours {
    /// Creates memory for so many whiskers.
    pub(super) fn new(whiskers: usize) -> Self {
        Self {
            points: Vec::with_capacity(MOST_POINTS),
            pieces: Vec::with_capacity(MOST_PIECES),
            recordings: vec![None; whiskers],
            spacing: SPACING,
            lost: 0,
        }
    }

    pub(super) fn points(&self) -> &[Stored] {
        &self.points
    }

    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Distance (m) of successive points.
    pub(super) fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Length (m) of all pieces.
    pub(super) fn length(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.length).sum()
    }

    /// Number of tips that found no memory for a further piece.
    pub(super) fn lost(&self) -> u64 {
        self.lost
    }

    /// The points as callers see them.
    pub(super) fn shown(&self) -> impl Iterator<Item = ContourPoint> + '_ {
        self.points.iter().map(|point| ContourPoint {
            place: point.place,
            deviation: f64::from(point.deviation),
            normal: Vector2::new(f64::from(point.normal[0]), f64::from(point.normal[1])),
            whisker: self.pieces.get(usize::from(point.piece)).map_or(0, |piece| usize::from(piece.whisker)),
            piece: usize::from(point.piece),
        })
    }

    /// The point of a piece at a path (m) before one of its ends, or the farthest one of a shorter piece.
    pub(super) fn before(&self, piece: usize, end: End, path: f64) -> Option<&Stored> {
        let own = self.points.iter().filter(|point| usize::from(point.piece) == piece);
        if end == End::First { at_path(own, path) } else { at_path(own.rev(), path) }
    }

    /// Ends a tick without a recorded tip of a whisker.
    pub(super) fn skip(&mut self, whisker: usize) {
        if let Some(slot) = self.recordings.get_mut(whisker)
            && let Some(recording) = slot
        {
            recording.silent_for += 1;
            if recording.silent_for > INTERRUPTED {
                *slot = None;
            }
        }
    }

    /// Records a tip (m, world frame) with its standard deviation (m). `base` (m, world frame) is on its free side. Returns the
    /// newest two stored points of its piece if this tip is stored and not the first one.
    pub(super) fn record(&mut self, whisker: usize, tip: Point2, deviation: f64, base: Point2) -> Option<[Stored; 2]> {
        let going = self.recordings.get(whisker).copied().flatten();
        let going = going.filter(|recording| (tip - recording.newest).norm() <= CONTINUED);
        let Some(recording) = going else {
            self.begin(whisker, tip, deviation);
            return None;
        };
        let index = usize::from(recording.piece);
        self.recordings[whisker] = Some(Recording { newest: tip, silent_for: 0, ..recording });
        let last = self.pieces[index].ends[1];
        let step = tip - last.place;
        self.pieces[index].length += step.norm() - self.pieces[index].beyond;
        self.pieces[index].beyond = step.norm();
        if step.norm() < self.spacing {
            return None;
        }
        if self.points.len() == MOST_POINTS {
            self.thin();
        }
        let along = step.normalize();
        let left = perpendicular(along);
        let normal = if left.dot(&(base - tip)) < 0.0 { -left } else { left };
        let stored = stored(tip, deviation, normal, recording.piece);
        self.points.push(stored);
        let piece = &mut self.pieces[index];
        (piece.count, piece.beyond, piece.ends[1], piece.outwards[1]) = (piece.count + 1, 0.0, stored, along);
        if piece.count == 2 {
            // The first point has no direction of its own.
            piece.outwards[0] = -along;
            piece.ends[0].normal = stored.normal;
            if let Some(first) =
                self.points.iter_mut().rev().find(|point| point.piece == recording.piece && point.place == last.place)
            {
                first.normal = stored.normal;
            }
        }
        Some([last, stored])
    }

    /// Begins a piece.
    fn begin(&mut self, whisker: usize, tip: Point2, deviation: f64) {
        let Some(slot) = self.recordings.get_mut(whisker) else { return };
        *slot = None;
        if self.points.len() == MOST_POINTS {
            self.thin();
        }
        let (Ok(number), true) = (u16::try_from(self.pieces.len()), self.pieces.len() < MOST_PIECES) else {
            self.lost += 1;
            return;
        };
        let first = stored(tip, deviation, Vector2::zeros(), number);
        self.points.push(first);
        self.pieces.push(Piece {
            whisker: u8::try_from(whisker).unwrap_or(u8::MAX),
            ends: [first; 2],
            outwards: [Vector2::zeros(); 2],
            count: 1,
            length: 0.0,
            beyond: 0.0,
        });
        self.recordings[whisker] = Some(Recording { piece: number, newest: tip, silent_for: 0 });
    }

    /// Drops every second inner point of each piece.
    fn thin(&mut self) {
        let mut seen = [0_u32; MOST_PIECES];
        let pieces = &self.pieces;
        self.points.retain(|point| {
            let index = usize::from(point.piece);
            let Some((seen, piece)) = seen.get_mut(index).zip(pieces.get(index)) else { return false };
            *seen += 1;
            *seen % 2 == 1 || *seen == piece.count
        });
        for piece in &mut self.pieces {
            // The first and each second one after it, and the last one.
            piece.count = piece.count / 2 + 1;
        }
        self.spacing *= 2.0;
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a direction and a standard deviation need few digits")]
fn stored(place: Point2, deviation: f64, normal: Vector2, piece: u16) -> Stored {
    Stored { place, normal: [normal.x as f32, normal.y as f32], deviation: deviation as f32, piece }
}

/// The point at a path (m) from the first one, or the last one.
fn at_path<'a>(mut points: impl Iterator<Item = &'a Stored>, path: f64) -> Option<&'a Stored> {
    let mut at = points.next()?;
    let mut left = path;
    for point in points {
        if left <= 0.0 {
            break;
        }
        left -= (point.place - at.place).norm();
        at = point;
    }
    Some(at)
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::unit;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn pieces_keep_their_order_their_ends_and_their_length(
            walks in prop::collection::vec((0_usize..2, 1_usize..60_000, -3.0..3.0_f64, 0.2e-3..4e-3_f64), 1..6),
        ) {
            let mut contours = Contours::new(2);
            let mut expected = Vec::new();
            for (index, &(whisker, ticks, direction, step)) in walks.iter().enumerate() {
                // Each walk is far from the others.
                let start = Point2::new(1000.0 * index as f64, 0.0);
                for tick in 0..ticks {
                    let tip = start + unit(direction) * (step * tick as f64);
                    contours.record(whisker, tip, 1e-4, tip + perpendicular(unit(direction)));
                }
                expected.push((start, unit(direction), step * (ticks - 1) as f64));
            }
            prop_assert!(contours.points().len() <= MOST_POINTS);
            prop_assert_eq!(contours.pieces().len(), walks.len());
            let mut last: HashMap<usize, f64> = HashMap::new();
            let mut counts: HashMap<usize, u32> = HashMap::new();
            for point in contours.shown() {
                let (start, along, length) = expected[point.piece];
                let at = along.dot(&(point.place - start));
                prop_assert!(at >= -1e-9 && at <= length + 1e-9);
                if let Some(before) = last.insert(point.piece, at) {
                    prop_assert!(at > before, "the points are in order");
                    // A walk of long steps has its points at every step from the start.
                    let most = contours.spacing() * (1.0 + walks[point.piece].3 / SPACING);
                    prop_assert!(at - before < most + 1e-9, "no hole of {} m", at - before);
                    prop_assert!(point.normal.dot(&perpendicular(along)) > 0.999, "the normal is on the side of the base");
                }
                *counts.entry(point.piece).or_default() += 1;
            }
            for (index, (piece, (start, along, length))) in contours.pieces().iter().zip(&expected).enumerate() {
                prop_assert_eq!(counts[&index], piece.count);
                prop_assert!((piece.length - length).abs() < 1e-6, "{} m and {length} m", piece.length);
                prop_assert_eq!(piece.ends[0].place, *start);
                let end = along.dot(&(piece.ends[1].place - start));
                prop_assert!(end > length - contours.spacing() - 1e-9);
            }
        }
    }

    #[test]
    fn a_tip_that_was_lifted_begins_a_piece() {
        let mut contours = Contours::new(1);
        let tip = |x: f64| Point2::new(x, 0.0);
        let base = Point2::new(0.0, 0.1);
        for x in [0.0, 3e-3, 6e-3, 30e-3, 33e-3] {
            contours.record(0, tip(x), 1e-4, base);
        }
        assert_eq!(contours.pieces().len(), 2, "it jumped");
        for _ in 0..=INTERRUPTED {
            contours.skip(0);
        }

        contours.record(0, tip(36e-3), 1e-4, base);
        assert_eq!(contours.pieces().len(), 3, "it was silent");
    }

    #[test]
    fn pieces_beyond_the_memory_are_counted() {
        let mut contours = Contours::new(1);
        for index in 0..MOST_PIECES + 5 {
            contours.record(0, Point2::new(index as f64, 0.0), 1e-4, Point2::origin());
        }
        assert_eq!((contours.pieces().len(), contours.lost()), (MOST_PIECES, 5));
    }
}
