//! Members of whiskers, contours, the body and a run.

use crate::policy::test::RunFigure;
use crate::policy::types::Type;
use vibrissa_runtime::machine::{BodyScalar, ContourVector, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::units::Dimension;

/// A member of a whisker, a contour, the body or a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::policy) struct Member {
    pub(in crate::policy) name: &'static str,
    pub(in crate::policy) r#type: Type,
    pub(in crate::policy) source: MemberSource,
    /// The vector that the member returns for an argument, if it takes one.
    pub(in crate::policy) at: Option<At>,
    /// The meaning, for hover texts and the reference page.
    pub(in crate::policy) meaning: &'static str,
}

/// The source of a member's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::policy) enum MemberSource {
    Scalar(WhiskerScalar),
    Vector(WhiskerVector),
    /// The contour of the whisker. Its value is that of the whisker.
    Contour,
    Body(BodyScalar),
    BodyPosition,
    /// Only with an argument.
    At,
    Run(RunFigure),
    /// Number of entries of a state, which is the argument.
    Visits,
    /// Total time in a state, which is the argument.
    TimeIn,
}

/// A vector that a member returns for an argument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::policy) enum At {
    /// Position of the tip at a base angle.
    Tip,
    /// A vector of the contour at a distance from its newest end.
    Contour(ContourVector),
}

impl At {
    /// The name of the argument, its type, and an example.
    pub(in crate::policy) fn takes(self) -> (&'static str, Type, &'static str) {
        match self {
            Self::Tip => ("deflection", Type::ANGLE, "300 urad"),
            Self::Contour(_) => ("distance behind the end", Type::LENGTH, "5 mm"),
        }
    }
}

