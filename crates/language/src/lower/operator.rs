//! Binary operators.

use crate::ast::Binary;
use crate::types::{Type, Value};
use crate::unit::units_of;
use vibrissa_runtime::machine::Op;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;

impl Compiler<'_> {
    /// Lowers an operator with two operands.
    pub(super) fn binary(&mut self, operator: Binary, left: (Value, Span), right: (Value, Span)) -> Option<Value> {
        let ((left, left_span), (right, right_span)) = (left, right);
        let (a, b) = (left.register, right.register);
        let truth = |register| Some(Value { r#type: Type::Bool, register });
        let (left, right) = (left.calculated(), right.calculated());
        match (operator, left.r#type, right.r#type) {
            (Binary::Or, Type::Bool, Type::Bool) => truth(self.code.scalar(|to| Op::Or { to, a, b })),
            (Binary::And, Type::Bool, Type::Bool) => truth(self.code.scalar(|to| Op::And { to, a, b })),
            (Binary::Less, Type::Scalar(l), Type::Scalar(r)) if l == r => {
                truth(self.code.scalar(|to| Op::Less { to, a, b }))
            }
            (Binary::Greater, Type::Scalar(l), Type::Scalar(r)) if l == r => {
                truth(self.code.scalar(|to| Op::Less { to, a: b, b: a }))
            }
            (Binary::LessOrEqual, Type::Scalar(l), Type::Scalar(r)) if l == r => {
                truth(self.code.scalar(|to| Op::LessOrEqual { to, a, b }))
            }
            (Binary::GreaterOrEqual, Type::Scalar(l), Type::Scalar(r)) if l == r => {
                truth(self.code.scalar(|to| Op::LessOrEqual { to, a: b, b: a }))
            }
            (Binary::Equal | Binary::Unequal, l, r)
                if l == r && matches!(l, Type::Bool | Type::Choice(_) | Type::Whisker | Type::Scalar(_)) =>
            {
                let equal = self.code.scalar(|to| Op::Equal { to, a, b });
                truth(if operator == Binary::Equal { equal } else { self.code.scalar(|to| Op::Not { to, a: equal }) })
            }
            (Binary::Add, Type::Scalar(l), Type::Scalar(r)) if l == r => {
                Some(Value { register: self.code.scalar(|to| Op::Add { to, a, b }), ..left })
            }
            (Binary::Add, Type::Vector(l), Type::Vector(r)) if l == r => {
                Some(Value { register: self.code.vector(|to| Op::AddVectors { to, a, b }), ..left })
            }
            (Binary::Add, Type::Position, Type::DISPLACEMENT) | (Binary::Add, Type::DISPLACEMENT, Type::Position) => {
                Some(Value { r#type: Type::Position, register: self.code.vector(|to| Op::AddVectors { to, a, b }) })
            }
            (Binary::Subtract, Type::Position, Type::DISPLACEMENT) => {
                Some(Value { register: self.code.vector(|to| Op::SubtractVectors { to, a, b }), ..left })
            }
            (Binary::Subtract, Type::Position, Type::Position) => {
                let register = self.code.vector(|to| Op::SubtractVectors { to, a, b });
                Some(Value { r#type: Type::DISPLACEMENT, register })
            }
            (Binary::Subtract, Type::Scalar(l), Type::Scalar(r)) if l == r => {
                Some(Value { register: self.code.scalar(|to| Op::Subtract { to, a, b }), ..left })
            }
            (Binary::Subtract, Type::Vector(l), Type::Vector(r)) if l == r => {
                Some(Value { register: self.code.vector(|to| Op::SubtractVectors { to, a, b }), ..left })
            }
            (Binary::Multiply, Type::Scalar(l), Type::Scalar(r)) => {
                let r#type = Type::Scalar(self.dimension(l.checked_mul(r), left_span.to(right_span))?);
                Some(Value { r#type, register: self.code.scalar(|to| Op::Multiply { to, a, b }) })
            }
            (Binary::Multiply, Type::Scalar(l), Type::Vector(r)) => {
                let r#type = Type::Vector(self.dimension(l.checked_mul(r), left_span.to(right_span))?);
                Some(Value { r#type, register: self.code.vector(|to| Op::MultiplyVector { to, a: b, b: a }) })
            }
            (Binary::Multiply, Type::Vector(l), Type::Scalar(r)) => {
                let r#type = Type::Vector(self.dimension(l.checked_mul(r), left_span.to(right_span))?);
                Some(Value { r#type, register: self.code.vector(|to| Op::MultiplyVector { to, a, b }) })
            }
            (Binary::Divide, Type::Scalar(l), Type::Scalar(r)) => {
                let r#type = Type::Scalar(self.dimension(l.checked_div(r), left_span.to(right_span))?);
                Some(Value { r#type, register: self.code.scalar(|to| Op::Divide { to, a, b }) })
            }
            (Binary::Divide, Type::Vector(l), Type::Scalar(r)) => {
                let r#type = Type::Vector(self.dimension(l.checked_div(r), left_span.to(right_span))?);
                Some(Value { r#type, register: self.code.vector(|to| Op::DivideVector { to, a, b }) })
            }
            (_, left_type, right_type) => {
                let hint = binary_hint(operator, left_type, right_type);
                let [left_type, right_type] = [left_type, right_type].map(|r#type| self.phrase(r#type));
                let message = format!("`{}` does not apply to {left_type} and {right_type}", operator.symbol());
                let mut diagnostic = Diagnostic::error("P0301", message, right_span, format!("is {right_type}"))
                    .note(left_span, format!("is {left_type}"));
                if let Some(hint) = hint {
                    diagnostic = diagnostic.hint(hint);
                }
                self.report(diagnostic);
                None
            }
        }
    }
}

/// Advice for operands of types that do not fit.
pub(super) fn binary_hint(operator: Binary, left: Type, right: Type) -> Option<String> {
    match (operator, left, right) {
        (Binary::Or | Binary::And, ..) => Some("both sides must be bools".to_owned()),
        (_, Type::Scalar(dimension), Type::Scalar(Dimension::NUMBER))
        | (_, Type::Scalar(Dimension::NUMBER), Type::Scalar(dimension)) => {
            Some(format!("give the plain number a unit, such as {}", units_of(dimension).join(", ")))
        }
        (Binary::Equal | Binary::Unequal, Type::Compound(_), Type::Compound(_)) => {
            Some("compare their fields or elements".to_owned())
        }
        (Binary::Add, Type::Position, Type::Position) => Some(
            "the middle of two positions is `blend(a, b, 0.5)`, and `a - b` is the displacement from `b` to `a`"
                .to_owned(),
        ),
        (Binary::Add | Binary::Subtract, Type::Position, _) | (Binary::Add | Binary::Subtract, _, Type::Position) => {
            Some("only a displacement can be added to a position, such as `30 mm * direction(body.yaw)`".to_owned())
        }
        (Binary::Multiply | Binary::Divide, Type::Position, _) | (Binary::Multiply, _, Type::Position) => {
            Some("a position cannot be scaled; `a - b` is the displacement from `b` to `a`".to_owned())
        }
        (Binary::Multiply, Type::Vector(_), Type::Vector(_)) => Some("write `dot(a, b)` or `cross(a, b)`".to_owned()),
        (Binary::Less | Binary::LessOrEqual | Binary::Greater | Binary::GreaterOrEqual, Type::Bool, _) => {
            Some("write `a < b and b < c`".to_owned())
        }
        (
            Binary::Less
            | Binary::LessOrEqual
            | Binary::Greater
            | Binary::GreaterOrEqual
            | Binary::Equal
            | Binary::Unequal,
            Type::Vector(_) | Type::Position,
            _,
        ) => Some("compare lengths: `|v|`, or of two vectors or positions `|a - b|`".to_owned()),
        _ => None,
    }
}
