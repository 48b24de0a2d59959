//! The union of outlines.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::arrangement::{Arrangement, Loop, Near, outline};
use super::simple::{MAX_PAIRS, grown};
use super::{Contour, ContourError, Point2, TreePoint};

/// Outlines within this distance (m) touch.
pub const TOUCHING: f64 = 1e-6;

/// The largest distance (m) of a united outline from its members, because both of two touching ends may be moved.
const TOLERANCE: f64 = 4.0 * TOUCHING;

/// A closed outline of a union, with the first of its members.
#[derive(Debug, Clone)]
pub struct United {
    /// The outline.
    pub outline: Contour,
    /// The index of its first member.
    pub first: usize,
}

/// The reason why outlines cannot be united. They are counted from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UnionError {
    /// Together they enclose an area that is inside of none of them.
    #[error("outlines {first} and {second} enclose a hole")]
    Hole {
        /// The first of these outlines.
        first: usize,
        /// The next.
        second: usize,
        /// A point on the boundary of the hole.
        at: Point2,
    },
    /// They have too many intersections, or too many possible ones.
    #[error("outline {first} and others have more than {limit} possible crossings")]
    Crossings {
        /// The first of these outlines.
        first: usize,
        /// The next.
        second: usize,
        /// The largest number.
        limit: usize,
    },
    /// They are so close to each other, without touching, that their union is ambiguous.
    #[error("outlines {first} and {second} touch too closely to be united")]
    Unclear {
        /// The first of these outlines.
        first: usize,
        /// The next.
        second: usize,
    },
}

/// The closed outlines of the union of these closed outlines, in the order of their first members.
///
/// Outlines within [`TOUCHING`] of each other become one, without common sides. Its pieces are those of its members,
/// cut at intersections. Only ends that touch without coincidence are moved, by at most [`TOUCHING`]. Outlines that
/// touch only at points, and separate outlines, are bit-identical afterwards.
///
/// ```
/// use vibrissa_world::geometry::{Point2, rounded_rectangle, unite};
/// let square = |x| rounded_rectangle(Point2::new(x, 0.0), 0.1, 0.1, 0.0, 0.0);
/// let united = unite(&[square(0.0)?, square(0.1)?, square(0.3)?])?;
/// assert_eq!(united.len(), 2);
/// assert_eq!(united[0].outline.pieces().len(), 4);
/// assert!((united[0].outline.area() - 0.02).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`UnionError`] when outlines enclose a hole together, or when their union cannot be determined.
pub fn unite(outlines: &[Contour]) -> Result<Vec<United>, UnionError> {
    let mut united = Vec::with_capacity(outlines.len());
    for group in groups(outlines)? {
        if let [only] = group.as_slice() {
            united.push(United { outline: outlines[*only].clone(), first: *only });
            continue;
        }
        let members: Vec<&Contour> = group.iter().map(|&index| &outlines[index]).collect();
        let (first, second) = (group[0], group[1]);
        let arrangement = Arrangement::of(&members).map_err(|limit| UnionError::Crossings { first, second, limit })?;
        let loops = arrangement.loops().ok_or(UnionError::Unclear { first, second })?;
        let mut found = Vec::with_capacity(loops.len());
        for Loop { parts, members: of } in &loops {
            let [first, second] = [0, 1].map(|place| group[*of.get(place).unwrap_or(&of[0])]);
            let outline = match outline(parts, &members) {
                // An outline that returns to a previous point encloses a hole.
                Err(ContourError::SelfIntersection { at, .. }) => Err(UnionError::Hole { first, second, at }),
                Ok(None) => Err(UnionError::Hole { first, second, at: parts[0].start() }),
                Err(_) => Err(UnionError::Unclear { first, second }),
                Ok(Some(outline)) => Ok(outline),
            };
            found.push(United { outline: outline?, first });
        }
        if !is_union(&members, &found) {
            return Err(UnionError::Unclear { first, second });
        }
        united.extend(found);
    }
    united.sort_by_key(|united| united.first);
    Ok(united)
}

/// The indices of outlines in groups of those that meet directly or through others, in order.
fn groups(outlines: &[Contour]) -> Result<Vec<Vec<usize>>, UnionError> {
    let frames: Vec<AABB<TreePoint>> =
        outlines.iter().map(|outline| grown(&outline.bounding_box(), TOUCHING)).collect();
    let boxed = |(index, frame): (usize, &AABB<TreePoint>)| {
        GeomWithData::new(Rectangle::from_corners(frame.lower(), frame.upper()), index)
    };
    let tree = RTree::bulk_load(frames.iter().enumerate().map(boxed).collect());
    // Each outline refers to an earlier one of its group, or to itself.
    let (mut work, mut leads_to): (usize, Vec<usize>) = (0, (0..outlines.len()).collect());
    for (second, frame) in frames.iter().enumerate() {
        for near in tree.locate_in_envelope_intersecting(*frame) {
            let first = near.data;
            let (one, other) = (root(&mut leads_to, first), root(&mut leads_to, second));
            if first >= second || one == other {
                continue;
            }
            let meets = outlines[first].meets(&outlines[second], TOUCHING, &mut work, MAX_PAIRS);
            if meets.ok_or(UnionError::Crossings { first, second, limit: MAX_PAIRS })? {
                leads_to[one.max(other)] = one.min(other);
            }
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); outlines.len()];
    for index in 0..outlines.len() {
        groups[root(&mut leads_to, index)].push(index);
    }
    groups.retain(|group| !group.is_empty());
    Ok(groups)
}

fn root(leads_to: &mut [usize], mut index: usize) -> usize {
    while leads_to[index] != index {
        leads_to[index] = leads_to[leads_to[index]];
        index = leads_to[index];
    }
    index
}

/// True if the result is the union: its outlines are on those of members and inside of none, and all members are in it.
fn is_union(members: &[&Contour], found: &[United]) -> bool {
    const ALONG: [f64; 3] = [0.02, 0.5, 0.98];
    let points = |contour: &Contour| {
        let pieces = contour.pieces().to_vec();
        pieces.into_iter().flat_map(|piece| ALONG.map(|share| piece.point_at(share * piece.length())))
    };
    let outlines: Vec<&Contour> = found.iter().map(|united| &united.outline).collect();
    let (members_near, found_near) = (Near::of(members), Near::of(&outlines));
    let is_outline = |point| members_near.signed_distance(point, TOLERANCE).abs() <= TOLERANCE;
    let is_covered = |point| found_near.signed_distance(point, TOLERANCE) <= TOLERANCE;
    found.iter().all(|united| points(&united.outline).all(is_outline))
        && members.iter().all(|member| points(member).all(is_covered))
}
