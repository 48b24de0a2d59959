//! From pest's pairs to the syntax tree.
//!
//! The grammar fixes which pairs follow which, so that this file only takes them in order. Where the grammar promises a pair
//! and none comes, [`Reader`] gives an internal error instead of a panic.

mod state;
mod test;

use crate::diagnostic::{Diagnostic, Source, Span};

use super::ast::{
    Argument, Binary, Bound, Derived, Expression, File, From, Guard, Kind, Law, Name, Parameter, Quantity, Statement,
    Steer, Transition, Turn, TypeName, Use,
};
use super::grammar::{self, Rule};
use super::pair::{Pair, Pairs, place};
use state::{state, target};
use test::test;

/// Expressions may nest this deep, so that walking the tree cannot exhaust the stack.
const DEPTH_LIMIT: usize = 200;

type Parsed<T> = Result<T, Box<Diagnostic>>;

/// Parses the text of one file. Its places count from `start`.
pub(super) fn parse(source: &Source, start: usize) -> Parsed<File> {
    let pairs = grammar::parse(source).map_err(|diagnostic| Box::new(diagnostic.moved(start)))?;
    let mut file = File {
        name: Name { text: String::new(), span: Span::new(start, start) },
        is_library: false,
        uses: Vec::new(),
        whiskers: Vec::new(),
        parameters: Vec::new(),
        initial: Vec::new(),
        derived: Vec::new(),
        laws: Vec::new(),
        states: Vec::new(),
        always: Vec::new(),
        tests: Vec::new(),
        failsafes: Vec::new(),
    };
    for item in Pairs::new(pairs, start).flat_map(Pair::into_inner) {
        let rule = item.as_rule();
        let mut reader = Reader::new(item);
        match rule {
            Rule::machine => file.name = reader.name()?,
            Rule::library => (file.name, file.is_library) = (reader.name()?, true),
            Rule::import => file.uses.push(import(&mut reader)?),
            Rule::whiskers => {
                reader.take(Rule::kw_whisker)?;
                file.whiskers.extend(reader.names()?);
            }
            Rule::parameter => file.parameters.push(parameter(&mut reader)?),
            Rule::initial => file.initial.push(reader.name()?),
            Rule::derived => file.derived.push(Derived {
                name: reader.name()?,
                arguments: arguments(&mut reader)?,
                value: reader.expression()?,
            }),
            Rule::law => file.laws.push(Law {
                name: reader.name()?,
                arguments: arguments(&mut reader)?,
                body: block(reader.take(Rule::block)?)?,
            }),
            Rule::state => state(&mut reader, None, &mut file.states)?,
            Rule::always => file.always.push(transition(reader.take(Rule::when)?)?),
            Rule::test => file.tests.push(test(&mut reader)?),
            Rule::failsafe => file.failsafes.push(target(reader.take(Rule::target)?)?),
            _ => {}
        }
    }
    Ok(file)
}

