//! Functions.

/// A built-in function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Sign,
    Sqrt,
    Min,
    Max,
    Clamp,
    Blend,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Exp,
    Floor,
    Direction,
    Vector,
    Position,
    Unit,
    Angle,
    Rotate,
    Turn,
    Wrap,
    Dot,
    Cross,
    LowPass,
    Pid,
    Previous,
    Peak,
    Settled,
    PathLength,
}

/// Every function: its name, the function, its notation and its result.
pub(crate) const FUNCTIONS: [(&str, Function, &str, &str); 30] = [
    ("abs", Function::Abs, "abs(x)", "the absolute value of a number"),
    ("sign", Function::Sign, "sign(x)", "\u{2212}1, 0 or 1, the sign of a number"),
    (
        "sqrt",
        Function::Sqrt,
        "sqrt(x)",
        "the square root of a number. Its dimension is the square root of the number's dimension",
    ),
    ("min", Function::Min, "min(a, b)", "the smaller of two numbers"),
    ("max", Function::Max, "max(a, b)", "the larger of two numbers"),
    ("clamp", Function::Clamp, "clamp(x, low, high)", "`min(max(x, low), high)`"),
    ("blend", Function::Blend, "blend(a, b, share)", "the linear interpolation `(1 - share) * a + share * b`"),
    ("sin", Function::Sin, "sin(angle)", "the sine of an angle, a plain number"),
    ("cos", Function::Cos, "cos(angle)", "the cosine of an angle, a plain number"),
    ("tan", Function::Tan, "tan(angle)", "the tangent of an angle, a plain number"),
    ("asin", Function::Asin, "asin(x)", "the arcsine of a plain number, an angle from \u{2212}90 deg to 90 deg"),
    ("acos", Function::Acos, "acos(x)", "the arccosine of a plain number, an angle from 0 deg to 180 deg"),
    ("exp", Function::Exp, "exp(x)", "e to the power of a plain number"),
    ("floor", Function::Floor, "floor(x)", "the largest integer that does not exceed a plain number"),
    (
        "direction",
        Function::Direction,
        "direction(angle)",
        "the direction with an angle (0 is along x, counter-clockwise positive)",
    ),
    ("vector", Function::Vector, "vector(x, y)", "the vector with these components"),
    ("position", Function::Position, "position(x, y)", "the position with these coordinates in the world frame"),
    ("unit", Function::Unit, "unit(vector)", "the direction of a vector"),
    ("angle", Function::Angle, "angle(vector)", "the angle of a vector, from \u{2212}180 deg to 180 deg"),
    (
        "rotate",
        Function::Rotate,
        "rotate(vector, angle)",
        "the vector, rotated counter-clockwise by the angle. A rotated direction is a direction",
    ),
    (
        "turn",
        Function::Turn,
        "turn(from, to)",
        "the smallest rotation from one angle to another, above \u{2212}180 deg to 180 deg",
    ),
    ("wrap", Function::Wrap, "wrap(angle)", "the angle, wrapped to the range above \u{2212}180 deg to 180 deg"),
    ("dot", Function::Dot, "dot(a, b)", "the scalar product of two vectors"),
    (
        "cross",
        Function::Cross,
        "cross(a, b)",
        "the cross product of two vectors. It is positive if the second is to the left of the first",
    ),
    (
        "lowpass",
        Function::LowPass,
        "lowpass(x, cutoff)",
        "a number, filtered by a first-order low-pass filter with this cutoff frequency",
    ),
    (
        "pid",
        Function::Pid,
        "pid(error, p, i, d, limit)",
        "the output of a PID controller, limited to \u{00b1} the limit. The integral does not change while the output is at the limit (anti-windup)",
    ),
    (
        "previous",
        Function::Previous,
        "previous(x)",
        "a number, a vector or a position as it was at the last earlier tick in which it was computed. At first, the value itself",
    ),
    ("peak", Function::Peak, "peak(x)", "the largest value of a number since the state was entered"),
    (
        "settled",
        Function::Settled,
        "settled(x, within, lasting)",
        "true if a number has stayed within this distance of one value for this time",
    ),
    (
        "path_length",
        Function::PathLength,
        "path_length(position)",
        "the length of the path of a position since the state was entered",
    ),
];

/// The function with a name, and its notation.
pub(crate) fn function(name: &str) -> Option<(Function, &'static str)> {
    FUNCTIONS.iter().find(|(known, ..)| *known == name).map(|&(_, function, usage, _)| (function, usage))
}

impl Function {
    /// The arguments of the function.
    pub(crate) fn takes(self) -> &'static str {
        match self {
            Self::Abs | Self::Sign | Self::Peak => "one number of any dimension",
            Self::Sqrt => "one number with a dimension that is a square, such as an area",
            Self::Min | Self::Max | Self::Vector => "two numbers of one dimension",
            Self::Clamp => "three numbers of one dimension: the value, the minimum, the maximum",
            Self::Blend => "two numbers, two vectors of one dimension or two positions, and a plain number",
            Self::Position => "two lengths",
            Self::Sin | Self::Cos | Self::Tan | Self::Direction | Self::Wrap => "one angle",
            Self::Asin | Self::Acos | Self::Exp | Self::Floor => "one plain number",
            Self::Unit | Self::Angle => "one vector",
            Self::Rotate => "a vector and an angle",
            Self::Turn => "two angles",
            Self::Dot | Self::Cross => "two vectors",
            Self::LowPass => "a number and a frequency",
            Self::Previous => "a number, a vector or a position",
            Self::Settled => "two numbers of one dimension, and a time",
            Self::PathLength => "a position",
            Self::Pid => {
                "the error, gains for the error, its integral and its derivative, and the limit of the output, such that each gain \
             multiplied by its quantity has the dimension of the limit"
            }
        }
    }
}
