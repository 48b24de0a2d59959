//! What is not known when a policy is compiled: parameters, what states are entered with, what is felt.

use std::f64::consts::{PI, TAU};

use vibrissa_runtime::machine::{BodyScalar, Register, WhiskerScalar, WhiskerVector};

use super::interval::Interval;

/// Farther than any whisker goes (m).
const FAR: f64 = 1e6;
/// More than any body turns (rad).
const WHIRL: f64 = 1e5;
/// The least deflection of a whisker that touches (rad).
pub(super) const TOUCH: f64 = 1e-9;

/// One degree of freedom of all that guards may read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unknown {
    /// A parameter, or a value that a state was entered with.
    Register(Register),
    Time,
    Body(BodyScalar),
    /// One coordinate.
    BodyPosition(usize),
    /// The side of a whisker and how it is bent, which go together: one of [`CONTACTS`].
    Contact(usize),
    /// The deflection of a whisker that does not touch; only its magnitude counts where it touches.
    Deflection(usize),
    /// What there is of a whisker's contour: one of [`CONTOURS`].
    Contour(usize),
    /// The direction of a whisker's contour (rad).
    Travel(usize),
    /// The direction away from a whisker's object (rad).
    Away(usize),
    /// Any other number of a whisker.
    Whisker(usize, WhiskerScalar),
    /// One coordinate of any other vector of a whisker.
    WhiskerVector(usize, WhiskerVector, usize),
}

/// A whisker's side and its sense, numbered.
const CONTACTS: [(f64, f64); 6] = [(1.0, 0.0), (-1.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];

/// A contour that is ready; none; one that was left off: it is not ready, and can be read.
const CONTOURS: [f64; 3] = [1.0, 0.0, -1.0];

/// The values that an unknown may have.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Domain {
    /// Any of these.
    Values(Vec<f64>),
    /// Any within.
    Range(Interval),
}

impl Domain {
    /// All that can be felt. For registers, see the model.
    pub(super) fn felt(unknown: Unknown) -> Self {
        let range = |low, high| Self::Range(Interval::new(low, high));
        match unknown {
            Unknown::Register(_) => Self::Range(Interval::ANYTHING),
            Unknown::Time => range(0.0, 1e9),
            Unknown::Body(BodyScalar::Yaw) | Unknown::Whisker(_, WhiskerScalar::Yaw) => range(-WHIRL, WHIRL),
            // The plainest body follows its commands.
            Unknown::Body(BodyScalar::Blocked) => Self::Values(vec![0.0, 1.0]),
            Unknown::Body(BodyScalar::Shortfall) => range(0.0, FAR),
            Unknown::Contact(_) => Self::Values((0..CONTACTS.len()).map(|index| index as f64).collect()),
            // Half a turn, and what a filter adds.
            Unknown::Deflection(_) => range(-TAU, TAU),
            Unknown::Contour(_) => Self::Values(CONTOURS.to_vec()),
            Unknown::Whisker(_, WhiskerScalar::Fitted) => Self::Values(vec![1.0, 0.0]),
            Unknown::Travel(_) | Unknown::Away(_) => range(-PI, PI),
            Unknown::Whisker(_, WhiskerScalar::Length) => range(f64::MIN_POSITIVE, FAR),
            Unknown::Whisker(_, WhiskerScalar::TipSpread) => range(0.0, f64::INFINITY),
            Unknown::BodyPosition(_) | Unknown::Whisker(..) | Unknown::WhiskerVector(..) => range(-FAR, FAR),
        }
    }

    /// The smallest interval around it.
    pub(super) fn hull(&self) -> Interval {
        match self {
            Self::Values(values) => {
                values.iter().copied().map(Interval::point).reduce(Interval::join).unwrap_or(Interval::NO_NUMBER)
            }
            Self::Range(range) => *range,
        }
    }

