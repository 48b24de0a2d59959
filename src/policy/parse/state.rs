//! States, inner states, and targets.

use crate::diagnostic::Span;
use crate::policy::ast::{Expression, Name, State, Step, Target};
use crate::policy::grammar::Rule;
use crate::policy::parse_tree::Pair;

use super::{Parsed, Reader, arguments, block, statement, text, transition, values};

/// Adds a state and its inner states to `states`.
pub(super) fn state(reader: &mut Reader<'_>, parent: Option<usize>, states: &mut Vec<State>) -> Parsed<()> {
    let (name, arguments) = (reader.name()?, arguments(reader)?);
    let (memory, entry, exit, body) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (initial, transitions, failsafes) = (Vec::new(), Vec::new(), Vec::new());
    let own = states.len();
    states.push(State { name, parent, arguments, initial, memory, entry, exit, body, transitions, failsafes });
    while let Some(pair) = reader.rest() {
        if pair.as_rule() == Rule::state {
            self::state(&mut Reader::new(pair), Some(own), states)?;
            continue;
        }
        let state = &mut states[own];
        match pair.as_rule() {
            Rule::start => state.initial.push(step(pair)?),
            Rule::when | Rule::after => state.transitions.push(transition(pair)?),
            Rule::failsafe => state.failsafes.push(target(Reader::new(pair).take(Rule::target)?)?),
            Rule::memory => state.memory.push(variable(&mut Reader::new(pair))?),
            Rule::entry => state.entry.extend(block(Reader::new(pair).take(Rule::block)?)?),
            Rule::exit => state.exit.extend(block(Reader::new(pair).take(Rule::block)?)?),
            _ => state.body.push(statement(pair)?),
        }
    }
    Ok(())
}

/// `var name = value`
pub(super) fn variable(reader: &mut Reader<'_>) -> Parsed<(Name, Expression)> {
    Ok((reader.name()?, reader.expression()?))
}

fn step(pair: Pair<'_>) -> Parsed<Step> {
    let span = pair.span();
    let mut reader = Reader::new(pair);
    let name = reader.name()?;
    Ok(Step { span: Span::new(name.span.start, span.end), name, values: reader.values()?.unwrap_or_default() })
}

/// The target of a transition.
pub(super) fn target(pair: Pair<'_>) -> Parsed<Target> {
    let span = pair.span();
    let mut reader = Reader::new(pair);
    let resume = if reader.has(Rule::kw_resume) { Some(reader.next()?.span()) } else { None };
    let name = reader.name()?;
    if reader.has(Rule::text_argument) {
        let text = text(&mut Reader::new(reader.take(Rule::text_argument)?))?;
        return Ok(Target { resume, outer: Vec::new(), name, text: Some(text), values: Vec::new(), span });
    }
    let mut last = Step { span: name.span, name, values: Vec::new() };
    if reader.has(Rule::values) {
        let pair = reader.next()?;
        last.span = last.span.to(pair.span());
        last.values = values(pair)?;
    }
    let mut outer = Vec::new();
    while reader.has(Rule::inner) {
        outer.push(std::mem::replace(&mut last, step(reader.take(Rule::inner)?)?));
    }
    let Step { name, values, .. } = last;
    Ok(Target { resume, outer, name, text: None, values, span })
}
