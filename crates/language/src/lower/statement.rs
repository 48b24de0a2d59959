//! Statements.

use crate::ast::{Expression, Name, Statement, Steer, Turn};
use crate::suggestion::did_you_mean;
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{Mark, Op};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::scope::{Scope, in_the_standard_library};
use super::{Commandless, Compiler};

impl<'f> Compiler<'f> {
    /// Lowers statements. Names that they declare end with them.
    pub(super) fn statements(&mut self, scope: &mut Scope<'f>, statements: &'f [Statement]) {
        let names = scope.len();
        for statement in statements {
            self.work += 1;
            if self.is_exhausted() {
                break;
            }
            // An error in one statement has been reported. The next statement is checked, too.
            let _ = self.statement(scope, statement);
        }
        scope.truncate(names);
    }

    fn statement(&mut self, scope: &mut Scope<'f>, statement: &'f Statement) -> Option<()> {
        match statement {
            Statement::Let { name, value } => {
                let meaning = self.expression(scope, value).map(|value| self.snapshot(scope, value));
                self.bind(scope, 0, name, meaning);
            }
            Statement::Set { name, value } => self.set(scope, name, value)?,
            Statement::If { branches, otherwise } => self.conditional(scope, branches, otherwise),
            Statement::Do { law, values, span } => self.apply(scope, law, values, *span)?,
            Statement::Record(whisker) => {
                self.allow_record(whisker.span)?;
                let whisker = self.expect(scope, whisker, Type::Whisker)?.register;
                self.code.push(Op::Record { whisker });
            }
            Statement::RecordPosition { position, contour } => self.record_position(scope, position, contour)?,
            Statement::Mark { name, whisker } => self.mark(scope, name, whisker)?,
            Statement::Tell { monitor, event, values, span } => self.tell(scope, [monitor, event], values, *span)?,
            Statement::Plot { name, value } => self.plot(scope, name, value)?,
            Statement::Log { text, values, span } => self.log(scope, text, values, *span)?,
            Statement::Steer(steer) => self.steer(scope, steer)?,
            Statement::Hold(span) => self.command(*span, Op::Hold)?,
            Statement::Stop(span) => self.command(*span, Op::Stop)?,
        }
        Some(())
    }

    fn record_position(&mut self, scope: &Scope<'f>, position: &'f Expression, contour: &Name) -> Option<()> {
        self.allow_record(position.span)?;
        let position = self.expect(scope, position, Type::Position);
        let Some(&contour) = self.names().contours.get(contour.text.as_str()) else {
            let message = format!("there is no contour `{}`", contour.text);
            let diagnostic = Diagnostic::error("P0201", message, contour.span, "unknown contour");
            let known = self.names().contours.keys().copied();
            let hint = format!("declare it in the policy's own file: `contour {}`", contour.text);
            self.report(did_you_mean(diagnostic, &contour.text, known).hint(hint));
            return None;
        };
        self.code.push(Op::RecordPosition { contour, a: position?.register });
        Some(())
    }

    fn mark(&mut self, scope: &Scope<'f>, name: &Name, whisker: &'f Expression) -> Option<()> {
        self.allow_record(whisker.span)?;
        let whisker = self.expect(scope, whisker, Type::Whisker);
        let Some(mark) = Mark::named(&name.text) else {
            let message = format!("there is no mark `{}`", name.text);
            let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown mark");
            let diagnostic = did_you_mean(diagnostic, &name.text, Mark::ALL.map(Mark::name));
            self.report(diagnostic.hint("marks are `lost` and `found`: `mark lost w`"));
            return None;
        };
        self.code.push(Op::Mark { whisker: whisker?.register, mark });
        Some(())
    }

