//! The convex parts of a wall.

use std::iter;

use nalgebra::center;
use vibrissa_runtime::math;

use crate::geometry::{Contour, Piece, Point2, Side, Strip, perpendicular};

use super::part::Part;

/// The largest distance (m) of a chord from the accessible side of a wall.
const FACE_SAGITTA: f64 = 1e-5;
/// The same for a convex side. There, finer chords do not increase the number of parts.
const ROUND_SAGITTA: f64 = 5e-6;
/// The largest distance (m) of a chord from the other side, if that is concave.
const BACK_SAGITTA: f64 = 5e-5;

/// The length (m) by which a part extends under the face of its neighbour, unless the neighbour is shorter.
const LAP: f64 = 3e-2;
/// The depth (m) of the end of this extension. It is somewhat larger than the penetration depth of a tip. A flat
/// extension changes the direction of the force only slightly.
const LAP_DEPTH: f64 = 7e-5;
/// Corners of a larger angle (rad) have no extensions. There, a tip touches the corner itself.
const LAPPED_TURN: f64 = 0.1;

/// Decomposes a wall, a strip with an accessible `face`, into convex parts. There is one part per straight piece. In
/// bends there is one per chord of a concave face. A convex face needs fewer parts, because each can have several
/// chords.
///
/// Neighbouring parts meet at an edge perpendicular to the wall. Each part has a lap: an extension into its neighbour
/// just under the face. Without it, the end of a part would push a tip along the wall, and the whisker would vibrate at
/// every seam. With it, the end is too deep to be touched, and the contact passes continuously from part to part.
///
/// At a lap, a tip touches both parts, and the direction of the force changes. It also changes at a chord, most at its
/// ends. In a convex bend the seams are therefore in the middle of chords, and no lap extends beyond the middle of its
/// neighbour.
pub(super) fn parts(wall: &Strip, face: Side) -> Vec<Part> {
    let sides = Sides { face: wall.side(face), back: wall.side(face.opposite()), round: round(face) };
    let blocks: Vec<Block> = bends(sides.face).flat_map(|bend| sides.blocks(bend)).collect();
    let count = blocks.len();
    let closed = sides.face.is_closed();
    let part = |(index, block): (usize, &Block)| {
        let before = (closed || index > 0).then(|| &blocks[(index + count - 1) % count]);
        let after = (closed || index + 1 < count).then(|| &blocks[(index + 1) % count]);
        let mut outline = block.face.clone();
        outline.extend(after.into_iter().flat_map(|after| lap(block, after, sides.round)));
        outline.extend([block.back[1], block.back[0]]);
        // The same in the opposite direction, in which the solid is on the other side.
        let behind = before.map(|before| lap(&block.reversed(), &before.reversed(), -sides.round));
        outline.extend(behind.into_iter().flat_map(|lap| lap.into_iter().rev()));
        if sides.round < 0.0 {
            outline.reverse();
        }
        Part::Prism { outline }
    };
    blocks.iter().enumerate().map(part).collect()
}

/// A block of a wall: the chords of its face and the two ends of its back, in the direction of the wall.
struct Block {
    face: Vec<Point2>,
    back: [Point2; 2],
}

impl Block {
    fn reversed(&self) -> Self {
        Self { face: self.face.iter().rev().copied().collect(), back: [self.back[1], self.back[0]] }
    }
}

/// The points of a block's lap in the next block, empty at a corner.
fn lap(block: &Block, next: &Block, round: f64) -> Vec<Point2> {
    let ([.., before, seam], [_, first, ..]) = (block.face.as_slice(), next.face.as_slice()) else { return Vec::new() };
    let (into, out) = (seam - before, first - seam);
    let turn = round * math::atan2(into.perp(&out), into.dot(&out));
    if turn.abs() > LAPPED_TURN {
        return Vec::new();
    }
    let thickness = (seam - block.back[1]).norm();
    let depth = LAP_DEPTH.min(0.25 * thickness);
    // Only a convex face has several chords per block.
    let share = if next.face.len() > 2 { 0.5 } else { 0.9 };
    let length = LAP.min(share * next.face.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum::<f64>());
    // At a slight corner of a thin wall, a long lap would leave the wall at the back.
    let length = length.min(0.5 * thickness / math::tan(turn.abs()));
    let slope = depth / length;
    if slope < math::tan(-turn) {
        // The face is concave, so a straight lap is deep enough.
        return vec![seam + length.min(0.9 * out.norm()) * into.normalize()];
    }
    // The lap follows the chords of the next face with increasing depth.
    let mut along = 0.0;
    let mut points = Vec::new();
    for ends in next.face.windows(2) {
        let chord = ends[1] - ends[0];
        let rest = length - along;
        let reached = chord.norm().min(rest);
        along += reached;
        let inwards = round * perpendicular(chord.normalize());
        points.push(ends[0] + reached * chord.normalize() + along * slope * inwards);
        // A remainder shorter than the depth would reverse the direction at a corner of the face.
        if rest - reached <= depth {
            break;
        }
    }
    points
}

