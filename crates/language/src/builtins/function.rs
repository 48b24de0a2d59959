//! Functions.

/// Declares the functions: the variant and the name, then the notation, the arguments and the result.
macro_rules! functions {
    ($($function:ident $name:literal => $usage:literal, $takes:literal, $result:literal;)*) => {
        /// A built-in function.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(crate) enum Function { $($function,)* }

        /// Every function: its name, the function, its notation and its result.
        pub(crate) const FUNCTIONS: [(&str, Function, &str, &str); [$($name),*].len()] =
            [$(($name, Function::$function, $usage, $result),)*];

        impl Function {
            /// The arguments of the function.
            pub(crate) fn takes(self) -> &'static str {
                match self { $(Self::$function => $takes,)* }
            }
        }
    };
}

functions! {
    Abs "abs" => "abs(x)", "one number of any dimension", "the absolute value of a number";
    Sign "sign" => "sign(x)", "one number of any dimension", "\u{2212}1, 0 or 1, the sign of a number";
    Sqrt "sqrt" => "sqrt(x)", "one number with a dimension that is a square, such as an area",
        "the square root of a number. Its dimension is the square root of the number's dimension";
    Min "min" => "min(a, b)", "two numbers of one dimension", "the smaller of two numbers";
    Max "max" => "max(a, b)", "two numbers of one dimension", "the larger of two numbers";
    Clamp "clamp" => "clamp(x, low, high)", "three numbers of one dimension: the value, the minimum, the maximum",
        "`min(max(x, low), high)`";
    Blend "blend" => "blend(a, b, share)", "two numbers, two vectors of one dimension or two positions, and a plain number",
        "the linear interpolation `(1 - share) * a + share * b`";
    Sin "sin" => "sin(angle)", "one angle", "the sine of an angle, a plain number";
    Cos "cos" => "cos(angle)", "one angle", "the cosine of an angle, a plain number";
    Tan "tan" => "tan(angle)", "one angle", "the tangent of an angle, a plain number";
    Asin "asin" => "asin(x)", "one plain number",
        "the arcsine of a plain number, an angle from \u{2212}90 deg to 90 deg";
    Acos "acos" => "acos(x)", "one plain number", "the arccosine of a plain number, an angle from 0 deg to 180 deg";
    Exp "exp" => "exp(x)", "one plain number", "e to the power of a plain number";
    Floor "floor" => "floor(x)", "one plain number", "the largest integer that does not exceed a plain number";
    Direction "direction" => "direction(angle)", "one angle",
        "the direction with an angle (0 is along x, counter-clockwise positive)";
    Vector "vector" => "vector(x, y)", "two numbers of one dimension", "the vector with these components";
    Position "position" => "position(x, y)", "two lengths", "the position with these coordinates in the world frame";
    Unit "unit" => "unit(vector)", "one vector", "the direction of a vector";
    Angle "angle" => "angle(vector)", "one vector", "the angle of a vector, from \u{2212}180 deg to 180 deg";
    Rotate "rotate" => "rotate(vector, angle)", "a vector and an angle",
        "the vector, rotated counter-clockwise by the angle. A rotated direction is a direction";
    Turn "turn" => "turn(from, to)", "two angles",
        "the smallest rotation from one angle to another, above \u{2212}180 deg to 180 deg";
    Wrap "wrap" => "wrap(angle)", "one angle", "the angle, wrapped to the range above \u{2212}180 deg to 180 deg";
    Dot "dot" => "dot(a, b)", "two vectors", "the scalar product of two vectors";
    Cross "cross" => "cross(a, b)", "two vectors",
        "the cross product of two vectors. It is positive if the second is to the left of the first";
    LowPass "lowpass" => "lowpass(x, cutoff)", "a number and a frequency",
        "a number, filtered by a first-order low-pass filter with this cutoff frequency";
    Pid "pid" => "pid(error, p, i, d, limit)", "the error, gains for the error, its integral and its derivative, and the limit of the output, such that each gain multiplied by its quantity has the dimension of the limit",
        "the output of a PID controller, limited to \u{00b1} the limit. The integral does not change while the output is at the limit (anti-windup)";
    Previous "previous" => "previous(x)", "a number, a vector or a position",
        "a number, a vector or a position as it was at the last earlier tick in which it was computed. At first, the value itself";
    Peak "peak" => "peak(x)", "one number of any dimension",
        "the largest value of a number since the state was entered";
    Settled "settled" => "settled(x, within, lasting)", "two numbers of one dimension, and a time",
        "true if a number has stayed within this distance of one value for this time";
    PathLength "path_length" => "path_length(position)", "a position",
        "the length of the path of a position since the state was entered";
}

/// The function with a name, and its notation.
pub(crate) fn function(name: &str) -> Option<(Function, &'static str)> {
    FUNCTIONS.iter().find(|(known, ..)| *known == name).map(|&(_, function, usage, _)| (function, usage))
}