    /// By what it differs from itself before it was narrowed: how many values there are, or the range.
    pub(super) fn extent(&self) -> (usize, Option<Interval>) {
        match self {
            Self::Values(values) => (values.len(), None),
            Self::Range(range) => (0, Some(*range)),
        }
    }

    /// Keeps only what lies in an interval; false if nothing does.
    pub(super) fn narrow(&mut self, to: Interval) -> bool {
        match self {
            Self::Values(values) => {
                values.retain(|&value| Interval::point(value).meet(to).has_any());
                !values.is_empty()
            }
            Self::Range(range) => {
                *range = range.meet(to);
                range.has_any()
            }
        }
    }

    /// Keeps only the contacts of which a number lies in an interval; false if none is left.
    pub(super) fn keep_contacts(&mut self, quantity: WhiskerScalar, to: Interval) -> bool {
        let Self::Values(numbers) = self else { return true };
        numbers.retain(|&number| {
            numbered(number).is_some_and(|contact| Interval::point(reading(quantity, contact)).meet(to).has_any())
        });
        !numbers.is_empty()
    }

    /// Keeps only the contours of which [`WhiskerScalar::ContourReady`] lies in an interval; false if none is left.
    pub(super) fn keep_ready(&mut self, to: Interval) -> bool {
        self.keep_contours(|contour| is_ready(contour).meet(to).has_any())
    }

    /// Keeps only the contours that can be read; false if none is left.
    pub(super) fn keep_readable(&mut self) -> bool {
        self.keep_contours(is_readable)
    }

    fn keep_contours(&mut self, keeps: impl Fn(f64) -> bool) -> bool {
        let Self::Values(contours) = self else { return true };
        contours.retain(|&contour| keeps(contour));
        !contours.is_empty()
    }

    /// Two parts of it; `None` if there is but one value.
    pub(super) fn split(&self) -> Option<[Self; 2]> {
        match self {
            Self::Values(values) if values.len() > 1 => {
                let (left, right) = values.split_at(values.len() / 2);
                Some([Self::Values(left.to_vec()), Self::Values(right.to_vec())])
            }
            Self::Range(range) if range.low < range.high => {
                let middle = middle(*range);
                let part = |low, high| Self::Range(Interval { low, high, nan: range.nan });
                (range.low <= middle && middle < range.high)
                    .then(|| [part(range.low, middle), part(middle.next_up(), range.high)])
            }
            _ => None,
        }
    }
}

/// A number well inside of an interval: it parts positive from negative, and halves large ranges by their magnitude.
pub(super) fn middle(range: Interval) -> f64 {
    let Interval { low, high, .. } = range;
    if low < 0.0 && high > 0.0 {
        0.0
    } else if low < 0.0 {
        -middle(range.negate())
    } else if high > 4.0 * low.max(1e-6) {
        // From nothing to far away: the geometric mean, if both ends are of a size that anything has.
        (low.max(1e-6) * high.min(FAR)).sqrt()
    } else {
        low + (high - low) / 2.0
    }
}

/// Where a reading finds the values of unknowns.
pub(super) trait Source {
    /// What an unknown may be.
    fn domain(&mut self, unknown: Unknown) -> &Domain;

    /// The interval that holds what an unknown may be.
    fn range(&mut self, unknown: Unknown) -> Interval {
        self.domain(unknown).hull()
    }
}

