//! Targets of transitions, and initial states.

use std::sync::Arc;

use crate::ast::{Expression, File, Name, State, StateContent, Step, Target};
use crate::expand::Instance;
use crate::foreign_syntax::target_advice;
use crate::suggestion::did_you_mean;
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{self, Block};
use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::call::{Callee, Given, usage};
use super::scope::{Meaning, Scope};
use super::structure::{FAILURE, SUCCESS};
use super::{Compiler, StateEntry};

/// The values for a state, and its arguments.
type ArgumentValues<'f> = (Vec<Given<'f>>, Vec<(String, Meaning)>);

impl<'f> Compiler<'f> {
    /// The text of `what`, without control characters.
    pub(super) fn plain_text(&mut self, text: &Name, what: &str) -> Option<Arc<str>> {
        if let Some((at, letter)) = text.text.char_indices().find(|(_, letter)| letter.is_control()) {
            let at = text.span.start + at;
            let span = Span::new(at, at + letter.len_utf8());
            let message = format!("{what} must be one line of plain text");
            let diagnostic = Diagnostic::error("P0413", message, span, format!("{letter:?} cannot be shown"));
            self.report(diagnostic.hint("write a space instead, or leave it out"));
            return None;
        }
        Some(Arc::from(text.text.as_str()))
    }

    /// Lowers the target of a transition of the state `from`, or of a global one.
    pub(super) fn target(
        &mut self,
        scope: &Scope<'f>,
        from: Option<usize>,
        target: &'f Target,
    ) -> Option<machine::Target> {
        if target.is_exit {
            return self.exit(scope, from, target);
        }
        self.target_in(scope, (self.hierarchy.instance(from), from), target)
    }

    /// Lowers a target whose names are those of an instance. The transition belongs to the state `from`, which may be in a
    /// behaviour that a state of the instance uses.
    pub(super) fn target_in(
        &mut self,
        scope: &Scope<'f>,
        (instance, from): (usize, Option<usize>),
        target: &'f Target,
    ) -> Option<machine::Target> {
        let end = [(FAILURE, "what went wrong"), (SUCCESS, "what was done")];
        let end = end.into_iter().find(|(name, _)| target.name.text == *name);
        if let Some((name, example)) = end
            && target.outer.is_empty()
            && target.resume.is_none()
        {
            let Some(reason) = &target.text else {
                let message = format!("`{name}` needs a reason");
                let diagnostic = Diagnostic::error("P0304", message, target.span, "without a reason");
                self.report(diagnostic.hint(format!("write `{name}(\"{example}\")`")));
                return None;
            };
            let reason = self.plain_text(reason, "a reason")?;
            return Some(if name == SUCCESS {
                machine::Target::Success(reason)
            } else {
                machine::Target::Failure(reason)
            });
        }
        if let Some((name, example)) = end {
            let message = format!("`{name}` is not in a state and has no history");
            let diagnostic = Diagnostic::error("P0408", message, target.span, "ends the run in any state");
            self.report(diagnostic.hint(format!("write `{name}(\"{example}\")` alone")));
            return None;
        }
        let Some(StateEntry { index: state, arguments }) = self.entry_of(instance, &target.name) else {
            if self.is_told("P0201", target.name.span) {
                return None;
            }
            let diagnostic = self.unknown_state(instance, &target.name);
            self.report(match &target.text {
                Some(text) => diagnostic.hint(end_advice(&target.name.text, &text.text)),
                None => diagnostic,
            });
            return None;
        };
        if let Some(text) = &target.text {
            let message = format!("the state `{}` takes no reason", target.name.text);
            let diagnostic =
                Diagnostic::error("P0304", message, text.span, "only `Failure` and `Success` take a reason");
            self.report(diagnostic.hint(end_advice(&target.name.text, &text.text)));
            return None;
        }
        if let Some(resume) = target.resume
            && self.hierarchy.inner(state).is_empty()
        {
            let message = format!("the state `{}` has no inner states to resume", target.name.text);
            self.report(
                Diagnostic::error("P0409", message, resume, "cannot be resumed")
                    .hint(format!("write `-> {}` to enter it", target.name.text)),
            );
            return None;
        }
        let entered = self.hierarchy.entered(from, state);
        let mut given = self.outer_values(instance, target, state, &entered)?;
        let values = self.given(state, target.span, &target.values, &entered)?;
        given.push((values, arguments));
        let arguments = self.pass_arguments(scope, &given)?;
        Some(machine::Target::State { state, arguments, resume: target.resume.is_some() })
    }

