//! Simplification of witnesses and their representation as text.

use crate::builtins::{Member, MemberSource, members};
use crate::types::Type;
use vibrissa_runtime::machine::{Program, Senses as _, compute};
use vibrissa_runtime::math;
use vibrissa_runtime::units::{Dimension, format_si, parse_quantity};

use super::model::Model;
use super::point::{Point, Reading, plainest};
use super::search::{Accept, Goal, Search};
use super::unknown::{Domain, Unknown};

/// The number of bisections in the search for the simplest valid value.
const BISECTION_LIMIT: usize = 60;

impl Search<'_> {
    /// A witness as text: `r0.touching = true, r0.base_angle = 950 urad`. Its values are as simple as possible for the
    /// goals, and exactly those shown.
    pub(super) fn describe(&mut self, goals: &[Goal<'_>], point: Point) -> String {
        self.describe_such(goals, point, None)
    }

    /// The same for a witness that `accept` must accept, if it is given.
    pub(super) fn describe_such(&mut self, goals: &[Goal<'_>], point: Point, accept: Option<&Accept<'_>>) -> String {
        let point = self.plainer(goals, point, accept);
        let (model, program) = (self.model, self.model.program);
        // Only the inputs of the conditions that hold matter, in the order in which they are read.
        let mut senses = point.clone();
        let mut registers = self.registers(&point);
        for wanted in goals.iter().flat_map(|goal| &goal.any).filter(|wanted| wanted.truth) {
            if self.meets(&[Goal::holds(wanted.condition)], &point) {
                compute(&program.code, wanted.condition.code, &mut registers, &mut senses);
            }
        }
        let named = named_values(model, &point);
        let readings = senses.readings().into_iter().filter_map(|reading| reading_text(program, &senses, reading));
        let words: Vec<String> = named.into_iter().chain(readings).collect();
        if words.is_empty() { "any time".to_owned() } else { words.join(", ") }
    }

    /// The point with simplified values that still meet the goals.
    fn plainer(&mut self, goals: &[Goal<'_>], mut point: Point, accept: Option<&Accept<'_>>) -> Point {
        // Twice, because one value may become simplifiable only after another.
        for (unknown, _) in [point.values(), point.values()].concat() {
            let value = point.value(unknown);
            let domain = match unknown {
                Unknown::Register(register) => self.model.domain(register),
                _ => Some(Domain::possible(unknown)),
            };
            let Some(domain) = domain else { continue };
            let plain = plainest(self.model, unknown, &domain);
            let dimension = dimension(self.model, unknown);
            let mut meets = |value: f64| {
                let mut moved = point.clone();
                moved.set(unknown, value);
                !self.is_exhausted() && self.meets(goals, &moved) && self.accepts(&moved, accept)
            };
            let Domain::Range(range) = domain else {
                if meets(plain) {
                    point.set(unknown, plain);
                }
                continue;
            };
            let mut best = if meets(plain) { plain } else { value };
            let mut worse = plain;
            for _ in 0..BISECTION_LIMIT {
                let between = best + (worse - best) / 2.0;
                if meets(between) { best = between } else { worse = between }
            }
            let mut rounded = (1..=6).flat_map(|digits| round(best, dimension, digits));
            let shown = rounded.find(|&value| (range.low..=range.high).contains(&value) && meets(value));
            let value = shown.unwrap_or(best);
            point.set(unknown, value);
        }
        point
    }
}

/// The numbers next to `value` with so many digits in a suitable unit, the nearest first.
fn round(value: f64, dimension: Dimension, digits: i32) -> Vec<f64> {
    let Ok(quantity) = parse_quantity(&format_si(value, dimension)) else { return Vec::new() };
    let scale = |number: f64| quantity.unit.map_or(number, |unit| unit.to_si(number));
    let number = quantity.unit.map_or(value, |unit| unit.from_si(value));
    if number == 0.0 {
        return vec![0.0];
    }
    #[expect(clippy::cast_possible_truncation, reason = "the magnitude of a finite number is small")]
    let step = math::powi(10.0, math::log10(number.abs()).floor() as i32 + 1 - digits);
    let steps = (number / step).round();
    [steps, steps - 1.0, steps + 1.0]
        .into_iter()
        .filter_map(|steps| {
            // Through the text, so that the tested value is the displayed one.
            let text = format_si(scale(steps * step), dimension);
            parse_quantity(&text).ok().map(|shown| shown.value_si)
        })
        .collect()
}

fn dimension(model: &Model<'_>, unknown: Unknown) -> Dimension {
    let r#type = match unknown {
        Unknown::Register(register) => model.named(register).map(|named| named.r#type),
        Unknown::Time => Some(Type::TIME),
        Unknown::Deflection(_) | Unknown::Tangent(_) | Unknown::Normal(_) => Some(Type::ANGLE),
        Unknown::Body(quantity) => member(MemberSource::Body(quantity)).map(|(_, member)| member.r#type),
        Unknown::Whisker(_, quantity) => member(MemberSource::Scalar(quantity)).map(|(_, member)| member.r#type),
        Unknown::BodyPosition(_) => Some(Type::LENGTH),
        Unknown::WhiskerVector(_, quantity, _) => {
            member(MemberSource::Vector(quantity)).map(|(_, member)| member.r#type)
        }
        Unknown::Contact(_) | Unknown::Contour(_) => None,
    };
    match r#type {
        Some(Type::Scalar(dimension)) => dimension,
        Some(r#type) => r#type.components().unwrap_or(Dimension::NUMBER),
        None => Dimension::NUMBER,
    }
}

/// The member that reads `source`, and the text before its name.
fn member(source: MemberSource) -> Option<(&'static str, Member)> {
    [(Type::Whisker, ""), (Type::Contour, "contour."), (Type::Body, "body.")].into_iter().find_map(|(owner, prefix)| {
        members(owner).iter().find(|member| member.source == source).map(|&member| (prefix, member))
    })
}

/// The values of arguments, and of parameters that differ from the policy's.
fn named_values(model: &Model<'_>, point: &Point) -> Vec<String> {
    let mut words = Vec::new();
    for (unknown, value) in point.values() {
        let Unknown::Register(register) = unknown else { continue };
        let parameter = model.program.parameters.get(usize::from(register));
        #[expect(clippy::float_cmp, reason = "a parameter that was left alone is exactly as it was")]
        let as_given = parameter.is_some_and(|parameter| parameter.default == value);
        let Some(named) = model.named(register) else { continue };
        if as_given {
            continue;
        }
        let choice = (0_u32..).zip(named.choices).find(|(number, _)| (f64::from(*number) - value).abs() < 0.5);
        let shown = match named.r#type {
            _ if let Some((_, choice)) = choice => choice.clone(),
            Type::Whisker | Type::Contour => index_name(model.program, value).to_owned(),
            r#type if r#type.components().is_some() => {
                let part = |register| point.value(Unknown::Register(register));
                show(named.r#type, [part(named.first), part(named.first + 1)])
            }
            r#type => show(r#type, [value, 0.0]),
        };
        let word = format!("{} = {shown}", named.name);
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words
}

fn index_name(program: &Program, index: f64) -> &str {
    let count = program.whiskers.len() + program.contours.len();
    let known = (0..count).find(|&known| (known as f64 - index).abs() < 0.5);
    known.and_then(|index| program.contour_name(index)).unwrap_or("?")
}

/// A number as text that can be read back exactly. It has a suitable unit if the digits suffice.
fn exact(value: f64, dimension: Dimension) -> String {
    let text = format_si(value, dimension);
    #[expect(clippy::float_cmp, reason = "it is to be the very same number")]
    let is_exact = parse_quantity(&text).is_ok_and(|read| read.value_si == value);
    if is_exact { text } else { format!("{value:?} {}", dimension.si_unit()).trim_end().to_owned() }
}

/// A value as text: both components of a vector, and otherwise the first number.
fn show(r#type: Type, [x, y]: [f64; 2]) -> String {
    match r#type {
        Type::Scalar(dimension) => exact(x, dimension),
        r#type => match r#type.components() {
            Some(dimension) => {
                let function = if r#type == Type::Position { "position" } else { "vector" };
                format!("{function}({}, {})", exact(x, dimension), exact(y, dimension))
            }
            None => (x > 0.5).to_string(),
        },
    }
}

/// A reading as text. `None` if it is NaN.
fn reading_text(program: &Program, point: &Point, reading: Reading) -> Option<String> {
    let (whisker, source, value) = match reading {
        Reading::Time => return Some(format!("time = {}", show(Type::TIME, [point.time(), 0.0]))),
        Reading::Body(quantity) => (None, MemberSource::Body(quantity), [point.body(quantity), 0.0]),
        Reading::BodyPosition => (None, MemberSource::BodyPosition, point.body_position().into()),
        Reading::Whisker(whisker, quantity) => {
            (Some(whisker), MemberSource::Scalar(quantity), [point.whisker(whisker, quantity), 0.0])
        }
        Reading::WhiskerVector(whisker, quantity) => {
            (Some(whisker), MemberSource::Vector(quantity), point.whisker_vector(whisker, quantity).into())
        }
    };
    let owner = whisker.map_or(String::new(), |whisker| format!("{}.", index_name(program, whisker as f64)));
    let (prefix, member) = member(source)?;
    // A contour of positions belongs to no whisker.
    let prefix = if whisker.is_some_and(|index| index >= program.whiskers.len()) { "" } else { prefix };
    let is_number = value.iter().all(|part| part.is_finite());
    is_number.then(|| format!("{owner}{prefix}{} = {}", member.name, show(member.r#type, value)))
}
