//! The types of the language.

use std::fmt;

use vibrissa_runtime::machine::Register;
use vibrissa_runtime::units::Dimension;

use crate::diagnostic::Span;

use super::ast::{Binary, TypeName};

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    Truth,
    /// One of the values of an enumeration.
    Choice(Choices),
    Scalar(Dimension),
    Vector(Dimension),
    Whisker,
    /// The local contour of a whisker.
    Contour,
    /// The platform.
    Body,
    /// A whole run, in a test.
    Run,
    /// A monitor with a content, by the span of its name. Its index is in place of a register.
    Monitor(Span),
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
    /// A position or a displacement.
    pub(super) const POSITION: Self = Self::Vector(Dimension::LENGTH);
    pub(super) const ANGULAR_SPEED: Self = Self::Scalar(Dimension::ANGULAR_SPEED);

    /// Number of registers of a value.
    pub(super) fn width(self) -> u16 {
        if matches!(self, Self::Vector(_)) { 2 } else { 1 }
    }

    /// The type with a name, if there is one.
    pub(super) fn named(name: &TypeName) -> Option<Self> {
        let of = name.of.as_ref().map(|of| of.text.as_str());
        match (name.base.text.as_str(), of) {
            ("whisker", None) if name.factors.is_empty() => Some(Self::Whisker),
            ("contour", None) if name.factors.is_empty() => Some(Self::Contour),
            ("truth", None) if name.factors.is_empty() => Some(Self::Truth),
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
            Self::Truth => f.write_str("a truth"),
            Self::Choice(_) => f.write_str("a value of an enumeration"),
            Self::Scalar(dimension) => f.write_str(&dimension.phrase()),
            Self::Vector(Dimension::NUMBER) => f.write_str("a vector of plain numbers"),
            Self::Vector(dimension) => write!(f, "a vector in {}", dimension.si_unit()),
            Self::Whisker => f.write_str("a whisker"),
            Self::Contour => f.write_str("a contour"),
            Self::Body => f.write_str("the body"),
            Self::Run => f.write_str("the run"),
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
    /// True if the value is in registers of `memory`, as it is or as a component of it.
    pub(super) fn is_part_of(self, memory: Self) -> bool {
        let registers = memory.register..memory.register.saturating_add(memory.r#type.width());
        !matches!(self.r#type, Type::Monitor(_)) && registers.contains(&self.register)
    }
}