fn import(reader: &mut Reader<'_>) -> Parsed<Use> {
    let from = reader.next()?;
    let span = place(&from);
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

fn parameter(reader: &mut Reader<'_>) -> Parsed<Parameter> {
    let name = reader.name()?;
    let value = bound(reader.take(Rule::bound)?)?;
    let range = if reader.has(Rule::bound) {
        Some((bound(reader.take(Rule::bound)?)?, bound(reader.take(Rule::bound)?)?))
    } else {
        None
    };
    Ok(Parameter { name, value, range })
}

fn bound(pair: Pair<'_>) -> Parsed<Bound> {
    let span = place(&pair);
    let mut reader = Reader::new(pair);
    let negative = reader.has(Rule::minus);
    if negative {
        reader.take(Rule::minus)?;
    }
    Ok(Bound { negative, quantity: quantity(reader.take(Rule::quantity)?)?, span })
}

fn quantity(pair: Pair<'_>) -> Parsed<Quantity> {
    let span = place(&pair);
    let mut reader = Reader::new(pair);
    let number = reader.take(Rule::number)?.as_str().to_owned();
    let unit = if reader.has(Rule::unit) { Some(named(&reader.take(Rule::unit)?)) } else { None };
    Ok(Quantity { number, unit, span })
}

fn arguments(reader: &mut Reader<'_>) -> Parsed<Vec<Argument>> {
    if !reader.has(Rule::arguments) {
        return Ok(Vec::new());
    }
    let mut list = Reader::new(reader.take(Rule::arguments)?);
    let mut arguments = Vec::new();
    while list.has(Rule::argument) {
        let mut argument = Reader::new(list.take(Rule::argument)?);
        let name = argument.name()?;
        let mut type_name = Reader::new(argument.take(Rule::type_name)?);
        let base = named(&type_name.next()?);
        let of = if type_name.has(Rule::name) { Some(type_name.name()?) } else { None };
        let mut factors = Vec::new();
        while let Some((operator, _)) = type_name.peek().and_then(binary) {
            type_name.next()?;
            factors.push((operator, type_name.name()?));
        }
        arguments.push(Argument { name, type_name: TypeName { base, of, factors } });
    }
    Ok(arguments)
}

/// What stands between two quotes.
fn text(reader: &mut Reader<'_>) -> Parsed<Name> {
    let mut text = Reader::new(reader.take(Rule::text)?);
    Ok(named(&text.take(Rule::text_inner)?))
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
    while let Ok(pair) = reader.next() {
        statements.push(statement(pair)?);
    }
    Ok(statements)
}

fn statement(pair: Pair<'_>) -> Parsed<Statement> {
    let rule = pair.as_rule();
    let span = place(&pair);
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
        Rule::record => Statement::Record(reader.expression()?),
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

/// Binds tighter than every operator.
const PREFIX_POWER: u8 = 6;

fn binary(rule: Rule) -> Option<(Binary, u8)> {
    Some(match rule {
        Rule::kw_or => (Binary::Or, 1),
        Rule::kw_and => (Binary::And, 2),
        Rule::less => (Binary::Less, 3),
        Rule::less_or_equal => (Binary::LessOrEqual, 3),
        Rule::greater => (Binary::Greater, 3),
        Rule::greater_or_equal => (Binary::GreaterOrEqual, 3),
        Rule::equal => (Binary::Equal, 3),
        Rule::unequal => (Binary::Unequal, 3),
        Rule::plus => (Binary::Add, 4),
        Rule::minus => (Binary::Subtract, 4),
        Rule::times => (Binary::Multiply, 5),
        Rule::over => (Binary::Divide, 5),
        _ => return None,
    })
}

/// Precedence climbing over the flat list of operands and operators that the grammar gives.
fn climb(reader: &mut Reader<'_>, least: u8) -> Parsed<Expression> {
    let mut left = operand(reader)?;
    while let Some((operator, power)) = reader.peek().and_then(binary) {
        if power < least {
            break;
        }
        reader.next()?;
        let right = climb(reader, power + 1)?;
        let span = left.span.to(right.span);
        let depth = left.depth.max(right.depth);
        left = node(Kind::Binary { operator, left: Box::new(left), right: Box::new(right) }, span, depth)?;
    }
    Ok(left)
}

fn operand(reader: &mut Reader<'_>) -> Parsed<Expression> {
    let pair = reader.next()?;
    let span = place(&pair);
    match pair.as_rule() {
        Rule::minus => {
            let inner = climb(reader, PREFIX_POWER)?;
            let (span, depth) = (span.to(inner.span), inner.depth);
            node(Kind::Negate(Box::new(inner)), span, depth)
        }
        Rule::kw_not => {
            // `not` takes a whole comparison: `not a < b` is `not (a < b)`.
            let inner = climb(reader, 3)?;
            let (span, depth) = (span.to(inner.span), inner.depth);
            node(Kind::Not(Box::new(inner)), span, depth)
        }
        Rule::norm => {
            let inner = Reader::new(pair).expression()?;
            let depth = inner.depth;
            node(Kind::Norm(Box::new(inner)), span, depth)
        }
        Rule::group => Reader::new(pair).expression().map(|inner| Expression { span, ..inner }),
        Rule::truth => node(Kind::Truth(pair.as_str() == "true"), span, 0),
        Rule::quantity => node(Kind::Quantity(quantity(pair)?), span, 0),
        Rule::access => access(pair),
        _ => Err(internal(span)),
    }
}

fn access(pair: Pair<'_>) -> Parsed<Expression> {
    let mut reader = Reader::new(pair);
    let mut parts = Reader::new(reader.take(Rule::root)?);
    let span = parts.span;
    let name = named(&parts.next()?);
    let values = parts.values()?;
    let depth = deepest(values.as_deref());
    let mut expression = node(Kind::Root { name, values }, span, depth)?;
    while reader.has(Rule::member) {
        let mut parts = Reader::new(reader.take(Rule::member)?);
        let span = expression.span.to(parts.span);
        let name = parts.name()?;
        let values = parts.values()?;
        let depth = expression.depth.max(deepest(values.as_deref()));
        expression = node(Kind::Member { owner: Box::new(expression), name, values }, span, depth)?;
    }
    Ok(expression)
}

fn deepest(values: Option<&[Expression]>) -> usize {
    values.into_iter().flatten().map(|value| value.depth).max().unwrap_or(0)
}

/// A node above others of which the deepest has `depth` levels.
fn node(kind: Kind, span: Span, depth: usize) -> Parsed<Expression> {
    if depth >= DEPTH_LIMIT {
        let message = format!("the expression nests more than {DEPTH_LIMIT} deep");
        return Err(Box::new(
            Diagnostic::error("P0104", message, span, "too many parts").hint("name parts of it with `let`"),
        ));
    }
    Ok(Expression { kind, span, depth: depth + 1 })
}

fn named(pair: &Pair<'_>) -> Name {
    Name { text: pair.as_str().to_owned(), span: place(pair) }
}

fn internal(span: Span) -> Box<Diagnostic> {
    let message = "the grammar and its reader disagree; this is a fault of the compiler";
    Box::new(Diagnostic::error("P0199", message, span, "here").hint("please report the policy that shows it"))
}

/// The inner pairs of a pair, taken in order.
struct Reader<'i> {
    pairs: Pairs<'i>,
    span: Span,
}

impl<'i> Reader<'i> {
    fn new(pair: Pair<'i>) -> Self {
        let span = place(&pair);
        let mut pairs = pair.into_inner();
        // Words and signs that only mark a place carry nothing.
        while pairs.peek().is_some_and(is_marker) {
            pairs.next();
        }
        Self { pairs, span }
    }

    fn peek(&self) -> Option<Rule> {
        self.pairs.peek()
    }

    fn has(&self, rule: Rule) -> bool {
        self.peek() == Some(rule)
    }

    fn next(&mut self) -> Parsed<Pair<'i>> {
        let pair = self.pairs.next().ok_or_else(|| internal(self.span))?;
        while self.pairs.peek().is_some_and(is_marker) {
            self.pairs.next();
        }
        Ok(pair)
    }

    fn take(&mut self, rule: Rule) -> Parsed<Pair<'i>> {
        let pair = self.next()?;
        if pair.as_rule() == rule { Ok(pair) } else { Err(internal(place(&pair))) }
    }

    fn name(&mut self) -> Parsed<Name> {
        Ok(named(&self.take(Rule::name)?))
    }

    /// All names that come next.
    fn names(&mut self) -> Parsed<Vec<Name>> {
        let mut names = Vec::new();
        while self.has(Rule::name) {
            names.push(self.name()?);
        }
        Ok(names)
    }

    fn expression(&mut self) -> Parsed<Expression> {
        climb(&mut Reader::new(self.take(Rule::expression)?), 0)
    }

    fn values(&mut self) -> Parsed<Option<Vec<Expression>>> {
        if self.has(Rule::values) { values(self.next()?).map(Some) } else { Ok(None) }
    }
}

