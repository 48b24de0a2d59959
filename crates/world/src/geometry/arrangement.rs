//! The arrangement of outlines: their parts between intersections, and the outer boundary.
//!
//! Why: docs/decisions/scenes.md#unions-of-outlines-are-exact.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::simple::{MAX_PAIRS, crossings, grown};
use super::union::TOUCHING;
use super::{Arc, BoundingBox, Contour, ContourError, JOIN_TOLERANCE, Piece, Point2, Segment, TreePoint, tree_point};

/// The largest number of intersections.
const MAX_CUTS: usize = 20_000;

/// Two positions on a piece are equal within this distance (m).
const CUT_TOLERANCE: f64 = 2.0 * TOUCHING;

/// The largest distance (m) between the end of a part and the start of its successor.
const MAX_GAP: f64 = 4.0 * TOUCHING;

/// A part of a piece between two cuts, by arc lengths (m) from the piece's start.
#[derive(Copy, Clone, Debug)]
pub(super) struct Part {
    member: usize,
    index: usize,
    piece: Piece,
    from: f64,
    to: f64,
}

/// All parts of closed outlines, in the order of travel, by outline.
pub(super) struct Arrangement {
    parts: Vec<Part>,
    /// For every part, true if it belongs to the outer boundary.
    is_outer: Vec<bool>,
    /// For every part, its successor on its own outline.
    next: Vec<usize>,
}

/// A closed sequence of at least one part.
pub(super) struct Loop {
    pub(super) parts: Vec<Part>,
    /// The members of the parts, without repetition, in order.
    pub(super) members: Vec<usize>,
}

impl Arrangement {
    /// The arrangement of `members`. The error is the largest number of cuts, if there are more.
    pub(super) fn of(members: &[&Contour]) -> Result<Self, usize> {
        let near = Near::of(members);
        let (mut parts, mut next, mut cuts, mut work) = (Vec::new(), Vec::new(), 0, 0);
        for (member, contour) in members.iter().enumerate() {
            let first = parts.len();
            for (index, piece) in contour.pieces().iter().enumerate() {
                let length = piece.length();
                let mut ends = near.cuts(member, piece, MAX_CUTS - cuts, &mut work).ok_or(MAX_CUTS)?;
                cuts += ends.len();
                ends.retain(|&end| end > CUT_TOLERANCE && end < length - CUT_TOLERANCE);
                ends.sort_by(f64::total_cmp);
                ends.dedup_by(|later, earlier| *later - *earlier < CUT_TOLERANCE);
                ends.push(length);
                let mut from = 0.0;
                for to in ends {
                    parts.push(Part { member, index, piece: *piece, from, to });
                    from = to;
                }
            }
            next.extend(first + 1..parts.len());
            next.push(first);
        }
        let is_outer = parts.iter().map(|part| near.is_outer(part, &mut work).ok_or(MAX_CUTS));
        let is_outer = is_outer.collect::<Result<_, _>>()?;
        Ok(Self { parts, is_outer, next })
    }

    /// The closed outlines of the outer parts. `None` if one of them does not close.
    pub(super) fn loops(&self) -> Option<Vec<Loop>> {
        let outer = || (0..self.parts.len()).filter(|&part| self.is_outer[part]);
        let starts = outer().map(|part| GeomWithData::new(tree_point(self.parts[part].start()), part));
        let starts: RTree<GeomWithData<TreePoint, usize>> = RTree::bulk_load(starts.collect());
        let mut is_left = self.is_outer.clone();
        let mut loops = Vec::new();
        for first in outer() {
            if !is_left[first] {
                continue;
            }
            let (mut parts, mut part) = (Vec::new(), first);
            loop {
                is_left[part] = false;
                parts.push(self.parts[part]);
                part = self.following(part, &starts, |next| next == first || is_left[next])?;
                if part == first {
                    break;
                }
            }
            let mut members: Vec<usize> = parts.iter().map(|part| part.member).collect();
            members.sort_unstable();
            members.dedup();
            loops.push(Loop { parts, members });
        }
        Some(loops)
    }

