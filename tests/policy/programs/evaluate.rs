//! Expressions and statements, interpreted over their trees, with names looked up as they are met.

use vibrissa_runtime::geometry::{Vector2, rotate, wrap};
use vibrissa_runtime::machine::{
    Action, BodyScalar, ContourVector, MapQuestion, MapScalar, MapVector, Mark, Mover, Senses, Turn, WhiskerScalar,
    WhiskerVector,
};
use vibrissa_runtime::math;

use super::arithmetic::{binary, greater, lesser, part, unit_in_si};
use super::interpreter::Interpreter;
use super::statement::{Statement, Steer, plot_name};
use super::tree::{Arguments, Derived, Expression, LIST_LENGTH, Law, Monitor};

#[derive(Debug, Clone, Copy)]
pub(crate) enum Value {
    Number(f64),
    Truth(bool),
    Vector(Vector2),
    /// A whisker, or its contour.
    Whisker(usize),
    /// The number of a value of the enumeration.
    Choice(usize),
    Record(f64, Vector2, bool),
    /// The positions, from the newest on. Those behind the count are not known.
    List(usize, [Vector2; LIST_LENGTH]),
}

impl Value {
    pub(crate) fn number(self) -> f64 {
        if let Self::Number(number) = self { number } else { panic!("{self:?} is no number") }
    }

    pub(crate) fn truth(self) -> bool {
        if let Self::Truth(truth) = self { truth } else { panic!("{self:?} is no truth") }
    }

    pub(crate) fn vector(self) -> Vector2 {
        if let Self::Vector(vector) = self { vector } else { panic!("{self:?} is no vector") }
    }

    /// Its numbers as text, all bits of them.
    fn numbers(self) -> String {
        match self {
            Self::Number(number) => numbers_text(&[number]),
            Self::Truth(truth) => numbers_text(&[f64::from(u8::from(truth))]),
            Self::Vector(vector) => numbers_text(&[vector.x, vector.y]),
            Self::Whisker(index) | Self::Choice(index) => numbers_text(&[index as f64]),
            Self::Record(..) | Self::List(..) => panic!("{self:?} is not shown"),
        }
    }

    fn whisker(self) -> usize {
        if let Self::Whisker(whisker) = self { whisker } else { panic!("{self:?} is no whisker") }
    }
}

/// Numbers as text, all bits of them.
pub(crate) fn numbers_text(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" ")
}

/// Where something is evaluated.
pub(crate) struct Place {
    /// The state whose arguments and memory are known, with those of the states around it.
    sees: Option<usize>,
    /// The state in which it stands, be it by way of laws and derived values.
    stands_in: Option<usize>,
    /// The uses of laws and derived values that lead here.
    uses: Vec<usize>,
    locals: Vec<(String, Value)>,
    /// Names of memory, and of what was named after it since it was last set.
    copies: Vec<(String, String)>,
    /// What it is part of, to count.
    pub(crate) part: &'static str,
}

impl Place {
    pub(crate) fn new(state: Option<usize>, part: &'static str) -> Self {
        Self { sees: state, stands_in: state, uses: Vec::new(), locals: Vec::new(), copies: Vec::new(), part }
    }

    /// A monitor. What it begins with is computed apart from what it does later.
    pub(crate) fn of_monitor(begins: bool, arguments: &Arguments, values: Vec<Value>) -> Self {
        let mut place = Self::new(None, "a monitor");
        place.uses.extend(begins.then_some(usize::MAX));
        place.locals = arguments.iter().map(|(name, _)| name.clone()).zip(values).collect();
        place
    }
}

