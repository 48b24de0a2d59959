//! Calls of built-in functions and of derived values.

use crate::ast::{Argument, Derived, Expression, Name};
use crate::builtins::Function;
use crate::types::{Type, Value};
use vibrissa_runtime::machine::Op;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::call::{Callee, Given, usage};
use super::scope::Scope;

/// The number of compared names that counts as one visited node.
const COMPARED_PER_WORK: usize = 64;

impl<'f> Compiler<'f> {
    /// Lowers a call of a built-in function.
    pub(super) fn function(
        &mut self,
        scope: &Scope<'f>,
        function: Function,
        usage: &str,
        values: &'f [Expression],
        span: Span,
    ) -> Option<Value> {
        let given: Vec<Option<Value>> = values.iter().map(|value| self.expression(scope, value)).collect();
        let given: Vec<Value> = given.into_iter().collect::<Option<_>>()?;
        let types: Vec<Type> = given.iter().map(|value| value.r#type.calculated()).collect();
        let register = |index: usize| given[index].register;
        let scalar = |dimension, register| Some(Value { r#type: Type::Scalar(dimension), register });
        let vector = |dimension, register| Some(Value { r#type: Type::Vector(dimension), register });
        if let Some(value) = self.signal(function, &given).or_else(|| self.vector_function(function, &given)) {
            return Some(value);
        }
        match (function, types.as_slice()) {
            (Function::Abs, &[Type::Scalar(dimension)]) => {
                scalar(dimension, self.code.scalar(|to| Op::Absolute { to, a: register(0) }))
            }
            (Function::Sign, [Type::Scalar(_)]) => {
                scalar(Dimension::NUMBER, self.code.scalar(|to| Op::Sign { to, a: register(0) }))
            }
            (Function::Sqrt, &[Type::Scalar(dimension)]) if square_root(dimension).is_some() => {
                let root = square_root(dimension)?;
                scalar(root, self.code.scalar(|to| Op::SquareRoot { to, a: register(0) }))
            }
            (Function::Min, &[Type::Scalar(a), Type::Scalar(b)]) if a == b => {
                scalar(a, self.code.scalar(|to| Op::Minimum { to, a: register(0), b: register(1) }))
            }
            (Function::Max, &[Type::Scalar(a), Type::Scalar(b)]) if a == b => {
                scalar(a, self.code.scalar(|to| Op::Maximum { to, a: register(0), b: register(1) }))
            }
            (Function::Clamp, &[Type::Scalar(dimension), Type::Scalar(b), Type::Scalar(c)])
                if dimension == b && b == c =>
            {
                let [a, low, high] = [0, 1, 2].map(register);
                scalar(dimension, self.code.scalar(|to| Op::Clamp { to, a, low, high }))
            }
            (Function::Blend, &[Type::Scalar(a), Type::Scalar(b), Type::NUMBER]) if a == b => {
                scalar(a, self.blend([register(0), register(1)], register(2)))
            }
            (Function::Blend, &[Type::Vector(a), Type::Vector(b), Type::NUMBER]) if a == b => {
                vector(a, self.code.vector(|to| Op::Blend { to, a: register(0), b: register(1), share: register(2) }))
            }
            (Function::Sin | Function::Cos | Function::Tan, &[Type::ANGLE])
            | (Function::Exp | Function::Floor, &[Type::NUMBER]) => {
                scalar(Dimension::NUMBER, self.elementary(function, register(0)))
            }
            (Function::Asin | Function::Acos, &[Type::NUMBER]) => {
                scalar(Dimension::ANGLE, self.arc(function, register(0)))
            }
            (Function::Angle, [Type::Vector(_)]) => {
                scalar(Dimension::ANGLE, self.code.scalar(|to| Op::Angle { to, a: register(0) }))
            }
            (Function::Turn, &[Type::ANGLE, Type::ANGLE]) => {
                let difference = self.code.scalar(|to| Op::Subtract { to, a: register(1), b: register(0) });
                scalar(Dimension::ANGLE, self.code.scalar(|to| Op::Wrap { to, a: difference }))
            }
            (Function::Wrap, &[Type::ANGLE]) => {
                scalar(Dimension::ANGLE, self.code.scalar(|to| Op::Wrap { to, a: register(0) }))
            }
            (Function::Dot | Function::Cross, &[Type::Vector(a), Type::Vector(b)]) => {
                let dimension = self.dimension(a.checked_mul(b), span)?;
                scalar(dimension, self.product(function, register(0), register(1)))
            }
            (Function::LowPass, &[Type::Scalar(dimension), Type::Scalar(Dimension::FREQUENCY)]) => {
                let memory = self.memory(3);
                let (a, b) = (register(0), register(1));
                scalar(dimension, self.code.scalar(|to| Op::LowPass { to, a, b, memory }))
            }
            (
                Function::Pid,
                &[Type::Scalar(error), Type::Scalar(p), Type::Scalar(i), Type::Scalar(d), Type::Scalar(limit)],
            ) if is_pid(error, p, i, d, limit) => {
                let (memory, gains) = (self.memory(4), self.code.allocate(4));
                for gain in 0..4 {
                    self.code.copy(gains + gain, register(usize::from(gain) + 1), 1);
                }
                scalar(limit, self.code.scalar(|to| Op::Pid { to, a: register(0), gains, memory }))
            }
            _ => {
                let found: Vec<String> = given.iter().map(|value| self.phrase(value.r#type)).collect();
                let message = match found.as_slice() {
                    [] => format!("`{usage}` needs its values"),
                    _ => format!("`{usage}` does not take {}", found.join(", ")),
                };
                let diagnostic = Diagnostic::error("P0304", message, span, "these values")
                    .hint(format!("it takes {}", function.takes()));
                self.report(if types.contains(&Type::Position) {
                    diagnostic.hint("the difference of two positions is a vector, as in `w.tip - body.position`")
                } else {
                    diagnostic
                });
                None
            }
        }
    }

    /// Lowers a function whose result is a vector, a direction or a position. `None` for another one, and for values that it does
    /// not take.
    fn vector_function(&mut self, function: Function, given: &[Value]) -> Option<Value> {
        let types: Vec<Type> = given.iter().map(|value| value.r#type.calculated()).collect();
        let register = |index: usize| given.get(index).map_or(0, |value| value.register);
        let (r#type, register) = match (function, types.as_slice()) {
            (Function::Blend, &[Type::Position, Type::Position, Type::NUMBER]) => {
                let [a, b, share] = [0, 1, 2].map(register);
                (Type::Position, self.code.vector(|to| Op::Blend { to, a, b, share }))
            }
            (Function::Direction, &[Type::ANGLE]) => (Type::Direction, self.direction(register(0))),
            (Function::Vector, &[Type::Scalar(x), Type::Scalar(y)]) if x == y => {
                (Type::Vector(x), self.pair([register(0), register(1)]))
            }
            (Function::Position, &[Type::LENGTH, Type::LENGTH]) => {
                (Type::Position, self.pair([register(0), register(1)]))
            }
            (Function::Unit, [Type::Vector(_)]) => {
                (Type::Direction, self.code.vector(|to| Op::Unit { to, a: register(0) }))
            }
            (Function::Rotate, &[Type::Vector(_), Type::ANGLE]) => {
                let rotated = self.code.vector(|to| Op::Rotate { to, a: register(0), b: register(1) });
                (given[0].r#type, rotated)
            }
            _ => return None,
        };
        Some(Value { r#type, register })
    }

    /// New registers for the memory of a stateful function. The entry of the current state resets them.
    pub(super) fn memory(&mut self, count: u16) -> u16 {
        let memory = self.code.allocate(count);
        self.memories.push((memory, count));
        memory
    }

    /// The vector with two components.
    fn pair(&mut self, [x, y]: [u16; 2]) -> u16 {
        let to = self.code.allocate(2);
        self.code.push(Op::Copy { to, a: x });
        self.code.push(Op::Copy { to: to + 1, a: y });
        to
    }

    /// The unit vector with the direction of an angle.
    pub(super) fn direction(&mut self, angle: u16) -> u16 {
        let to = self.code.allocate(2);
        self.code.push(Op::Cosine { to, a: angle });
        self.code.push(Op::Sine { to: to + 1, a: angle });
        to
    }

    /// Linear interpolation between two numbers.
    fn blend(&mut self, [from, into]: [u16; 2], share: u16) -> u16 {
        let one = self.code.constant(1.0);
        let rest = self.code.scalar(|to| Op::Subtract { to, a: one, b: share });
        let first = self.code.scalar(|to| Op::Multiply { to, a: from, b: rest });
        let second = self.code.scalar(|to| Op::Multiply { to, a: into, b: share });
        self.code.scalar(|to| Op::Add { to, a: first, b: second })
    }

    /// An elementary function of one number.
    fn elementary(&mut self, function: Function, a: u16) -> u16 {
        match function {
            Function::Cos => self.code.scalar(|to| Op::Cosine { to, a }),
            Function::Tan => {
                let (a, b) = (self.elementary(Function::Sin, a), self.elementary(Function::Cos, a));
                self.code.scalar(|to| Op::Divide { to, a, b })
            }
            Function::Exp => self.code.scalar(|to| Op::Exponential { to, a }),
            Function::Floor => self.code.scalar(|to| Op::Floor { to, a }),
            _ => self.code.scalar(|to| Op::Sine { to, a }),
        }
    }

    /// The angle whose sine or cosine is `x`, computed as the angle of a unit vector. NaN outside of -1 to 1.
    fn arc(&mut self, function: Function, x: u16) -> u16 {
        let one = self.code.constant(1.0);
        // 1 - x² as a product, because a difference would lose digits near 1.
        let below = self.code.scalar(|to| Op::Subtract { to, a: one, b: x });
        let above = self.code.scalar(|to| Op::Add { to, a: one, b: x });
        let rest = self.code.scalar(|to| Op::Multiply { to, a: below, b: above });
        let other = self.code.scalar(|to| Op::SquareRoot { to, a: rest });
        let sides = if function == Function::Asin { [other, x] } else { [x, other] };
        let vector = self.code.allocate(2);
        self.code.push(Op::Copy { to: vector, a: sides[0] });
        self.code.push(Op::Copy { to: vector + 1, a: sides[1] });
        self.code.scalar(|to| Op::Angle { to, a: vector })
    }

    /// The dot or cross product of two vectors.
    fn product(&mut self, function: Function, a: u16, b: u16) -> u16 {
        let crossed = u16::from(function == Function::Cross);
        let first = self.code.scalar(|to| Op::Multiply { to, a, b: b + crossed });
        let second = self.code.scalar(|to| Op::Multiply { to, a: a + 1, b: b + 1 - crossed });
        self.code.scalar(|to| {
            if function == Function::Cross {
                Op::Subtract { to, a: first, b: second }
            } else {
                Op::Add { to, a: first, b: second }
            }
        })
    }

    /// Inlines a derived value.
    pub(super) fn derived_value(
        &mut self,
        scope: &Scope<'f>,
        (file, derived): (usize, &'f Derived),
        values: &'f [Expression],
        span: Span,
    ) -> Option<Value> {
        let inner = self.arguments(scope, file, &derived.name, &derived.arguments, values, span)?;
        self.inlined(&derived.name, |compiler| {
            compiler.within(file, |compiler| compiler.expression(&inner, &derived.value))
        })
    }

    /// Lowers the content of the law or derived value `name`, where it is used. One with an error is not inlined again: each use would
    /// double the time if its content uses another one twice.
    pub(super) fn inlined<T>(&mut self, name: &'f Name, write: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let faults = self.faults;
        self.inlining.push(name);
        let written = write(self);
        self.inlining.pop();
        if self.faults > faults {
            self.erroneous.insert(name.span);
        }
        written
    }

    /// The scope of a law or derived value of a file with `values` for its arguments. `None` if they do not fit, or if it has an
    /// error or is recursive. All of these have been reported.
    pub(super) fn arguments(
        &mut self,
        scope: &Scope<'f>,
        file: usize,
        name: &'f Name,
        arguments: &'f [Argument],
        values: &'f [Expression],
        span: Span,
    ) -> Option<Scope<'f>> {
        if self.inlining.iter().any(|inlined| inlined.span == name.span) {
            let chain = self.inlining.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join("` uses `");
            let message = format!("`{}` uses itself (`{chain}` uses `{}`)", name.text, name.text);
            self.report(Diagnostic::error("P0401", message, span, "used within itself").hint(
                "recursion is not possible, because the work of a tick is bounded; use memory and states instead",
            ));
            return None;
        }
        // Each value with a name is compared with the names of all arguments.
        self.work += values.len() * arguments.len() / COMPARED_PER_WORK;
        let what = format!("`{}`", name.text);
        let given = match (Callee { what: &what, label: "used here" }).values(arguments, values, span) {
            Ok(given) => given,
            Err(diagnostic) => {
                let hint = format!("write `{}`", usage(&name.text, arguments));
                self.report(diagnostic.note(name.span, "made here").hint(hint));
                return None;
            }
        };
        let mut inner = Scope::default();
        let mut complete = true;
        // The defaults of one with an error have been checked.
        let is_erroneous = self.erroneous.contains(&name.span);
        for (argument, Given { value, is_default }) in arguments.iter().zip(given) {
            // An unknown type is reported where the law is declared.
            let r#type = self.within(file, |compiler| compiler.named_type(&argument.type_name));
            let value = match r#type {
                Some(_) if is_default && is_erroneous => None,
                Some(r#type) if is_default => {
                    let faults = self.faults;
                    let value = self.within(file, |compiler| compiler.expect(&Scope::default(), value, r#type));
                    if self.faults > faults {
                        self.erroneous.insert(name.span);
                    }
                    value
                }
                Some(r#type) => self.expect(scope, value, r#type),
                None => self.expression(scope, value).and(None),
            };
            complete &= value.is_some();
            inner.insert(&argument.name, value);
        }
        if self.erroneous.contains(&name.span) {
            self.erroneous.extend(self.inlining.iter().map(|name| name.span));
            return None;
        }
        complete.then_some(inner)
    }
}

/// True if the gains of a PID controller convert the error to the dimension of the limit.
fn is_pid(error: Dimension, p: Dimension, i: Dimension, d: Dimension, limit: Dimension) -> bool {
    let integrated = error.checked_mul(Dimension::TIME);
    let changing = error.checked_div(Dimension::TIME);
    p.checked_mul(error) == Some(limit)
        && integrated.is_some_and(|integrated| i.checked_mul(integrated) == Some(limit))
        && changing.is_some_and(|changing| d.checked_mul(changing) == Some(limit))
}

/// The dimension whose square is `dimension`, if there is one.
fn square_root(dimension: Dimension) -> Option<Dimension> {
    let Dimension { length, angle, time, mass } = dimension;
    let even = [length, angle, time, mass].iter().all(|exponent| exponent % 2 == 0);
    even.then(|| Dimension::new(length / 2, angle / 2, time / 2, mass / 2))
}