    /// A value that later statements cannot change: a copy if it is memory, otherwise the value itself.
    fn snapshot(&mut self, scope: &Scope<'f>, value: Value) -> Value {
        // The shorter of both lists is searched. Each may have thousands of names.
        let is_memory = if self.variables.len() < scope.len() / 8 {
            let mut own = self.variables.iter().filter_map(|name| scope.get(&name.text).flatten());
            own.any(|memory| value.is_part_of(memory))
        } else {
            scope.has_part(value, |name| self.variables.contains(name))
        };
        if is_memory { self.copied(value) } else { self.untold(value) }
    }

    /// A value that no event can change: a copy if it is memory of a monitor, otherwise the value itself.
    pub(super) fn untold(&mut self, value: Value) -> Value {
        if self.is_of_a_monitor(value) { self.copied(value) } else { value }
    }

    /// A copy of a value in its own registers.
    pub(super) fn copied(&mut self, value: Value) -> Value {
        let width = value.r#type.width();
        let register = self.code.allocate(width);
        self.code.copy(register, value.register, width);
        Value { register, ..value }
    }

    /// Emits a command, unless commands are not allowed here.
    fn command(&mut self, span: Span, op: Op) -> Option<()> {
        if let Some(commandless) = self.commandless {
            return self.refuse(commandless, span, ("cannot give a command", "gives one", "a command"));
        }
        self.code.push(op);
        Some(())
    }

    /// Refuses a record or a mark at `span` where it is not allowed.
    fn allow_record(&mut self, span: Span) -> Option<()> {
        match self.commandless.filter(|commandless| !commandless.allows_records) {
            Some(commandless) => {
                self.refuse(commandless, span, ("cannot record or mark", "does so", "is recorded or marked"))
            }
            None => Some(()),
        }
    }

    /// Refuses to tell the map something at `span` where it is not allowed.
    pub(super) fn allow_telling_the_map(&mut self, span: Span) -> Option<()> {
        match self.commandless.filter(|commandless| !commandless.allows_records) {
            Some(commandless) => {
                self.refuse(commandless, span, ("cannot tell the map anything", "does so", "is told here"))
            }
            None => Some(()),
        }
    }

    /// Reports that a construct does not allow something: what it cannot do, what a law in it does, and what it is.
    fn refuse(&mut self, within: Commandless, span: Span, (cannot, does, what): (&str, &str, &str)) -> Option<()> {
        let message = format!("{} {cannot}", within.construct);
        let diagnostic = match (self.outer_use, self.inlining.first()) {
            // Other uses of the law may be valid, so the error is reported at this use.
            (Some(used), Some(law)) => Diagnostic::error("P0407", message, used, format!("`{}` {does}", law.text)),
            _ => Diagnostic::error("P0407", message, span, what),
        };
        self.report(diagnostic.hint(within.hint));
        None
    }

