//! The time in a state, and functions with a memory of a signal: its previous value, its peak, whether it is settled, and
//! the length of a path.
//!
//! Guards of a state may be evaluated more than once in a tick. A second evaluation with the same value changes no
//! memory. The entry of a state sets the memory to zero, so its first register tells whether there is a value.

use crate::builtins::Function;
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{Op, Register, TIME_SLACK};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;

impl Compiler<'_> {
    /// Lowers a function with a memory of a signal. `None` for another function, and for values that it does not take.
    pub(super) fn signal(&mut self, function: Function, given: &[Value]) -> Option<Value> {
        let (r#type, register) = match (function, given) {
            (Function::Previous, &[signal])
                if matches!(signal.r#type, Type::Scalar(_)) || signal.r#type.components().is_some() =>
            {
                return Some(self.previous(signal));
            }
            (Function::Peak, &[Value { r#type: r#type @ Type::Scalar(_), register }]) => (r#type, self.peak(register)),
            (Function::Settled, &[signal, within, lasting])
                if matches!(signal.r#type, Type::Scalar(_))
                    && (within.r#type, lasting.r#type) == (signal.r#type, Type::TIME) =>
            {
                (Type::Bool, self.settled([signal, within, lasting].map(|value| value.register)))
            }
            (Function::PathLength, &[Value { r#type: Type::Position, register }]) => {
                (Type::LENGTH, self.path_length(register))
            }
            _ => return None,
        };
        Some(Value { r#type, register })
    }

    /// Lowers `previous(x)`: the value at the last earlier tick in which it was computed. At first, the value itself.
    fn previous(&mut self, signal: Value) -> Value {
        let clock = self.memory(2);
        let (has, time) = (clock, clock + 1);
        let now = self.code.scalar(|to| Op::Time { to });
        let is_later = self.code.scalar(|to| Op::Less { to, a: time, b: now });
        let width = signal.r#type.width();
        let to = self.code.allocate(width);
        for part in 0..width {
            let values = self.memory(2);
            let (last, before) = (values, values + 1);
            let a = signal.register + part;
            let earlier = self.select(is_later, last, before);
            self.keep(before, earlier);
            let first = self.select(has, before, a);
            self.keep(before, first);
            self.keep(to + part, first);
            self.keep(last, a);
        }
        self.note(has);
        self.keep(time, now);
        Value { r#type: signal.r#type, register: to }
    }

    /// Lowers `peak(x)`: the largest value since the entry of the state.
    fn peak(&mut self, a: Register) -> Register {
        let memory = self.memory(2);
        let (has, peak) = (memory, memory + 1);
        let is_number = self.code.scalar(|to| Op::Equal { to, a, b: a });
        let is_larger = self.code.scalar(|to| Op::Less { to, a: peak, b: a });
        let is_first = self.code.scalar(|to| Op::Not { to, a: has });
        let is_new = self.code.scalar(|to| Op::Or { to, a: is_larger, b: is_first });
        let counts = self.code.scalar(|to| Op::And { to, a: is_number, b: is_new });
        let largest = self.select(counts, a, peak);
        self.keep(peak, largest);
        let known = self.code.scalar(|to| Op::Or { to, a: has, b: is_number });
        self.keep(has, known);
        self.select(known, largest, a)
    }

    /// Lowers `settled(x, within, lasting)`: true if the value stayed within a distance of one value for a time.
    fn settled(&mut self, [a, within, lasting]: [Register; 3]) -> Register {
        let memory = self.memory(3);
        let (has, around, since) = (memory, memory + 1, memory + 2);
        let now = self.code.scalar(|to| Op::Time { to });
        let difference = self.code.scalar(|to| Op::Subtract { to, a, b: around });
        let distance = self.code.scalar(|to| Op::Absolute { to, a: difference });
        let is_near = self.code.scalar(|to| Op::LessOrEqual { to, a: distance, b: within });
        let stays = self.code.scalar(|to| Op::And { to, a: has, b: is_near });
        let around_now = self.select(stays, around, a);
        self.keep(around, around_now);
        let since_now = self.select(stays, since, now);
        self.keep(since, since_now);
        self.note(has);
        let slack = self.code.constant(TIME_SLACK);
        let elapsed = self.code.scalar(|to| Op::Subtract { to, a: now, b: since_now });
        let rounded = self.code.scalar(|to| Op::Add { to, a: elapsed, b: slack });
        self.code.scalar(|to| Op::LessOrEqual { to, a: lasting, b: rounded })
    }

    /// Lowers `path_length(position)`: the length of the path of a position since the entry of the state.
    fn path_length(&mut self, position: Register) -> Register {
        let memory = self.memory(4);
        let (has, last, length) = (memory, memory + 1, memory + 3);
        let step = self.code.scalar(|to| Op::Distance { to, a: position, b: last });
        // A position that is not a number makes no step, and the next one counts from the last known position.
        let has_step = self.code.scalar(|to| Op::Equal { to, a: step, b: step });
        let counts = self.code.scalar(|to| Op::And { to, a: has, b: has_step });
        let longer = self.code.scalar(|to| Op::Add { to, a: length, b: step });
        let total = self.select(counts, longer, length);
        self.keep(length, total);
        for part in 0..2 {
            let next = self.select(has_step, position + part, last + part);
            self.keep(last + part, next);
        }
        let known = self.code.scalar(|to| Op::Or { to, a: has, b: has_step });
        self.keep(has, known);
        total
    }

    /// Lowers `state_time`: the time since the entry of the state that contains it. `span` is that of the name.
    pub(super) fn state_time(&mut self, span: Span) -> Option<Register> {
        let Some(entered) = self.entered else {
            let diagnostic =
                Diagnostic::error("P0201", "`state_time` is known only in a state", span, "not in a state");
            self.report(diagnostic.hint("give it to a law or a derived value as an argument, or use `time`"));
            return None;
        };
        let now = self.code.scalar(|to| Op::Time { to });
        Some(self.code.scalar(|to| Op::Subtract { to, a: now, b: entered }))
    }

    fn select(&mut self, condition: Register, a: Register, b: Register) -> Register {
        self.code.scalar(|to| Op::Select { to, condition, a, b })
    }

    /// Notes in a register that there is a value. It reads the register, because the optimiser would move a copy of a
    /// constant to the start of the run.
    fn note(&mut self, has: Register) {
        let b = self.code.constant(1.0);
        self.code.push(Op::Or { to: has, a: has, b });
    }

    fn keep(&mut self, to: Register, a: Register) {
        self.code.push(Op::Copy { to, a });
    }
}
