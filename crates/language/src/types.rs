//! The types of the language.

use std::fmt;

use vibrissa_runtime::machine::Register;
use vibrissa_runtime::units::Dimension;

use vibrissa_text::diagnostic::Span;

use super::ast::{Binary, TypeName};

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    Bool,
    /// One of the values of an enumeration.
    Choice(Choices),
    Scalar(Dimension),
    /// A vector that is neither a position nor a unit vector by its type: a displacement, a velocity, a sum of directions.
    Vector(Dimension),
    /// A point of the world frame. The difference of two positions is a displacement.
    Position,
    /// A unit vector. It is also a vector of plain numbers.
    Direction,
    Whisker,
    /// The local contour of a whisker.
    Contour,
    /// The platform.
    Body,
    /// The map.
    Map,
    /// What the map wants to be touched or looked at next.
    Target,
    /// The route through the map.
    Route,
    /// A whole run, in a test.
    Run,
    /// A record or a list.
    Compound(Compound),
    /// A monitor with a content, by the span of its name. Its index is in place of a register.
    Monitor(Span),
}

/// A record or a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Compound {
    /// Span of the name in its declaration, which identifies the type.
    pub(super) declared: Span,
    /// The number of registers.
    pub(super) width: u16,
}

/// An enumeration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Choices {
    /// Span of the name in its declaration, which identifies the enumeration.
    pub(super) declared: Span,
    /// The number of values.
    pub(super) count: usize,
}

impl Type {
    pub(super) const NUMBER: Self = Self::Scalar(Dimension::NUMBER);
    pub(super) const LENGTH: Self = Self::Scalar(Dimension::LENGTH);
    pub(super) const ANGLE: Self = Self::Scalar(Dimension::ANGLE);
    pub(super) const TIME: Self = Self::Scalar(Dimension::TIME);
    pub(super) const SPEED: Self = Self::Scalar(Dimension::SPEED);
    pub(super) const DISPLACEMENT: Self = Self::Vector(Dimension::LENGTH);
    pub(super) const ANGULAR_SPEED: Self = Self::Scalar(Dimension::ANGULAR_SPEED);

    /// Number of registers of a value.
    pub(super) fn width(self) -> u16 {
        match self {
            Self::Compound(compound) => compound.width,
            _ if self.components().is_some() => 2,
            _ => 1,
        }
    }

    /// The dimension of the components `x` and `y`, if the type has them.
    pub(super) fn components(self) -> Option<Dimension> {
        match self {
            Self::Vector(dimension) => Some(dimension),
            Self::Position => Some(Dimension::LENGTH),
            Self::Direction => Some(Dimension::NUMBER),
            _ => None,
        }
    }

    /// The type in calculations: a direction is a vector of plain numbers.
    pub(super) fn calculated(self) -> Self {
        if self == Self::Direction { Self::Vector(Dimension::NUMBER) } else { self }
    }

    /// True if a value of this type can stand where `wanted` is required.
    pub(super) fn fits(self, wanted: Self) -> bool {
        self == wanted || self.calculated() == wanted
    }

    /// The type with a name, if there is one.
    pub(super) fn named(name: &TypeName) -> Option<Self> {
        let of = name.of.as_ref().map(|of| of.text.as_str());
        match (name.base.text.as_str(), of) {
            ("whisker", None) if name.factors.is_empty() => Some(Self::Whisker),
            ("contour", None) if name.factors.is_empty() => Some(Self::Contour),
            ("bool", None) if name.factors.is_empty() => Some(Self::Bool),
            ("position", None) if name.factors.is_empty() => Some(Self::Position),
            ("direction", None) if name.factors.is_empty() => Some(Self::Direction),
            ("vector", None) if name.factors.is_empty() => Some(Self::Vector(Dimension::NUMBER)),
            ("vector", Some(of)) => product(of, name).map(Self::Vector),
            (base, None) => product(base, name).map(Self::Scalar),
            _ => None,
        }
    }
}

/// The dimension of a type's name: `first` with the factors.
fn product(first: &str, name: &TypeName) -> Option<Dimension> {
    name.factors.iter().try_fold(dimension(first)?, |product, (operator, factor)| {
        let factor = dimension(&factor.text)?;
        if *operator == Binary::Divide { product.checked_div(factor) } else { product.checked_mul(factor) }
    })
}

/// The types that have a name and no dimension.
pub(super) const PLAIN_TYPES: [&str; 6] = ["whisker", "contour", "bool", "position", "direction", "vector"];

/// The dimensions with names.
pub(super) const DIMENSIONS: [(&str, Dimension); 12] = [
    ("number", Dimension::NUMBER),
    ("length", Dimension::LENGTH),
    ("angle", Dimension::ANGLE),
    ("time", Dimension::TIME),
    ("area", Dimension::AREA),
    ("speed", Dimension::SPEED),
    ("acceleration", Dimension::ACCELERATION),
    ("angular_speed", Dimension::ANGULAR_SPEED),
    ("angular_acceleration", Dimension::ANGULAR_ACCELERATION),
    ("frequency", Dimension::FREQUENCY),
    ("force", Dimension::FORCE),
    ("moment", Dimension::MOMENT),
];

pub(super) fn dimension(name: &str) -> Option<Dimension> {
    DIMENSIONS.iter().find(|(known, _)| *known == name).map(|&(_, dimension)| dimension)
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool => f.write_str("a bool"),
            Self::Choice(_) => f.write_str("a value of an enumeration"),
            Self::Scalar(dimension) => f.write_str(&dimension.phrase()),
            Self::Vector(Dimension::NUMBER) => f.write_str("a vector of plain numbers"),
            &Self::DISPLACEMENT => f.write_str("a displacement"),
            Self::Vector(dimension) => write!(f, "a vector in {}", dimension.si_unit()),
            Self::Position => f.write_str("a position"),
            Self::Direction => f.write_str("a direction"),
            Self::Whisker => f.write_str("a whisker"),
            Self::Contour => f.write_str("a contour"),
            Self::Body => f.write_str("the body"),
            Self::Map => f.write_str("the map"),
            Self::Target => f.write_str("the next target of the map"),
            Self::Route => f.write_str("the route of the map"),
            Self::Run => f.write_str("the run"),
            Self::Compound(_) => f.write_str("a record or a list"),
            Self::Monitor(_) => f.write_str("a monitor"),
        }
    }
}

/// A value in the code: its type and its first register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Value {
    pub(super) r#type: Type,
    pub(super) register: Register,
}

impl Value {
    /// The value in calculations: a direction is a vector of plain numbers.
    pub(super) fn calculated(self) -> Self {
        Self { r#type: self.r#type.calculated(), ..self }
    }

    /// True if the value is in registers of `memory`, as it is or as a component of it.
    pub(super) fn is_part_of(self, memory: Self) -> bool {
        let registers = memory.register..memory.register.saturating_add(memory.r#type.width());
        !matches!(self.r#type, Type::Monitor(_)) && registers.contains(&self.register)
    }
}
