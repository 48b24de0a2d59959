//! What the language offers: members of whiskers, contours and the body, and functions.

use crate::machine::{BodyScalar, WhiskerScalar, WhiskerVector};
use crate::units::Dimension;

use super::test::RunFigure;
use super::types::Type;

/// A member of a whisker, a contour or the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Member {
    pub(super) name: &'static str,
    pub(super) r#type: Type,
    pub(super) source: MemberSource,
}

/// Where a member's value comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MemberSource {
    Scalar(WhiskerScalar),
    Vector(WhiskerVector),
    /// The whisker's place at a deflection that is given as a value.
    TipAt,
    /// The contour of the whisker, which is known by the whisker.
    Contour,
    Body(BodyScalar),
    BodyPosition,
    Run(RunFigure),
    /// How often a state was entered that is given as a value.
    Visits,
    /// For how long a state was active that is given as a value.
    TimeIn,
}

const fn member(name: &'static str, r#type: Type, source: MemberSource) -> Member {
    Member { name, r#type, source }
}

const WHISKER: [Member; 11] = [
    member("deflection", Type::ANGLE, MemberSource::Scalar(WhiskerScalar::Deflection)),
    member("touching", Type::Truth, MemberSource::Scalar(WhiskerScalar::Touching)),
    member("yaw", Type::ANGLE, MemberSource::Scalar(WhiskerScalar::Yaw)),
    member("side", Type::NUMBER, MemberSource::Scalar(WhiskerScalar::Side)),
    member("sense", Type::NUMBER, MemberSource::Scalar(WhiskerScalar::Sense)),
    member("length", Type::LENGTH, MemberSource::Scalar(WhiskerScalar::Length)),
    member("tip", Type::Vector(Dimension::LENGTH), MemberSource::Vector(WhiskerVector::Tip)),
    member("tip_base", Type::Vector(Dimension::LENGTH), MemberSource::Vector(WhiskerVector::TipBase)),
    member("base", Type::Vector(Dimension::LENGTH), MemberSource::Vector(WhiskerVector::Base)),
    member("tip_at", Type::Vector(Dimension::LENGTH), MemberSource::TipAt),
    member("contour", Type::Contour, MemberSource::Contour),
];

const CONTOUR: [Member; 4] = [
    member("ready", Type::Truth, MemberSource::Scalar(WhiskerScalar::ContourReady)),
    member("tangent", Type::Vector(Dimension::NUMBER), MemberSource::Vector(WhiskerVector::ContourTangent)),
    member("end", Type::Vector(Dimension::LENGTH), MemberSource::Vector(WhiskerVector::ContourEnd)),
    member(
        "curvature",
        Type::Scalar(Dimension::new(-1, 1, 0, 0)),
        MemberSource::Scalar(WhiskerScalar::ContourCurvature),
    ),
];

const BODY: [Member; 2] = [
    member("yaw", Type::ANGLE, MemberSource::Body(BodyScalar::Yaw)),
    member("position", Type::Vector(Dimension::LENGTH), MemberSource::BodyPosition),
];

const RUN: [Member; 12] = [
    member("completed", Type::Truth, MemberSource::Run(RunFigure::Completed)),
    member("failed", Type::Truth, MemberSource::Run(RunFigure::Failed)),
    member("timed_out", Type::Truth, MemberSource::Run(RunFigure::TimedOut)),
    member("diverged", Type::Truth, MemberSource::Run(RunFigure::Diverged)),
    member("time", Type::TIME, MemberSource::Run(RunFigure::Time)),
    member("error_mean", Type::LENGTH, MemberSource::Run(RunFigure::ErrorMean)),
    member("error_p95", Type::LENGTH, MemberSource::Run(RunFigure::ErrorP95)),
    member("error_max", Type::LENGTH, MemberSource::Run(RunFigure::ErrorMax)),
    member("hausdorff", Type::LENGTH, MemberSource::Run(RunFigure::Hausdorff)),
    member("coverage", Type::NUMBER, MemberSource::Run(RunFigure::Coverage)),
    member("visits", Type::NUMBER, MemberSource::Visits),
    member("time_in", Type::TIME, MemberSource::TimeIn),
];

/// The members of a type.
pub(super) fn members(owner: Type) -> &'static [Member] {
    match owner {
        Type::Whisker => &WHISKER,
        Type::Contour => &CONTOUR,
        Type::Body => &BODY,
        Type::Run => &RUN,
        Type::Truth | Type::Scalar(_) | Type::Vector(_) => &[],
    }
}

