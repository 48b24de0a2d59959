//! The convex parts of all solids of a scene.

use super::part::Part;
use super::parts_fault::{PartsError, PartsFault};
use super::solid::Solid;

/// The largest total number of parts of all solids. MuJoCo needs some 70 µs to build each.
const MAX_PARTS: usize = 8192;
/// The largest sum of squared corner counts of all parts, equal to that of eight of the largest prisms. MuJoCo's time for
/// building a part is proportional to its squared count.
const MAX_CORNERS: usize = 8 * 2048 * 2048;

/// The convex parts of all solids for MuJoCo, in order.
///
/// # Errors
/// [`PartsError`] with the first solid that MuJoCo cannot simulate, by itself or with those before it.
pub fn convex_parts<'s>(solids: impl IntoIterator<Item = &'s Solid>) -> Result<Vec<Part>, PartsError> {
    let (mut parts, mut corners) = (Vec::new(), 0_usize);
    for (index, solid) in solids.into_iter().enumerate() {
        let refused = |fault| PartsError { solid: index, place: solid.place(), fault };
        let own = solid.parts().map_err(|fault| refused(fault.clone()))?;
        parts.extend_from_slice(own);
        corners += own.iter().map(|part| part.corners().pow(2)).sum::<usize>();
        if parts.len() > MAX_PARTS {
            return Err(refused(PartsFault::Parts { count: parts.len(), limit: MAX_PARTS }));
        }
        if corners > MAX_CORNERS {
            return Err(refused(PartsFault::SquaredCorners { sum: corners, limit: MAX_CORNERS }));
        }
    }
    Ok(parts)
}