    fn set(&mut self, scope: &Scope<'f>, name: &'f Name, value: &'f Expression) -> Option<()> {
        let meaning = scope.get(&name.text);
        let is_memory =
            scope.given(&name.text).is_some_and(|given| self.variables.iter().any(|known| known.span == given));
        if !self.inlining.is_empty() || !is_memory {
            self.expression(scope, value);
            let message = format!("`{}` cannot be set", name.text);
            self.report(if self.inlining.is_empty() {
                let diagnostic = Diagnostic::error("P0406", message, name.span, "not memory that is visible here");
                // A hidden name has the same spelling, so it must not be suggested.
                let others = self.variables.iter().map(|known| known.text.as_str()).filter(|known| *known != name.text);
                did_you_mean(diagnostic, &name.text, others).hint(format!(
                    "only a `var` can be set: declare `var {} = \u{2026}` in a state for it and its inner states, or outside of states for \
                     the whole machine",
                    name.text
                ))
            } else {
                Diagnostic::error("P0406", message, name.span, "a law cannot set memory")
                    .hint("compute the value with a `let` outside of the law, and `set` it where the law is used")
            });
            return None;
        }
        let Some(variable) = meaning.flatten() else {
            self.expression(scope, value);
            return None;
        };
        let value = self.expect(scope, value, variable.r#type)?;
        self.code.copy(variable.register, value.register, value.r#type.width());
        Some(())
    }

    fn conditional(
        &mut self,
        scope: &mut Scope<'f>,
        branches: &'f [(Expression, Vec<Statement>)],
        otherwise: &'f [Statement],
    ) {
        let mut exits = Vec::new();
        for (condition, block) in branches {
            let a = self.expect(scope, condition, Type::Bool).map_or(0, |value| value.register);
            let skip = self.code.here();
            self.code.push(Op::JumpUnless { a, target: skip + 1 });
            self.statements(scope, block);
            exits.push(self.code.here());
            self.code.push(Op::Jump { target: skip + 1 });
            self.code.set_jump_target(skip);
        }
        self.statements(scope, otherwise);
        for exit in exits {
            self.code.set_jump_target(exit);
        }
    }

    fn apply(&mut self, scope: &Scope<'f>, name: &'f Name, values: &'f [Expression], span: Span) -> Option<()> {
        let Some((file, law)) = self.names().laws.get(name.text.as_str()).copied() else {
            if self.is_told("P0201", name.span) {
                return None;
            }
            let message = format!("there is no law `{}`", name.text);
            let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown law");
            let diagnostic = did_you_mean(diagnostic, &name.text, self.names().laws.keys().copied());
            self.report(in_the_standard_library(diagnostic, &name.text));
            return None;
        };
        let mut inner = self.arguments(scope, file, &law.name, &law.arguments, values, span)?;
        for argument in &law.arguments {
            let value = inner.get(&argument.name.text).flatten().map(|value| self.untold(value));
            inner.insert(&argument.name, value);
        }
        let used = self.outer_use;
        self.outer_use = used.or(Some(span));
        let written = self.inlined(&law.name, |compiler| {
            compiler.descend(span, |compiler| {
                compiler.within(file, |compiler| compiler.statements(&mut inner, &law.body));
                Some(())
            })
        });
        self.outer_use = used;
        written
    }

    fn steer(&mut self, scope: &Scope<'f>, steer: &'f Steer) -> Option<()> {
        let whisker = match &steer.whisker {
            None => Some(None),
            Some(whisker) => self.expect(scope, whisker, Type::Whisker).map(|value| Some(value.register)),
        };
        let along = self.expression(scope, &steer.along).and_then(|value| match value.r#type {
            Type::Vector(_) | Type::Direction => Some(value.register),
            other => {
                let rule = "the direction of a motion must be a vector";
                let diagnostic = self.wrong_type(steer.along.span, other, rule);
                self.report(match other {
                    Type::Position => diagnostic.hint("the displacement to a position is `position - body.position`"),
                    Type::ANGLE => diagnostic.hint("`direction(angle)` is the direction with an angle"),
                    _ => diagnostic,
                });
                None
            }
        });
        let speed = self.expect(scope, &steer.speed, Type::SPEED);
        let turn = match &steer.turn {
            Turn::Facing(heading) => self.expect(scope, heading, Type::ANGLE),
            Turn::Turning(rate) => self.expect(scope, rate, Type::ANGULAR_SPEED),
        };
        let (whisker, along) = (whisker?, along?);
        let (Value { register: speed, .. }, Value { register: turned, .. }) = (speed?, turn?);
        let op = match (whisker, &steer.turn) {
            (None, Turn::Facing(_)) => Op::SteerBodyFacing { along, speed, heading: turned },
            (None, Turn::Turning(_)) => Op::SteerBodyTurning { along, speed, rate: turned },
            (Some(whisker), Turn::Facing(_)) => Op::SteerWhiskerFacing { whisker, along, speed, heading: turned },
            (Some(whisker), Turn::Turning(_)) => Op::SteerWhiskerTurning { whisker, along, speed, rate: turned },
        };
        self.command(steer.span, op)
    }
}