/// A function that the language offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Abs,
    Sign,
    Sqrt,
    Min,
    Max,
    Clamp,
    Sin,
    Cos,
    Direction,
    Vector,
    Unit,
    Angle,
    Rotate,
    Turn,
    Dot,
    Cross,
    LowPass,
    Pid,
}

/// Every function, by its name, with how it is called.
pub(super) const FUNCTIONS: [(&str, Function, &str); 18] = [
    ("abs", Function::Abs, "abs(x)"),
    ("sign", Function::Sign, "sign(x)"),
    ("sqrt", Function::Sqrt, "sqrt(x)"),
    ("min", Function::Min, "min(a, b)"),
    ("max", Function::Max, "max(a, b)"),
    ("clamp", Function::Clamp, "clamp(x, low, high)"),
    ("sin", Function::Sin, "sin(angle)"),
    ("cos", Function::Cos, "cos(angle)"),
    ("direction", Function::Direction, "direction(angle)"),
    ("vector", Function::Vector, "vector(x, y)"),
    ("unit", Function::Unit, "unit(vector)"),
    ("angle", Function::Angle, "angle(vector)"),
    ("rotate", Function::Rotate, "rotate(vector, angle)"),
    ("turn", Function::Turn, "turn(from, to)"),
    ("dot", Function::Dot, "dot(a, b)"),
    ("cross", Function::Cross, "cross(a, b)"),
    ("lowpass", Function::LowPass, "lowpass(x, cutoff)"),
    ("pid", Function::Pid, "pid(error, p, i, d, limit)"),
];

/// The function called `name`, with how it is called.
pub(super) fn function(name: &str) -> Option<(Function, &'static str)> {
    FUNCTIONS.iter().find(|(known, ..)| *known == name).map(|&(_, function, usage)| (function, usage))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_languages_page_names_everything_that_the_language_offers() {
        let page = include_str!("../../docs/language.md");
        for (_, _, usage) in FUNCTIONS {
            assert!(page.contains(&format!("`{usage}`")), "{usage}");
        }
        for (owner, prefix) in
            [(Type::Whisker, "w"), (Type::Contour, "w.contour"), (Type::Body, "body"), (Type::Run, "run")]
        {
            for member in members(owner) {
                let plain = page.contains(&format!("`{prefix}.{}`", member.name));
                assert!(plain || page.contains(&format!("`{prefix}.{}(", member.name)), "{}", member.name);
            }
        }
        for (name, _) in super::super::types::DIMENSIONS {
            assert!(page.contains(&format!("`{name}`")), "{name}");
        }
    }

    #[test]
    fn the_editors_grammar_lists_the_functions_and_types_of_the_language() {
        let grammar = include_str!("../../editors/vscode/syntaxes/fsm.tmLanguage.json");
        let list =
            |words: &mut dyn Iterator<Item = &'static str>| format!(r"\\b({})\\b", words.collect::<Vec<_>>().join("|"));
        assert!(grammar.contains(&list(&mut FUNCTIONS.iter().map(|&(name, ..)| name))));
        let types = ["truth", "vector"].into_iter().chain(super::super::types::DIMENSIONS.map(|(name, _)| name));
        assert!(grammar.contains(&list(&mut { types })));
    }
}
