//! Errors of outline files.

use std::fmt;

use crate::geometry::{ContourError, Point2};
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::NotUtf8;

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
    #[error("the file is empty")]
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
    #[error("the file does not state its unit of length")]
    NoUnit,
    /// The file contains no outline.
    #[error("the file has no closed outline")]
    NoOutline,
    /// All outlines of the file are invisible.
    #[error("the file has no visible outline; parts that are hidden, or have neither a fill nor a stroke: {unseen}")]
    Invisible {
        /// The number of invisible parts.
        unseen: usize,
    },
    /// The frame of a drawing states no lengths.
    #[error(
        "the file does not state its unit of length: `{attribute}` is {}",
        found.as_ref().map_or("missing".to_owned(), |found| format!("`{found}`, which is no physical length"))
    )]
    NoLength {
        /// The attribute of the frame.
        attribute: &'static str,
        /// Its value, if it has one.
        found: Option<String>,
    },
    /// The frame of a drawing does not say how many units it has.
    #[error(
        "the file does not state its unit of length: it has no `viewBox` of four numbers, so its units have no length"
    )]
    NoViewBox,
    /// The file states a unit of length that does not exist.
    #[error("the file states `{stated}` as its unit of length, which is not known")]
    UnknownUnit {
        /// The unit.
        stated: String,
    },
    /// The requested element or layer does not exist.
    #[error("the file has no element or layer `{element}`")]
    NoElement {
        /// The requested name.
        element: String,
        /// A similar existing name.
        meant: Option<String>,
    },
    /// The file contains an unsupported feature that may change outlines.
    #[error("{what} is not supported")]
    Unsupported {
        /// The feature.
        what: String,
        /// Advice to the user.
        advice: &'static str,
    },
    /// A number is not finite, or too large.
    #[error("a coordinate is more than 100 m from the origin, or not a number")]
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
    #[error("a polygon has {count} corners, and needs at least three")]
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
    #[error("an outline is invalid: {0}")]
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
        "the plane at {} does not cut the mesh, which extends from {} to {}", length(*height), length(*lowest), length(*highest)
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
            Self::NotBuilt => "build the program with the readers: `cargo build --release --features outlines`",
            Self::Empty | Self::Syntax { .. } => {
                "check this line, or export the file again: it may be damaged, truncated, or in another format than its extension says"
            }
            Self::NotUtf8(_) => NotUtf8::ADVICE,
            Self::TooLarge { .. } => "leave out details that are finer than whiskers resolve, or split the drawing into several files",
            Self::Invisible { .. } => "make visible what is an outline, or choose it by `element`",
            Self::NoUnit | Self::NoViewBox | Self::UnknownUnit { .. } => "add `unit`, such as `unit: 1 mm`",
            Self::NoLength { .. } => {
                "add `unit`, such as `unit: 1 mm`; or write the size of the drawing in mm, cm, Q, in, pt or pc"
            }
            Self::NoOutline => "draw closed lines, arcs, curves or shapes; texts and pictures are not read",
            Self::NoElement { meant: Some(meant), .. } => return format!("did you mean `{meant}`?"),
            Self::NoElement { .. } => "leave `element` out to read the whole file",
            Self::Unsupported { advice, .. } => advice,
            Self::FarOff => "is the `unit` right?",
            Self::Radius { .. } => "give it a positive radius, or remove it",
            Self::AxisRatio { .. } => "give it a positive ratio, or remove it",
            Self::Corners { .. } => "add corners, one in each line",
            Self::Open { .. } => "close it; if it is not an outline, remove it or choose another `element`",
            Self::Branches { .. } => "remove duplicate lines, and lines that are not outlines",
            Self::Crosses { .. } => "trace the object once, without crossing an earlier side",
            Self::Contour(_) => "correct the drawing there",
            Self::Curve => "round the cusp off, or split the curve there",
            Self::NotWatertight { .. } => "close the hole; most modelling programs can repair a mesh",
            Self::Missed { .. } => "choose a `height` between them, or another `unit`",
            Self::Hole { .. } => "whiskers cannot reach a hole: write `holes: ignore`, remove it, or choose one of the two outlines by `element`",
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
        self.0.map_or(Ok(()), |line| write!(f, ", which begins in line {line}"))
    }
}
