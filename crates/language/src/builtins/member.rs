//! Members of whiskers, contours, the body and a run.

use std::sync::LazyLock;

use crate::test::{PlotFigure, RunFigure};
use crate::types::Type;
use vibrissa_declare::figures::{Figure, Metric};
use vibrissa_runtime::machine::{
    BodyScalar, ContourVector, MapQuestion, MapScalar, MapVector, WhiskerScalar, WhiskerVector,
};
use vibrissa_runtime::units::Dimension;

/// A member of a whisker, a contour, the body or a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Member {
    pub(crate) name: &'static str,
    pub(crate) r#type: Type,
    pub(crate) source: MemberSource,
    /// The value that the member returns for arguments, if it takes some.
    pub(crate) at: Option<At>,
    /// The meaning, for hover texts and the reference page.
    pub(crate) meaning: &'static str,
}

/// The source of a member's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MemberSource {
    Scalar(WhiskerScalar),
    Vector(WhiskerVector),
    /// The contour of the whisker. Its value is that of the whisker.
    Contour,
    Body(BodyScalar),
    BodyPosition,
    /// The component of a vector with this index. Its dimension is that of the vector.
    Component(u16),
    /// The middle of the nose.
    Nose,
    /// The middle of the tail.
    Tail,
    /// Only with arguments.
    At,
    Map(MapScalar),
    MapVector(MapVector),
    /// A part of the map: its next target or its route.
    MapPart,
    Run(RunFigure),
    /// Number of entries of a state, which is the argument.
    Visits,
    /// Total time in a state, which is the argument.
    TimeIn,
    /// A figure of a plot, which is the argument. Its type is that of the plot.
    Plot(PlotFigure),
}

/// A value that a member returns for arguments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum At {
    /// Position of the tip at a base angle.
    Tip,
    /// A vector of the contour at a distance from its newest end.
    Contour(ContourVector),
    /// True if a loop is closed within a distance, after a time.
    LoopClosed,
    /// True if a statement holds in the map.
    Map(MapQuestion),
}

impl At {
    /// The arguments.
    pub(crate) fn takes(self) -> Takes {
        match self {
            Self::Tip => &[("base angle", Type::ANGLE, "300 urad")],
            Self::Contour(_) => &[("distance behind the end", Type::LENGTH, "5 mm")],
            Self::LoopClosed => &[("largest distance", Type::LENGTH, "5 mm"), ("least time", Type::TIME, "5 s")],
            Self::Map(MapQuestion::IsClear) => {
                &[("position", Type::Position, "body.position"), ("heading", Type::ANGLE, "body.yaw")]
            }
            Self::Map(_) => &[("position", Type::Position, "body.position")],
        }
    }
}

