//! From pairs of the grammar to the syntax tree.
//!
//! The grammar determines the order of the pairs, so this module only reads them in order. If a promised pair is
//! missing, [`Reader`] returns an internal error instead of a panic.

mod contract;
mod expression;
mod reader;
mod state;
mod test;

use std::borrow::Cow;

use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

use super::ast::{
    Argument, Bound, Compound, Content, Contour, Derived, Enumeration, File, FileKind, From, Guard, Keypoints, Law,
    Name, Need, Parameter, Quantity, Setting, Statement, Steer, Transition, Turn, TypeName, Use,
};
use super::grammar::{self, Rule};
use super::parse_tree::{Pair, Pairs};
use contract::contract;
use expression::{binary, choice, climb, named_value};
use reader::{Reader, values};
use state::{behaviour, monitor, state, target, variable};
use test::{property, test};

type Parsed<T> = Result<T, Box<Diagnostic>>;

/// Parses the text of one file. Its spans count from `start`.
pub(super) fn parse(source: &Source, start: usize) -> Parsed<File> {
    let found = grammar::matches(source).map_err(|diagnostic| Box::new(diagnostic.moved(start)))?;
    let mut file = File {
        name: Name { text: String::new(), span: Span::new(start, start) },
        kind: FileKind::Machine,
        is_standard: matches!(found, Cow::Borrowed(_)),
        uses: Vec::new(),
        whiskers: Vec::new(),
        tip_models: Vec::new(),
        optional: Vec::new(),
        needs: Vec::new(),
        keypoints: Vec::new(),
        contours: Vec::new(),
        enumerations: Vec::new(),
        compounds: Vec::new(),
        parameters: Vec::new(),
        initial: Vec::new(),
        derived: Vec::new(),
        laws: Vec::new(),
        states: Vec::new(),
        behaviours: Vec::new(),
        monitors: Vec::new(),
        memory: Vec::new(),
        acts: None,
        body: Vec::new(),
        always: Vec::new(),
        tests: Vec::new(),
        failsafes: Vec::new(),
        contracts: Vec::new(),
    };
    for item in Pairs::new(&found, &source.text, start).flat_map(Pair::into_inner) {
        let rule = item.as_rule();
        let mut reader = Reader::new(item);
        match rule {
            Rule::machine => file.name = reader.name()?,
            Rule::library => (file.name, file.kind) = (reader.name()?, FileKind::Library),
            Rule::tested => {
                let path = text(&mut reader)?;
                let from = From::Path(path.text.clone());
                file.uses.push(Use { from, span: path.span, names: Some(Vec::new()) });
                (file.name, file.kind) = (path, FileKind::Tests);
            }
            Rule::import => file.uses.push(import(&mut reader)?),
            Rule::whiskers => {
                reader.take(Rule::kw_whisker)?;
                file.whiskers.extend(reader.names()?);
                let model =
                    if reader.has(Rule::model) { Some(Reader::new(reader.take(Rule::model)?).name()?) } else { None };
                file.tip_models.resize(file.whiskers.len(), model);
                let is_optional = reader.has(Rule::optional);
                if is_optional {
                    fitted(reader.take(Rule::optional)?)?;
                }
                file.optional.resize(file.whiskers.len(), is_optional);
            }
            Rule::needs => file.needs.push(Need {
                name: reader.name()?,
                low: bound(reader.take(Rule::bound)?)?,
                high: bound(reader.take(Rule::bound)?)?,
            }),
            Rule::contour if reader.has(Rule::keypoints) => {
                file.keypoints.push(keypoints(reader.take(Rule::keypoints)?)?);
            }
            Rule::contour => {
                let name = reader.name()?;
                let given = reader.has(Rule::keypoints);
                let keypoints = if given { Some(keypoints(reader.take(Rule::keypoints)?)?) } else { None };
                file.contours.push(Contour { name, keypoints });
            }
            Rule::parameter => file.parameters.push(parameter(&mut reader)?),
            Rule::enumeration => file.enumerations.push(enumeration(&mut reader)?),
            Rule::record_type | Rule::list_type => file.compounds.push(compound(&mut reader, rule)?),
            Rule::initial => file.initial.push(reader.name()?),
            Rule::derived => file.derived.push(Derived {
                name: reader.name()?,
                arguments: arguments(&mut reader)?,
                value: reader.expression()?,
            }),
            Rule::law => file.laws.push(law(&mut reader)?),
            Rule::state => state(&mut reader, None, &mut file.states)?,
            Rule::monitor => file.monitors.push(monitor(&mut reader)?),
            Rule::behaviour => file.behaviours.push(behaviour(item)?),
            Rule::always => file.always.push(transition(reader.take(Rule::when)?)?),
            Rule::test => file.tests.push(test(&mut reader)?),
            Rule::property => file.tests.push(property(&mut reader)?),
            Rule::failsafe => file.failsafes.push(target(reader.take(Rule::target)?)?),
            Rule::memory => file.memory.push(variable(&mut reader)?),
            Rule::assume | Rule::never | Rule::recurring => file.contracts.push(contract(item)?),
            _ => {
                file.acts.get_or_insert(item.span());
                file.body.push(statement(item)?);
            }
        }
    }
    Ok(file)
}

