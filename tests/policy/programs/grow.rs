//! Random expressions of a given type, grown from bytes that say at every point what comes next.

use super::tree::{Arguments, Expression, Program, Type, default};

/// A name that is known where something grows.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    pub(crate) name: String,
    pub(crate) r#type: Type,
    /// Whether it can be `set`.
    pub(crate) is_memory: bool,
}

/// Every part of a program grows from bytes of its own, so that a shorter part leaves the others what they are. A part whose bytes
/// are used up grows in the simplest way.
pub(crate) struct Grower<'g> {
    parts: std::slice::Iter<'g, Vec<u8>>,
    bytes: std::slice::Iter<'g, u8>,
    pub(crate) program: Program,
    pub(crate) scope: Vec<Known>,
    /// Names that a state gives, and that mean nothing while what they begin with is grown.
    pub(crate) hidden: Vec<String>,
    /// Whether a part of a state grows, which knows its time.
    pub(crate) in_state: bool,
    sites: usize,
}

const NUMBERS: [&str; 10] = ["1", "0.5", "2", "0.1", "3.7", "0", "10", "0.25", "0.013", "1e2"];

/// The units of a type whose values are numbers with one.
fn units(r#type: Type) -> &'static [&'static str] {
    match r#type {
        Type::Length => &["m", "mm", "cm", "um"],
        Type::Angle => &["rad", "deg", "mrad", "urad"],
        Type::Time => &["s", "ms", "us"],
        Type::Speed => &["m/s", "mm/s", "cm/s", "mm/ms"],
        Type::Rate => &["rad/s", "deg/s", "mrad/ms"],
        Type::Frequency => &["Hz", "kHz"],
        _ => &[""],
    }
}

const SCALARS: [Type; 7] =
    [Type::Number, Type::Length, Type::Angle, Type::Time, Type::Speed, Type::Rate, Type::Frequency];

impl<'g> Grower<'g> {
    pub(crate) fn new(parts: &'g [Vec<u8>]) -> Self {
        Self {
            parts: parts.iter(),
            bytes: [].iter(),
            program: Program::default(),
            scope: Vec::new(),
            hidden: Vec::new(),
            in_state: false,
            sites: 0,
        }
    }

    pub(crate) fn next_part(&mut self) {
        self.bytes = self.parts.next().map_or([].iter(), |part| part.iter());
    }

    /// One of `0..all`, and 0 when the bytes are used up.
    pub(crate) fn pick(&mut self, all: usize) -> usize {
        usize::from(self.bytes.next().copied().unwrap_or(0)) % all
    }

    pub(crate) fn one_of<T: Clone>(&mut self, items: &[T]) -> T {
        items[self.pick(items.len())].clone()
    }

    pub(crate) fn site(&mut self) -> usize {
        self.sites += 1;
        self.sites
    }