const fn member(name: &'static str, r#type: Type, source: MemberSource, meaning: &'static str) -> Member {
    Member { name, r#type, source, at: None, meaning }
}

impl Member {
    const fn returning(self, at: At) -> Self {
        Self { at: Some(at), ..self }
    }
}

/// Declares the members of owners: the name, the type and the source, then the meaning, and what the member returns for arguments.
macro_rules! members {
    ($($(#[$doc:meta])* $owner:ident { $($name:literal $type:expr => $source:ident $(($of:expr))?, $meaning:literal $(, $at:expr)?;)* })*) => {
        $($(#[$doc])* const $owner: [Member; [$($name),*].len()] =
            [$(member($name, $type, MemberSource::$source $(($of))?, $meaning) $(.returning($at))?,)*];)*
    };
}

members! {
    /// A vector of plain numbers has components of this type.
    VECTOR {
        "x" Type::NUMBER => Component(0), "the first component of a vector";
        "y" Type::NUMBER => Component(1), "the second component of a vector";
    }

    WHISKER {
        "base_angle" Type::ANGLE => Scalar(WhiskerScalar::BaseAngle),
            "the filtered angle of its base, counter-clockwise positive";
        "base_angle_deviation" Type::ANGLE => Scalar(WhiskerScalar::BaseAngleDeviation),
            "standard deviation of `base_angle`, from the noise that the rig states or that was measured in free air, and from vibrations of the shaft";
        "touching" Type::Bool => Scalar(WhiskerScalar::Touching),
            "true if the magnitude of the base angle exceeds the rig's contact threshold and five standard deviations";
        "yaw" Type::ANGLE => Scalar(WhiskerScalar::Yaw), "the direction of the undeflected shaft";
        "side" Type::NUMBER => Scalar(WhiskerScalar::Side),
            "the side of the platform: \u{2212}1 on the right, 1 on the left";
        "sense" Type::NUMBER => Scalar(WhiskerScalar::Sense),
            "the sign of the base angle: 1 for the sign that forward motion causes, \u{2212}1 for the other, 0 without contact";
        "length" Type::LENGTH => Scalar(WhiskerScalar::Length), "the length of the shaft";
        "tip" Type::Position => Vector(WhiskerVector::Tip),
            "the position of the tip, as estimated by the contact estimator";
        "tip_base" Type::DISPLACEMENT => Vector(WhiskerVector::TipBase),
            "the displacement of the tip from the base: x along the undeflected shaft, y to its left";
        "tip_deviation" Type::LENGTH => Scalar(WhiskerScalar::TipDeviation),
            "standard deviation of `tip` as the contact estimator reports it. It is infinite beyond its range";
        "recorded_deviation" Type::LENGTH => Scalar(WhiskerScalar::RecordedDeviation),
            "standard deviation from the surface with which `record` records the tip. Other than `tip_deviation`, it contains what the estimator does not know: a whisker that came to rest without having been free may be caught";
        "base" Type::Position => Vector(WhiskerVector::Base), "the position of the base";
        "fitted" Type::Bool => Scalar(WhiskerScalar::Fitted),
            "true if the rig has the whisker. Only whiskers that are bound `if fitted` may be missing";
        "tip_at" Type::DISPLACEMENT => At,
            "the displacement of the tip from the base at a given base angle, in the axes of `tip_base`", At::Tip;
        "loop_closed" Type::Bool => At,
            "true if the whisker went around an object: in the tick before it recorded a tip within the given distance of its first ones, at least the given time later, and the body has moved around. A whisker can close one loop in a run: behind a gap, the same loop goes on. `trace_object` in `std.object` traces several objects", At::LoopClosed;
        "contour" Type::Contour => Contour, "the local contour behind the tip, from the points of `record`";
    }

    CONTOUR {
        "ready" Type::Bool => Scalar(WhiskerScalar::ContourReady),
            "true if a point was recorded in this tick or the one before, and there are enough points for a curve: seven, unless the policy states another number";
        "tangent" Type::Direction => Vector(WhiskerVector::ContourTangent),
            "the tangent of the curve in the direction of travel, at its newest end or at a distance behind it", At::Contour(ContourVector::Tangent);
        "normal" Type::Direction => Vector(WhiskerVector::ContourNormal),
            "the normal of the curve, away from the object: on the side of the whisker's base when the newest point was recorded. A contour of positions has it on the left", At::Contour(ContourVector::Normal);
        "end" Type::Position => Vector(WhiskerVector::ContourEnd), "the newest point of the contour";
        "point" Type::Position => At,
            "the point of the curve at a distance behind its newest end", At::Contour(ContourVector::Point);
        "curvature" Type::Scalar(Dimension::new(-1, 1, 0, 0)) => Scalar(WhiskerScalar::ContourCurvature),
            "the curvature at the newest end, counter-clockwise positive";
    }

    BODY {
        "yaw" Type::ANGLE => Body(BodyScalar::Yaw), "the heading of the platform, without wrapping at full rotations";
        "position" Type::Position => BodyPosition, "the centre of mass of the platform";
        "blocked" Type::Bool => Body(BodyScalar::Blocked),
            "true if the body is blocked: an obstacle prevents it from following its commands";
        "shortfall" Type::SPEED => Body(BodyScalar::Shortfall),
            "the difference between commanded and actual speed, averaged over 0.2 s, at the corner of the body where it is largest";
        "nose" Type::Position => Nose, "the middle of the nose of the platform, from the rig";
        "tail" Type::Position => Tail, "the middle of the tail of the platform, from the rig";
        "length" Type::LENGTH => Body(BodyScalar::Length), "the length of the platform from tail to nose, from the rig";
        "width" Type::LENGTH => Body(BodyScalar::Width), "the greatest width of the platform, from the rig";
        "nose_width" Type::LENGTH => Body(BodyScalar::NoseWidth), "the width of the platform at the nose, from the rig";
        "tail_width" Type::LENGTH => Body(BodyScalar::TailWidth), "the width of the platform at the tail, from the rig";
        "flexibility" Type::NUMBER => Body(BodyScalar::Flexibility),
            "the ratio of the base angles of the first bound whisker and of the reference whisker, bent to the same shape, from the rig";
        "decay" Type::TIME => Body(BodyScalar::Decay),
            "the time in which the first bound whisker, released in the air, comes nearer to rest by a factor e, from the rig";
        "sway" Type::NUMBER => Body(BodyScalar::Sway),
            "the ratio of the base angles of the first bound whisker and of the reference whisker by inertia, under the same acceleration, from the rig";
    }

    MAP {
        "next" Type::Target => MapPart, "what should be touched or looked at next";
        "route" Type::Route => MapPart, "the route of the body to the goal of `tell map.go_to`";
        "complete" Type::Bool => Map(MapScalar::IsComplete),
            "true if nothing that the array can reach is left to be touched or looked at";
        "unknown" Type::Scalar(Dimension::AREA) => Map(MapScalar::Unknown),
            "the area of the unknown ground beside free ground, without ground beside known surfaces";
        "free" Type::Bool => At, "true if the position is proved free", At::Map(MapQuestion::IsFree);
        "clear" Type::Bool => At,
            "true if all ground of the body at the position and heading is proved free", At::Map(MapQuestion::IsClear);
        "traced" Type::Bool => At,
            "true if a tip was recorded within 10 mm of the position", At::Map(MapQuestion::IsTraced);
    }

    TARGET {
        "exists" Type::Bool => Map(MapScalar::HasNext),
            "true if there is a next target. Its other members are unknown without one";
        "on_surface" Type::Bool => Map(MapScalar::NextIsSurface),
            "true if the target is the open end of a contour, a gap or a touched position, false if it is unknown ground";
        "place" Type::Position => MapVector(MapVector::NextPlace), "the position that should be touched or looked at";
        "normal" Type::Direction => MapVector(MapVector::NextNormal), "the direction from `place` to free ground";
        "position" Type::Position => MapVector(MapVector::NextPosition), "the position of the body from which to begin";
        "heading" Type::ANGLE => Map(MapScalar::NextHeading), "the heading of the body from which to begin";
        "side" Type::NUMBER => Map(MapScalar::NextSide),
            "the side of the whisker that should touch: \u{2212}1 on the right, 1 on the left";
    }

    ROUTE {
        "direction" Type::Vector(Dimension::NUMBER) => MapVector(MapVector::RouteDirection),
            "the direction of motion along the route, of length 1, or 0 at a standstill";
        "speed" Type::SPEED => Map(MapScalar::RouteSpeed), "the speed along the route, 0 while there is none";
        "yaw_rate" Type::ANGULAR_SPEED => Map(MapScalar::RouteYawRate),
            "the yaw rate along the route, 0 while there is none";
        "arrived" Type::Bool => Map(MapScalar::RouteIsDone),
            "true if the body has followed the route and is at its goal";
        "lost" Type::Bool => Map(MapScalar::RouteIsLost), "true if no route leads to the goal, or the body has left it";
    }

    /// The verdicts on a run.
    VERDICTS {
        "passed" Type::Bool => Run(RunFigure::Passed),
            "true if the run fulfils the expectations of its scenario. A scenario without expectations expects completion";
        "completed" Type::Bool => Run(RunFigure::Completed),
            "true if the run completed: the policy succeeded, the loop closed, the goal was reached, or the time of a scenario without an aim ended";
        "failed" Type::Bool => Run(RunFigure::Failed), "true if the run ended in `Failure`";
        "timed_out" Type::Bool => Run(RunFigure::TimedOut),
            "true if the run reached its time limit before the loop closed";
        "diverged" Type::Bool => Run(RunFigure::Diverged), "true if the simulation diverged";
    }

    /// Figures of the states and the plots of a run.
    PARTS {
        "visits" Type::NUMBER => Visits,
            "the number of entries of the given state: ticks that end in it or in an inner state, after a tick that did not";
        "time_in" Type::TIME => TimeIn, "the total time in the given state or in an inner state";
        "least" Type::NUMBER => Plot(PlotFigure::Least),
            "the least value of the given plot, of its type. Unknown if it was never set";
        "greatest" Type::NUMBER => Plot(PlotFigure::Greatest), "its greatest value";
        "last" Type::NUMBER => Plot(PlotFigure::Last), "its last value";
    }
}

/// The names of values, their types, and examples.
type Takes = &'static [(&'static str, Type, &'static str)];

/// The events of the map that a statement can tell: the name, the values, and the meaning.
pub(crate) const MAP_EVENTS: [(&str, Takes, &str); 3] = [
    (
        "go_to",
        &[("position", Type::Position, "map.next.position"), ("heading", Type::ANGLE, "map.next.heading")],
        "searches a route of the body to a position and a heading. The search takes some ticks, and goes on while the goal stays the same",
    ),
    (
        "felt",
        &[("position", Type::Position, "w.tip"), ("direction", Type::Direction, "direction(body.yaw + 180 deg)")],
        "something was felt at a position, with free ground in a direction. It becomes a target, unless it is known, refuted by free ground, or given up",
    ),
    (
        "give_up",
        &[],
        "the target that the body went to could not be touched. After three attempts the map closes it, and what is near it",
    ),
];

/// The notation of an event of the map.
pub(crate) fn map_event_usage(name: &str, takes: &[(&str, Type, &str)]) -> String {
    let values: Vec<&str> = takes.iter().map(|&(value, ..)| value).collect();
    let values = if values.is_empty() { String::new() } else { format!("({})", values.join(", ")) };
    format!("tell map.{name}{values}")
}

/// The members of a run: its verdict, the figures that tests can read, and figures of its states and plots.
static RUN: LazyLock<Vec<Member>> = LazyLock::new(|| {
    let figures = Metric::ALL.into_iter().filter(|metric| metric.figure().is_in_tests).map(|metric| {
        let Figure { meaning, .. } = *metric.figure();
        let (r#type, source) =
            (Type::Scalar(metric.figure().dimension()), MemberSource::Run(RunFigure::Metric(metric)));
        member(metric.name(), r#type, source, meaning)
    });
    VERDICTS.into_iter().chain(figures).chain(PARTS).collect()
});

/// The members of a list: the name, the notation and the meaning.
pub(crate) const LIST_MEMBERS: [(&str, &str, &str); 6] = [
    ("count", "count", "the number of its elements"),
    ("newest", "newest", "the element that was added last. Unknown in an empty list"),
    ("oldest", "oldest", "the element that was added first of those that it has. Unknown in an empty list"),
    ("element", "element(index)", "the element with an index, from 0 for the newest. Unknown if there is none"),
    ("nearest", "nearest(position)", "of a list of positions, the one nearest to a position. Unknown in an empty list"),
    ("with", "with(value)", "the list with a new element. A full list loses its oldest element"),
];

/// The members of a type.
pub(crate) fn members(owner: Type) -> &'static [Member] {
    match owner {
        Type::Whisker => &WHISKER,
        Type::Contour => &CONTOUR,
        Type::Body => &BODY,
        Type::Map => &MAP,
        Type::Target => &TARGET,
        Type::Route => &ROUTE,
        Type::Vector(_) | Type::Position | Type::Direction => &VECTOR,
        Type::Run => &RUN,
        Type::Bool | Type::Choice(_) | Type::Scalar(_) | Type::Compound(_) | Type::Monitor(_) => &[],
    }
}