const fn member(name: &'static str, r#type: Type, source: MemberSource, meaning: &'static str) -> Member {
    Member { name, r#type, source, at: None, meaning }
}

const fn scalar(name: &'static str, r#type: Type, quantity: WhiskerScalar, meaning: &'static str) -> Member {
    member(name, r#type, MemberSource::Scalar(quantity), meaning)
}

const fn place(name: &'static str, quantity: WhiskerVector, meaning: &'static str) -> Member {
    member(name, Type::PLACE, MemberSource::Vector(quantity), meaning)
}

const WHISKER: [Member; 13] = [
    scalar(
        "deflection",
        Type::ANGLE,
        WhiskerScalar::Deflection,
        "the filtered angle of its base, counter-clockwise positive",
    ),
    scalar(
        "touching",
        Type::Truth,
        WhiskerScalar::Touching,
        "whether the deflection is beyond the rig's contact threshold",
    ),
    scalar("yaw", Type::ANGLE, WhiskerScalar::Yaw, "the direction of its straight shaft"),
    scalar("side", Type::NUMBER, WhiskerScalar::Side, "\u{2212}1 on the right, 1 on the left"),
    scalar(
        "sense",
        Type::NUMBER,
        WhiskerScalar::Sense,
        "1 when bent as forward motion bends it, \u{2212}1 when bent the other way, 0 when not touching",
    ),
    scalar("length", Type::LENGTH, WhiskerScalar::Length, "the length of its shaft"),
    place("tip", WhiskerVector::Tip, "where its tip touches, by the tip model"),
    place("tip_base", WhiskerVector::TipBase, "the same seen from its base: x along the straight shaft, y to its left"),
    scalar(
        "tip_spread",
        Type::LENGTH,
        WhiskerScalar::TipSpread,
        "how far off `tip` may be by its tip model, as a standard deviation; infinite beyond the model's range",
    ),
    place("base", WhiskerVector::Base, "its base"),
    scalar(
        "fitted",
        Type::Truth,
        WhiskerScalar::Fitted,
        "whether the rig has it, which may lack one that is bound `if fitted`",
    ),
    Member {
        at: Some(At::Tip),
        ..member(
            "tip_at",
            Type::PLACE,
            MemberSource::At,
            "where the tip would touch at another deflection, seen from its base",
        )
    },
    member("contour", Type::Contour, MemberSource::Contour, "what `record` has gathered behind its tip"),
];

const CONTOUR: [Member; 6] = [
    scalar(
        "ready",
        Type::Truth,
        WhiskerScalar::ContourReady,
        "whether this tick or the one before recorded it, and there are seven points, each a millimetre or more from the last; the curve is fitted to the newest seven",
    ),
    Member {
        at: Some(At::Contour(ContourVector::Tangent)),
        ..member(
            "tangent",
            Type::Vector(Dimension::NUMBER),
            MemberSource::Vector(WhiskerVector::ContourTangent),
            "the direction of travel at its end, or a distance behind it",
        )
    },
    Member {
        at: Some(At::Contour(ContourVector::Normal)),
        ..member(
            "normal",
            Type::Vector(Dimension::NUMBER),
            MemberSource::Vector(WhiskerVector::ContourNormal),
            "the direction away from the object: square to the tangent, on the side on which the whisker's base was when the newest \
             point was taken",
        )
    },
    place("end", WhiskerVector::ContourEnd, "its newest point"),
    Member {
        at: Some(At::Contour(ContourVector::Point)),
        ..member("point", Type::PLACE, MemberSource::At, "the point of the curve at a distance behind its end")
    },
    scalar(
        "curvature",
        Type::Scalar(Dimension::new(-1, 1, 0, 0)),
        WhiskerScalar::ContourCurvature,
        "the curvature at its end, counter-clockwise positive",
    ),
];

const BODY: [Member; 4] = [
    member("yaw", Type::ANGLE, MemberSource::Body(BodyScalar::Yaw), "its heading; it counts whole turns"),
    member("position", Type::PLACE, MemberSource::BodyPosition, "its centre of mass"),
    member(
        "blocked",
        Type::Truth,
        MemberSource::Body(BodyScalar::Blocked),
        "whether something other than the whiskers keeps it from following its commands",
    ),
    member(
        "shortfall",
        Type::SPEED,
        MemberSource::Body(BodyScalar::Shortfall),
        "the speed that it lacks against its commands, averaged over 0.2 s, at the corner that lacks most",
    ),
];

const fn figure(name: &'static str, r#type: Type, figure: RunFigure, meaning: &'static str) -> Member {
    member(name, r#type, MemberSource::Run(figure), meaning)
}

const RUN: [Member; 17] = [
    figure(
        "completed",
        Type::Truth,
        RunFigure::Completed,
        "whether it ended as it should: the loop closed, or the time of a scenario without a loop was up",
    ),
    figure("failed", Type::Truth, RunFigure::Failed, "whether the policy gave up"),
    figure("timed_out", Type::Truth, RunFigure::TimedOut, "whether the time was up before the loop closed"),
    figure("diverged", Type::Truth, RunFigure::Diverged, "whether the simulation could not be trusted"),
    figure("time", Type::TIME, RunFigure::Time, "how much time was simulated"),
    figure(
        "error_mean",
        Type::LENGTH,
        RunFigure::ErrorMean,
        "how far the recorded tips were from the object, on average",
    ),
    figure("error_p95", Type::LENGTH, RunFigure::ErrorP95, "the 95th percentile of that"),
    figure("error_max", Type::LENGTH, RunFigure::ErrorMax, "the maximum of that"),
    figure(
        "outliers",
        Type::NUMBER,
        RunFigure::Outliers,
        "the share of the recorded tips whose error exceeds 0.1 mm and four of their own standard deviations, 0 to 1",
    ),
    figure(
        "hausdorff",
        Type::LENGTH,
        RunFigure::Hausdorff,
        "the Hausdorff distance between the measured contour and the object's",
    ),
    figure("coverage", Type::NUMBER, RunFigure::Coverage, "the share of the object's outline that was traced, 0 to 1"),
    figure(
        "corner_place_max",
        Type::LENGTH,
        RunFigure::CornerPlaceMax,
        "how far the worst sharp corner was from where it is; not known if there is none, or one was not traced",
    ),
    figure(
        "corner_time_max",
        Type::TIME,
        RunFigure::CornerTimeMax,
        "the longest time that a sharp corner cost; not known if there is none, or one was not traced",
    ),
    figure(
        "corner_path_max",
        Type::LENGTH,
        RunFigure::CornerPathMax,
        "the longest path of the platform that one cost; not known if there is none, or one was not traced",
    ),
    figure("collisions", Type::NUMBER, RunFigure::Collisions, "how often the platform's body touched something"),
    member(
        "visits",
        Type::NUMBER,
        MemberSource::Visits,
        "how often a tick ended in the state that is given, or in one within it, and the tick before did not",
    ),
    member(
        "time_in",
        Type::TIME,
        MemberSource::TimeIn,
        "for how long the state that is given, or one within it, was active",
    ),
];

/// The members of a type.
pub(in crate::policy) fn members(owner: Type) -> &'static [Member] {
    match owner {
        Type::Whisker => &WHISKER,
        Type::Contour => &CONTOUR,
        Type::Body => &BODY,
        Type::Run => &RUN,
        Type::Truth | Type::Scalar(_) | Type::Vector(_) => &[],
    }
}