    /// The values of the outer states that the transition enters. `entered` lists the entered states.
    fn outer_values(
        &mut self,
        instance: usize,
        target: &'f Target,
        state: usize,
        entered: &[usize],
    ) -> Option<Vec<ArgumentValues<'f>>> {
        let path = self.path(entered);
        let mut steps: Vec<(usize, &Step)> = Vec::with_capacity(target.outer.len());
        let mut behind = 0;
        for step in &target.outer {
            let Some(index) = self.entry_of(instance, &step.name).map(|entry| entry.index) else {
                if !self.is_told("P0201", step.name.span) {
                    let diagnostic = self.unknown_state(instance, &step.name);
                    self.report(diagnostic);
                }
                return None;
            };
            let outer = &entered[..entered.len() - 1];
            let Some(level) = outer.iter().position(|&on_path| on_path == index).filter(|&level| level >= behind)
            else {
                let (name, inner) = (&step.name.text, &target.name.text);
                let is_outer = self.hierarchy.contains(index, state) && index != state && !outer.contains(&index);
                self.report(if is_outer {
                    let message = format!("`{name}` is already active when a transition enters `{inner}`");
                    Diagnostic::error("P0408", message, step.span, "already active")
                        .hint(format!("write `{path}`, without the states that stay active"))
                } else {
                    let message = match steps.last() {
                        Some((_, before)) if outer.contains(&index) => {
                            format!("the state `{name}` is not in `{}`", before.name.text)
                        }
                        _ => format!("the state `{inner}` is not in `{name}`"),
                    };
                    Diagnostic::error("P0408", message, step.span, "not a path to the state")
                        .hint(format!("write `{path}`"))
                });
                return None;
            };
            behind = level + 1;
            steps.push((level, step));
        }
        let mut given = Vec::with_capacity(entered.len());
        for (level, &index) in entered[..entered.len() - 1].iter().enumerate() {
            let state = &self.hierarchy.states[index];
            let outer = &state.name;
            let arguments = self.entry_of(state.instance, outer)?.arguments;
            if let Some((_, step)) = steps.iter().find(|(at, _)| *at == level) {
                let values = self.given(index, step.span, &step.values, entered)?;
                given.push((values, arguments));
            } else if self.hierarchy.states[index].arguments.iter().all(|argument| argument.default.is_some()) {
                let values = self.given(index, target.span, &[], entered)?;
                given.push((values, arguments));
            } else {
                let message =
                    format!("`{}` takes values, and is entered together with `{}`", outer.text, target.name.text);
                let label = format!("the values of `{}` are missing", outer.text);
                self.report(
                    Diagnostic::error("P0307", message, target.span, label)
                        .note(outer.span, "in this")
                        .hint(format!("write `{path}`")),
                );
                return None;
            }
        }
        Some(given)
    }

    /// The notation of the last state of `entered`, with the outer states that take values.
    fn path(&self, entered: &[usize]) -> String {
        let usages = entered.iter().enumerate().filter_map(|(level, &index)| {
            let name = &self.hierarchy.states[index].name.text;
            let arguments = &self.hierarchy.states[index].arguments;
            (level + 1 == entered.len() || !arguments.is_empty()).then(|| usage(name, arguments))
        });
        usages.collect::<Vec<_>>().join(".")
    }

    /// The state with a name of an instance.
    fn entry_of(&self, instance: usize, name: &Name) -> Option<StateEntry> {
        self.states.get(&(instance, name.text.as_str())).cloned()
    }

    fn unknown_state(&self, instance: usize, name: &Name) -> Diagnostic {
        let message = format!("there is no state `{}`", name.text);
        let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown state");
        let known = self.states.keys().filter(|(known, _)| *known == instance).map(|&(_, name)| name);
        let diagnostic = did_you_mean(diagnostic, &name.text, known.chain([FAILURE, SUCCESS]));
        let inside = self.hierarchy.states.iter().find(|state| state.name.text == name.text);
        let around = inside.map(|state| &self.hierarchy.instances[state.instance]);
        match (target_advice(&name.text), around) {
            (Some(advice), _) => diagnostic.hint(advice),
            (None, Some(Instance { user: Some(user), name: behaviour, .. }))
                if !self.hierarchy.is_behaviour(instance) =>
            {
                let user = &self.hierarchy.states[*user].name.text;
                let (name, behaviour) = (&name.text, &behaviour.text);
                diagnostic.hint(format!(
                    "`{name}` is inside the behaviour `{behaviour}`, which begins in its own initial state: write `-> {user}`"
                ))
            }
            _ if self.hierarchy.is_behaviour(instance) => {
                let behaviour = &self.hierarchy.instances[instance].name.text;
                diagnostic.hint(format!(
                    "the behaviour `{behaviour}` knows no states outside of it; declare an exit, and write `-> exit name`"
                ))
            }
            _ => diagnostic,
        }
    }

    /// The values of the arguments of a state of `entered`.
    fn given(
        &mut self,
        state: usize,
        span: Span,
        values: &'f [Expression],
        entered: &[usize],
    ) -> Option<Vec<Given<'f>>> {
        let states = self.hierarchy.states;
        let StateContent { name, arguments, .. } = &*states[state].content;
        let what = format!("the state `{}`", name.text);
        match (Callee { what: &what, label: "entered here" }).values(arguments, values, span) {
            Ok(given) => Some(given),
            Err(diagnostic) => {
                let hint = format!("write `{}`", self.path(entered));
                self.report(diagnostic.note(name.span, "declared here").hint(hint));
                None
            }
        }
    }

    /// Emits the values of the entered states' arguments. All are computed before the first is stored, because a state
    /// may pass its own arguments to itself in another order.
    fn pass_arguments(&mut self, scope: &Scope<'f>, given: &[ArgumentValues<'f>]) -> Option<Block> {
        let start = self.code.here();
        let pairs = given.iter().flat_map(|(values, arguments)| values.iter().zip(arguments));
        let values: Vec<Option<(Value, Value)>> = pairs
            .map(|(&Given { value, is_default }, &(_, argument))| {
                let none = Scope::default();
                let scope = if is_default { &none } else { scope };
                let Some(argument) = argument else {
                    self.expression(scope, value);
                    return None;
                };
                Some((self.expect(scope, value, argument.r#type)?, argument))
            })
            .collect();
        let mut copies = Vec::with_capacity(values.len());
        // A behaviour got its monitors when it was declared.
        let values = values.into_iter().collect::<Option<Vec<_>>>()?.into_iter();
        for (value, argument) in values.filter(|(value, _)| !matches!(value.r#type, Type::Monitor(_))) {
            let between = self.code.allocate(value.r#type.width());
            self.code.copy(between, value.register, value.r#type.width());
            copies.push((argument.register, between, value.r#type.width()));
        }
        for (to, from, width) in copies {
            self.code.copy(to, from, width);
        }
        Some(self.code.since(start))
    }

    /// The initial state of the machine.
    pub(super) fn initial(&mut self, file: &'f File) -> Option<usize> {
        let [name] = file.initial.as_slice() else {
            let diagnostic = match file.initial.as_slice() {
                [first, second, ..] => second_initial("a machine has one initial state", first.span, second.span),
                _ => Diagnostic::error("P0404", "the machine has no initial state", file.name.span, "has no `initial`")
                    .hint("write `initial` and the name of a state"),
            };
            self.report(diagnostic);
            return None;
        };
        let Some(entry) = self.entry_of(0, name) else {
            let diagnostic = self.unknown_state(0, name);
            self.report(diagnostic);
            return None;
        };
        let index = entry.index;
        let fault = if let Some(outer) = self.hierarchy.states[index].parent {
            let outer = &self.hierarchy.states[outer].name.text;
            let hint = format!("start in an outermost state; the `initial` of `{outer}` selects its inner state");
            Some((format!("a run cannot start in an inner state of `{outer}`"), hint))
        } else if entry.arguments.is_empty() {
            None
        } else {
            let hint = format!("start in a state without arguments that has a transition to `{}`", name.text);
            Some(("the initial state cannot have arguments".to_owned(), hint))
        };
        let Some((message, hint)) = fault else { return Some(index) };
        self.report(Diagnostic::error("P0404", message, name.span, "starts here").hint(hint));
        None
    }

    /// The initial inner state of a state, and its values. `None` if there are no inner states.
    pub(super) fn inner_initial(
        &mut self,
        scope: &Scope<'f>,
        index: usize,
        state: &'f State,
    ) -> Option<(usize, Block)> {
        let name = &state.name.text;
        let inner = self.hierarchy.inner(index).iter().map(|&inner| self.hierarchy.states[inner].name.text.as_str());
        let names: Vec<String> = inner.clone().map(|name| format!("`{name}`")).collect();
        let step = match state.initial.as_slice() {
            [] if names.is_empty() => return None,
            [] => {
                let message = format!("the state `{name}` has inner states, but no initial one");
                self.report(
                    Diagnostic::error("P0404", message, state.name.span, "has no `initial`")
                        .hint(format!("write `initial` and the name of {}", names.join(" or "))),
                );
                return None;
            }
            [step] => step,
            [first, second, ..] => {
                self.report(second_initial("a state has one initial inner state", first.span, second.span));
                return None;
            }
        };
        let Step { name: begin, values, span } = &**step;
        // The content of a behaviour follows the state that uses it.
        let place = if state.behaviour.is_some() { index + 1 } else { index };
        let Some(StateEntry { index: child, arguments }) = self.entry_of(self.hierarchy.instance(Some(place)), begin)
        else {
            let message = format!("there is no state `{}`", begin.text);
            let diagnostic = Diagnostic::error("P0201", message, begin.span, "unknown state");
            let diagnostic = did_you_mean(diagnostic, &begin.text, inner);
            self.report(diagnostic);
            return None;
        };
        if !self.hierarchy.inner(index).contains(&child) {
            let message = format!("the state `{}` is not an inner state of `{name}`", begin.text);
            let diagnostic = Diagnostic::error("P0404", message, begin.span, "cannot be initial");
            self.report(if names.is_empty() {
                diagnostic.hint(format!("`{name}` has no inner state: remove `initial`"))
            } else {
                diagnostic.hint(format!("write `initial` and the name of {}", names.join(" or ")))
            });
            return None;
        }
        let values = self.given(child, *span, values, &[child])?;
        let values = self.pass_arguments(scope, &[(values, arguments)])?;
        Some((child, values))
    }
}

/// Advice for a target with a reason that is neither `Failure` nor `Success`: the one that is meant, or both.
fn end_advice(name: &str, reason: &str) -> String {
    let lower = name.to_lowercase();
    let is_meant = |end: &str, begin: &str| lower.starts_with(begin) || suggest(name, [end]).is_some();
    let ends = match (is_meant(FAILURE, "fail"), is_meant(SUCCESS, "succ") || target_advice(name).is_some()) {
        (true, false) => return format!("write `{FAILURE}(\"{reason}\")` to end the run"),
        (false, true) => return format!("write `{SUCCESS}(\"{reason}\")` to complete the run"),
        _ => [FAILURE, SUCCESS].map(|end| format!("`{end}(\"{reason}\")`")),
    };
    format!("write {} to end the run", ends.join(" or "))
}

fn second_initial(message: &str, first: Span, second: Span) -> Diagnostic {
    Diagnostic::error("P0404", message, second, "a second initial state")
        .note(first, "the first")
        .hint("keep one of them")
}
