//! Errors of outline files.

use std::fmt;

use crate::diagnostic::NotUtf8;
use crate::geometry::{ContourError, Point2};
use vibrissa_runtime::units::{Dimension, format_si};

/// An error of an outline file, with its line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct OutlineError {
    /// The error.
    pub fault: OutlineFault,
    /// The line, counted from 1, if it is known.
    pub line: Option<usize>,
}

/// The kinds of errors of outline files. Positions are in the file's frame (m), y up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineFault {
    /// The program was built without the readers.
    #[error("this build reads no outlines from files")]
    NotBuilt,
    /// The file is empty.
    #[error("there is nothing in it")]
    Empty,
    /// The file is not valid text.
    #[error("{0}")]
    NotUtf8(NotUtf8),
    /// The content exceeds a limit.
    #[error("there are more than {limit} {what}")]
    TooLarge {
        /// The quantity that exceeds its limit.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The file violates its format.
    #[error("{reason}")]
    Syntax {
        /// The reason.
        reason: String,
    },
    /// The unit of length is unknown.
    #[error("it does not say what 1 in it is")]
    NoUnit,
    /// The file contains no outline.
    #[error("there is no outline in it")]
    NoOutline,
    /// The requested element or layer does not exist.
    #[error("there is no `{element}` in it")]
    NoElement {
        /// The requested name.
        element: String,
        /// A similar existing name.
        meant: Option<String>,
    },
    /// The file contains an unsupported feature that may change outlines.
    #[error("{what} is not understood")]
    Unsupported {
        /// The feature.
        what: String,
        /// Advice to the user.
        advice: &'static str,
    },
    /// A number is not finite, or too large.
    #[error("a coordinate is more than 100 m from the origin, or no number")]
    FarOff,
    /// The radius of a circle or an arc is not positive.
    #[error("a circle or an arc has the radius {radius}: it must be positive")]
    Radius {
        /// The radius, in units of the file.
        radius: f64,
    },
    /// The axis ratio of an ellipse is not positive.
    #[error("an ellipse has the axis ratio {ratio}: it must be positive")]
    AxisRatio {
        /// The ratio of its minor and its major axis.
        ratio: f64,
    },
    /// A polygon has too few corners.
    #[error("{count} corners make no polygon")]
    Corners {
        /// The number of its corners.
        count: usize,
    },
    /// An outline is open.
    #[error("an outline is open: {} from {} to {}", length((to - from).norm()), Place(*from), Place(*to))]
    Open {
        /// One end.
        from: Point2,
        /// The other end.
        to: Point2,
    },
    /// More than two lines meet at a point, so that the outline is ambiguous.
    #[error("more than two lines end at {}", Place(*at))]
    Branches {
        /// The point.
        at: Point2,
    },
    /// An outline crosses or touches itself.
    #[error("an outline crosses or touches itself at {}", Place(*at))]
    Crosses {
        /// The point.
        at: Point2,
    },
    /// An outline is not a valid contour.
    #[error("an outline cannot be: {0}")]
    Contour(ContourError),
    /// A curve has a cusp or a degenerate part.
    #[error("a curve cannot be fitted by arcs to 1 µm")]
    Curve,
    /// The mesh has a gap at the cutting plane.
    #[error("the mesh is not watertight: it has a hole at {}", Place(*at))]
    NotWatertight {
        /// The position of the gap.
        at: Point2,
    },
    /// The plane does not intersect the mesh. Heights are relative to the file's z = 0 (m).
    #[error(
        "the plane at {} passes it by: it reaches from {} to {}", length(*height), length(*lowest), length(*highest)
    )]
    Missed {
        /// The height of the plane.
        height: f64,
        /// The lowest point of the mesh.
        lowest: f64,
        /// The highest point of the mesh.
        highest: f64,
    },
    /// An outline lies within another.
    #[error("an outline lies inside another{}", Other(*outer_line))]
    Hole {
        /// The line of the outer outline.
        outer_line: Option<usize>,
    },
}

impl OutlineFault {
    /// Advice to the user.
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

    /// Adds a line to the error.
    #[cfg(feature = "outlines")]
    pub(super) fn at(self, line: Option<usize>) -> OutlineError {
        OutlineError { fault: self, line }
    }
}

#[cfg(feature = "outlines")]
impl OutlineError {
    /// Adds a line to the error, unless it has one.
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