fn import(reader: &mut Reader<'_>) -> Parsed<Use> {
    let from = reader.next()?;
    let span = from.span();
    let is_text = from.as_rule() == Rule::text;
    let mut parts = Reader::new(from);
    let from = if is_text {
        From::Path(parts.take(Rule::text_inner)?.as_str().to_owned())
    } else {
        From::Module(parts.names()?)
    };
    let names = if reader.has(Rule::chosen) { Some(Reader::new(reader.take(Rule::chosen)?).names()?) } else { None };
    Ok(Use { from, span, names })
}

/// Refuses any word other than `fitted` after the `if` of whiskers.
fn fitted(optional: Pair<'_>) -> Parsed<()> {
    let word = Reader::new(optional).next()?;
    if word.as_rule() == Rule::cw_fitted {
        return Ok(());
    }
    let message = format!("`{}` is unexpected here", word.as_str());
    // The `if` may be the beginning of a statement.
    Err(Box::new(Diagnostic::error("P0101", message, word.span(), "expected `fitted`, or `{` after this")))
}

fn parameter(reader: &mut Reader<'_>) -> Parsed<Parameter> {
    let name = reader.name()?;
    let value = setting(reader)?;
    let range = if reader.has(Rule::bound) {
        Some((bound(reader.take(Rule::bound)?)?, bound(reader.take(Rule::bound)?)?))
    } else {
        None
    };
    Ok(Parameter { name, value, range })
}

/// The value of a parameter.
fn setting(reader: &mut Reader<'_>) -> Parsed<Setting> {
    if reader.has(Rule::bound) {
        return Ok(Setting::Number(bound(reader.take(Rule::bound)?)?));
    }
    let mut value = Reader::new(reader.take(Rule::chosen_value)?);
    if value.has(Rule::bool) {
        let truth = value.next()?;
        return Ok(Setting::Bool(truth.as_str() == "true", truth.span()));
    }
    Ok(Setting::Choice(value.name()?, value.name()?))
}

fn enumeration(reader: &mut Reader<'_>) -> Parsed<Enumeration> {
    let (name, mut values) = (reader.name()?, vec![reader.name()?]);
    while reader.has(Rule::kw_or) {
        reader.next()?;
        values.push(reader.name()?);
    }
    Ok(Enumeration { name, values })
}

/// A record or a list.
fn compound(reader: &mut Reader<'_>, rule: Rule) -> Parsed<Compound> {
    let name = reader.name()?;
    if rule == Rule::list_type {
        let most = named(reader.take(Rule::number)?);
        return Ok(Compound {
            name,
            content: Content::List { most, element: type_name(reader.take(Rule::type_name)?)? },
        });
    }
    let mut fields = Vec::new();
    while reader.has(Rule::argument) {
        fields.push(argument(reader.next()?)?);
    }
    Ok(Compound { name, content: Content::Record(fields) })
}

fn keypoints(pair: Pair<'_>) -> Parsed<Keypoints> {
    let span = pair.span();
    let mut reader = Reader::new(pair);
    Ok(Keypoints { count: named(reader.take(Rule::number)?), spacing: bound(reader.take(Rule::bound)?)?, span })
}

fn bound(pair: Pair<'_>) -> Parsed<Bound> {
    let span = pair.span();
    let mut reader = Reader::new(pair);
    let negative = reader.has(Rule::minus);
    if negative {
        reader.take(Rule::minus)?;
    }
    Ok(Bound { negative, quantity: quantity(reader.take(Rule::quantity)?)?, span })
}

fn quantity(pair: Pair<'_>) -> Parsed<Quantity> {
    let span = pair.span();
    let mut reader = Reader::new(pair);
    let number = reader.take(Rule::number)?.as_str().to_owned();
    let unit = if reader.has(Rule::unit) { Some(named(reader.take(Rule::unit)?)) } else { None };
    Ok(Quantity { number, unit, span })
}

fn arguments(reader: &mut Reader<'_>) -> Parsed<Vec<Argument>> {
    if !reader.has(Rule::arguments) {
        return Ok(Vec::new());
    }
    let mut list = Reader::new(reader.take(Rule::arguments)?);
    let mut arguments = Vec::new();
    while list.has(Rule::argument) {
        arguments.push(argument(list.next()?)?);
    }
    Ok(arguments)
}