    /// The successor of a part. Where outlines only touch, each continues on itself.
    fn following(
        &self,
        part: usize,
        starts: &RTree<GeomWithData<TreePoint, usize>>,
        is_free: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let own = self.next[part];
        if self.is_outer[own] && is_free(own) {
            return Some(own);
        }
        let end = self.parts[part].end();
        let near = starts.locate_within_distance(tree_point(end), MAX_GAP * MAX_GAP).map(|start| start.data);
        let apart = |&next: &usize| (self.parts[next].start() - end).norm();
        near.filter(|&next| is_free(next)).min_by(|a, b| apart(a).total_cmp(&apart(b)))
    }
}

/// A spatial index of the members.
pub(super) struct Near<'m> {
    members: &'m [&'m Contour],
    /// The bounding boxes of the members.
    frames: RTree<Boxed<usize>>,
    /// The bounding boxes of their pieces, each with its member and its index there.
    pieces: RTree<Boxed<(usize, usize)>>,
}

/// An item with its bounding box, enlarged by the touching distance.
type Boxed<T> = GeomWithData<Rectangle<TreePoint>, T>;

fn boxed<T>(bounds: &BoundingBox, data: T) -> Boxed<T> {
    let frame = grown(bounds, TOUCHING);
    GeomWithData::new(Rectangle::from_corners(frame.lower(), frame.upper()), data)
}

