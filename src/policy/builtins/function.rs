//! Functions.

/// A built-in function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::policy) enum Function {
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
    Unit,
    Angle,
    Rotate,
    Turn,
    Wrap,
    Dot,
    Cross,
    LowPass,
    Pid,
}

/// Every function: its name, the function, its notation and its result.
pub(in crate::policy) const FUNCTIONS: [(&str, Function, &str, &str); 25] = [
    ("abs", Function::Abs, "abs(x)", "the magnitude of a number"),
    ("sign", Function::Sign, "sign(x)", "\u{2212}1, 0 or 1"),
    ("sqrt", Function::Sqrt, "sqrt(x)", "the square root of a number, with the root of its dimension"),
    ("min", Function::Min, "min(a, b)", "the lesser of two numbers"),
    ("max", Function::Max, "max(a, b)", "the greater of two numbers"),
    ("clamp", Function::Clamp, "clamp(x, low, high)", "`min(max(x, low), high)`"),
    (
        "blend",
        Function::Blend,
        "blend(a, b, share)",
        "`(1 - share) * a + share * b`: `a` at a share of 0, `b` at a share of 1",
    ),
    ("sin", Function::Sin, "sin(angle)", "its sine, a plain number"),
    ("cos", Function::Cos, "cos(angle)", "its cosine, a plain number"),
    ("tan", Function::Tan, "tan(angle)", "its tangent, a plain number"),
    ("asin", Function::Asin, "asin(x)", "the angle from \u{2212}90 deg to 90 deg with this sine"),
    ("acos", Function::Acos, "acos(x)", "the angle from 0 deg to 180 deg with this cosine"),
    ("exp", Function::Exp, "exp(x)", "e to the power of a plain number"),
    ("floor", Function::Floor, "floor(x)", "the greatest whole number that is not above a plain number"),
    (
        "direction",
        Function::Direction,
        "direction(angle)",
        "the unit vector that points there (0 is along x, counter-clockwise positive)",
    ),
    ("vector", Function::Vector, "vector(x, y)", "the vector of two numbers of one dimension"),
    ("unit", Function::Unit, "unit(vector)", "the vector at length 1, a plain vector"),
    ("angle", Function::Angle, "angle(vector)", "its direction, from \u{2212}180 deg to 180 deg"),
    ("rotate", Function::Rotate, "rotate(vector, angle)", "the vector turned counter-clockwise"),
    (
        "turn",
        Function::Turn,
        "turn(from, to)",
        "the shorter turn from one angle to another, above \u{2212}180 deg to 180 deg",
    ),
    ("wrap", Function::Wrap, "wrap(angle)", "the same direction as an angle above \u{2212}180 deg to 180 deg"),
    ("dot", Function::Dot, "dot(a, b)", "the scalar product of two vectors"),
    (
        "cross",
        Function::Cross,
        "cross(a, b)",
        "the product of two vectors that is positive when the second is to the left of the first",
    ),
    (
        "lowpass",
        Function::LowPass,
        "lowpass(x, cutoff)",
        "a number through a first-order low-pass filter with the cutoff, a frequency",
    ),
    (
        "pid",
        Function::Pid,
        "pid(error, p, i, d, limit)",
        "the output of a PID controller, within \u{00b1} the limit; its integral stands still at the limit",
    ),
];

/// The function with a name, and its notation.
pub(in crate::policy) fn function(name: &str) -> Option<(Function, &'static str)> {
    FUNCTIONS.iter().find(|(known, ..)| *known == name).map(|&(_, function, usage, _)| (function, usage))
}

impl Function {
    /// The arguments of the function.
    pub(in crate::policy) fn takes(self) -> &'static str {
        match self {
            Self::Abs | Self::Sign => "one number of any dimension",
            Self::Sqrt => "one number whose dimension is a square, such as an area",
            Self::Min | Self::Max | Self::Vector => "two numbers of one dimension",
            Self::Clamp => "three numbers of one dimension: what to clamp, the least, the greatest",
            Self::Blend => "two numbers or two vectors of one dimension, and a plain number",
            Self::Sin | Self::Cos | Self::Tan | Self::Direction | Self::Wrap => "one angle",
            Self::Asin | Self::Acos | Self::Exp | Self::Floor => "one plain number",
            Self::Unit | Self::Angle => "one vector",
            Self::Rotate => "a vector and an angle",
            Self::Turn => "two angles",
            Self::Dot | Self::Cross => "two vectors",
            Self::LowPass => "a number and a frequency",
            Self::Pid => {
                "the error, gains for its value, its integral and its change, and the output's limit; each gain times what \
             it is for has the dimension of the limit"
            }
        }
    }
}
