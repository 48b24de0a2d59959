//! The convex parts of a wall.

use std::iter;

use nalgebra::center;

use crate::geometry::{Contour, Piece, Point2, Side, Strip, perpendicular};

use super::part::Part;

/// The furthest (m) that a chord lies from the side of a wall that is to be touched.
const FACE_SAGITTA: f64 = 1e-5;
/// The same where that side is round: finer chords are no more parts there.
const ROUND_SAGITTA: f64 = 5e-6;
/// The furthest (m) that a chord lies from its other side, where that is hollow.
const BACK_SAGITTA: f64 = 5e-5;

/// How far (m) a part reaches on under the face of its neighbour, unless the neighbour is shorter.
const LAP: f64 = 3e-2;
/// How deep (m) it lies there at the end: somewhat deeper than a tip sinks in. The flatter the lap, the less it turns the force on
/// the tip.
const LAP_DEPTH: f64 = 7e-5;
/// A corner that turns more than this (rad) has no laps: what a tip feels there is the corner.
const LAPPED_TURN: f64 = 0.1;

/// The parts of a wall, which is a strip with its `face` to be touched: one for every straight piece, and in bends one for
/// every chord of a hollow face. A round face needs fewer parts, as each can have several chords.
///
/// Neighbouring parts meet in an edge square across the wall, and each has a lap: it reaches on into the other, just under its
/// face. The contact of a tip with the end of a part pushes it along the wall, which would make the whisker ring at every seam;
/// with the laps the end lies too deep to be felt, and the tip is handed over from one part to the next.
///
/// Where it is handed over it touches both parts, and the lap turns the force on it; so does a chord, the most at its ends. In a round
/// bend the seams are therefore in the middle of chords, and no lap goes beyond the middle of its neighbour.
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
        // The same seen the other way along the wall, where its solid side is the other one.
        let behind = before.map(|before| lap(&block.reversed(), &before.reversed(), -sides.round));
        outline.extend(behind.into_iter().flat_map(|lap| lap.into_iter().rev()));
        if sides.round < 0.0 {
            outline.reverse();
        }
        Part::Prism { outline }
    };
    blocks.iter().enumerate().map(part).collect()
}

/// A piece of a wall: the chords of its face, and the two ends of its back, in the direction of the wall.
struct Block {
    face: Vec<Point2>,
    back: [Point2; 2],
}

impl Block {
    fn reversed(&self) -> Self {
        Self { face: self.face.iter().rev().copied().collect(), back: [self.back[1], self.back[0]] }
    }
}

/// The points by which a block reaches on into the next one; none at a corner.
fn lap(block: &Block, next: &Block, round: f64) -> Vec<Point2> {
    let ([.., before, seam], [_, first, ..]) = (block.face.as_slice(), next.face.as_slice()) else { return Vec::new() };
    let (into, out) = (seam - before, first - seam);
    let turn = round * into.perp(&out).atan2(into.dot(&out));
    if turn.abs() > LAPPED_TURN {
        return Vec::new();
    }
    let thickness = (seam - block.back[1]).norm();
    let depth = LAP_DEPTH.min(0.25 * thickness);
    // Of several chords are round faces alone.
    let share = if next.face.len() > 2 { 0.5 } else { 0.9 };
    let length = LAP.min(share * next.face.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum::<f64>());
    // At a slight corner of a thin wall a long lap would come out at the back.
    let length = length.min(0.5 * thickness / turn.abs().tan());
    let slope = depth / length;
    if slope < (-turn).tan() {
        // The face is hollow: straight on is deep enough.
        return vec![seam + length.min(0.9 * out.norm()) * into.normalize()];
    }
    // Along the chords of the next face, ever deeper under them.
    let mut along = 0.0;
    let mut points = Vec::new();
    for ends in next.face.windows(2) {
        let chord = ends[1] - ends[0];
        let rest = length - along;
        let reached = chord.norm().min(rest);
        along += reached;
        let inwards = round * perpendicular(chord.normalize());
        points.push(ends[0] + reached * chord.normalize() + along * slope * inwards);
        // A rest shorter than the lap is deep would lead back where the face turns.
        if rest - reached <= depth {
            break;
        }
    }
    points
}

/// The sign of the curvature of a round face: a face on the right of its wall is round where the wall bends to the left.
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

/// Consecutive pieces that bend the same way; or a single straight one.
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

/// +1 for a piece that bends to the left, −1 to the right, 0 for a straight one.
fn sense(piece: &Piece) -> f64 {
    if let Piece::Arc(arc) = piece { arc.sweep.signum() } else { 0.0 }
}

impl Sides<'_> {
    fn blocks(&self, bend: Bend) -> Vec<Block> {
        let is_round = sense(&self.face.pieces()[bend.start]) * self.round > 0.0;
        let face_chords = chords(self.face, &bend, if is_round { ROUND_SAGITTA } else { FACE_SAGITTA });
        // Where the face is round its back is hollow, and the back's chords cut the bend into parts.
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
        // A hollow face has its corners at the seams, a round one half a chord away from them.
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

/// How many chords stand for a bend of a side, none further from it than `sagitta`.
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

/// What a piece takes of the chords of its bend: chords of one sagitta are as long as the root of the radius is great.
fn weight(piece: &Piece) -> f64 {
    piece.length() * piece.curvature().abs().sqrt()
}

/// Places along a bend that cut it into chords of one sagitta: the piece, and the share of it that lies before the place.
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