    pub(crate) fn know(&mut self, name: &str, r#type: Type, is_memory: bool) {
        self.scope.push(Known { name: name.to_owned(), r#type, is_memory });
    }

    /// A name that means nothing yet where something grows; beside it, it may.
    pub(crate) fn fresh_name(&self) -> String {
        format!("x{}", self.scope.len())
    }

    /// Seldom, for an argument or a memory, the name of something around that it may hide, but none of those `taken`.
    pub(crate) fn hiding_name(&mut self, taken: &[String]) -> Option<String> {
        let around = self.scope.iter().map(|known| known.name.clone());
        let machine = (0..3).map(|index| format!("m{index}"));
        let hidable: Vec<String> =
            around.chain(machine).filter(|name| name.starts_with(['x', 'm']) && !taken.contains(name)).collect();
        (self.pick(4) == 3 && !hidable.is_empty()).then(|| self.one_of(&hidable))
    }

    /// The names that are known: of several that are called so the one that came last.
    pub(crate) fn known(&self) -> Vec<Known> {
        let is_hidden = |index: usize, name: &String| {
            self.hidden.contains(name) || self.scope[index + 1..].iter().any(|later| later.name == *name)
        };
        let known = self.scope.iter().enumerate().filter(|(index, known)| !is_hidden(*index, &known.name));
        known.map(|(_, known)| known.clone()).collect()
    }

    pub(crate) fn arguments(&mut self, most: usize) -> Arguments {
        let count = self.pick(most + 1);
        let mut arguments = Arguments::new();
        for _ in 0..count {
            let another = self.one_of(&Type::ALL);
            // Arguments of one type can be taken for one another.
            let same = arguments.last().map(|&(_, r#type)| r#type).filter(|_| self.pick(2) == 1);
            let taken: Vec<String> = arguments.iter().map(|(name, _)| name.clone()).collect();
            let name = self.hiding_name(&taken).unwrap_or_else(|| self.fresh_name());
            let r#type = same.unwrap_or(another);
            self.know(&name, r#type, false);
            arguments.push((name, r#type));
        }
        arguments
    }

    pub(crate) fn values(&mut self, arguments: &Arguments, depth: u8) -> Vec<Expression> {
        // From one of them on, values have names or are left out.
        let first = self.pick(2 * arguments.len() + 1);
        let value = |(index, (name, r#type)): (usize, &(String, Type))| {
            // A direction is a vector.
            let given = if *r#type == Type::Vector && self.pick(2) == 1 { Type::Direction } else { *r#type };
            if index < first {
                return self.expression(given, depth);
            }
            match default(name, *r#type) {
                Some(default) if self.pick(3) > 0 => Expression::Omitted(Box::new(default)),
                _ => Expression::Named(name.clone(), Box::new(self.expression(given, depth))),
            }
        };
        arguments.iter().enumerate().map(value).collect()
    }

    pub(crate) fn quantity(&mut self, r#type: Type) -> Expression {
        Expression::Quantity(self.one_of(&NUMBERS), self.one_of(units(r#type)))
    }

    pub(crate) fn call(&mut self, name: &str, values: Vec<Expression>) -> Expression {
        Expression::Call(name.to_owned(), values, self.site())
    }

    pub(crate) fn expression(&mut self, r#type: Type, depth: u8) -> Expression {
        let names: Vec<String> =
            self.known().into_iter().filter(|known| known.r#type == r#type).map(|known| known.name).collect();
        let derived: Vec<_> = self.program.derived.iter().filter(|derived| derived.r#type == r#type).cloned().collect();
        match self.pick(if depth == 0 { 6 } else { 10 }) {
            0 => self.simple(r#type),
            1..=3 if !names.is_empty() => Expression::Name(self.one_of(&names)),
            4 | 5 if depth > 0 && !derived.is_empty() => {
                let derived = self.one_of(&derived);
                let values = self.values(&derived.arguments, depth - 1);
                self.call(&derived.name, values)
            }
            1..=5 => self.sensed(r#type),
            _ => self.composite(r#type, depth - 1),
        }
    }

    pub(crate) fn simple(&mut self, r#type: Type) -> Expression {
        match r#type {
            Type::Truth => Expression::Truth(self.pick(2) == 0),
            Type::Whisker => Expression::Name(format!("w{}", self.pick(self.program.whiskers))),
            Type::Contour => member(self.simple(Type::Whisker), "contour"),
            Type::Choice => Expression::Choice(self.pick(3)),
            Type::Record => {
                let values = [Type::Number, Type::Place, Type::Truth].map(|r#type| self.simple(r#type));
                self.call("R", values.into())
            }
            Type::List => self.call("L", Vec::new()),
            Type::Vector => {
                let parts = vec![self.quantity(Type::Number), self.quantity(Type::Number)];
                self.call("vector", parts)
            }
            Type::Direction => member(self.simple(Type::Contour), "tangent"),
            Type::Shift => member(self.simple(Type::Whisker), "tip_base"),
            Type::Place => Expression::Body("position"),
            _ => self.quantity(r#type),
        }
    }

    fn of_whisker(&mut self, members: &[&'static str]) -> Expression {
        member(self.expression(Type::Whisker, 0), self.one_of(members))
    }

    /// Something that is felt.
    fn sensed(&mut self, r#type: Type) -> Expression {
        match r#type {
            Type::Number if self.pick(3) == 0 => Expression::Map("next.side", Vec::new()),
            Type::Number => self.of_whisker(&["side", "sense"]),
            Type::Length if self.pick(3) == 0 => {
                Expression::Body(self.one_of(&["length", "width", "nose_width", "tail_width"]))
            }
            Type::Length => self.of_whisker(&["length", "tip_deviation"]),
            Type::Angle if self.pick(3) == 0 => Expression::Body("yaw"),
            Type::Angle if self.pick(3) == 0 => Expression::Map("next.heading", Vec::new()),
            Type::Angle => self.of_whisker(&["base_angle", "yaw", "base_angle_deviation"]),
            Type::Time if self.in_state && self.pick(2) == 0 => self.call("state_time", Vec::new()),
            Type::Time => self.call("time", Vec::new()),
            Type::Truth if self.pick(3) == 0 => member(self.expression(Type::Contour, 0), "ready"),
            Type::Truth if self.pick(3) == 0 => Expression::Body("blocked"),
            Type::Truth if self.pick(3) == 0 => {
                let member =
                    self.one_of(&["complete", "next.exists", "next.on_surface", "route.arrived", "route.lost"]);
                Expression::Map(member, Vec::new())
            }
            Type::Truth if self.pick(3) == 0 => match self.pick(3) {
                0 => Expression::Map("free", vec![self.simple(Type::Place)]),
                1 => Expression::Map("traced", vec![self.simple(Type::Place)]),
                _ => Expression::Map("clear", vec![self.simple(Type::Place), self.quantity(Type::Angle)]),
            },
            Type::Speed if self.pick(2) == 0 => Expression::Map("route.speed", Vec::new()),
            Type::Rate => Expression::Map("route.yaw_rate", Vec::new()),
            Type::Direction if self.pick(3) == 0 => Expression::Map("next.normal", Vec::new()),
            Type::Place if self.pick(3) == 0 => {
                Expression::Map(self.one_of(&["next.place", "next.position"]), Vec::new())
            }
            Type::Vector => Expression::Map("route.direction", Vec::new()),
            Type::Speed => Expression::Body("shortfall"),
            Type::Truth => self.of_whisker(&["touching"]),
            Type::Direction => member(self.expression(Type::Contour, 0), self.one_of(&["tangent", "normal"])),
            Type::Place if self.pick(3) == 0 => member(self.expression(Type::Contour, 0), "end"),
            Type::Place if self.pick(3) == 0 => Expression::Body(self.one_of(&["nose", "tail"])),
            Type::Place => self.of_whisker(&["tip", "base"]),
            Type::Contour => self.of_whisker(&["contour"]),
            Type::Shift | Type::Whisker | Type::Frequency | Type::Choice | Type::Record | Type::List => {
                self.simple(r#type)
            }
        }
    }

    pub(crate) fn composite(&mut self, r#type: Type, depth: u8) -> Expression {
        if self.pick(10) == 9 {
            let parts = [Type::Truth, r#type, r#type].map(|r#type| self.expression(r#type, depth));
            return Expression::If(Box::new(parts));
        }
        match r#type {
            Type::Truth => self.truth(depth),
            Type::Vector | Type::Shift => self.vector(r#type, depth),
            Type::Direction => self.direction(depth),
            Type::Place => self.place(depth),
            Type::Record => self.function("R", &[Type::Number, Type::Place, Type::Truth], depth),
            Type::List => self.at(Type::List, &["with"], Type::Place, depth),
            Type::Whisker | Type::Contour | Type::Choice => self.sensed(r#type),
            _ if self.pick(2) == 0 => self.scalar(r#type, depth),
            _ => self.special(r#type, depth),
        }
    }

    fn binary(&mut self, sign: &'static str, left: Type, right: Type, depth: u8) -> Expression {
        let (left, right) = (self.expression(left, depth), self.expression(right, depth));
        Expression::Binary(sign, Box::new(left), Box::new(right))
    }

    fn function(&mut self, name: &str, types: &[Type], depth: u8) -> Expression {
        let values = types.iter().map(|&r#type| self.expression(r#type, depth)).collect();
        self.call(name, values)
    }

    /// What numbers of every dimension have.
    fn scalar(&mut self, r#type: Type, depth: u8) -> Expression {
        match self.pick(16) {
            0 => self.binary("+", r#type, r#type, depth),
            1 => self.binary("-", r#type, r#type, depth),
            2 => self.binary("*", Type::Number, r#type, depth),
            3 => self.binary("*", r#type, Type::Number, depth),
            4 => self.binary("/", r#type, Type::Number, depth),
            5 => Expression::Negate(Box::new(self.expression(r#type, depth))),
            6 => Expression::Norm(Box::new(self.expression(r#type, depth))),
            7 => self.function("abs", &[r#type], depth),
            8 => self.function("min", &[r#type; 2], depth),
            9 => self.function("max", &[r#type; 2], depth),
            10 => self.function("clamp", &[r#type; 3], depth),
            11 | 12 => {
                let name = self.one_of(&["previous", "peak"]);
                let value = self.filtered(r#type, depth);
                self.call(name, vec![value])
            }
            _ => {
                let values = vec![self.filtered(r#type, depth), self.quantity(Type::Frequency)];
                self.call("lowpass", values)
            }
        }
    }

    /// What a filter is given: what changes, as often as not.
    fn filtered(&mut self, r#type: Type, depth: u8) -> Expression {
        if self.pick(2) == 0 { self.sensed(r#type) } else { self.expression(r#type, depth) }
    }

    /// What numbers of one dimension have.
    fn special(&mut self, r#type: Type, depth: u8) -> Expression {
        match (r#type, self.pick(8)) {
            (Type::Number, 0) => {
                let scalar = self.one_of(&SCALARS);
                self.binary("/", scalar, scalar, depth)
            }
            (Type::Number, 1) => {
                let scalar = self.one_of(&SCALARS);
                self.function("sign", &[scalar], depth)
            }
            (Type::Number, 2) => {
                let name = self.one_of(&["sin", "cos"]);
                self.function(name, &[Type::Angle], depth)
            }
            (Type::Number, 3) => {
                let name = self.one_of(&["sqrt", "exp", "floor"]);
                self.function(name, &[Type::Number], depth)
            }
            (Type::Number, 4) => {
                let name = self.one_of(&["dot", "cross"]);
                let types = [(); 2].map(|()| self.one_of(&[Type::Vector, Type::Direction]));
                self.function(name, &types, depth)
            }
            (Type::Number, 5) => {
                let of = self.one_of(&[Type::Vector, Type::Direction]);
                if self.pick(2) == 0 {
                    self.component(of, depth)
                } else {
                    Expression::Norm(Box::new(self.expression(of, depth)))
                }
            }
            (Type::Number, 6) if self.pick(2) == 0 => member(self.expression(Type::Record, depth), "n"),
            (Type::Number, 6) => member(self.expression(Type::List, depth), "count"),
            (Type::Number, _) => self.pid([Type::Number, Type::Number], "", "Hz", "s", depth),
            (Type::Length, 0..=3) => Expression::Norm(Box::new(self.expression(Type::Shift, depth))),
            (Type::Length, 4) => {
                let of = self.one_of(&[Type::Place, Type::Shift]);
                self.component(of, depth)
            }
            (Type::Length, 5) => {
                let value = self.filtered(Type::Place, depth);
                self.call("path_length", vec![value])
            }
            (Type::Length, _) => self.binary("*", Type::Speed, Type::Time, depth),
            (Type::Angle, 0..=1) => {
                let of = self.one_of(&[Type::Vector, Type::Direction, Type::Shift]);
                self.function("angle", &[of], depth)
            }
            (Type::Angle, 2..=3) => self.function("turn", &[Type::Angle; 2], depth),
            (Type::Angle, 4..=5) => self.function("wrap", &[Type::Angle], depth),
            (Type::Angle, _) => self.binary("*", Type::Rate, Type::Time, depth),
            (Type::Speed, 0..=2) => self.binary("*", Type::Length, Type::Frequency, depth),
            (Type::Speed, 3) => self.binary("/", Type::Length, Type::Time, depth),
            (Type::Speed, _) => self.pid([Type::Length, Type::Speed], "Hz", "Hz^2", "", depth),
            (Type::Rate, 0..=2) => self.binary("*", Type::Angle, Type::Frequency, depth),
            (Type::Rate, 3) => self.binary("/", Type::Angle, Type::Time, depth),
            (Type::Rate, _) => self.pid([Type::Angle, Type::Rate], "Hz", "Hz^2", "", depth),
            (Type::Time, _) => self.binary("/", Type::Length, Type::Speed, depth),
            _ => self.binary("/", Type::Number, Type::Time, depth),
        }
    }

    fn pid(&mut self, types: [Type; 2], p: &'static str, i: &'static str, d: &'static str, depth: u8) -> Expression {
        let error = self.filtered(types[0], depth);
        let mut gain = |unit| Expression::Quantity(self.one_of(&NUMBERS), unit);
        let gains = [gain(p), gain(i), gain(d)];
        let limit = self.expression(types[1], 0);
        let values = std::iter::once(error).chain(gains).chain([limit]).collect();
        self.call("pid", values)
    }

    fn vector(&mut self, r#type: Type, depth: u8) -> Expression {
        let is_shift = r#type == Type::Shift;
        match self.pick(12) {
            11 => self.before(r#type, depth),
            0 => self.binary("+", r#type, r#type, depth),
            1 => self.binary("-", r#type, r#type, depth),
            2 => self.binary("*", Type::Number, r#type, depth),
            3 => self.binary("*", r#type, Type::Number, depth),
            4 => self.binary("/", r#type, Type::Number, depth),
            5 => Expression::Negate(Box::new(self.expression(r#type, depth))),
            6 => self.function("rotate", &[r#type, Type::Angle], depth),
            7 => self.function("vector", &[if is_shift { Type::Length } else { Type::Number }; 2], depth),
            8 if is_shift => self.binary("*", Type::Vector, Type::Length, depth),
            9 if is_shift => self.at(Type::Whisker, &["tip_at"], Type::Angle, depth),
            _ if is_shift => self.binary("-", Type::Place, Type::Place, depth),
            8 => self.binary("+", Type::Direction, Type::Direction, depth),
            9 => self.binary("-", Type::Direction, Type::Vector, depth),
            _ => self.binary("*", Type::Direction, Type::Number, depth),
        }
    }

    fn direction(&mut self, depth: u8) -> Expression {
        match self.pick(6) {
            0 => self.before(Type::Direction, depth),
            1 => Expression::Negate(Box::new(self.expression(Type::Direction, depth))),
            2 => self.function("rotate", &[Type::Direction, Type::Angle], depth),
            3 => self.function("direction", &[Type::Angle], depth),
            4 => {
                let of = self.one_of(&[Type::Vector, Type::Shift, Type::Direction]);
                self.function("unit", &[of], depth)
            }
            _ => self.at(Type::Contour, &["tangent", "normal"], Type::Length, depth),
        }
    }

    fn place(&mut self, depth: u8) -> Expression {
        match self.pick(10) {
            6 => member(self.expression(Type::Record, depth), "p"),
            7 => {
                let name = self.one_of(&["newest", "oldest"]);
                member(self.expression(Type::List, depth), name)
            }
            8 => self.at(Type::List, &["nearest"], Type::Place, depth),
            9 => {
                let index = Expression::Quantity(self.one_of(&["0", "1", "2", "3"]), "");
                Expression::Member(Box::new(self.expression(Type::List, depth)), "element", vec![index])
            }
            0 => self.before(Type::Place, depth),
            1 => self.binary("+", Type::Place, Type::Shift, depth),
            2 => self.binary("+", Type::Shift, Type::Place, depth),
            3 => self.binary("-", Type::Place, Type::Shift, depth),
            4 => self.function("position", &[Type::Length; 2], depth),
            _ => self.at(Type::Contour, &["point"], Type::Length, depth),
        }
    }

    fn before(&mut self, r#type: Type, depth: u8) -> Expression {
        let value = self.filtered(r#type, depth);
        self.call("previous", vec![value])
    }

    fn component(&mut self, of: Type, depth: u8) -> Expression {
        let name = self.one_of(&["x", "y"]);
        Expression::Member(Box::new(self.expression(of, depth)), name, Vec::new())
    }

    /// A time of some ticks.
    fn one_of_times(&mut self) -> Expression {
        Expression::Quantity(self.one_of(&["20", "50", "100"]), "ms")
    }

    fn at(&mut self, owner: Type, members: &[&'static str], value: Type, depth: u8) -> Expression {
        let (owner, value) = (self.expression(owner, depth), self.expression(value, depth));
        Expression::Member(Box::new(owner), self.one_of(members), vec![value])
    }

    fn truth(&mut self, depth: u8) -> Expression {
        match self.pick(11) {
            10 => member(self.expression(Type::Record, depth), "b"),
            9 => {
                let scalar = self.one_of(&SCALARS);
                let within = self.expression(scalar, 0);
                let values = vec![self.filtered(scalar, depth), within, self.one_of_times()];
                self.call("settled", values)
            }
            0..=2 => {
                let (sign, scalar) = (self.one_of(&["<", "<=", ">", ">=", "==", "!="]), self.one_of(&SCALARS));
                self.binary(sign, scalar, scalar, depth)
            }
            3 => {
                let (sign, either) =
                    (self.one_of(&["==", "!="]), self.one_of(&[Type::Whisker, Type::Truth, Type::Choice]));
                self.binary(sign, either, either, depth)
            }
            4 => Expression::Not(Box::new(self.expression(Type::Truth, depth))),
            5 => self.binary("and", Type::Truth, Type::Truth, depth),
            6 => self.binary("or", Type::Truth, Type::Truth, depth),
            7 => {
                let owner = self.expression(Type::Whisker, depth);
                let values = [Type::Length, Type::Time].map(|r#type| self.expression(r#type, depth));
                Expression::Member(Box::new(owner), "loop_closed", values.into())
            }
            // A comparison shows what a filter remembers of a gap, in which a command cannot be given.
            _ => {
                let values = vec![self.sensed(Type::Angle), self.quantity(Type::Frequency)];
                let filtered = self.call("lowpass", values);
                Expression::Binary("<", Box::new(filtered), Box::new(self.sensed(Type::Angle)))
            }
        }
    }
}

fn member(owner: Expression, member: &'static str) -> Expression {
    Expression::Member(Box::new(owner), member, Vec::new())
}