impl<'m> Near<'m> {
    pub(super) fn of(members: &'m [&'m Contour]) -> Self {
        let frames = members.iter().enumerate().map(|(member, contour)| boxed(&contour.bounding_box(), member));
        let pieces = members.iter().enumerate().flat_map(|(member, contour)| {
            let pieces = contour.pieces().iter().enumerate();
            pieces.map(move |(index, piece)| boxed(&piece.bounding_box(), (member, index)))
        });
        Self { members, frames: RTree::bulk_load(frames.collect()), pieces: RTree::bulk_load(pieces.collect()) }
    }

    /// The positions (m) on a member's piece at which other members cross it, touch it or end on it. `None` if there
    /// are more than `most`.
    fn cuts(&self, member: usize, piece: &Piece, most: usize, work: &mut usize) -> Option<Vec<f64>> {
        let mut cuts = Vec::new();
        for near in self.pieces.locate_in_envelope_intersecting(grown(&piece.bounding_box(), 0.0)) {
            *work += 1;
            let (other, index) = near.data;
            if other == member {
                continue;
            }
            let met = &self.members[other].pieces()[index];
            let places =
                [Some(met.start()), Some(met.end())].into_iter().chain(crossings(piece, met, TOUCHING)).flatten();
            let is_met = |place: &Point2| piece.distance(*place) <= TOUCHING && met.distance(*place) <= TOUCHING;
            cuts.extend(places.filter(is_met).map(|place| piece.nearest(place)));
            if cuts.len() > most || *work > MAX_PAIRS {
                return None;
            }
        }
        Some(cuts)
    }

    /// The smallest signed distance (m) of a point from the members whose boxes are within `reach` (m), infinite if
    /// there are none.
    pub(super) fn signed_distance(&self, point: Point2, reach: f64) -> f64 {
        let near = self.frames.locate_in_envelope_intersecting(grown(&BoundingBox::around(point, point), reach));
        near.map(|frame| self.members[frame.data].signed_distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// True if a part belongs to the outer boundary: it is inside of no other member, and its side does not touch the
    /// side of another. Of coincident sides, that of the first member counts.
    fn is_outer(&self, part: &Part, work: &mut usize) -> Option<bool> {
        let along = 0.5 * (part.from + part.to);
        let (place, tangent) = (part.piece.point_at(along), part.piece.tangent_at(along));
        let near =
            self.frames.locate_in_envelope_intersecting(AABB::from_point(tree_point(place))).map(|frame| frame.data);
        for index in near.filter(|&other| other != part.member) {
            *work += 1;
            if *work > MAX_PAIRS {
                return None;
            }
            let other = self.members[index];
            let distance = other.signed_distance(place);
            let keeps_out = if distance.abs() > TOUCHING {
                distance > 0.0
            } else {
                part.member < index && other.nearest(place).tangent.dot(&tangent) > 0.0
            };
            if !keeps_out {
                return Some(false);
            }
        }
        Some(true)
    }
}

impl Part {
    pub(super) fn start(&self) -> Point2 {
        self.piece.point_at(self.from)
    }

    fn end(&self) -> Point2 {
        self.piece.point_at(self.to)
    }

    /// The part as a piece.
    fn piece(&self) -> Piece {
        let length = self.piece.length();
        if self.from <= 0.0 && self.to >= length {
            return self.piece;
        }
        match self.piece {
            Piece::Segment(_) => Piece::segment(self.start(), self.end()),
            Piece::Arc(arc) => {
                let (from, to) = (self.from / length, self.to / length);
                let start_angle = arc.start_angle + from * arc.sweep;
                Piece::Arc(Arc { start_angle, sweep: (to - from) * arc.sweep, ..arc })
            }
        }
    }
}

/// The outline of a loop. If the loop is a complete member, the member itself. `None` if the enclosed area is on the
/// right.
///
/// # Errors
/// The pieces are not a valid contour.
pub(super) fn outline(parts: &[Part], members: &[&Contour]) -> Result<Option<Contour>, ContourError> {
    let parts = whole_parts(parts);
    let pieces: Vec<Piece> = parts.iter().map(Part::piece).collect();
    let Some(origin) = parts.first().map(Part::start) else { return Err(ContourError::Empty) };
    if pieces.iter().map(|piece| piece.swept_area(origin)).sum::<f64>() < 0.0 {
        return Ok(None);
    }
    let member = parts[0].member;
    let is_whole = |part: &Part| part.member == member && part.from <= 0.0 && part.to >= part.piece.length();
    if parts.len() == members[member].pieces().len() && parts.iter().all(is_whole) {
        return Ok(Some(members[member].clone()));
    }
    Contour::closed(straightened(joined(&pieces))).map(Some)
}

/// Merges parts that were cut at a position where nothing ends.
fn whole_parts(cut: &[Part]) -> Vec<Part> {
    let goes_on = |last: &Part, next: &Part| {
        (last.member, last.index) == (next.member, next.index) && last.to.to_bits() == next.from.to_bits()
    };
    let mut parts: Vec<Part> = Vec::with_capacity(cut.len());
    for part in cut {
        match parts.last_mut() {
            Some(last) if goes_on(last, part) => last.to = part.to,
            _ => parts.push(*part),
        }
    }
    if let ([first, .., last], Some(end)) = (parts.as_mut_slice(), cut.last())
        && goes_on(end, first)
    {
        first.from = last.from;
        parts.pop();
    }
    parts
}

/// Moves ends that touch to one point, so that the pieces are contiguous.
fn joined(pieces: &[Piece]) -> Vec<Piece> {
    let starts = pieces.iter().cycle().skip(1).map(Piece::start);
    let join = |(piece, start): (&Piece, Point2)| {
        let is_there = (start - piece.end()).norm() <= 0.5 * JOIN_TOLERANCE;
        if is_there { vec![*piece] } else { piece.ending_at(start) }
    };
    pieces.iter().zip(starts).flat_map(join).collect()
}

/// Merges collinear consecutive segments of a closed contour.
fn straightened(pieces: Vec<Piece>) -> Vec<Piece> {
    let goes_on = |last: &Piece, next: &Piece| match (last, next) {
        (Piece::Segment(last), Piece::Segment(next)) => {
            let whole = Segment { start: last.start, end: next.end };
            last.tangent().dot(&next.tangent()) > 0.0 && whole.distance(last.end) <= JOIN_TOLERANCE
        }
        _ => false,
    };
    let mut straight: Vec<Piece> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        match straight.last_mut() {
            Some(last) if goes_on(last, &piece) => *last = Piece::segment(last.start(), piece.end()),
            _ => straight.push(piece),
        }
    }
    if let [first, .., last] = straight.as_mut_slice()
        && goes_on(last, first)
    {
        *first = Piece::segment(last.start(), first.end());
        straight.pop();
    }
    straight
}
