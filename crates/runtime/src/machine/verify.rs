//! Verification of programs from untrusted sources.
//!
//! Why: docs/decisions/machine.md#artifacts-are-verified-at-every-load.

use std::collections::{HashMap, HashSet};

use crate::signal::MAX_WHISKERS;

use super::contour::Keypoints;
use super::contract::{CONTRACT_LIMIT, Contract};
use super::op::{Block, Op, Register};
use super::operands::{Index, RegisterSpan};
use super::output::{MESSAGE_LIMIT, PLOT_LIMIT};
use super::parameter::DESCRIPTION_LIMIT;
use super::program::{
    CODE_LIMIT, CONTOUR_LIMIT, Guard, NESTING_LIMIT, Program, REGISTER_LIMIT, State, Target, Transition,
};
use super::unsound::Unsound;

/// Maximum number of states, and of transitions, of a program.
const STRUCTURE_LIMIT: usize = 50_000;
/// Maximum number of registers that one operation may clear, equal to the largest memory. It bounds the work of an
/// operation.
const CLEAR_LIMIT: u16 = 4;

impl Program {
    /// Checks everything that the execution of the program relies on.
    ///
    /// The work of a tick in a verified program is bounded by the length of its code for each transition taken,
    /// including a fallback transition. It accesses only existing registers, states, timers and whiskers, and never
    /// changes a parameter. [`Machine::tick`](super::Machine::tick) ensures that actions are finite, and steering
    /// limits the commands.
    ///
    /// # Errors
    /// [`Unsound`] with the first problem found. The compiler never produces such a program.
    pub fn verify(&self) -> Result<(), Unsound> {
        // Without `..`, the compiler reports a new field that is not checked here.
        let Self {
            name,
            whiskers,
            contact_estimators,
            optional,
            keypoints,
            contours,
            needs,
            parameters,
            states,
            initial,
            start: _,
            entry: _,
            monitors,
            body: _,
            always,
            contracts,
            fallback: _,
            outputs,
            code,
            initial_registers,
            timers: _,
        } = self;
        let transitions = always.len() + states.iter().map(|state| state.transitions.len()).sum::<usize>();
        let contracts = contracts.len() + states.iter().map(|state| state.contracts.len()).sum::<usize>();
        for (what, count, limit) in [
            ("contracts", contracts, CONTRACT_LIMIT),
            ("whiskers", whiskers.len(), MAX_WHISKERS),
            ("states", states.len(), STRUCTURE_LIMIT),
            ("transitions", transitions, STRUCTURE_LIMIT),
            ("operations", code.len(), CODE_LIMIT),
            ("registers", initial_registers.len(), REGISTER_LIMIT),
            ("parameters", parameters.len(), initial_registers.len()),
            ("contact estimators", contact_estimators.len(), MAX_WHISKERS),
            ("contours", contours.len(), CONTOUR_LIMIT),
            ("plots", outputs.plots.len(), PLOT_LIMIT),
            ("messages", outputs.messages.len(), MESSAGE_LIMIT),
            ("whiskers that a rig may lack", optional.len(), MAX_WHISKERS),
        ] {
            if count > limit {
                return Err(Unsound::TooMany { what, count, limit });
            }
        }
        is_name(name)?;
        // The name of a state in a behaviour is a path: `Following.Swiping`.
        let values = parameters.iter().map(|parameter| parameter.name.as_str());
        let values = values.chain(whiskers.iter().map(String::as_str));
        let values = values.chain(contours.iter().map(|contour| contour.name.as_str()));
        values.clone().try_for_each(is_name)?;
        states.iter().try_for_each(|state| state.name.split('.').try_for_each(is_name))?;
        distinct(values.chain(states.iter().map(|state| &*state.name)))?;
        if !contours.iter().map(|contour| &contour.keypoints).chain([keypoints]).all(Keypoints::are_valid) {
            return Err(Unsound::Keypoints);
        }
        let is_unfit = |text: &str| text.len() > DESCRIPTION_LIMIT || text.chars().any(char::is_control);
        if let Some(parameter) = parameters.iter().find(|parameter| is_unfit(&parameter.description)) {
            return Err(Unsound::Description(parameter.name.clone()));
        }
        for parameter in parameters {
            distinct(parameter.choices.iter().map(String::as_str))?;
        }
        if !needs.are_valid() {
            return Err(Unsound::Needs);
        }
        self.verify_numbers()?;
        within("state", *initial, states.len())?;
        self.verify_hierarchy()?;
        self.verify_transitions()?;
        self.verify_blocks()?;
        // The block is within the code.
        if code[monitors.start as usize..monitors.end as usize].iter().any(|op| op.is_action()) {
            return Err(Unsound::Monitor);
        }
        self.verify_contracts()?;
        outputs.verify(initial_registers.len(), states.len())?;
        self.verify_operands()
    }