impl Interpreter<'_> {
    pub(crate) fn values(&mut self, values: &[Expression], place: &mut Place) -> Vec<Value> {
        values.iter().map(|value| self.value(value, place)).collect()
    }

    pub(crate) fn value(&mut self, expression: &Expression, place: &mut Place) -> Value {
        match expression {
            Expression::Quantity(number, unit) => {
                let (factor, divisor) = unit_in_si(unit);
                self.seen(
                    "a unit with a factor",
                    (!unit.is_empty() && unit_in_si(unit) != (1.0, 1.0)).then_some(place.part),
                );
                Value::Number(number.parse::<f64>().unwrap() * factor / divisor)
            }
            Expression::Truth(truth) => Value::Truth(*truth),
            Expression::Choice(number) => {
                self.seen("a value of an enumeration", Some(place.part));
                Value::Choice(*number)
            }
            Expression::Name(name) => self.named(name, place),
            Expression::Call(name, values, site) => {
                let values = self.values(values, place);
                let derived = self.program.derived.iter().find(|derived| derived.name == *name);
                match derived {
                    Some(Derived { arguments, value, .. }) => {
                        self.seen(
                            if values.is_empty() { "a derived value" } else { "one with arguments" },
                            Some(place.part),
                        );
                        let mut inside = inside(place, *site, arguments, values, "a derived value");
                        self.value(value, &mut inside)
                    }
                    None => self.function(name, &values, *site, place),
                }
            }
            Expression::Body("yaw") => Value::Number(self.senses.body(BodyScalar::Yaw)),
            Expression::Body("blocked") => Value::Truth(self.senses.body(BodyScalar::Blocked) > 0.5),
            Expression::Body("length") => Value::Number(self.senses.body(BodyScalar::Length)),
            Expression::Body("width") => Value::Number(self.senses.body(BodyScalar::Width)),
            Expression::Body("nose_width") => Value::Number(self.senses.body(BodyScalar::NoseWidth)),
            Expression::Body("tail_width") => Value::Number(self.senses.body(BodyScalar::TailWidth)),
            Expression::Body(end @ ("nose" | "tail")) => {
                let [reach, length, yaw] =
                    [BodyScalar::NoseReach, BodyScalar::Length, BodyScalar::Yaw].map(|part| self.senses.body(part));
                let reach = if *end == "nose" { reach } else { reach - length };
                let ahead = Vector2::new(math::cos(yaw), math::sin(yaw));
                Value::Vector(self.senses.body_position() + ahead * reach)
            }
            Expression::Body("shortfall") => Value::Number(self.senses.body(BodyScalar::Shortfall)),
            Expression::Body(_) => Value::Vector(self.senses.body_position()),
            Expression::Map(member, values) => {
                self.seen("the map", Some(place.part));
                let values = self.values(values, place);
                self.of_map(member, &values)
            }
            Expression::Member(owner, part @ ("x" | "y"), _) => {
                self.seen("a component", Some(place.part));
                let vector = self.value(owner, place).vector();
                Value::Number(if *part == "x" { vector.x } else { vector.y })
            }
            Expression::Member(owner, member, values) => {
                let owner = self.value(owner, place);
                let values = self.values(values, place);
                if let Some(value) = part(owner, member, &values) {
                    self.seen("a member of a record or a list", Some(place.part));
                    return value;
                }
                let whisker = owner.whisker();
                self.seen("a closed loop", (*member == "loop_closed").then_some(place.part));
                self.member(whisker, member, &values.iter().map(|value| value.number()).collect::<Vec<_>>())
            }
            Expression::Named(_, value) => {
                self.seen("a named value", Some(place.part));
                self.value(value, place)
            }
            Expression::Omitted(value) => {
                self.seen("a default", Some(place.part));
                self.value(value, &mut Place::new(None, "a default"))
            }
            Expression::Norm(inner) => Value::Number(match self.value(inner, place) {
                Value::Vector(vector) => vector.norm(),
                other => other.number().abs(),
            }),
            Expression::Negate(inner) => match self.value(inner, place) {
                Value::Vector(vector) => Value::Vector(-vector),
                other => Value::Number(-other.number()),
            },
            Expression::Not(inner) => Value::Truth(!self.value(inner, place).truth()),
            // All parts are computed, whatever the condition is: filters in them see every tick.
            Expression::If(parts) => {
                self.seen("a choice", Some(place.part));
                let [condition, value, otherwise] = [0, 1, 2].map(|part| self.value(&parts[part], place));
                if condition.truth() { value } else { otherwise }
            }
            // Both sides are computed, whatever the first is: filters in the second see every tick.
            Expression::Binary(sign, left, right) => binary(sign, self.value(left, place), self.value(right, place)),
        }
    }

    fn named(&mut self, name: &str, place: &Place) -> Value {
        if let Some((_, value)) = place.locals.iter().rev().find(|(known, _)| known == name) {
            return *value;
        }
        let around = place.sees.map_or_else(Vec::new, |state| self.program.way(state));
        let mut kept = around.iter().rev().filter_map(|&state| self.kept[state].get(name)).copied();
        if let Some(value) = kept.next() {
            let hides = kept.next().is_some() || self.own.contains_key(name);
            self.seen("what hides another", hides.then_some(place.part));
            return value;
        }
        self.seen("what a monitor remembers", name.starts_with('M').then_some(place.part));
        if let Some(value) = self.own.get(name.rsplit('.').next().unwrap()) {
            return *value;
        }
        if let Some((_, value)) = self.program.parameters.iter().find(|(known, _)| known == name) {
            self.seen("a parameter", Some(place.part));
            return self.value(value, &mut Place::new(None, "a parameter"));
        }
        let number = |prefix| name.strip_prefix(prefix).and_then(|number: &str| number.parse::<usize>().ok());
        // The contours follow those of the whiskers.
        let contour = || number('c').map(|contour| self.program.whiskers + contour);
        Value::Whisker(number('w').or_else(contour).unwrap())
    }

    fn member(&self, whisker: usize, member: &str, values: &[f64]) -> Value {
        let scalar = |quantity| Value::Number(self.senses.whisker(whisker, quantity));
        let truth = |quantity| Value::Truth(self.senses.whisker(whisker, quantity) > 0.5);
        let vector = |quantity| Value::Vector(self.senses.whisker_vector(whisker, quantity));
        let behind = |quantity| Value::Vector(self.senses.contour_at(whisker, values[0], quantity));
        match member {
            "base_angle" => scalar(WhiskerScalar::BaseAngle),
            "touching" => truth(WhiskerScalar::Touching),
            "yaw" => scalar(WhiskerScalar::Yaw),
            "side" => scalar(WhiskerScalar::Side),
            "sense" => scalar(WhiskerScalar::Sense),
            "length" => scalar(WhiskerScalar::Length),
            "tip_deviation" => scalar(WhiskerScalar::TipDeviation),
            "base_angle_deviation" => scalar(WhiskerScalar::BaseAngleDeviation),
            "recorded_deviation" => scalar(WhiskerScalar::RecordedDeviation),
            "loop_closed" => Value::Truth(self.senses.loop_closed(whisker, values[0], values[1])),
            "ready" => truth(WhiskerScalar::ContourReady),
            "tip" => vector(WhiskerVector::Tip),
            "tip_base" => vector(WhiskerVector::TipBase),
            "base" => vector(WhiskerVector::Base),
            "end" => vector(WhiskerVector::ContourEnd),
            "tip_at" => Value::Vector(self.senses.tip_at(whisker, values[0])),
            "point" => behind(ContourVector::Point),
            "tangent" if !values.is_empty() => behind(ContourVector::Tangent),
            "normal" if !values.is_empty() => behind(ContourVector::Normal),
            "tangent" => vector(WhiskerVector::ContourTangent),
            "normal" => vector(WhiskerVector::ContourNormal),
            _ => Value::Whisker(whisker),
        }
    }

    fn function(&mut self, name: &str, values: &[Value], site: usize, place: &mut Place) -> Value {
        let number = |index: usize| values[index].number();
        Value::Number(match name {
            "time" => self.senses.time(),
            "state_time" => {
                self.seen("time in a state", Some(place.part));
                self.senses.time() - self.entered_at[place.sees.unwrap()]
            }
            "previous" | "peak" | "settled" | "path_length" => {
                let now = self.senses.time();
                let which = place.uses.iter().copied().chain([site]).collect();
                let signal = self.signals.entry((place.stands_in, which)).or_default();
                let (what, output) = match name {
                    "previous" => ("previous", signal.previous(now, values[0])),
                    "peak" => ("peak", Value::Number(signal.peak(number(0)))),
                    "settled" => ("settled", Value::Truth(signal.settled(now, number(0), number(1), number(2)))),
                    _ => ("path_length", Value::Number(signal.path_length(values[0].vector()))),
                };
                self.seen(what, Some(place.part));
                return output;
            }
            "abs" => number(0).abs(),
            "sign" if number(0) == 0.0 => 0.0,
            "sign" => number(0).signum(),
            "sqrt" => number(0).sqrt(),
            "exp" => math::exp(number(0)),
            "floor" => number(0).floor(),
            "sin" => math::sin(number(0)),
            "cos" => math::cos(number(0)),
            "min" => lesser(number(0), number(1)),
            "max" => greater(number(0), number(1)),
            "clamp" => lesser(greater(number(0), number(1)), number(2)),
            "wrap" => wrap(number(0)),
            "turn" => wrap(number(1) - number(0)),
            "angle" => math::atan2(values[0].vector().y, values[0].vector().x),
            "dot" => values[0].vector().dot(&values[1].vector()),
            "cross" => values[0].vector().perp(&values[1].vector()),
            "direction" => return Value::Vector(Vector2::new(math::cos(number(0)), math::sin(number(0)))),
            "R" => return Value::Record(number(0), values[1].vector(), values[2].truth()),
            "L" => return Value::List(0, [Vector2::new(f64::NAN, f64::NAN); LIST_LENGTH]),
            "vector" | "position" => return Value::Vector(Vector2::new(number(0), number(1))),
            "rotate" => return Value::Vector(rotate(values[0].vector(), number(1))),
            "unit" => {
                let (vector, length) = (values[0].vector(), values[0].vector().norm());
                return Value::Vector(if length == 0.0 { Vector2::zeros() } else { vector / length });
            }
            _ => {
                let now = self.senses.time();
                let which = place.uses.iter().copied().chain([site]).collect();
                let filter = self.filters.entry((place.stands_in, which)).or_default();
                let (what, output) = match name {
                    "lowpass" => ("lowpass", filter.low_pass(now, number(0), number(1))),
                    _ => ("pid", filter.pid(now, number(0), [1, 2, 3, 4].map(number))),
                };
                self.seen(what, Some(place.part));
                output
            }
        })
    }

    /// Runs statements; the last command that they give, if any.
    pub(crate) fn run(&mut self, statements: &[Statement], place: &mut Place) -> Option<Action> {
        let (known, mut command) = (place.locals.len(), None);
        for statement in statements {
            command = self.statement(statement, place).or(command);
        }
        place.locals.truncate(known);
        command
    }

    fn statement(&mut self, statement: &Statement, place: &mut Place) -> Option<Action> {
        match statement {
            Statement::Let(name, value) => {
                if let Expression::Name(memory) = value {
                    place.copies.push((memory.clone(), name.clone()));
                }
                let value = self.value(value, place);
                place.locals.push((name.clone(), value));
                self.seen("let", Some(place.part));
            }
            Statement::Set(name, value) => {
                let value = self.value(value, place);
                let around = place.sees.map_or_else(Vec::new, |state| self.program.way(state));
                let owner = around.into_iter().rev().find(|&state| self.kept[state].contains_key(name));
                owner.map_or(&mut self.own, |owner| &mut self.kept[owner]).insert(name.clone(), value);
                let was_copied = place.copies.iter().any(|(memory, _)| memory == name);
                self.seen("set of what was named before", was_copied.then_some(place.part));
                self.seen("set of the machine's memory", owner.is_none().then_some(place.part));
                let is_outer = owner.is_some() && owner != place.sees;
                self.seen("set of an outer state's memory", is_outer.then_some(place.part));
                self.seen("set", Some(place.part));
            }
            Statement::If(branches, otherwise) => {
                let part = std::mem::replace(&mut place.part, "an if");
                let taken = branches.iter().find(|(condition, _)| self.value(condition, place).truth());
                let command = self.run(taken.map_or(otherwise, |(_, then)| then), place);
                place.part = part;
                self.seen("if", Some(part));
                return command;
            }
            Statement::Do(law, values, site) => {
                let values = self.values(values, place);
                let Law { arguments, body, .. } = self.program.laws.iter().find(|known| known.name == *law).unwrap();
                self.seen("do", Some(place.part));
                return self.run(body, &mut inside(place, *site, arguments, values, "a law"));
            }
            Statement::Tell(monitor, values, site) => {
                let told = self.values(values, place);
                let Monitor { arguments, values, event, .. } = &self.program.monitors[*monitor];
                let mut inside = inside(place, *site, &Vec::new(), Vec::new(), "an event");
                let values = self.values(values, &mut inside);
                let names = arguments.iter().chain(&event.0).map(|(name, _)| name.clone());
                inside.locals = names.zip(values.into_iter().chain(told)).collect();
                self.seen("tell", Some(place.part));
                self.run(&event.1, &mut inside);
            }
            Statement::Record(whisker) => {
                let whisker = self.value(whisker, place).whisker();
                self.senses.record(whisker);
                self.seen("record", Some(place.part));
            }
            Statement::RecordPosition(position, contour) => {
                let position = self.value(position, place).vector();
                self.senses.record_position(*contour, position);
                self.seen("record in a contour", Some(place.part));
            }
            Statement::TellMap(event, values) => {
                let values = self.values(values, place);
                match (*event, values.as_slice()) {
                    ("go_to", [position, heading]) => self.senses.go_to(position.vector(), heading.number()),
                    ("felt", [position, normal]) => self.senses.felt(position.vector(), normal.vector()),
                    _ => self.senses.give_up(),
                }
                self.seen("tell map", Some(place.part));
            }
            Statement::Plot(of, value) => {
                let value = self.value(value, place);
                self.plotted.insert(plot_name(*of), value.numbers());
                self.seen("plot", Some(place.part));
            }
            Statement::Log(message, values) => {
                let values = self.values(values, place);
                let key = (place.stands_in, place.uses.iter().copied().chain([*message]).collect::<Vec<_>>());
                // Within a tick, a statement shows only what it did last.
                self.logged.retain(|(known, ..)| *known != key);
                let shown = values.into_iter().map(Value::numbers).collect::<Vec<_>>().join(" ");
                self.logged.push((key, format!("m{message}"), shown));
                self.seen("log", Some(place.part));
            }
            Statement::Mark(mark, whisker) => {
                let whisker = self.value(whisker, place).whisker();
                self.senses.mark(whisker, if *mark == "lost" { Mark::Lost } else { Mark::Found });
                self.seen("mark", Some(place.part));
            }
            Statement::Steer(steer) => return Some(self.steer(steer, place)),
            Statement::Hold => {
                self.seen("hold", Some(place.part));
                return Some(Action::Hold);
            }
            Statement::Stop => {
                self.seen("stop", Some(place.part));
                return Some(Action::Stop);
            }
        }
        None
    }

    /// A member of the map.
    fn of_map(&self, member: &str, values: &[Value]) -> Value {
        let holds = |question, heading| {
            let position = values.first().map(|position| position.vector());
            Value::Truth(position.is_some_and(|position| self.senses.map_holds(question, position, heading)))
        };
        let number = |quantity| Value::Number(self.senses.map(quantity));
        let truth = |quantity| Value::Truth(self.senses.map(quantity) > 0.5);
        let vector = |quantity| Value::Vector(self.senses.map_vector(quantity));
        match member {
            "free" => holds(MapQuestion::IsFree, 0.0),
            "traced" => holds(MapQuestion::IsTraced, 0.0),
            "clear" => holds(MapQuestion::IsClear, values[1].number()),
            "complete" => truth(MapScalar::IsComplete),
            "next.exists" => truth(MapScalar::HasNext),
            "next.on_surface" => truth(MapScalar::NextIsSurface),
            "next.side" => number(MapScalar::NextSide),
            "next.heading" => number(MapScalar::NextHeading),
            "next.place" => vector(MapVector::NextPlace),
            "next.position" => vector(MapVector::NextPosition),
            "next.normal" => vector(MapVector::NextNormal),
            "route.arrived" => truth(MapScalar::RouteIsDone),
            "route.lost" => truth(MapScalar::RouteIsLost),
            "route.speed" => number(MapScalar::RouteSpeed),
            "route.yaw_rate" => number(MapScalar::RouteYawRate),
            _ => vector(MapVector::RouteDirection),
        }
    }

    fn steer(&mut self, steer: &Steer, place: &mut Place) -> Action {
        let Steer { whisker, along, speed, facing, turn } = steer;
        let whisker = whisker.as_ref().map(|whisker| self.value(whisker, place).whisker());
        let (along_world, speed) = (self.value(along, place).vector(), self.value(speed, place).number());
        let turn = self.value(turn, place).number();
        let is = ["steer body turning", "steer body facing", "steer w turning", "steer w facing"];
        self.seen(is[2 * usize::from(whisker.is_some()) + usize::from(*facing)], Some(place.part));
        let mover = whisker.map_or(Mover::Body, Mover::Whisker);
        Action::Steer { mover, along_world, speed, turn: if *facing { Turn::Facing(turn) } else { Turn::Rate(turn) } }
    }
}

/// The place within a law or a derived value: it knows its arguments alone, and stands where it is used.
fn inside(place: &Place, site: usize, arguments: &Arguments, values: Vec<Value>, part: &'static str) -> Place {
    let uses = place.uses.iter().copied().chain([site]).collect();
    let locals = arguments.iter().map(|(name, _)| name.clone()).zip(values).collect();
    Place { uses, locals, stands_in: place.stands_in, ..Place::new(None, part) }
}
