//! Programs as texts.

use std::fmt::Write;

use super::statement::block;
use super::tree::{
    Arguments, Contract, Derived, Expression, Guard, LIST_LENGTH, Law, Monitor, Program, Rule, Target, Type, default,
};

impl std::fmt::Debug for Program {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text())
    }
}

impl Type {
    fn name(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Length => "length",
            Self::Angle => "angle",
            Self::Time => "time",
            Self::Speed => "speed",
            Self::Rate => "angular_speed",
            Self::Frequency => "number / time",
            Self::Truth => "bool",
            Self::Vector => "vector",
            Self::Direction => "direction",
            Self::Shift => "vector of length",
            Self::Place => "position",
            Self::Whisker => "whisker",
            Self::Contour => "contour",
            Self::Choice => "E",
            Self::Record => "R",
            Self::List => "L",
        }
    }
}

impl Program {
    /// The program as a policy.
    pub(crate) fn text(&self) -> String {
        let mut text = self.head("S0");
        self.write_own(&mut text);
        for Rule { guard, target } in &self.always {
            writeln!(text, "always {} -> {}", guard.text(), target.text()).unwrap();
        }
        text
    }

    /// The program, but for its rules that hold always, as a policy with one state around all others, which has the machine's memory.
    pub(crate) fn wrapped(&self) -> String {
        let mut text = self.head("Whole");
        text.push_str("state Whole {\ninitial S0\n");
        self.write_own(&mut text);
        text + "}\n"
    }

    /// What is written before states and memory.
    fn head(&self, initial: &str) -> String {
        let whiskers: Vec<String> = (0..self.whiskers).map(|whisker| format!("w{whisker}")).collect();
        let mut text = format!("machine m\nwhisker {}\ninitial {initial}\n", whiskers.join(", "));
        text.push_str("type E = e0 or e1 or e2\ntype R(n: number, p: position, b: bool)\n");
        writeln!(text, "type L = list of {LIST_LENGTH} position").unwrap();
        for contour in 0..self.contours {
            writeln!(text, "contour c{contour} of {} points 2 mm apart", 3 + contour).unwrap();
        }
        for (name, value) in &self.parameters {
            writeln!(text, "param {name} = {}", value.text()).unwrap();
        }
        for Derived { name, arguments, value, .. } in &self.derived {
            writeln!(text, "let {name}{} = {}", self::arguments(arguments), value.text()).unwrap();
        }
        for Law { name, arguments, body, .. } in &self.laws {
            let typed: Vec<String> = typed(arguments);
            writeln!(text, "law {name}({}) {{\n{}}}", typed.join(", "), block(body)).unwrap();
        }
        for (index, Monitor { arguments, values, memory, body, event }) in self.monitors.iter().enumerate() {
            let name = if arguments.is_empty() { format!("M{index}") } else { format!("T{index}") };
            let memory = memory.iter().map(|(name, _, value)| format!("var {name} = {}\n", value.text()));
            let memory = memory.collect::<String>();
            let event = format!("on e{} {{\n{}}}\n", self::arguments(&event.0), block(&event.1));
            writeln!(text, "monitor {name}{} {{\n{memory}{event}{}}}", self::arguments(arguments), block(body))
                .unwrap();
            if !arguments.is_empty() {
                writeln!(text, "monitor M{index} is {}", call(&name, values)).unwrap();
            }
        }
        text
    }

    /// What the machine remembers and does, its states, and its failsafe.
    fn write_own(&self, text: &mut String) {
        for (name, _, value) in &self.memory {
            writeln!(text, "var {name} = {}", value.text()).unwrap();
        }
        text.push_str(&block(&self.body));
        for contract in &self.contracts {
            writeln!(text, "{}", contract.text()).unwrap();
        }
        self.write_inside(None, text);
        if let Some(target) = &self.failsafe {
            writeln!(text, "failsafe -> {}", target.text()).unwrap();
        }
    }

    fn write_inside(&self, parent: Option<usize>, text: &mut String) {
        for (index, state) in self.states.iter().enumerate().filter(|(_, state)| state.parent == parent) {
            writeln!(text, "state S{index}{} {{", arguments(&state.arguments)).unwrap();
            if let Some((initial, values)) = &state.initial {
                writeln!(text, "initial {}", call(&format!("S{initial}"), values)).unwrap();
            }
            for (name, _, value) in &state.memory {
                writeln!(text, "var {name} = {}", value.text()).unwrap();
            }
            writeln!(
                text,
                "entry {{\n{}}}\n{}exit {{\n{}}}",
                block(&state.entry),
                block(&state.body),
                block(&state.exit)
            )
            .unwrap();
            for Rule { guard, target } in &state.rules {
                writeln!(text, "{} -> {}", guard.text(), target.text()).unwrap();
            }
            for contract in &state.contracts {
                writeln!(text, "{}", contract.text()).unwrap();
            }
            if let Some(target) = &state.failsafe {
                writeln!(text, "failsafe -> {}", target.text()).unwrap();
            }
            self.write_inside(Some(index), text);
            text.push_str("}\n");
        }
    }
}