    /// Checks the texts and registers of contracts, and that they only compute.
    fn verify_contracts(&self) -> Result<(), Unsound> {
        for contract in self.all_contracts() {
            let Contract { moment: _, text, code, violated, lasting, margin } = contract;
            if text.len() > DESCRIPTION_LIMIT || text.chars().any(char::is_control) {
                return Err(Unsound::Contract(text.to_string()));
            }
            // The block is within the code.
            if self.code[code.start as usize..code.end as usize].iter().any(|op| op.is_action()) {
                return Err(Unsound::Contract(text.to_string()));
            }
            for register in [Some(*violated), *lasting, margin.map(|(register, _)| register)].into_iter().flatten() {
                within("register", usize::from(register), self.initial_registers.len())?;
            }
        }
        Ok(())
    }

    /// The contracts of the machine and of all states.
    fn all_contracts(&self) -> impl Iterator<Item = &Contract> {
        self.contracts.iter().chain(self.states.iter().flat_map(|state| &state.contracts))
    }

    /// Checks that initial registers are finite and parameters are within their ranges.
    fn verify_numbers(&self) -> Result<(), Unsound> {
        if let Some(register) = self.initial_registers.iter().position(|value| !value.is_finite()) {
            return Err(Unsound::NotFinite(register));
        }
        for (parameter, value) in self.parameters.iter().zip(&self.initial_registers) {
            let is_choice = |value: f64| value.fract() == 0.0 && value < parameter.choices.len() as f64;
            let holds = match parameter.range {
                None => parameter.default.is_finite() && parameter.choices.is_empty(),
                Some((low, _)) if !parameter.choices.is_empty() => {
                    low.to_bits() == 0
                        && [*value, parameter.default].iter().all(|&value| value >= 0.0 && is_choice(value))
                }
                Some((low, high)) => {
                    let range = low..=high;
                    low.is_finite() && high.is_finite() && range.contains(value) && range.contains(&parameter.default)
                }
            };
            if !holds {
                return Err(Unsound::OutOfRange(parameter.name.clone()));
            }
        }
        Ok(())
    }

    /// Checks that outer states come before their inner states, which excludes cycles, and that every state with inner
    /// states has an initial one among them.
    fn verify_hierarchy(&self) -> Result<(), Unsound> {
        let mut depths: Vec<usize> = Vec::with_capacity(self.states.len());
        for (index, state) in self.states.iter().enumerate() {
            let outer = match state.parent {
                None => 0,
                Some(parent) => *depths.get(parent).ok_or(Unsound::Nesting(index))?,
            };
            if outer == NESTING_LIMIT {
                return Err(Unsound::Nesting(index));
            }
            depths.push(outer + 1);
        }
        for (index, state) in self.states.iter().enumerate() {
            if let Some(parent) = state.parent
                && self.states[parent].initial.is_none()
            {
                return Err(Unsound::InitialState(parent));
            }
            if let Some((inner, _)) = state.initial
                && self.states.get(inner).is_none_or(|inner| inner.parent != Some(index))
            {
                return Err(Unsound::InitialState(index));
            }
        }
        Ok(())
    }

    /// Checks the registers, timers and targets of transitions. Timers of `always` come first. Entering a state resets
    /// only the timers of that state.
    fn verify_transitions(&self) -> Result<(), Unsound> {
        let timed = |transitions: &[Transition]| transitions.iter().filter(|one| one.guard.is_timed()).count();
        let lasting = timed(&self.always);
        let most = lasting + self.states.iter().map(|state| timed(&state.transitions)).sum::<usize>();
        if !(lasting..=most).contains(&self.timers) {
            return Err(Unsound::TooMany { what: "timers", count: self.timers, limit: most });
        }
        self.always.iter().try_for_each(|rule| self.verify_transition(rule, 0..lasting))?;
        let mut transitions = self.states.iter().flat_map(|state| &state.transitions);
        transitions.try_for_each(|transition| self.verify_transition(transition, lasting..self.timers))?;
        for transitions in self.states.iter().map(|state| &state.transitions).chain([&self.always]) {
            for pair in transitions.windows(2) {
                let Block { start, end } = pair[1].guard.code().clone();
                if start != pair[0].guard.code().end {
                    return Err(Unsound::Block { start, end });
                }
            }
        }
        let of_states = self.states.iter().filter_map(|state| state.fallback.as_ref());
        of_states.chain(&self.fallback).try_for_each(|target| self.verify_target(target))
    }

