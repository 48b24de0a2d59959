//! Expressions.

use crate::ast::{Binary, Expression, Kind, Name, Quantity};
use crate::builtins::{self, At, Member, MemberSource};
use crate::suggestion::did_you_mean;
use crate::test::RunFigure;
use crate::types::{Type, Value};
use crate::unit::{unit_hint, units_of};
use vibrissa_runtime::machine::{BodyScalar, Op, Register};
use vibrissa_runtime::units::{Dimension, parse_unit};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::code::Origin;
use super::operator::binary_hint;
use super::scope::Scope;

impl<'f> Compiler<'f> {
    /// Lowers an expression. `None` if it has an error, which has been reported.
    pub(super) fn expression(&mut self, scope: &Scope<'f>, expression: &'f Expression) -> Option<Value> {
        let value = self.descend(expression.span, |compiler| compiler.kind(scope, expression))?;
        self.code.origins.note(value.register, Origin { span: expression.span, compared: None });
        Some(value)
    }

    fn kind(&mut self, scope: &Scope<'f>, expression: &'f Expression) -> Option<Value> {
        match &expression.kind {
            Kind::Quantity(quantity) => {
                let (value, dimension) = self.quantity(quantity)?;
                Some(Value { r#type: Type::Scalar(dimension), register: self.code.constant(value) })
            }
            Kind::Bool(truth) => {
                let register = self.code.constant(f64::from(u8::from(*truth)));
                Some(Value { r#type: Type::Bool, register })
            }
            Kind::Root { name, values } => self.root(scope, name, values.as_deref(), expression.span),
            Kind::Member { owner, name, values } => self.member(scope, owner, name, values.as_deref()),
            Kind::Norm(inner) => self.norm(scope, inner),
            Kind::Negate(inner) => {
                let value = self.expression(scope, inner)?;
                let a = value.register;
                let register = match value.r#type {
                    Type::Scalar(_) => self.code.scalar(|to| Op::Negate { to, a }),
                    Type::Vector(_) | Type::Direction => self.code.vector(|to| Op::NegateVector { to, a }),
                    other => return self.mismatch(inner.span, other, "only a number or a vector can be negated"),
                };
                Some(Value { register, ..value })
            }
            Kind::Not(inner) => {
                let a = self.expect(scope, inner, Type::Bool)?;
                Some(Value { r#type: Type::Bool, register: self.code.scalar(|to| Op::Not { to, a: a.register }) })
            }
            Kind::Named { name, value } => {
                self.expression(scope, value);
                let message = "this value takes no name";
                let diagnostic = Diagnostic::error("P0304", message, name.span, "the name of an argument");
                self.report(
                    diagnostic.hint("only arguments of laws, derived values and states are named; leave out the name"),
                );
                None
            }
            Kind::If { condition, value, otherwise } => self.choice(scope, condition, [value, otherwise]),
            Kind::Binary { operator, left, right } => {
                let (left_value, right_value) = (self.expression(scope, left), self.expression(scope, right));
                let (left_value, right_value) = (left_value?, right_value?);
                let value = self.binary(*operator, (left_value, left.span), (right_value, right.span))?;
                if let (Type::Bool, Type::Scalar(dimension)) = (value.r#type, left_value.r#type) {
                    let origin = Origin { span: expression.span, compared: Some(dimension) };
                    self.code.origins.note(value.register, origin);
                }
                Some(value)
            }
        }
    }

    /// Lowers an expression that must have a type.
    pub(super) fn expect(&mut self, scope: &Scope<'f>, expression: &'f Expression, wanted: Type) -> Option<Value> {
        let value = self.expression(scope, expression)?;
        if value.r#type.fits(wanted) {
            return Some(Value { r#type: wanted, ..value });
        }
        let found = self.phrase(value.r#type);
        let mut diagnostic = Diagnostic::error(
            "P0301",
            format!("this must be {}, not {found}", self.phrase(wanted)),
            expression.span,
            format!("is {found}"),
        );
        match (wanted, value.r#type) {
            (Type::Scalar(wanted), Type::Scalar(Dimension::NUMBER)) => {
                diagnostic = diagnostic.hint(format!("give it a unit, such as {}", units_of(wanted).join(", ")));
            }
            (Type::ANGLE, Type::Vector(_) | Type::Direction) => {
                diagnostic = diagnostic.hint("`angle(v)` is the angle of a vector");
            }
            (Type::Direction, Type::Vector(_)) => {
                diagnostic = diagnostic.hint("`unit(v)` is the direction of a vector");
            }
            (Type::Direction, Type::ANGLE) => {
                diagnostic = diagnostic.hint("`direction(a)` is the direction with an angle");
            }
            (Type::Vector(_) | Type::Direction, Type::Position) => {
                diagnostic =
                    diagnostic.hint("the difference of two positions is a displacement, as in `w.tip - body.position`");
            }
            (Type::Position, Type::DISPLACEMENT) => {
                diagnostic =
                    diagnostic.hint("a position and a displacement add to a position, as in `body.position + v`");
            }
            (Type::Scalar(_), Type::Vector(_)) => diagnostic = diagnostic.hint("`|v|` is the length of a vector"),
            (Type::Bool, Type::Scalar(_)) => {
                diagnostic = diagnostic.hint("compare it with something, such as `x > 0`");
            }
            (Type::Contour, Type::Whisker) => diagnostic = diagnostic.hint("`w.contour` is the contour of a whisker"),
            (Type::Bool, Type::Whisker) => {
                diagnostic = diagnostic.hint("`w.touching` is true if a whisker touches");
            }
            _ => {}
        }
        self.report(diagnostic);
        None
    }

    /// The SI value and dimension of a number with a unit.
    pub(super) fn quantity(&mut self, quantity: &Quantity) -> Option<(f64, Dimension)> {
        // The grammar accepts only valid numbers.
        let number: f64 = quantity.number.parse().unwrap_or(f64::NAN);
        let (value, dimension) = match &quantity.unit {
            None => (number, Dimension::NUMBER),
            Some(unit) => match parse_unit(&unit.text.replace('*', " ")) {
                Ok(known) => (known.to_si(number), known.dimension()),
                Err(error) => {
                    let message = format!("`{}` is not a unit", unit.text);
                    let range = error.range();
                    let span = Span::new(unit.span.start + range.start, unit.span.start + range.end);
                    let diagnostic =
                        Diagnostic::error("P0302", message, span, error.to_string()).hint(unit_hint(&error));
                    // The grammar accepts `50 mm/t` as a number with a unit.
                    self.report(match unit.text.find(['/', '*']) {
                        Some(at) if at < range.start => {
                            let sign = &unit.text[at..=at];
                            diagnostic.hint(format!("to calculate with a value, put a space before `{sign}`"))
                        }
                        _ => diagnostic,
                    });
                    return None;
                }
            },
        };
        if !value.is_finite() {
            let diagnostic = Diagnostic::error("P0303", "the number is too large", quantity.span, "not finite");
            self.report(diagnostic.hint("write a number within the range of 64-bit floating point"));
            return None;
        }
        Some((value, dimension))
    }

    fn root(
        &mut self,
        scope: &Scope<'f>,
        name: &'f Name,
        values: Option<&'f [Expression]>,
        span: Span,
    ) -> Option<Value> {
        let known = scope.get(&name.text).or_else(|| self.names().globals.get(name.text.as_str()).copied());
        if known.is_none()
            && let Some(derived) = self.names().derived.get(name.text.as_str()).copied()
        {
            if derived.1.arguments.is_empty() && values.is_some_and(<[Expression]>::is_empty) {
                self.report_call(format!("`{}` takes no values", name.text), span);
                return None;
            }
            return self.derived_value(scope, derived, values.unwrap_or_default(), span);
        }
        if known.is_none()
            && let Some(compound) = self.names().compounds.get(name.text.as_str()).copied()
        {
            return self.compound_value(scope, compound, values, span);
        }
        if known.is_none()
            && let Some((function, usage)) = builtins::function(&name.text)
        {
            return self.function(scope, function, usage, values.unwrap_or_default(), span);
        }
        let value = match (known, name.text.as_str()) {
            (Some(meaning), _) => meaning?,
            (None, "body") => Value { r#type: Type::Body, register: 0 },
            (None, "run") if self.figures.is_some() => Value { r#type: Type::Run, register: 0 },
            (None, "map") => Value { r#type: Type::Map, register: 0 },
            (None, "time") => Value { r#type: Type::TIME, register: self.code.scalar(|to| Op::Time { to }) },
            (None, "state_time") => Value { r#type: Type::TIME, register: self.state_time(name.span)? },
            (None, _) => {
                self.unknown_name(scope, name);
                return None;
            }
        };
        if values.is_some() {
            self.report_call(format!("`{}` is {} and takes no values", name.text, self.phrase(value.r#type)), span);
            return None;
        }
        Some(value)
    }

    /// Reports parentheses after a name that takes no values.
    pub(super) fn report_call(&mut self, message: String, span: Span) {
        let diagnostic = Diagnostic::error("P0304", message, span, "called like a function");
        self.report(diagnostic.hint("leave out the parentheses"));
    }

    fn member(
        &mut self,
        scope: &Scope<'f>,
        owner: &'f Expression,
        name: &'f Name,
        values: Option<&'f [Expression]>,
    ) -> Option<Value> {
        if let Kind::Root { name: of, values: None } = &owner.kind
            && scope.get(&of.text).is_none()
            && let Some(&item) = self.names().enumerations.get(of.text.as_str())
        {
            if values.is_some() {
                self.report_call(format!("`{}.{}` takes no values", of.text, name.text), name.span);
                return None;
            }
            return self.choice_value(item, name);
        }
        let value = self.expression(scope, owner)?;
        if let Type::Monitor(_) = value.r#type {
            if values.is_some() {
                self.report_call(format!("`{}` takes no values", name.text), name.span);
                return None;
            }
            return self.monitor_member(value, name);
        }
        if let Type::Compound(of) = value.r#type {
            return self.compound_member(scope, value, of.declared, name, values);
        }
        let members = builtins::members(value.r#type);
        let Some(&member) = members.iter().find(|member| member.name == name.text) else {
            if self.is_told("P0203", name.span) {
                return None;
            }
            let message = format!("{} has no `{}`", self.phrase(value.r#type), name.text);
            let diagnostic = Diagnostic::error("P0203", message, name.span, "unknown member");
            let mut diagnostic = did_you_mean(diagnostic, &name.text, members.iter().map(|member| member.name));
            if members.is_empty() {
                diagnostic = diagnostic
                    .hint("only whiskers, their contours, vectors, records, lists, `body` and `map` have members");
            } else {
                let known: Vec<&str> = members.iter().map(|member| member.name).collect();
                diagnostic = diagnostic.hint(format!("{} has {}", value.r#type, known.join(", ")));
            }
            self.report(diagnostic);
            return None;
        };
        if let (MemberSource::Component(part), Some(dimension), None) =
            (member.source, value.r#type.components(), values)
        {
            return Some(Value { r#type: Type::Scalar(dimension), register: value.register + part });
        }
        self.member_value(scope, value, member, name, values)
    }

    fn member_value(
        &mut self,
        scope: &Scope<'f>,
        owner: Value,
        member: Member,
        name: &'f Name,
        values: Option<&'f [Expression]>,
    ) -> Option<Value> {
        let whisker = owner.register;
        let register = match (member.source, member.at, values) {
            (_, Some(at), Some(values)) if values.len() == at.takes().len() => {
                let values = values.iter().zip(at.takes()).map(|(value, &(_, r#type, _))| {
                    // An error in one value does not hide those in the others.
                    self.expect(scope, value, r#type).map(|value| value.register)
                });
                match (at, values.collect::<Vec<_>>().as_slice()) {
                    (At::Tip, &[Some(a)]) => self.code.vector(|to| Op::TipAt { to, whisker, a }),
                    (At::Contour(quantity), &[Some(a)]) => {
                        self.code.vector(|to| Op::ContourAt { to, contour: whisker, a, quantity })
                    }
                    (At::LoopClosed, &[Some(a), Some(b)]) => {
                        self.code.scalar(|to| Op::LoopClosed { to, whisker, a, b })
                    }
                    (At::Map(question), &[Some(a)]) => {
                        let b = self.code.constant(0.0);
                        self.code.scalar(|to| Op::MapHolds { to, a, b, question })
                    }
                    (At::Map(question), &[Some(a), Some(b)]) => {
                        self.code.scalar(|to| Op::MapHolds { to, a, b, question })
                    }
                    _ => return None,
                }
            }
            (source, Some(at), given) if given.is_some() || source == MemberSource::At => {
                let list = |part: fn(&(&'static str, Type, &'static str)) -> &'static str, separator| {
                    at.takes().iter().map(part).collect::<Vec<_>>().join(separator)
                };
                let (needed, examples) = (list(|&(name, ..)| name, " and the "), list(|&(.., example)| example, ", "));
                let (count, label) = match at.takes() {
                    [_] => ("one value", format!("which {needed}?")),
                    _ => ("two values", "which values?".to_owned()),
                };
                let message = format!("`{}` needs {count}, the {needed}", name.text);
                let diagnostic = Diagnostic::error("P0304", message, name.span, label);
                self.report(diagnostic.hint(format!("write `{}({examples})`", name.text)));
                return None;
            }
            (MemberSource::Visits, ..) => self.run_of_state(RunFigure::Visits, name, values)?,
            (MemberSource::TimeIn, ..) => self.run_of_state(RunFigure::TimeIn, name, values)?,
            (MemberSource::Plot(figure), ..) => return self.figure_of_plot(figure, name, values),
            (_, _, Some(_)) => {
                self.report_call(format!("`{}` takes no values", name.text), name.span);
                return None;
            }
            (MemberSource::Contour | MemberSource::At | MemberSource::Component(_) | MemberSource::MapPart, ..) => {
                whisker
            }
            (MemberSource::Scalar(quantity), ..) => self.code.scalar(|to| Op::Whisker { to, whisker, quantity }),
            (MemberSource::Vector(quantity), ..) => self.code.vector(|to| Op::WhiskerVector { to, whisker, quantity }),
            (MemberSource::Body(quantity), ..) => self.code.scalar(|to| Op::Body { to, quantity }),
            (MemberSource::BodyPosition, ..) => self.code.vector(|to| Op::BodyPosition { to }),
            (MemberSource::Map(quantity), ..) => self.code.scalar(|to| Op::Map { to, quantity }),
            (MemberSource::MapVector(quantity), ..) => self.code.vector(|to| Op::MapVector { to, quantity }),
            (MemberSource::Nose, ..) => self.end_of_body(false),
            (MemberSource::Tail, ..) => self.end_of_body(true),
            (MemberSource::Run(figure), ..) => self.figure(figure, name.span),
        };
        Some(Value { r#type: member.r#type, register })
    }

    /// Lowers a conditional expression. Both sides are always computed.
    fn choice(&mut self, scope: &Scope<'f>, condition: &'f Expression, sides: [&'f Expression; 2]) -> Option<Value> {
        let condition = self.expect(scope, condition, Type::Bool);
        let [first, second] = sides.map(|side| self.expression(scope, side));
        let (condition, first, second) = (condition?.register, first?, second?);
        let r#type = if first.r#type.fits(second.r#type) { second.r#type } else { first.r#type };
        if !second.r#type.fits(r#type) {
            let [one, other] = [r#type, second.r#type].map(|r#type| self.phrase(r#type));
            let message = format!("the sides of an `if` differ: {one} and {other}");
            let diagnostic = Diagnostic::error("P0301", message, sides[1].span, format!("is {other}"))
                .note(sides[0].span, format!("is {one}"));
            self.report(match (r#type, binary_hint(Binary::Add, r#type, second.r#type)) {
                (Type::Scalar(_), Some(hint)) => diagnostic.hint(hint),
                _ => diagnostic.hint("both sides must have the same type"),
            });
            return None;
        }
        if let Type::Body | Type::Map | Type::Target | Type::Route | Type::Run | Type::Monitor(_) = r#type {
            return self.mismatch(sides[0].span, r#type, "an `if` chooses between values");
        }
        let width = r#type.width();
        let to = self.code.allocate(width);
        for part in 0..width {
            let (to, a, b) = (to + part, first.register + part, second.register + part);
            self.code.push(Op::Select { to, condition, a, b });
        }
        Some(Value { r#type, register: to })
    }

    /// The middle of the nose or of the tail: the position of the body, moved along its heading.
    fn end_of_body(&mut self, is_tail: bool) -> Register {
        let scalar = |compiler: &mut Self, quantity| compiler.code.scalar(|to| Op::Body { to, quantity });
        let nose = scalar(self, BodyScalar::NoseReach);
        let reach = if is_tail {
            let length = scalar(self, BodyScalar::Length);
            self.code.scalar(|to| Op::Subtract { to, a: nose, b: length })
        } else {
            nose
        };
        let heading = scalar(self, BodyScalar::Yaw);
        let ahead = self.direction(heading);
        let offset = self.code.vector(|to| Op::MultiplyVector { to, a: ahead, b: reach });
        let position = self.code.vector(|to| Op::BodyPosition { to });
        self.code.vector(|to| Op::AddVectors { to, a: position, b: offset })
    }

    fn norm(&mut self, scope: &Scope<'f>, inner: &'f Expression) -> Option<Value> {
        let Value { r#type, register: a } = self.expression(scope, inner)?;
        match r#type.calculated() {
            Type::Vector(dimension) => {
                // An unnamed difference is not used elsewhere, so its operation can be removed.
                let difference = if let Kind::Binary { .. } = inner.kind { self.code.take_difference() } else { None };
                let register = match difference {
                    Some((a, b)) => self.code.scalar(|to| Op::Distance { to, a, b }),
                    None => self.code.scalar(|to| Op::Norm { to, a }),
                };
                Some(Value { r#type: Type::Scalar(dimension), register })
            }
            Type::Scalar(_) => Some(Value { r#type, register: self.code.scalar(|to| Op::Absolute { to, a }) }),
            other => {
                let diagnostic = self.wrong_type(inner.span, other, "only a number or a vector has a magnitude");
                self.report(match other {
                    Type::Position => diagnostic.hint("`|a - b|` is the distance of two positions"),
                    _ => diagnostic,
                });
                None
            }
        }
    }

    /// The dimension of a product, unless its exponents exceed their range.
    pub(super) fn dimension(&mut self, dimension: Option<Dimension>, span: Span) -> Option<Dimension> {
        if dimension.is_none() {
            let diagnostic = Diagnostic::error("P0305", "the dimension has too large an exponent", span, "of this");
            self.report(diagnostic.hint("divide before you multiply further"));
        }
        dimension
    }

    /// Reports a value of the wrong type.
    pub(super) fn mismatch<T>(&mut self, span: Span, found: Type, rule: &str) -> Option<T> {
        let diagnostic = self.wrong_type(span, found, rule);
        self.report(diagnostic);
        None
    }

    /// The diagnostic of a value of the wrong type.
    pub(super) fn wrong_type(&self, span: Span, found: Type, rule: &str) -> Diagnostic {
        Diagnostic::error("P0301", rule, span, format!("is {}", self.phrase(found)))
    }
}