/// What a number of a whisker may be.
pub(super) fn scalar(source: &mut impl Source, whisker: usize, quantity: WhiskerScalar) -> Interval {
    match quantity {
        WhiskerScalar::Touching | WhiskerScalar::Side | WhiskerScalar::Sense => {
            let values = contacts(source, whisker).map(|contact| Interval::point(reading(quantity, contact)));
            values.reduce(Interval::join).unwrap_or(Interval::ANYTHING)
        }
        WhiskerScalar::Deflection => {
            let free = source.range(Unknown::Deflection(whisker));
            let size = free.absolute();
            let bent = Interval::new(size.low.max(TOUCH), size.high.max(TOUCH));
            contacts(source, whisker)
                .map(|(side, sense)| if sense == 0.0 { free } else { bent.multiply(Interval::point(side * sense)) })
                .reduce(Interval::join)
                .unwrap_or(Interval::ANYTHING)
        }
        WhiskerScalar::ContourReady => {
            contours(source, whisker).map(is_ready).reduce(Interval::join).unwrap_or(Interval::ANYTHING)
        }
        WhiskerScalar::ContourCurvature => {
            let curvature = source.range(Unknown::Whisker(whisker, quantity));
            once_readable(source, whisker, curvature)
        }
        WhiskerScalar::Yaw | WhiskerScalar::Length | WhiskerScalar::TipSpread | WhiskerScalar::Fitted => {
            source.range(Unknown::Whisker(whisker, quantity))
        }
    }
}

/// What a vector of a whisker may be.
pub(super) fn vector(source: &mut impl Source, whisker: usize, quantity: WhiskerVector) -> [Interval; 2] {
    match quantity {
        WhiskerVector::ContourTangent => {
            let travel = source.range(Unknown::Travel(whisker));
            [travel.cosine(), travel.sine()].map(|part| once_readable(source, whisker, part))
        }
        WhiskerVector::ContourNormal => {
            let away = source.range(Unknown::Away(whisker));
            [away.cosine(), away.sine()].map(|part| once_readable(source, whisker, part))
        }
        WhiskerVector::ContourEnd => {
            // There is an end before there is a tangent, and before the first point there is none.
            let may_be_none = !contours(source, whisker).all(is_readable);
            [0, 1].map(|axis| {
                let end = source.range(Unknown::WhiskerVector(whisker, quantity, axis));
                Interval { nan: end.nan || (may_be_none && end.single().is_none()), ..end }
            })
        }
        WhiskerVector::Tip | WhiskerVector::TipBase | WhiskerVector::Base => {
            [0, 1].map(|axis| source.range(Unknown::WhiskerVector(whisker, quantity, axis)))
        }
    }
}

fn contacts(source: &mut impl Source, whisker: usize) -> impl Iterator<Item = (f64, f64)> {
    let domain = source.domain(Unknown::Contact(whisker));
    let numbers = if let Domain::Values(numbers) = domain { numbers.as_slice() } else { &[] };
    numbers.iter().filter_map(|&number| numbered(number))
}

/// The contact with a number.
fn numbered(number: f64) -> Option<(f64, f64)> {
    let mut known = CONTACTS.iter().enumerate().filter(|&(index, _)| (index as f64 - number).abs() < 0.5);
    known.next().map(|(_, &contact)| contact)
}

/// What a contact is read as.
fn reading(quantity: WhiskerScalar, (side, sense): (f64, f64)) -> f64 {
    match quantity {
        WhiskerScalar::Side => side,
        WhiskerScalar::Touching => sense.abs(),
        _ => sense,
    }
}

/// What there may be of a whisker's contour.
fn contours(source: &mut impl Source, whisker: usize) -> impl Iterator<Item = f64> {
    let domain = source.domain(Unknown::Contour(whisker));
    let contours = if let Domain::Values(contours) = domain { contours.as_slice() } else { &[] };
    contours.iter().copied()
}

fn is_ready(contour: f64) -> Interval {
    Interval::point(f64::from(u8::from(contour > 0.5)))
}

fn is_readable(contour: f64) -> bool {
    contour.abs() > 0.5
}

/// What is no number before there is a contour.
fn once_readable(source: &mut impl Source, whisker: usize, value: Interval) -> Interval {
    let readable = contours(source, whisker).filter(|&contour| is_readable(contour)).count();
    match contours(source, whisker).count() {
        all if all == readable => value,
        _ if readable > 0 => Interval { nan: true, ..value },
        _ => Interval::NO_NUMBER,
    }
}