    /// Checks the registers, the timer and the target of a transition. `timers` are the timers that it may use.
    fn verify_transition(&self, transition: &Transition, timers: std::ops::Range<usize>) -> Result<(), Unsound> {
        let registers = match &transition.guard {
            Guard::When { truth, lasting: Some((duration, timer)), .. } => {
                if !timers.contains(timer) {
                    return Err(Unsound::Timer(*timer));
                }
                [*truth, *duration]
            }
            Guard::When { truth: only, lasting: None, .. } | Guard::After { time: only, .. } => [*only; 2],
        };
        for register in registers {
            within("register", usize::from(register), self.initial_registers.len())?;
        }
        self.verify_target(&transition.target)
    }

    /// Checks the state or the reason of a target.
    fn verify_target(&self, target: &Target) -> Result<(), Unsound> {
        match target {
            Target::State { state, resume, .. } => {
                within("state", *state, self.states.len())?;
                if *resume && self.states[*state].initial.is_none() {
                    Err(Unsound::InitialState(*state))
                } else {
                    Ok(())
                }
            }
            Target::Failure(reason) | Target::Success(reason) if reason.chars().any(char::is_control) => {
                Err(Unsound::Reason(reason.to_string()))
            }
            Target::Failure(_) | Target::Success(_) => Ok(()),
        }
    }

    /// Checks that blocks are within the code and do not overlap, that jumps go forward within their block, and that
    /// the work of a tick is bounded.
    fn verify_blocks(&self) -> Result<(), Unsound> {
        let of_target = |target: &Target| match target {
            Target::State { arguments, .. } => arguments.clone(),
            Target::Failure(_) | Target::Success(_) => 0..0,
        };
        let of_transition = |transition: &Transition| [transition.guard.code().clone(), of_target(&transition.target)];
        let of_state = |state: &State| {
            let own = [&state.entry, &state.body, &state.exit].map(Block::clone);
            let own = own.into_iter().chain(state.initial.iter().map(|(_, arguments)| arguments.clone()));
            let fallback = state.fallback.iter().map(of_target);
            let contracts = state.contracts.iter().map(|contract| contract.code.clone());
            let transitions = state.transitions.iter().flat_map(of_transition);
            transitions.chain(own).chain(fallback).chain(contracts).collect::<Vec<Block>>()
        };
        let fallback = self.fallback.iter().map(of_target);
        let acts = [&self.start, &self.entry, &self.monitors, &self.body].map(Block::clone);
        let contracts = self.contracts.iter().map(|contract| contract.code.clone());
        let transitions = self.always.iter().flat_map(of_transition);
        let own: Vec<Block> = transitions.chain(fallback).chain(acts).chain(contracts).collect();
        let states: Vec<Vec<Block>> = self.states.iter().map(of_state).collect();
        let mut blocks: Vec<Block> = states.iter().flatten().chain(&own).cloned().collect();
        blocks.sort_by_key(|block| (block.start, block.end));
        blocks.dedup();

        let mut free = 0;
        for Block { start, end } in blocks {
            if start > end || end as usize > self.code.len() || (start < end && start < free) {
                return Err(Unsound::Block { start, end });
            }
            free = free.max(end);
            for at in start..end {
                if let Some(target) = self.code[at as usize].target()
                    && !(at < target && target <= end)
                {
                    return Err(Unsound::Jump { at, target });
                }
            }
        }
        // Between two transitions, each block of the active states runs at most once.
        let sum = |blocks: &[Block]| blocks.iter().map(ExactSizeIterator::len).sum::<usize>();
        let mut sums: Vec<usize> = Vec::with_capacity(states.len());
        for (index, state) in states.iter().enumerate() {
            let outer = self.states[index].parent.map_or_else(|| sum(&own), |parent| sums[parent]);
            let operations = outer + sum(state);
            if operations > self.code.len() {
                return Err(Unsound::Work { state: index, operations });
            }
            sums.push(operations);
        }
        Ok(())
    }