impl Contract {
    pub(crate) fn text(&self) -> String {
        match self {
            Self::Assume(condition) => format!("assume {}", condition.text()),
            Self::Never(condition, None) => format!("never {}", condition.text()),
            Self::Never(condition, Some(time)) => format!("never {} for {}", condition.text(), time.text()),
            Self::Always(condition, time) => format!("always {} within {}", condition.text(), time.text()),
        }
    }
}

fn typed(arguments: &Arguments) -> Vec<String> {
    let typed = |(name, r#type): &(String, Type)| {
        let default = default(name, *r#type).map_or_else(String::new, |default| format!(" = {}", default.text()));
        format!("{name}: {}{default}", r#type.name())
    };
    arguments.iter().map(typed).collect()
}

/// Arguments with their parentheses, which are left out if there are none.
fn arguments(arguments: &Arguments) -> String {
    if arguments.is_empty() { String::new() } else { format!("({})", typed(arguments).join(", ")) }
}

pub(super) fn list(values: &[Expression]) -> String {
    // Those with names come last, in any order.
    let (named, mut in_order): (Vec<_>, Vec<_>) = values
        .iter()
        .filter(|value| !matches!(value, Expression::Omitted(_)))
        .partition(|value| matches!(value, Expression::Named(..)));
    in_order.extend(named.into_iter().rev());
    in_order.into_iter().map(Expression::text).collect::<Vec<_>>().join(", ")
}

pub(super) fn call(name: &str, values: &[Expression]) -> String {
    let list = list(values);
    if name == "L" {
        return "L()".to_owned();
    }
    if list.is_empty() { name.to_owned() } else { format!("{name}({list})") }
}

impl Guard {
    fn text(&self) -> String {
        match self {
            Self::When(condition) => format!("when {}", condition.text()),
            Self::WhenFor(condition, time) => format!("when {} for {}", condition.text(), time.text()),
            Self::After(time) => format!("after {}", time.text()),
        }
    }
}

impl Target {
    fn text(&self) -> String {
        match self {
            Self::Failure(reason) => format!("Failure(\"{reason}\")"),
            Self::Success(reason) => format!("Success(\"{reason}\")"),
            Self::State { way, resume } => {
                let steps: Vec<String> = way.iter().map(|(state, values)| call(&format!("S{state}"), values)).collect();
                format!("{}{}", if *resume { "resume " } else { "" }, steps.join("."))
            }
        }
    }
}

const OR: u8 = 1;
const AND: u8 = 2;
const COMPARE: u8 = 3;
const SUM: u8 = 4;
const PRODUCT: u8 = 5;
const PREFIX: u8 = 6;
const ATOM: u8 = 7;

impl Expression {
    /// How tightly it binds.
    fn power(&self) -> u8 {
        match self {
            Self::If(_) => 0,
            Self::Binary("or", ..) => OR,
            Self::Binary("and", ..) | Self::Not(_) => AND,
            Self::Binary("+" | "-", ..) => SUM,
            Self::Binary("*" | "/", ..) => PRODUCT,
            Self::Binary(..) => COMPARE,
            Self::Negate(_) => PREFIX,
            _ => ATOM,
        }
    }

    /// The text, in parentheses if it binds less than `least`.
    fn at(&self, least: u8) -> String {
        if self.power() < least { format!("({})", self.text()) } else { self.text() }
    }

    pub(crate) fn text(&self) -> String {
        match self {
            Self::Quantity(number, "") => (*number).to_owned(),
            Self::Quantity(number, unit) => format!("{number} {unit}"),
            Self::Truth(truth) => truth.to_string(),
            Self::Choice(number) => format!("E.e{number}"),
            Self::Name(name) => name.clone(),
            Self::Call(name, values, _) => call(name, values),
            Self::Body(member) => format!("body.{member}"),
            Self::Map(member, values) if values.is_empty() => format!("map.{member}"),
            Self::Map(member, values) => format!("map.{}", call(member, values)),
            Self::Member(owner, member, values) => call(&format!("{}.{member}", owner.at(ATOM)), values),
            Self::Named(name, value) => format!("{name}: {}", value.text()),
            Self::Omitted(_) => String::new(),
            Self::Norm(inner) => format!("|{}|", inner.text()),
            Self::Negate(inner) => format!("-{}", inner.at(ATOM)),
            Self::Not(inner) => format!("not {}", inner.at(COMPARE)),
            Self::If(parts) => {
                let [condition, value, otherwise] = &**parts;
                format!("if {} then {} else {}", condition.at(OR), value.at(OR), otherwise.text())
            }
            Self::Binary(sign, left, right) => {
                format!("{} {sign} {}", left.at(self.power()), right.at(self.power() + 1))
            }
        }
    }
}
