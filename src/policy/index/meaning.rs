//! What the language's functions and members mean, in a line each.

use crate::policy::types::Type;

const FUNCTIONS: [(&str, &str); 18] = [
    ("abs", "The magnitude of a number."),
    ("sign", "\u{2212}1, 0 or 1."),
    ("sqrt", "The square root of a number, with the root of its dimension."),
    ("min", "The lesser of two numbers of one dimension."),
    ("max", "The greater of two numbers of one dimension."),
    ("clamp", "A number raised to `low` and lowered to `high`, all of one dimension."),
    ("sin", "The sine of an angle, a plain number."),
    ("cos", "The cosine of an angle, a plain number."),
    ("direction", "The unit vector that points there: 0 is along x, counter-clockwise positive."),
    ("vector", "The vector of two numbers of one dimension."),
    ("unit", "The vector at length 1, a plain vector; the zero vector stays what it is."),
    ("angle", "The direction of a vector, from \u{2212}180 deg to 180 deg; 0 for the zero vector."),
    ("rotate", "The vector turned counter-clockwise by the angle."),
    ("turn", "The shorter turn from one angle to another, above \u{2212}180 deg to 180 deg."),
    ("dot", "The scalar product of two vectors."),
    ("cross", "The cross product of two vectors, positive when the second is to the left of the first."),
    (
        "lowpass",
        "A number through a first-order low-pass filter with the cutoff, a frequency. It remembers for itself.",
    ),
    (
        "pid",
        "The output of a PID controller, within \u{b1} the limit; its integral stands still at the limit. It remembers for \
         itself.",
    ),
];

const WHISKER: [(&str, &str); 11] = [
    ("deflection", "The filtered angle of its base, counter-clockwise positive."),
    ("touching", "Whether the deflection is beyond the rig's contact threshold."),
    ("yaw", "The direction of its straight shaft, in the world."),
    ("side", "\u{2212}1 on the right, 1 on the left."),
    ("sense", "1 when bent as forward motion bends it, \u{2212}1 when bent the other way, 0 when not touching."),
    ("length", "The length of its shaft."),
    ("tip", "Where its tip touches, in the world, by the tip model."),
    ("tip_base", "Where its tip touches, seen from its base: x along the straight shaft, y to its left."),
    ("base", "Its base, in the world."),
    ("tip_at", "Where the tip would touch at another deflection, an angle, seen from its base."),
    ("contour", "What `record` has gathered behind its tip."),
];

const CONTOUR: [(&str, &str); 4] = [
    ("ready", "Whether there are seven points, each a millimetre or more from the last."),
    ("tangent", "The direction of travel at its end; not a number before it is ready."),
    ("end", "Its newest point, in the world."),
    ("curvature", "The curvature at its end, counter-clockwise positive; not a number before it is ready."),
];

const BODY: [(&str, &str); 2] =
    [("yaw", "Its heading; it counts whole turns."), ("position", "Its centre of mass, in the world.")];

/// What the language's function of this name gives.
pub(super) fn of_function(name: &str) -> &'static str {
    find(&FUNCTIONS, name)
}

/// What a member of a type is.
pub(super) fn of_member(owner: Type, name: &str) -> &'static str {
    match owner {
        Type::Whisker => find(&WHISKER, name),
        Type::Contour => find(&CONTOUR, name),
        Type::Body => find(&BODY, name),
        Type::Truth | Type::Scalar(_) | Type::Vector(_) => "",
    }
}

fn find(table: &[(&str, &'static str)], name: &str) -> &'static str {
    table.iter().find(|(known, _)| *known == name).map_or("", |&(_, meaning)| meaning)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::policy::builtins::{self, FUNCTIONS};

    #[test]
    fn everything_that_the_language_offers_is_explained() {
        for (name, ..) in FUNCTIONS {
            assert!(!of_function(name).is_empty(), "{name}");
        }
        for owner in [Type::Whisker, Type::Contour, Type::Body] {
            for member in builtins::members(owner) {
                assert!(!of_member(owner, member.name).is_empty(), "{}", member.name);
            }
        }
    }
}
