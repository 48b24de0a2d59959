//! The convex parts of a rough solid.

use vibrissa_runtime::math;

use crate::geometry::{Contour, Piece, Point2, Vector2, perpendicular};

use super::part::{Part, chords};

/// The largest distance of a chord from its convex arc, as a share of the texture's amplitude.
const CREST_SAGITTA: f64 = 0.02;
/// The same for a concave arc. Each of its chords is one part.
const VALLEY_SAGITTA: f64 = 0.1;
/// The depth of the core and the thickness of the layer, as multiples of the amplitude. The layer ends in the core, at
/// crests too. A random texture with 24 sines is at most 7 amplitudes high.
pub(super) const DEPTH_OF_CORE: f64 = 8.0;
const THICKNESS: f64 = 15.0;
/// Where the solid is thinner than twice the layer, the layer is reduced by this factor until it fits, at most so often.
const SHORTENING: f64 = 0.8;
const SHORTENINGS: i32 = 20;
/// The largest share of a neighbour's chord under which a part extends.
const LAP: f64 = 0.9;

/// Decomposes the layer under a rough outline into convex parts. `amplitude` (m) is that of its texture.
///
/// The outline is replaced by chords, and cut at all their concave corners. So each part has a convex surface: a crest,
/// or one chord of a valley. At a cut, each of both parts extends straight under the surface of the other. Therefore no
/// part ends at the surface, and a tip that passes a cut touches nothing but surfaces.
///
/// The result is empty if the outline has no concave corner.
pub(super) fn layer(outline: &Contour, amplitude: f64) -> Vec<Part> {
    let sagitta = |piece: &Piece| amplitude * if piece.curvature() > 0.0 { CREST_SAGITTA } else { VALLEY_SAGITTA };
    let corners: Vec<Point2> = outline.pieces().iter().flat_map(|piece| chords(piece, sagitta(piece))).collect();
    let count = corners.len();
    let chord = |index: usize| corners[(index + 1) % count] - corners[index % count];
    let is_cut = |index: &usize| chord(index + count - 1).perp(&chord(*index)) <= 0.0;
    let cuts: Vec<usize> = (0..count).filter(is_cut).collect();
    let following = cuts.iter().cycle().skip(1);
    let parts = cuts.iter().zip(following).map(|(&start, &end)| {
        let end = if end > start { end } else { end + count };
        let (first, last) = (chord(start), chord(end - 1));
        // Under a neighbour that turns away by more than a right angle, there is no place.
        let lap = |own: Vector2, other: Vector2| LAP * own.dot(&other).max(0.0) / own.norm_squared() * own;
        let from = corners[start % count] - lap(first, chord(start + count - 1));
        let to = corners[end % count] + lap(last, chord(end));
        let mut part = vec![from];
        part.extend((start + 1..end).map(|index| corners[index % count]));
        part.push(to);
        let back = [(to, last), (from, first)].map(|(end, along)| {
            let inwards = perpendicular(along.normalize());
            let depth = |count| THICKNESS * amplitude * math::powi(SHORTENING, count);
            let fits = |depth: &f64| outline.contains(end + 2.0 * *depth * inwards);
            end + (0..SHORTENINGS).map(depth).find(fits).unwrap_or(depth(SHORTENINGS)) * inwards
        });
        // Under a sharp corner of the outline, both ends of the back may change places.
        if (back[0] - back[1]).dot(&(to - from)) > 0.0 {
            part.extend(back);
        }
        while let Some(inner) = inner_corner(&part) {
            part.remove(inner);
        }
        Part::Prism { outline: part }
    });
    parts.collect()
}

/// The index of a corner at which an outline does not turn to the left. Near a sharp corner of the solid, an end of the
/// back can be one.
fn inner_corner(outline: &[Point2]) -> Option<usize> {
    let count = outline.len();
    let side = |index: usize| outline[(index + 1) % count] - outline[index % count];
    (0..count).find(|index| side(index + count - 1).perp(&side(*index)) <= 0.0)
}
