//! Binary files.

use super::super::{OutlineError, OutlineFault};
use super::triangle::{Solid, Triangle};

/// The number of bytes before the number of triangles, before the triangles, and of a triangle.
const COUNT: usize = 80;
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// True if a file has as many bytes as its number of triangles requires. A text never does, because the bytes of its letters are a
/// number that is too large.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    count(bytes).is_some_and(|(count, triangles)| triangles.len() as u64 == u64::from(count) * TRIANGLE as u64)
}

/// Reads the triangles. The bytes behind them must be zeros or blanks, because they could be a part of the mesh.
pub(super) fn read(bytes: &[u8]) -> Result<Solid, OutlineError> {
    let Some((count, triangles)) = count(bytes) else {
        let reason = "it is no STL: a text begins with `solid`, and a binary file has 84 bytes before its triangles";
        return Err(OutlineFault::Syntax { reason: reason.to_owned() }.into());
    };
    let (all, rest) = triangles.as_chunks::<TRIANGLE>();
    let is_padding = |bytes: &[u8]| bytes.iter().all(|byte| *byte == 0 || byte.is_ascii_whitespace());
    let expected = usize::try_from(count).unwrap_or(usize::MAX);
    match all.split_at_checked(expected) {
        Some((all, behind)) if is_padding(behind.as_flattened()) && is_padding(rest) => {
            Ok(all.iter().map(triangle).collect())
        }
        _ => {
            let reason = format!(
                "byte {COUNT}: the number of triangles is {count}, but the file has the bytes of {}{}",
                all.len(),
                if rest.is_empty() { "" } else { " and a part of one" }
            );
            Err(OutlineFault::Syntax { reason }.into())
        }
    }
}

/// The number of triangles, and the bytes behind it.
fn count(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (header, triangles) = bytes.split_at_checked(HEADER)?;
    let count = header.last_chunk()?;
    Some((u32::from_le_bytes(*count), triangles))
}

/// A triangle: a normal, three corners, and two bytes for other programs. The normal follows from the corners.
fn triangle(bytes: &[u8; TRIANGLE]) -> Triangle {
    let mut corners = [[0.0; 3]; 3];
    let numbers = bytes.as_chunks::<4>().0.iter().map(|number| f32::from_le_bytes(*number));
    for (coordinate, number) in corners.as_flattened_mut().iter_mut().zip(numbers.skip(3)) {
        *coordinate = number;
    }
    Triangle { corners, line: None }
}
