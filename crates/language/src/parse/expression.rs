//! Expressions.

use crate::ast::{Binary, Expression, Kind};
use crate::grammar::Rule;
use crate::parse_tree::Pair;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::{Parsed, Reader, internal, named, quantity, values};

/// The maximum nesting depth, so that recursion cannot exhaust the stack.
const DEPTH_LIMIT: usize = 200;

/// Precedence of prefix operators, above that of every binary operator.
const PREFIX_POWER: u8 = 6;

/// The operator with this text, and its precedence.
pub(super) fn binary(sign: &str) -> Option<(Binary, u8)> {
    Some(match sign {
        "or" => (Binary::Or, 1),
        "and" => (Binary::And, 2),
        "<" => (Binary::Less, 3),
        "<=" => (Binary::LessOrEqual, 3),
        ">" => (Binary::Greater, 3),
        ">=" => (Binary::GreaterOrEqual, 3),
        "==" => (Binary::Equal, 3),
        "!=" => (Binary::Unequal, 3),
        "+" => (Binary::Add, 4),
        "-" => (Binary::Subtract, 4),
        "*" => (Binary::Multiply, 5),
        "/" => (Binary::Divide, 5),
        _ => return None,
    })
}

/// Precedence climbing over the flat list of operands and operators.
pub(super) fn climb(reader: &mut Reader<'_>, least: u8) -> Parsed<Expression> {
    let mut left = operand(reader)?;
    while let Some((operator, power)) = reader.peek().map(Pair::as_str).and_then(binary) {
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

/// A conditional expression. In a chain of several, each is the last side of the one before.
pub(super) fn choice(pair: Pair<'_>) -> Parsed<Expression> {
    let mut reader = Reader::new(pair);
    let mut branches = Vec::new();
    while reader.has(Rule::branch) {
        branches.push(climb(&mut Reader::new(reader.take(Rule::branch)?), 0)?);
    }
    let end = pair.span();
    let mut otherwise = branches.pop().ok_or_else(|| internal(end))?;
    while let Some(value) = branches.pop() {
        let condition = branches.pop().ok_or_else(|| internal(end))?;
        let span = condition.span.to(otherwise.span);
        let depth = condition.depth.max(value.depth).max(otherwise.depth);
        let [condition, value, last] = [condition, value, otherwise].map(Box::new);
        otherwise = node(Kind::If { condition, value, otherwise: last }, span, depth)?;
    }
    Ok(Expression { span: end, ..otherwise })
}

fn operand(reader: &mut Reader<'_>) -> Parsed<Expression> {
    let pair = reader.next()?;
    let span = pair.span();
    match pair.as_rule() {
        Rule::minus => {
            let inner = climb(reader, PREFIX_POWER)?;
            let (span, depth) = (span.to(inner.span), inner.depth);
            node(Kind::Negate(Box::new(inner)), span, depth)
        }
        Rule::kw_not => {
            // `not` applies to a whole comparison: `not a < b` is `not (a < b)`.
            let inner = climb(reader, 3)?;
            let (span, depth) = (span.to(inner.span), inner.depth);
            node(Kind::Not(Box::new(inner)), span, depth)
        }
        Rule::norm => {
            let inner = Reader::new(pair).expression()?;
            let depth = inner.depth;
            node(Kind::Norm(Box::new(inner)), span, depth)
        }
        Rule::group => {
            let mut reader = Reader::new(pair);
            let inner = reader.expression()?;
            if !reader.has(Rule::member) {
                return Ok(Expression { span, ..inner });
            }
            let span = Span::new(span.start, inner.span.end);
            members(&mut reader, Expression { span, ..inner })
        }
        Rule::bool => node(Kind::Bool(pair.as_str() == "true"), span, 0),
        Rule::quantity => node(Kind::Quantity(quantity(pair)?), span, 0),
        Rule::access => access(pair),
        _ => Err(internal(span)),
    }
}

fn access(pair: Pair<'_>) -> Parsed<Expression> {
    let mut reader = Reader::new(pair);
    let name = named(reader.next()?);
    let mut span = name.span;
    let values = if reader.has(Rule::values) {
        let pair = reader.next()?;
        span = span.to(pair.span());
        Some(values(pair)?)
    } else {
        None
    };
    let depth = deepest(values.as_deref());
    members(&mut reader, node(Kind::Root { name, values }, span, depth)?)
}

/// An expression with the members behind it.
fn members(reader: &mut Reader<'_>, mut expression: Expression) -> Parsed<Expression> {
    while reader.has(Rule::member) {
        let mut parts = Reader::new(reader.take(Rule::member)?);
        let span = expression.span.to(parts.span());
        let name = parts.name()?;
        let values = parts.values()?;
        let depth = expression.depth.max(deepest(values.as_deref()));
        expression = node(Kind::Member { owner: Box::new(expression), name, values }, span, depth)?;
    }
    Ok(expression)
}

/// A value with the name of its argument.
pub(super) fn named_value(pair: Pair<'_>) -> Parsed<Expression> {
    let mut reader = Reader::new(pair);
    let (name, value) = (reader.name()?, reader.expression()?);
    let (span, depth) = (name.span.to(value.span), value.depth);
    node(Kind::Named { name, value: Box::new(value) }, span, depth)
}

fn deepest(values: Option<&[Expression]>) -> usize {
    values.into_iter().flatten().map(|value| value.depth).max().unwrap_or(0)
}

/// A node whose deepest child has `depth` levels.
fn node(kind: Kind, span: Span, depth: usize) -> Parsed<Expression> {
    if depth >= DEPTH_LIMIT {
        let message = format!("the expression nests more than {DEPTH_LIMIT} deep");
        return Err(Box::new(
            Diagnostic::error("P0104", message, span, "too many parts").hint("name parts of it with `let`"),
        ));
    }
    Ok(Expression { kind, span, depth: depth + 1 })
}
