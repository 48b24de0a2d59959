//! Random well-typed programs.

use proptest::prelude::*;

use super::grow::Grower;
use super::statement::{Statement, Steer};
use super::tree::{Arguments, Contract, Derived, Expression, Guard, Law, Monitor, Program, Rule, State, Target, Type};

/// Programs that are well typed; some go round within a tick, which the compiler refuses.
pub(crate) fn programs() -> impl Strategy<Value = Program> {
    prop::collection::vec(prop::collection::vec(any::<u8>(), 0..100), 62)
        .prop_map(|parts| Grower::new(&parts).grow_program())
}

/// What a block may do.
#[derive(Clone, Copy)]
struct May {
    command: bool,
    set: bool,
}

const MOST_STATES: usize = 6;

impl Grower<'_> {
    fn grow_program(mut self) -> Program {
        self.next_part();
        self.program.whiskers = 1 + self.pick(3);
        for whisker in 0..self.program.whiskers {
            self.know(&format!("w{whisker}"), Type::Whisker, false);
        }
        self.program.contours = self.pick(3);
        for contour in 0..self.program.contours {
            self.know(&format!("c{contour}"), Type::Contour, false);
        }
        for index in 0..self.pick(4) {
            let numbers = [Type::Number, Type::Length, Type::Angle, Type::Time, Type::Speed, Type::Rate];
            let r#type = self.one_of(&[&numbers[..], &[Type::Truth, Type::Choice]].concat());
            let value = if numbers.contains(&r#type) { self.quantity(r#type) } else { self.simple(r#type) };
            let name = format!("p{index}");
            self.know(&name, r#type, false);
            self.program.parameters.push((name, value));
        }
        let globals = self.scope.len();
        let [derived, laws, states] = [6, 5, MOST_STATES].map(|most| self.pick(most));
        for index in 0..derived {
            self.next_part();
            let (arguments, r#type) = (self.arguments(2), self.one_of(&Type::ALL));
            let value = self.composite(r#type, 2);
            self.scope.truncate(globals);
            self.program.derived.push(Derived { name: format!("d{index}"), arguments, r#type, value });
        }
        for index in 0..laws {
            self.next_part();
            let (arguments, commands) = (self.arguments(3), self.pick(2) == 0);
            let mut body = self.statements(May { command: commands, set: false }, 2);
            if commands {
                body.push(self.steer());
            }
            self.scope.truncate(globals);
            self.program.laws.push(Law { name: format!("l{index}"), arguments, commands, body });
        }
        self.next_part();
        let own = self.scope.len();
        self.grow_own();
        // Monitors do not know the machine's memory.
        let memory = self.scope.split_off(own);
        self.grow_monitors();
        self.scope.extend(memory);
        let globals = self.scope.len();
        for index in 0..=states {
            self.next_part();
            self.declare(index, globals);
        }
        for index in 0..self.program.states.len() {
            self.know_state(index, globals);
            self.grow_state(index);
        }
        self.scope.truncate(globals);
        self.next_part();
        for _ in 0..self.pick(3) {
            let rule = self.rule(None);
            self.program.always.push(rule);
        }
        if self.pick(4) > 0 {
            self.program.failsafe = Some(self.target(None));
        }
        self.program.contracts = self.contracts();
        self.program
    }

    /// What runs first in every tick.
    fn grow_monitors(&mut self) {
        // What the machine can read of them. They know one another only by the values of their arguments.
        let mut readable: Vec<(String, Type)> = Vec::new();
        for index in 0..self.pick(4) {
            self.next_part();
            let outside = self.scope.len();
            let arguments = self.arguments(2);
            let mut memory = Vec::new();
            for number in 0..=self.pick(2) {
                let r#type = self.one_of(&Type::ALL);
                let (name, value) = (format!("k{index}_{number}"), self.expression(r#type, 2));
                self.know(&name, r#type, true);
                memory.push((name, r#type, value));
            }
            let body = self.grow_memories(&memory);
            // The names of its arguments may hide those of the monitor.
            let event = self.arguments(2);
            let event = (event, self.grow_memories(&memory));
            self.scope.truncate(outside);
            for (name, r#type) in &readable {
                self.know(name, *r#type, false);
            }
            let values = self.values(&arguments, 2);
            self.scope.truncate(outside);
            readable.extend(memory.iter().map(|(name, r#type, _)| (format!("M{index}.{name}"), *r#type)));
            self.program.monitors.push(Monitor { arguments, values, memory, body, event });
        }
        for (name, r#type) in &readable {
            self.know(name, *r#type, false);
        }
    }

    /// Statements that set the memory of a monitor or show it, some of them under a condition.
    fn grow_memories(&mut self, memory: &[(String, Type, Expression)]) -> Vec<Statement> {
        let mut body = Vec::new();
        for _ in 0..self.pick(4) {
            let (name, r#type, _) = self.one_of(memory);
            let set = if ![Type::Contour, Type::Record, Type::List].contains(&r#type) && self.pick(6) == 0 {
                Statement::Log(self.site(), vec![self.expression(r#type, 1)])
            } else {
                Statement::Set(name, self.expression(r#type, 2))
            };
            let condition = (self.pick(2) == 1).then(|| self.expression(Type::Truth, 2));
            body.push(
                condition.map_or(set.clone(), |condition| Statement::If(vec![(condition, vec![set])], Vec::new())),
            );
        }
        body
    }

    /// What the machine itself remembers and does.
    fn grow_own(&mut self) {
        for index in 0..self.pick(4) {
            let r#type = self.one_of(&Type::ALL);
            // Laws and derived values do not know it, so that their arguments may be called so.
            let (name, value) = (format!("m{index}"), self.expression(r#type, 2));
            self.know(&name, r#type, true);
            self.program.memory.push((name, r#type, value));
        }
        self.next_part();
        let known = self.scope.len();
        for _ in 0..self.pick(8) {
            let statement = self.statement(May { command: false, set: true }, 2);
            self.scope.truncate(known);
            // Outside of states a `let` is a derived value.
            self.program.body.push(match statement {
                Statement::Let(..) => Statement::If(vec![(Expression::Truth(true), vec![statement])], Vec::new()),
                statement => statement,
            });
        }
    }

    /// Makes the next state, beside the one before, in it, or beside one around it, with what it knows.
    fn declare(&mut self, index: usize, globals: usize) {
        let around = index.checked_sub(1).map_or_else(Vec::new, |before| self.program.way(before));
        let depth = self.pick(around.len().min(2) + 1);
        let parent = around[..depth].last().copied();
        self.program.states.push(State { parent, ..State::default() });
        self.know_state(index, globals);
        let arguments = if index == 0 { Vec::new() } else { self.arguments(3) };
        let mut names: Vec<String> = arguments.iter().map(|(name, _)| name.clone()).collect();
        let (first, outside) = (names.len(), self.scope.len());
        for index in 0..self.pick(4) {
            let name = self.hiding_name(&names);
            names.push(name.unwrap_or_else(|| format!("x{}", outside + index)));
        }
        // What a memory hides is hidden from what stands above it, too.
        let mut memory = Vec::new();
        for index in first..names.len() {
            self.hidden = names[index..].to_vec();
            self.in_state = true;
            let r#type = self.one_of(&Type::ALL);
            let value = self.expression(r#type, 2);
            self.in_state = false;
            self.hidden.clear();
            self.know(&names[index], r#type, true);
            memory.push((names[index].clone(), r#type, value));
        }
        let state = &mut self.program.states[index];
        (state.arguments, state.memory) = (arguments, memory);
    }

    /// What is known in a state, but for what its blocks name.
    fn know_state(&mut self, index: usize, globals: usize) {
        self.scope.truncate(globals);
        for state in self.program.way(index) {
            let State { arguments, memory, .. } = self.program.states[state].clone();
            for (name, r#type) in &arguments {
                self.know(name, *r#type, false);
            }
            for (name, r#type, _) in &memory {
                self.know(name, *r#type, true);
            }
        }
    }

    fn grow_state(&mut self, index: usize) {
        self.in_state = true;
        self.next_part();
        let inner: Vec<usize> =
            (0..self.program.states.len()).filter(|&state| self.program.states[state].parent == Some(index)).collect();
        let initial = (!inner.is_empty()).then(|| {
            let inner = self.one_of(&inner);
            (inner, self.values(&self.program.states[inner].arguments.clone(), 1))
        });
        let rules = (0..self.pick(4)).map(|_| self.rule(Some(index))).collect();
        let failsafe = (self.pick(3) > 0).then(|| self.target(Some(index)));
        let contracts = self.contracts();
        self.next_part();
        let entry = self.block(May { command: false, set: true }, 2);
        self.next_part();
        let exit = self.block(May { command: false, set: true }, 2);
        self.next_part();
        let known = self.scope.len();
        let mut body = self.statements(May { command: true, set: true }, 3);
        // A command shows what the names stand for.
        if self.pick(4) > 0 {
            body.push(self.steer());
        }
        self.scope.truncate(known);
        let state = &mut self.program.states[index];
        *state = State { initial, entry, exit, body, rules, failsafe, contracts, ..state.clone() };
        self.in_state = false;
    }

    fn contracts(&mut self) -> Vec<Contract> {
        self.next_part();
        (0..self.pick(3)).map(|_| self.contract()).collect()
    }

    fn contract(&mut self) -> Contract {
        let condition = self.expression(Type::Truth, 2);
        match self.pick(4) {
            0 => Contract::Assume(condition),
            1 => Contract::Never(condition, None),
            2 => Contract::Never(condition, Some(self.time())),
            _ => Contract::Always(condition, self.time()),
        }
    }

    fn rule(&mut self, from: Option<usize>) -> Rule {
        let guard = match self.pick(6) {
            0 | 1 => Guard::After(self.time()),
            2 => Guard::When(self.expression(Type::Truth, 2)),
            _ => Guard::WhenFor(self.expression(Type::Truth, 2), self.time()),
        };
        // The machine's rules have no beginning to count from.
        let guard = match guard {
            Guard::After(time) if from.is_none() => Guard::WhenFor(self.expression(Type::Truth, 1), time),
            guard => guard,
        };
        Rule { guard, target: self.target(from) }
    }

    /// A time of some ticks, or seldom any other.
    fn time(&mut self) -> Expression {
        if self.pick(8) == 7 {
            return self.expression(Type::Time, 2);
        }
        Expression::Quantity(self.one_of(&["100", "20", "50", "200", "350"]), "ms")
    }

    fn target(&mut self, from: Option<usize>) -> Target {
        if self.pick(16) == 15 {
            let reason = format!("reason {}", self.pick(3));
            return if self.pick(2) == 0 { Target::Failure(reason) } else { Target::Success(reason) };
        }
        let target = match from {
            Some(from) if self.pick(4) == 3 => from,
            _ => self.pick(self.program.states.len()),
        };
        let has_inner = self.program.states.iter().any(|state| state.parent == Some(target));
        let resume = has_inner && self.pick(2) == 1;
        let entered = self.program.entered(from, target);
        let mut way = Vec::new();
        for state in entered {
            let arguments = self.program.states[state].arguments.clone();
            // A state that hands its own arguments on to itself could overwrite one before it is read.
            let values =
                if from == Some(state) && self.pick(3) == 1 { swapped(&arguments) } else { self.values(&arguments, 2) };
            way.push((state, values));
        }
        Target::State { way, resume }
    }

    /// Statements whose names end with them.
    fn block(&mut self, may: May, depth: u8) -> Vec<Statement> {
        let known = self.scope.len();
        let statements = self.statements(may, depth);
        self.scope.truncate(known);
        statements
    }

    fn statements(&mut self, may: May, depth: u8) -> Vec<Statement> {
        let mut statements = Vec::new();
        for _ in 0..self.pick(8) {
            let statement = self.statement(may, depth);
            let copied = match &statement {
                Statement::Let(_, Expression::Name(name)) if may.set => name.clone(),
                _ => String::new(),
            };
            statements.push(statement);
            let memory = self.known().into_iter().find(|known| known.is_memory && known.name == copied);
            if let Some(memory) = memory {
                statements.push(Statement::Set(memory.name, self.expression(memory.r#type, 2)));
            }
        }
        statements
    }

    fn statement(&mut self, may: May, depth: u8) -> Statement {
        let memory: Vec<_> = self.known().into_iter().filter(|known| known.is_memory).collect();
        let laws: Vec<Law> = self.program.laws.iter().filter(|law| may.command || !law.commands).cloned().collect();
        match self.pick(25) {
            0 | 1 => {
                let r#type = self.one_of(&Type::ALL);
                let (name, value) = (self.fresh_name(), self.expression(r#type, 2));
                self.know(&name, r#type, false);
                Statement::Let(name, value)
            }
            2..=5 if may.set && !memory.is_empty() => {
                let memory = self.one_of(&memory);
                // Named, and set behind that: what the name stands for must stay.
                if self.pick(3) > 0 {
                    let name = self.fresh_name();
                    self.know(&name, memory.r#type, false);
                    return Statement::Let(name, Expression::Name(memory.name));
                }
                Statement::Set(memory.name, self.expression(memory.r#type, 2))
            }
            6 | 7 if depth > 0 => {
                let mut branches = Vec::new();
                for _ in 0..=self.pick(2) {
                    branches.push((self.expression(Type::Truth, 2), self.block(may, depth - 1)));
                }
                Statement::If(branches, if self.pick(2) == 1 { self.block(may, depth - 1) } else { Vec::new() })
            }
            8..=11 if !laws.is_empty() => {
                let law = self.one_of(&laws);
                let values = self.values(&law.arguments, 2);
                Statement::Do(law.name, values, self.site())
            }
            12 => Statement::Mark(self.one_of(&["lost", "found"]), self.expression(Type::Whisker, 1)),
            13 | 16 if may.command => [Statement::Hold, Statement::Stop][self.pick(2)].clone(),
            14 | 15 if may.command => self.steer(),
            17 | 18 if self.program.contours > 0 => {
                let contour = self.pick(self.program.contours);
                Statement::RecordPosition(self.expression(Type::Place, 2), contour)
            }
            // Laws and the machine itself come before the monitors.
            19 | 20 if may.set && !self.program.monitors.is_empty() => {
                let monitor = self.pick(self.program.monitors.len());
                let arguments = self.program.monitors[monitor].event.0.clone();
                Statement::Tell(monitor, self.values(&arguments, 2), self.site())
            }
            23 if may.command || may.set => match self.pick(3) {
                0 => Statement::TellMap("give_up", Vec::new()),
                1 => {
                    Statement::TellMap("go_to", vec![self.expression(Type::Place, 1), self.expression(Type::Angle, 1)])
                }
                _ => Statement::TellMap(
                    "felt",
                    vec![self.expression(Type::Place, 1), self.expression(Type::Direction, 1)],
                ),
            },
            21 => {
                let of = self.one_of(&[Type::Number, Type::Length, Type::Angle, Type::Truth, Type::Choice]);
                Statement::Plot(of, self.expression(of, 2))
            }
            22 => {
                let types = [
                    Type::Number,
                    Type::Time,
                    Type::Truth,
                    Type::Vector,
                    Type::Direction,
                    Type::Shift,
                    Type::Place,
                    Type::Whisker,
                    Type::Choice,
                ];
                let values = (0..self.pick(4)).map(|_| {
                    let of = self.one_of(&types);
                    self.expression(of, 2)
                });
                let values = values.collect();
                Statement::Log(self.site(), values)
            }
            _ => Statement::Record(self.expression(Type::Whisker, 1)),
        }
    }

    fn steer(&mut self) -> Statement {
        let whisker = (self.pick(2) == 1).then(|| self.expression(Type::Whisker, 1));
        let along = self.one_of(&[Type::Vector, Type::Direction, Type::Shift]);
        let (along, speed) = (self.expression(along, 2), self.expression(Type::Speed, 3));
        let facing = self.pick(2) == 1;
        let turn = self.expression(if facing { Type::Angle } else { Type::Rate }, 3);
        Statement::Steer(Steer { whisker, along, speed, facing, turn })
    }
}

/// For every argument the name of the next one of its type.
fn swapped(arguments: &Arguments) -> Vec<Expression> {
    let next = |(index, (_, r#type)): (usize, &(String, Type))| {
        let mut behind = arguments.iter().cycle().skip(index + 1);
        let (name, _) = behind.find(|(_, other)| other == r#type).unwrap();
        Expression::Name(name.clone())
    };
    arguments.iter().enumerate().map(next).collect()
}
