//! Unknowns at compile time: parameters, arguments of states, sensor inputs.

use std::f64::consts::{PI, TAU};

use vibrissa_runtime::machine::{BodyScalar, Register, WhiskerScalar, WhiskerVector};

use super::interval::Interval;

/// A bound of all distances (m).
const DISTANCE_LIMIT: f64 = 1e6;
/// A bound of the body's yaw (rad).
const YAW_LIMIT: f64 = 1e5;
/// The minimum base angle of a whisker in contact (rad).
pub(super) const MIN_CONTACT_ANGLE: f64 = 1e-9;

/// One degree of freedom of the inputs of guards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unknown {
    /// A parameter, or an argument of a state.
    Register(Register),
    Time,
    Body(BodyScalar),
    /// A coordinate of the body's position.
    BodyPosition(usize),
    /// The side of a whisker and the sign of its base angle, which depend on each other. An index into [`CONTACTS`].
    Contact(usize),
    /// The base angle of a whisker without contact. With contact only its magnitude matters.
    Deflection(usize),
    /// The state of a whisker's contour: one of [`CONTOURS`].
    Contour(usize),
    /// The tangent direction of a whisker's contour (rad).
    Tangent(usize),
    /// The direction of a whisker's contour normal, away from the object (rad).
    Normal(usize),
    /// Any other scalar of a whisker.
    Whisker(usize, WhiskerScalar),
    /// A coordinate of any other vector of a whisker.
    WhiskerVector(usize, WhiskerVector, usize),
}

/// The possible pairs of a whisker's side and sense.
const CONTACTS: [(f64, f64); 6] = [(1.0, 0.0), (-1.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];

/// The states of a contour: ready, absent, or finished. A finished contour is not ready but can be read.
const CONTOURS: [f64; 3] = [1.0, 0.0, -1.0];

/// The possible values of an unknown.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Domain {
    /// Discrete values.
    Values(Vec<f64>),
    /// An interval.
    Range(Interval),
}

impl Domain {
    /// All possible values of an input. For registers, see [`Model::domain`](super::model::Model::domain).
    pub(super) fn possible(unknown: Unknown) -> Self {
        let range = |low, high| Self::Range(Interval::new(low, high));
        match unknown {
            Unknown::Register(_) => Self::Range(Interval::ANYTHING),
            Unknown::Time | Unknown::Body(BodyScalar::Decay) => range(0.0, 1e9),
            Unknown::Body(BodyScalar::Yaw) | Unknown::Whisker(_, WhiskerScalar::Yaw) => range(-YAW_LIMIT, YAW_LIMIT),
            // The simplest body follows its commands, so that value comes first.
            Unknown::Body(BodyScalar::Blocked) => Self::Values(vec![0.0, 1.0]),
            Unknown::Body(BodyScalar::Shortfall | BodyScalar::NoseWidth | BodyScalar::TailWidth) => {
                range(0.0, DISTANCE_LIMIT)
            }
            Unknown::Body(BodyScalar::Flexibility | BodyScalar::Sway) => range(f64::MIN_POSITIVE, 1e9),
            Unknown::Contact(_) => Self::Values((0..CONTACTS.len()).map(|index| index as f64).collect()),
            // Half a revolution, and the overshoot of a filter.
            Unknown::Deflection(_) => range(-TAU, TAU),
            Unknown::Contour(_) => Self::Values(CONTOURS.to_vec()),
            Unknown::Whisker(_, WhiskerScalar::Fitted) => Self::Values(vec![1.0, 0.0]),
            Unknown::Tangent(_) | Unknown::Normal(_) => range(-PI, PI),
            Unknown::Body(BodyScalar::Length | BodyScalar::Width) | Unknown::Whisker(_, WhiskerScalar::Length) => {
                range(f64::MIN_POSITIVE, DISTANCE_LIMIT)
            }
            Unknown::Whisker(
                _,
                WhiskerScalar::TipDeviation | WhiskerScalar::BaseAngleDeviation | WhiskerScalar::RecordedDeviation,
            ) => range(0.0, f64::INFINITY),
            Unknown::Body(BodyScalar::NoseReach)
            | Unknown::BodyPosition(_)
            | Unknown::Whisker(..)
            | Unknown::WhiskerVector(..) => range(-DISTANCE_LIMIT, DISTANCE_LIMIT),
        }
    }

    /// The smallest interval that contains the domain.
    pub(super) fn hull(&self) -> Interval {
        match self {
            Self::Values(values) => {
                values.iter().copied().map(Interval::point).reduce(Interval::join).unwrap_or(Interval::NO_NUMBER)
            }
            Self::Range(range) => *range,
        }
    }

    /// A measure that changes whenever the domain is narrowed: the number of values, or the range.
    pub(super) fn extent(&self) -> (usize, Option<Interval>) {
        match self {
            Self::Values(values) => (values.len(), None),
            Self::Range(range) => (0, Some(*range)),
        }
    }

    /// Restricts the domain to an interval. False if nothing remains.
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