/// An argument, or a field of a record.
fn argument(pair: Pair<'_>) -> Parsed<Argument> {
    let mut reader = Reader::new(pair);
    let (name, type_name) = (reader.name()?, type_name(reader.take(Rule::type_name)?)?);
    let default = if reader.has(Rule::expression) { Some(reader.expression()?) } else { None };
    Ok(Argument { name, type_name, default })
}

fn type_name(pair: Pair<'_>) -> Parsed<TypeName> {
    let mut reader = Reader::new(pair);
    let base = named(reader.next()?);
    let of = if reader.has(Rule::name) { Some(reader.name()?) } else { None };
    let mut factors = Vec::new();
    while let Some((operator, _)) = reader.peek().map(Pair::as_str).and_then(binary) {
        reader.next()?;
        factors.push((operator, reader.name()?));
    }
    Ok(TypeName { base, of, factors })
}

/// The content of a string.
fn text(reader: &mut Reader<'_>) -> Parsed<Name> {
    let mut text = Reader::new(reader.take(Rule::text)?);
    Ok(named(text.take(Rule::text_inner)?))
}

fn transition(pair: Pair<'_>) -> Parsed<Transition> {
    let rule = pair.as_rule();
    let mut reader = Reader::new(pair);
    let first = reader.expression()?;
    let guard = match rule {
        Rule::after => Guard::After(first),
        _ if reader.has(Rule::expression) => Guard::When { condition: first, lasting: Some(reader.expression()?) },
        _ => Guard::When { condition: first, lasting: None },
    };
    Ok(Transition { guard, target: target(reader.take(Rule::target)?)? })
}

fn block(pair: Pair<'_>) -> Parsed<Vec<Statement>> {
    let mut reader = Reader::new(pair);
    let mut statements = Vec::new();
    while let Some(pair) = reader.rest() {
        statements.push(statement(pair)?);
    }
    Ok(statements)
}

fn statement(pair: Pair<'_>) -> Parsed<Statement> {
    let rule = pair.as_rule();
    let span = pair.span();
    let mut reader = Reader::new(pair);
    Ok(match rule {
        Rule::binding => Statement::Let { name: reader.name()?, value: reader.expression()? },
        Rule::assign => Statement::Set { name: reader.name()?, value: reader.expression()? },
        Rule::conditional => {
            let mut branches = Vec::new();
            while reader.has(Rule::expression) {
                branches.push((reader.expression()?, block(reader.take(Rule::block)?)?));
            }
            let otherwise = if reader.has(Rule::block) { block(reader.take(Rule::block)?)? } else { Vec::new() };
            Statement::If { branches, otherwise }
        }
        Rule::apply => Statement::Do { law: reader.name()?, values: reader.values()?.unwrap_or_default(), span },
        Rule::record => {
            let recorded = reader.expression()?;
            if reader.has(Rule::name) {
                Statement::RecordPosition { position: recorded, contour: reader.name()? }
            } else {
                Statement::Record(recorded)
            }
        }
        Rule::tell => Statement::Tell {
            monitor: reader.name()?,
            event: reader.name()?,
            values: reader.values()?.unwrap_or_default(),
            span,
        },
        Rule::plot => Statement::Plot { name: reader.name()?, value: reader.expression()? },
        Rule::log => {
            let text = text(&mut reader)?;
            let mut values = Vec::new();
            while reader.has(Rule::expression) {
                values.push(reader.expression()?);
            }
            Statement::Log { text, values, span }
        }
        Rule::mark => Statement::Mark { name: reader.name()?, whisker: reader.expression()? },
        Rule::steer => {
            let mut mover = Reader::new(reader.take(Rule::mover)?);
            let whisker = if mover.has(Rule::expression) { Some(mover.expression()?) } else { None };
            let (along, speed) = (reader.expression()?, reader.expression()?);
            let turn = if reader.has(Rule::facing) {
                Turn::Facing(Reader::new(reader.take(Rule::facing)?).expression()?)
            } else {
                Turn::Turning(Reader::new(reader.take(Rule::turning)?).expression()?)
            };
            Statement::Steer(Box::new(Steer { whisker, along, speed, turn, span }))
        }
        Rule::hold => Statement::Hold(span),
        Rule::stop => Statement::Stop(span),
        _ => return Err(internal(span)),
    })
}

/// A law, or an event of a monitor.
fn law(reader: &mut Reader<'_>) -> Parsed<Law> {
    Ok(Law { name: reader.name()?, arguments: arguments(reader)?, body: block(reader.take(Rule::block)?)? })
}

fn named(pair: Pair<'_>) -> Name {
    Name { text: pair.as_str().to_owned(), span: pair.span() }
}

fn internal(span: Span) -> Box<Diagnostic> {
    let message = "the compiler does not handle this syntax; this is a fault of the program";
    Box::new(Diagnostic::error("P0199", message, span, "here").hint("please report it with the policy"))
}