/// The sign of the curvature of a convex face. A face on the right of its wall is convex if the wall bends to the left.
fn round(face: Side) -> f64 {
    match face {
        Side::Left => -1.0,
        Side::Right => 1.0,
    }
}

/// The two sides of a wall.
struct Sides<'w> {
    face: &'w Contour,
    back: &'w Contour,
    round: f64,
}

/// Consecutive pieces with the same sign of curvature, or a single straight piece.
type Bend = std::ops::Range<usize>;

fn bends(side: &Contour) -> impl Iterator<Item = Bend> {
    let pieces = side.pieces();
    let mut start = 0;
    iter::from_fn(move || {
        let way = sense(pieces.get(start)?);
        let rest = pieces[start + 1..].iter().take_while(|piece| way * sense(piece) > 0.0);
        let bend = start..start + 1 + rest.count();
        start = bend.end;
        Some(bend)
    })
}

/// The sign of curvature: +1 for a piece that bends to the left, −1 to the right, 0 for a straight one.
fn sense(piece: &Piece) -> f64 {
    if let Piece::Arc(arc) = piece { arc.sweep.signum() } else { 0.0 }
}

impl Sides<'_> {
    fn blocks(&self, bend: Bend) -> Vec<Block> {
        let is_round = sense(&self.face.pieces()[bend.start]) * self.round > 0.0;
        let face_chords = chords(self.face, &bend, if is_round { ROUND_SAGITTA } else { FACE_SAGITTA });
        // Behind a convex face the back is concave, and the chords of the back determine the parts.
        let (count, each) = if is_round {
            let count = chords(self.back, &bend, BACK_SAGITTA);
            (count, face_chords.div_ceil(count))
        } else {
            (face_chords, 1)
        };
        let seams = stations(self.face, &bend, count);
        let place = |side: &Contour, (index, share): (usize, f64)| {
            let piece = &side.pieces()[index];
            piece.point_at(share * piece.length())
        };
        // A concave face has its corners at the seams, a convex face half a chord away from them.
        let halves = if is_round { stations(self.face, &bend, 2 * count * each) } else { Vec::new() };
        let corners: Vec<Point2> = halves.iter().skip(1).step_by(2).map(|&station| place(self.face, station)).collect();
        let seam = |index: usize| {
            let before = (index * each).checked_sub(1);
            let chord = before.and_then(|before| corners.get(before..before + 2));
            chord.map_or_else(|| place(self.face, seams[index]), |ends| center(&ends[0], &ends[1]))
        };
        let block = |index: usize| {
            let own = corners.chunks(each).nth(index).unwrap_or_default();
            Block {
                face: iter::once(seam(index)).chain(own.iter().copied()).chain([seam(index + 1)]).collect(),
                back: [seams[index], seams[index + 1]].map(|station| place(self.back, station)),
            }
        };
        (0..count).map(block).collect()
    }
}

/// The number of chords of a bend for a distance of at most `sagitta`.
fn chords(side: &Contour, bend: &Bend, sagitta: f64) -> usize {
    let weight: f64 = side.pieces()[bend.clone()].iter().map(|piece| weight(piece) / (8.0 * sagitta).sqrt()).sum();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive count, bounded by the caller"
    )]
    let count = weight.ceil().max(1.0) as usize;
    count
}

/// The weight of a piece in the division of its bend. For equal sagitta, the length of a chord is proportional to the
/// square root of the radius.
fn weight(piece: &Piece) -> f64 {
    piece.length() * piece.curvature().abs().sqrt()
}

/// The positions that divide a bend into chords of equal sagitta. Each is given by a piece and the share of it that
/// precedes the position.
fn stations(side: &Contour, bend: &Bend, chords: usize) -> Vec<(usize, f64)> {
    let weights: Vec<f64> = side.pieces()[bend.clone()].iter().map(weight).collect();
    let step = weights.iter().sum::<f64>() / chords as f64;
    let mut stations = vec![(bend.start, 0.0)];
    let (mut index, mut before) = (0, 0.0);
    for station in 1..chords {
        let along = step * station as f64;
        while index + 1 < weights.len() && before + weights[index] < along {
            before += weights[index];
            index += 1;
        }
        stations.push((bend.start + index, ((along - before) / weights[index]).clamp(0.0, 1.0)));
    }
    stations.push((bend.end - 1, 1.0));
    stations
}