    /// Restricts contacts to those with a scalar in an interval. False if none remains.
    pub(super) fn keep_contacts(&mut self, quantity: WhiskerScalar, to: Interval) -> bool {
        let Self::Values(numbers) = self else { return true };
        numbers.retain(|&number| {
            numbered(number).is_some_and(|contact| Interval::point(reading(quantity, contact)).meet(to).has_any())
        });
        !numbers.is_empty()
    }

    /// Restricts contours to those with [`WhiskerScalar::ContourReady`] in an interval. False if none remains.
    pub(super) fn keep_ready(&mut self, to: Interval) -> bool {
        self.keep_contours(|contour| is_ready(contour).meet(to).has_any())
    }

    /// Restricts contours to those that can be read. False if none remains.
    pub(super) fn keep_readable(&mut self) -> bool {
        self.keep_contours(is_readable)
    }

    fn keep_contours(&mut self, keeps: impl Fn(f64) -> bool) -> bool {
        let Self::Values(contours) = self else { return true };
        contours.retain(|&contour| keeps(contour));
        !contours.is_empty()
    }

    /// Splits the domain in two. `None` if it has only one value.
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

/// A number inside an interval. It separates positive from negative numbers, and halves large ranges by magnitude.
pub(super) fn middle(range: Interval) -> f64 {
    let Interval { low, high, .. } = range;
    if low < 0.0 && high > 0.0 {
        0.0
    } else if low < 0.0 {
        -middle(range.negate())
    } else if high > 4.0 * low.max(1e-6) {
        // The geometric mean, if both ends have a plausible magnitude.
        (low.max(1e-6) * high.min(DISTANCE_LIMIT)).sqrt()
    } else {
        low + (high - low) / 2.0
    }
}

/// Access to the domains of unknowns.
pub(super) trait Source {
    /// The domain of an unknown.
    fn domain(&mut self, unknown: Unknown) -> &Domain;

    /// The smallest interval that contains the domain of an unknown.
    fn range(&mut self, unknown: Unknown) -> Interval {
        self.domain(unknown).hull()
    }
}

/// The interval of a whisker's scalar.
pub(super) fn scalar(source: &mut impl Source, whisker: usize, quantity: WhiskerScalar) -> Interval {
    match quantity {
        WhiskerScalar::Touching | WhiskerScalar::Side | WhiskerScalar::Sense => {
            let values = contacts(source, whisker).map(|contact| Interval::point(reading(quantity, contact)));
            values.reduce(Interval::join).unwrap_or(Interval::ANYTHING)
        }
        WhiskerScalar::BaseAngle => {
            let free = source.range(Unknown::Deflection(whisker));
            let size = free.absolute();
            let angle = Interval::new(size.low.max(MIN_CONTACT_ANGLE), size.high.max(MIN_CONTACT_ANGLE));
            contacts(source, whisker)
                .map(|(side, sense)| if sense == 0.0 { free } else { angle.multiply(Interval::point(side * sense)) })
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
        WhiskerScalar::Yaw
        | WhiskerScalar::Length
        | WhiskerScalar::TipDeviation
        | WhiskerScalar::BaseAngleDeviation
        | WhiskerScalar::RecordedDeviation
        | WhiskerScalar::Fitted => source.range(Unknown::Whisker(whisker, quantity)),
    }
}

/// The intervals of a whisker's vector.
pub(super) fn vector(source: &mut impl Source, whisker: usize, quantity: WhiskerVector) -> [Interval; 2] {
    match quantity {
        WhiskerVector::ContourTangent => {
            let travel = source.range(Unknown::Tangent(whisker));
            [travel.cosine(), travel.sine()].map(|part| once_readable(source, whisker, part))
        }
        WhiskerVector::ContourNormal => {
            let away = source.range(Unknown::Normal(whisker));
            [away.cosine(), away.sine()].map(|part| once_readable(source, whisker, part))
        }
        WhiskerVector::ContourEnd => {
            // An end exists before a tangent does, and before the first point there is no end.
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

/// The contact with an index.
fn numbered(number: f64) -> Option<(f64, f64)> {
    let mut known = CONTACTS.iter().enumerate().filter(|&(index, _)| (index as f64 - number).abs() < 0.5);
    known.next().map(|(_, &contact)| contact)
}

/// The value of a scalar for a contact.
fn reading(quantity: WhiskerScalar, (side, sense): (f64, f64)) -> f64 {
    match quantity {
        WhiskerScalar::Side => side,
        WhiskerScalar::Touching => sense.abs(),
        _ => sense,
    }
}

/// The possible states of a whisker's contour.
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

/// Adds NaN to a value if the contour may be absent.
fn once_readable(source: &mut impl Source, whisker: usize, value: Interval) -> Interval {
    let readable = contours(source, whisker).filter(|&contour| is_readable(contour)).count();
    match contours(source, whisker).count() {
        all if all == readable => value,
        _ if readable > 0 => Interval { nan: true, ..value },
        _ => Interval::NO_NUMBER,
    }
}