    /// Checks that every operand is an existing register, that every recorded contour exists, and that no parameter is
    /// written.
    fn verify_operands(&self) -> Result<(), Unsound> {
        for op in &self.code {
            let operands = op.operands();
            for span in operands.all_reads().into_iter().chain(operands.writes) {
                if let Some(last) = span.registers().last() {
                    within("register", last, self.initial_registers.len())?;
                }
            }
            for written in operands.writes.map(RegisterSpan::registers) {
                if let Some(parameter) = self.parameters.get(written.start)
                    && !written.is_empty()
                {
                    return Err(Unsound::ParameterWritten(parameter.name.clone()));
                }
            }
            match *op {
                Op::Clear { count, .. } if count > CLEAR_LIMIT => {
                    let (count, limit) = (count.into(), CLEAR_LIMIT.into());
                    return Err(Unsound::TooMany { what: "registers to clear at once", count, limit });
                }
                Op::RecordPosition { contour, .. } => within("contour", contour.into(), self.contours.len())?,
                _ => {}
            }
        }
        let contours = self.whiskers.len() + self.contours.len();
        self.verify_indices(Index::Whisker, self.whiskers.len(), Unsound::Whisker)?;
        self.verify_indices(Index::Contour, contours, Unsound::Contour)
    }

    /// Checks that registers that are read as an index into a list always contain an index below `count`. They start
    /// with one, and only copies of such registers or a choice of them are written to them.
    fn verify_indices(&self, list: Index, count: usize, fault: fn(Register) -> Unsound) -> Result<(), Unsound> {
        let mut copied_from: HashMap<Register, Vec<Register>> = HashMap::new();
        for op in &self.code {
            match *op {
                Op::Copy { to, a } => copied_from.entry(to).or_default().push(a),
                Op::Select { to, a, b, .. } => copied_from.entry(to).or_default().extend([a, b]),
                Op::CopyVector { to, a } => {
                    copied_from.entry(to).or_default().push(a);
                    copied_from.entry(to + 1).or_default().push(a + 1);
                }
                _ => {}
            }
        }
        let read = self.code.iter().filter_map(|op| op.operands().index.filter(|&(of, _)| of == list));
        let mut pending: Vec<Register> = read.map(|(_, register)| register).collect();
        let mut indices = HashSet::new();
        while let Some(register) = pending.pop() {
            if indices.insert(register) {
                pending.extend(copied_from.get(&register).into_iter().flatten());
            }
        }
        if count == 0 && !indices.is_empty() {
            return Err(Unsound::NoWhisker);
        }
        for &register in &indices {
            let index = self.initial_registers[usize::from(register)];
            let is_index = index.fract() == 0.0 && (0.0..count as f64).contains(&index);
            if !is_index || usize::from(register) < self.parameters.len() {
                return Err(fault(register));
            }
        }
        let computes = |op: &&Op| !matches!(op, Op::Copy { .. } | Op::CopyVector { .. } | Op::Select { .. });
        for op in self.code.iter().filter(computes) {
            for register in op.operands().writes.into_iter().flat_map(RegisterSpan::registers) {
                if let Ok(register) = Register::try_from(register)
                    && indices.contains(&register)
                {
                    return Err(fault(register));
                }
            }
        }
        Ok(())
    }
}

/// Checks that an index is less than a count.
pub(super) fn within(what: &'static str, index: usize, count: usize) -> Result<(), Unsound> {
    if index < count { Ok(()) } else { Err(Unsound::Index { what, index, count }) }
}

/// Checks that a name consists of letters, digits and underscores and does not start with a digit.
pub(super) fn is_name(name: &str) -> Result<(), Unsound> {
    let holds = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
        && name.bytes().next().is_some_and(|first| !first.is_ascii_digit());
    if holds { Ok(()) } else { Err(Unsound::Name(name.to_owned())) }
}

/// Checks that all names are different.
pub(super) fn distinct<'n>(names: impl Iterator<Item = &'n str>) -> Result<(), Unsound> {
    let mut known = HashSet::new();
    for name in names {
        if !known.insert(name) {
            return Err(Unsound::SameName(name.to_owned()));
        }
    }
    Ok(())
}
