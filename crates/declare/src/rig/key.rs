//! One key of a rig.

use vibrissa_runtime::calibration::Calibration;
use vibrissa_runtime::geometry::Point2;
use vibrissa_runtime::rig::{Platform, Sensing, Whisker};
use vibrissa_runtime::units::{Dimension, Key};

use crate::mismatch::{Change, Difference, Property, Scope};
use crate::physics::Physics;

/// A key of a rig.
///
/// The ranges are wide. They exclude impossible values, such as a negative radius, and obvious mistakes, such as a whisker of
/// 100 m. Both ends belong to a range.
#[derive(Debug, Clone, Copy)]
pub struct RigKey {
    /// The keys that lead to it, separated by points. `*` stands for the name of a whisker.
    pub path: &'static str,
    /// Where its value is stored.
    pub place: Place,
    /// The dimension of its numbers.
    pub dimension: Dimension,
    /// The smallest and the largest number, in SI units.
    pub range: (f64, f64),
    /// A possible value, for messages.
    pub example: &'static str,
    /// The meaning, for the documentation.
    pub about: &'static str,
    /// True if a robot uses the value. Otherwise it reads the key and checks its range, so that robots and scenarios accept the
    /// same rigs.
    pub is_on_robot: bool,
    /// The change of the value by a mismatch, its range in SI units and an example, if the key of the mismatch has no entry of
    /// its own.
    pub change: Option<(Change, (f64, f64), &'static str)>,
}

/// Where the value of a key is stored.
#[derive(Debug, Clone, Copy)]
pub enum Place {
    /// In the platform.
    Platform(Access<Platform>),
    /// In every whisker.
    Whisker(Access<Whisker>),
    /// In the sensing.
    Sensing(Access<Sensing>),
    /// In the settings of the simulation.
    Physics(Access<Physics>),
}

/// A field of a part `T` of a rig, with the type of its value.
#[derive(Debug)]
pub enum Access<T: 'static> {
    /// A number.
    Number(fn(&mut T) -> &mut f64),
    /// A number that may be absent.
    Optional(fn(&mut T) -> &mut Option<f64>),
    /// A point.
    Point(fn(&mut T) -> &mut Point2),
    /// Two numbers of the key's dimension, and a third one of another dimension and range.
    Triple(fn(&mut T) -> &mut [f64; 3], Dimension, (f64, f64)),
    /// A whole number.
    Count(fn(&mut T) -> &mut usize),
    /// True or false.
    Flag(fn(&mut T) -> &mut bool),
    /// One of several words.
    Choice(Choice<T>),
    /// A calibration: its values, or the path of its file.
    Calibration(fn(&mut T) -> &mut Option<Calibration>),
}

// A derived one would need `T: Clone`.
impl<T> Clone for Access<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Access<T> {}

/// One of several words.
#[derive(Debug)]
pub struct Choice<T: 'static> {
    /// What is chosen, with its article.
    pub what: &'static str,
    /// The words.
    pub words: fn() -> Vec<&'static str>,
    /// The word of the value.
    pub get: fn(&T) -> &'static str,
    /// Sets the value to that of a word. An index without a word has no effect.
    pub set: fn(&mut T, usize) -> Result<(), Refusal>,
}

impl<T> Clone for Choice<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Choice<T> {}

/// The reason why a word is not possible together with the values before it.
#[derive(Debug, Clone, Copy)]
pub struct Refusal {
    /// What is wrong.
    pub message: &'static str,
    /// What the other values are.
    pub label: &'static str,
    /// What to do.
    pub hint: &'static str,
}

/// A part of a rig that has keys.
pub trait Part: Clone + 'static {
    /// The field of a key that belongs to this part.
    fn access(place: Place) -> Option<Access<Self>>;
}

macro_rules! parts {
    ($($part:ident)*) => { $(
        impl Part for $part {
            fn access(place: Place) -> Option<Access<Self>> {
                if let Place::$part(access) = place { Some(access) } else { None }
            }
        }
    )* };
}

parts! { Platform Whisker Sensing Physics }

impl RigKey {
    pub(super) const fn new(
        path: &'static str,
        place: Place,
        dimension: Dimension,
        range: (f64, f64),
        example: &'static str,
        about: &'static str,
    ) -> Self {
        let is_on_robot = !matches!(place, Place::Physics(_));
        Self { path, place, dimension, range, example, about, is_on_robot, change: None }
    }

    /// A key that is no number.
    pub(super) const fn other(path: &'static str, place: Place, example: &'static str, about: &'static str) -> Self {
        Self::new(path, place, Dimension::NUMBER, (0.0, 0.0), example, about)
    }

    /// A key that has an effect in simulations alone.
    pub(super) const fn simulated(self) -> Self {
        Self { is_on_robot: false, ..self }
    }

    /// A key in which a mismatch may differ, with the range and an example of the difference.
    pub(super) const fn differs(self, change: Change, range: (f64, f64), example: &'static str) -> Self {
        Self { change: Some((change, range, example)), ..self }
    }

    /// The key with its range.
    #[must_use]
    pub fn key(&self) -> Key {
        Key::new(self.name(), self.dimension, self.range, self.example)
    }

    /// The last key of the path.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or(self.path)
    }

    /// The number, if the key is one of this part.
    pub fn number<T: Part>(&self, part: &mut T) -> Option<f64> {
        match T::access(self.place)? {
            Access::Number(field) => Some(*field(part)),
            Access::Optional(field) => *field(part),
            _ => None,
        }
    }

    /// Changes the number of a part by the `value` of a mismatch. A key that is not of this part has no effect.
    pub fn apply<T: Part>(&self, part: &mut T, change: Change, value: f64) {
        match T::access(self.place) {
            Some(Access::Number(field)) => change.apply(field(part), value),
            Some(Access::Optional(field)) => match field(part) {
                Some(number) => change.apply(number, value),
                missing if change == Change::Replaced => *missing = Some(value),
                None => {}
            },
            _ => {}
        }
    }

    /// The difference of a mismatch in this key.
    #[must_use]
    pub fn difference(&self) -> Option<Difference> {
        let (change, range, example) = self.change?;
        let (path, scope) = match self.path.strip_prefix(super::OF_A_WHISKER) {
            Some(path) => (path, Scope::Whisker),
            None => (self.path.split_once('.').map_or(self.path, |(_, name)| name), Scope::Array),
        };
        let dimension = if change == Change::Relative { Dimension::NUMBER } else { self.dimension };
        let (property, about, of) = (Property::Rig(self.path), change.about(), Some((self.path, change)));
        Some(Difference { property, path, dimension, range, example, about, scope, of })
    }
}