fn values(pair: Pair<'_>) -> Parsed<Vec<Expression>> {
    let mut reader = Reader::new(pair);
    let mut values = Vec::new();
    while reader.has(Rule::expression) {
        values.push(reader.expression()?);
    }
    Ok(values)
}

/// Whether a pair is a word or a sign that only marks a place.
fn is_marker(rule: Rule) -> bool {
    matches!(
        rule,
        Rule::kw_machine
            | Rule::kw_library
            | Rule::kw_use
            | Rule::kw_param
            | Rule::kw_initial
            | Rule::kw_let
            | Rule::kw_law
            | Rule::kw_state
            | Rule::kw_always
            | Rule::kw_failsafe
            | Rule::kw_when
            | Rule::kw_after
            | Rule::kw_for
            | Rule::kw_in
            | Rule::kw_of
            | Rule::kw_if
            | Rule::kw_else
            | Rule::kw_do
            | Rule::kw_record
            | Rule::kw_mark
            | Rule::kw_steer
            | Rule::kw_along
            | Rule::kw_at
            | Rule::kw_facing
            | Rule::kw_turning
            | Rule::kw_hold
            | Rule::kw_stop
            | Rule::kw_var
            | Rule::kw_set
            | Rule::kw_entry
            | Rule::kw_exit
            | Rule::kw_test
            | Rule::kw_expect
            | Rule::open
            | Rule::close
            | Rule::open_brace
            | Rule::close_brace
            | Rule::bar
            | Rule::comma
            | Rule::colon
            | Rule::dot
            | Rule::dots
            | Rule::equals
            | Rule::arrow
            | Rule::EOI
    )
}
