//! Why a file gives no outlines.

use std::fmt;

use crate::diagnostic::NotUtf8;
use crate::geometry::{ContourError, Point2};
use vibrissa_runtime::units::{Dimension, format_si};

/// Why a file gives no outlines, and where in it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct OutlineError {
    /// Why.
    pub fault: OutlineFault,
    /// The line, from 1, where that is known.
    pub line: Option<usize>,
}

/// Why a file gives no outlines. Places are in the file's frame (m), y up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineFault {
    /// The program was built without the readers.
    #[error("this build reads no outlines from files")]
    NotBuilt,
    /// There are no bytes.
    #[error("there is nothing in it")]
    Empty,
    /// It should be a text, and is none.
    #[error("{0}")]
    NotUtf8(NotUtf8),
    /// There is more in it than is taken.
    #[error("there are more than {limit} {what}")]
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// The most that is taken.
        limit: usize,
    },
    /// It is not of its format.
    #[error("{reason}")]
    Syntax {
        /// What is wrong.
        reason: String,
    },
    /// Nobody says what 1 in it is.
    #[error("it does not say what 1 in it is")]
    NoUnit,
    /// There is nothing drawn in it.
    #[error("there is no outline in it")]
    NoOutline,
    /// There is no such element or layer.
    #[error("there is no `{element}` in it")]
    NoElement {
        /// What was asked for.
        element: String,
        /// What was probably meant.
        meant: Option<String>,
    },
    /// It has something that may change outlines, and that is not understood.
    #[error("{what} is not understood")]
    Unsupported {
        /// What it is.
        what: String,
        /// What can be done.
        advice: &'static str,
    },
    /// A number is not finite, or too large.
    #[error("a coordinate is more than 100 m from the origin, or no number")]
    FarOff,
    /// A circle or an arc has no size.
    #[error("a circle or an arc has the radius {radius}: it must be positive")]
    Radius {
        /// Its radius, in units of the file.
        radius: f64,
    },
    /// An ellipse has no width, or one that is negative.
    #[error("an ellipse has the axis ratio {ratio}: it must be positive")]
    AxisRatio {
        /// Its minor axis, divided by its major axis.
        ratio: f64,
    },
    /// A polygon has too few corners.
    #[error("{count} corners make no polygon")]
    Corners {
        /// How many it has.
        count: usize,
    },
    /// An outline has ends.
    #[error("an outline is open: {} from {} to {}", length((to - from).norm()), Place(*from), Place(*to))]
    Open {
        /// One end.
        from: Point2,
        /// The other.
        to: Point2,
    },
    /// Lines meet in a place, and there is no saying which of them go on in which.
    #[error("more than two lines end at {}", Place(*at))]
    Branches {
        /// Where.
        at: Point2,
    },
    /// An outline crosses or touches itself.
    #[error("an outline crosses or touches itself at {}", Place(*at))]
    Crosses {
        /// Where.
        at: Point2,
    },
    /// An outline is no contour.
    #[error("an outline cannot be: {0}")]
    Contour(ContourError),
    /// A curve has a cusp, or a part that is flat.
    #[error("a curve cannot be fitted by arcs to 1 µm")]
    Curve,
    /// A mesh has a hole where the plane cuts it.
    #[error("the mesh is not watertight: it has a hole at {}", Place(*at))]
    NotWatertight {
        /// Where.
        at: Point2,
    },
    /// The plane passes a mesh by. Heights are above the file's z = 0 (m).
    #[error(
        "the plane at {} passes it by: it reaches from {} to {}", length(*height), length(*lowest), length(*highest)
    )]
    Missed {
        /// That of the plane.
        height: f64,
        /// Where the mesh begins.
        lowest: f64,
        /// Where it ends.
        highest: f64,
    },
    /// An outline lies within another.
    #[error("an outline lies inside another{}", Other(*outer_line))]
    Hole {
        /// The line of the outer one.
        outer_line: Option<usize>,
    },
}

impl OutlineFault {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> String {
        match self {
            Self::NotBuilt => "build it with them: `cargo build --release --features outlines`",
            Self::Empty | Self::Syntax { .. } => {
                "look there, or save it anew: it may be damaged, cut off, or not what its ending says"
            }
            Self::NotUtf8(_) => NotUtf8::ADVICE,
            Self::TooLarge { .. } => "leave out what the whiskers cannot tell, or split it into several files",
            Self::NoUnit => "add `unit`, such as `unit: 1 mm`",
            Self::NoOutline => "draw lines, arcs, curves or shapes that are closed; texts and pictures are none",
            Self::NoElement { meant: Some(meant), .. } => return format!("did you mean `{meant}`?"),
            Self::NoElement { .. } => "leave `element` out for all that is in the file",
            Self::Unsupported { advice, .. } => advice,
            Self::FarOff => "is the `unit` right?",
            Self::Radius { .. } => "draw it anew with a positive radius, or take it out",
            Self::AxisRatio { .. } => "draw it anew with a positive ratio, or take it out",
            Self::Corners { .. } => "give at least three, a line each",
            Self::Open { .. } => "close it; or, if it is no outline, take it out or choose another `element`",
            Self::Branches { .. } => "take out what is drawn twice, and lines that are no outline",
            Self::Crosses { .. } => "go round the object once, without crossing an earlier side",
            Self::Contour(_) => "draw it anew there",
            Self::Curve => "round its cusp off, or end the curve there and begin another",
            Self::NotWatertight { .. } => "mend the mesh: most modelling programs can",
            Self::Missed { .. } => "choose a `height` between, or another `unit`",
            Self::Hole { .. } => "whiskers cannot reach a hole: take it out, or choose one of the two as `element`",
        }
        .to_owned()
    }

    /// The same at a line.
    #[cfg(feature = "outlines")]
    pub(super) fn at(self, line: Option<usize>) -> OutlineError {
        OutlineError { fault: self, line }
    }
}

#[cfg(feature = "outlines")]
impl OutlineError {
    /// The same at a line, unless it has one.
    pub(super) fn or_at(self, line: usize) -> Self {
        Self { line: self.line.or(Some(line)), ..self }
    }
}

impl From<OutlineFault> for OutlineError {
    fn from(fault: OutlineFault) -> Self {
        Self { fault, line: None }
    }
}

impl fmt::Display for OutlineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {}", self.fault),
            None => self.fault.fmt(f),
        }
    }
}

fn length(metres: f64) -> String {
    format_si(metres, Dimension::LENGTH)
}

struct Place(Point2);

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = [self.0.x, self.0.y].map(|metres| format_si(metres * 1e3, Dimension::NUMBER));
        write!(f, "({x} mm, {y} mm)")
    }
}

struct Other(Option<usize>);

impl fmt::Display for Other {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |line| write!(f, ", that of line {line}"))
    }
}
