//! States, inner states, and targets.

use std::sync::Arc;

use crate::ast::{Behaviour, Connection, Exit, Expression, Monitor, Name, State, StateContent, Step, Target};
use crate::grammar::Rule;
use crate::parse_tree::Pair;
use vibrissa_text::diagnostic::Span;

use super::{Parsed, Reader, arguments, block, contract, internal, law, statement, text, transition, values};

/// Adds a state and its inner states to `states`.
pub(super) fn state(reader: &mut Reader<'_>, parent: Option<usize>, states: &mut Vec<State>) -> Parsed<()> {
    let (name, given) = (reader.name()?, arguments(reader)?);
    let behaviour =
        if reader.has(Rule::application) { Some(Arc::new(step(reader.take(Rule::application)?)?)) } else { None };
    let content = StateContent {
        name,
        arguments: given,
        memory: Vec::new(),
        entry: Vec::new(),
        exit: Vec::new(),
        body: Vec::new(),
        transitions: Vec::new(),
        failsafes: Vec::new(),
        behaviour,
        connections: Vec::new(),
        exits: Arc::default(),
    };
    let own = states.len();
    let (initial, contracts) = (Vec::new(), Arc::default());
    states.push(State { parent, initial, contracts, instance: 0, content: Arc::new(content) });
    while let Some(pair) = reader.rest() {
        if pair.as_rule() == Rule::state {
            self::state(&mut Reader::new(pair), Some(own), states)?;
            continue;
        }
        let State { initial, contracts, content, .. } = &mut states[own];
        // There are no copies yet.
        let content = Arc::make_mut(content);
        match pair.as_rule() {
            Rule::start => initial.push(Arc::new(step(pair)?)),
            Rule::when | Rule::after => content.transitions.push(transition(pair)?),
            Rule::failsafe => content.failsafes.push(target(Reader::new(pair).take(Rule::target)?)?),
            Rule::assume | Rule::never | Rule::recurring => Arc::make_mut(contracts).push(contract(pair)?),
            Rule::memory => content.memory.push(variable(&mut Reader::new(pair))?),
            Rule::entry => content.entry.extend(block(Reader::new(pair).take(Rule::block)?)?),
            Rule::connection => content.connections.push(connection(&mut Reader::new(pair))?),
            Rule::outlet => {
                let mut reader = Reader::new(pair);
                let exit = Exit { name: reader.name()?, arguments: arguments(&mut reader)? };
                Arc::make_mut(&mut content.exits).push(exit);
            }
            Rule::exit => content.exit.extend(block(Reader::new(pair).take(Rule::block)?)?),
            _ => content.body.push(statement(pair)?),
        }
    }
    Ok(())
}

/// A behaviour with its states.
pub(super) fn behaviour(pair: Pair<'_>) -> Parsed<Behaviour> {
    let mut states = Vec::new();
    state(&mut Reader::new(pair), None, &mut states)?;
    let name = states.first().map(|root| root.name.clone());
    Ok(Behaviour { name: name.ok_or_else(|| internal(pair.span()))?, span: pair.span(), states })
}

/// A monitor, or the use of one.
pub(super) fn monitor(reader: &mut Reader<'_>) -> Parsed<Monitor> {
    let (name, given) = (reader.name()?, arguments(reader)?);
    let used = if reader.has(Rule::application) { Some(step(reader.take(Rule::application)?)?) } else { None };
    let mut monitor =
        Monitor { name, arguments: given, memory: Vec::new(), body: Vec::new(), events: Vec::new(), used };
    while let Some(pair) = reader.rest() {
        match pair.as_rule() {
            Rule::memory => monitor.memory.push(variable(&mut Reader::new(pair))?),
            Rule::event => monitor.events.push(law(&mut Reader::new(pair))?),
            _ => monitor.body.push(statement(pair)?),
        }
    }
    Ok(monitor)
}

fn connection(reader: &mut Reader<'_>) -> Parsed<Connection> {
    let exit = reader.name()?;
    let names =
        if reader.has(Rule::received) { Reader::new(reader.take(Rule::received)?).names()? } else { Vec::new() };
    Ok(Connection { exit, names, target: target(reader.take(Rule::target)?)? })
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
    let is_exit = reader.has(Rule::leave);
    if is_exit {
        reader.next()?;
    }
    let resume = if reader.has(Rule::kw_resume) { Some(reader.next()?.span()) } else { None };
    let name = reader.name()?;
    if reader.has(Rule::text_argument) {
        let text = text(&mut Reader::new(reader.take(Rule::text_argument)?))?;
        return Ok(Target { is_exit, resume, outer: Vec::new(), name, text: Some(text), values: Vec::new(), span });
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
    Ok(Target { is_exit, resume, outer, name, text: None, values, span })
}
