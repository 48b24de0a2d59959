//! Thresholds: the constants of guards, with which they compare values and times.

use vibrissa_runtime::machine::{Guard, Op, Program, Register, TransitionId};
use vibrissa_runtime::units::Dimension;

use super::Explained;
use super::condition::{Comparison, Leaf};

/// A constant with which a guard compares a value or a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// The transition of the guard.
    pub transition: TransitionId,
    /// The part that compares, as its index among those of the guard's condition, in the order of the text. `None` for the time after
    /// `after` or `for`.
    pub part: Option<usize>,
    /// The text of the part, or that of the guard.
    pub text: String,
    /// The constant (SI).
    pub value: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

/// A threshold that cannot be changed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ThresholdError {
    /// The guard has no constant there.
    #[error("this guard compares with no constant there; change a parameter of the policy")]
    NoConstant,
    /// The program has too many registers.
    #[error("the program has no register left for another threshold; change fewer thresholds")]
    NoRegister,
}

impl Explained {
    /// All thresholds, in the order of the transitions: global ones first, then those of every state.
    #[must_use]
    pub fn thresholds(&self) -> Vec<Threshold> {
        let is_written = written(&self.program);
        let always = (0..self.always.len()).map(|index| TransitionId { state: None, index });
        let of_states = self.states.iter().enumerate().flat_map(|(state, transitions)| {
            (0..transitions.len()).map(move |index| TransitionId { state: Some(state), index })
        });
        let thresholds = always.chain(of_states).flat_map(|transition| {
            let leaves = self.leaves(transition).into_iter().enumerate();
            let value = |register: Register| self.program.initial_registers.get(usize::from(register)).copied();
            let compared = |(part, leaf): (usize, &Leaf)| {
                let (register, Comparison { dimension, .. }) = self.constant(leaf, &is_written)?;
                let (part, text) = (Some(part), leaf.text.clone());
                Some(Threshold { transition, part, text, value: value(register)?, dimension })
            };
            let mut all: Vec<Threshold> = leaves.filter_map(compared).collect();
            all.extend(self.transition(transition).and_then(|explained| {
                let time = guard(&self.program, transition).and_then(time)?;
                let value = value(time).filter(|_| self.is_constant(time, &is_written))?;
                let text = explained.text.clone();
                Some(Threshold { transition, part: None, text, value, dimension: Dimension::TIME })
            }));
            all
        });
        thresholds.collect()
    }

    /// Sets a threshold in a program of this policy. The new constant has a register after all others, so that a running machine can
    /// [continue](vibrissa_runtime::machine::Machine::continue_with) with the program. `part` is that of the [`Threshold`].
    ///
    /// # Errors
    /// [`ThresholdError`] if the guard has no threshold there, or if there is no register left.
    pub fn set_threshold(
        &self,
        program: &mut Program,
        transition: TransitionId,
        part: Option<usize>,
        value: f64,
    ) -> Result<(), ThresholdError> {
        let new = Register::try_from(program.initial_registers.len()).map_err(|_| ThresholdError::NoRegister)?;
        match part {
            Some(part) => self.compare_with(program, (transition, part), new)?,
            None => self.wait_for(program, transition, new)?,
        }
        program.initial_registers.push(value);
        Ok(())
    }

    /// Lets a part of a guard compare with another register than that of its constant.
    fn compare_with(
        &self,
        program: &mut Program,
        (transition, part): (TransitionId, usize),
        new: Register,
    ) -> Result<(), ThresholdError> {
        let leaves = self.leaves(transition);
        let leaf = leaves.get(part).ok_or(ThresholdError::NoConstant)?;
        let (old, _) = self.constant(leaf, &written(&self.program)).ok_or(ThresholdError::NoConstant)?;
        let code = guard(program, transition).map(|guard| guard.code().clone()).unwrap_or_default();
        let code = program.code.get_mut(code.start as usize..code.end as usize).unwrap_or_default();
        for op in code.iter_mut().filter(|op| op.bool_result() == Some(leaf.truth)) {
            if let Op::Less { a, b, .. } | Op::LessOrEqual { a, b, .. } = op {
                for operand in [a, b].into_iter().filter(|operand| **operand == old) {
                    *operand = new;
                }
            }
        }
        Ok(())
    }

    /// Lets a guard take its time from another register than that of its constant.
    fn wait_for(&self, program: &mut Program, transition: TransitionId, new: Register) -> Result<(), ThresholdError> {
        let all = match transition.state {
            None => Some(&mut program.always),
            Some(state) => program.states.get_mut(state).map(|state| &mut state.transitions),
        };
        let guard = all.and_then(|all| all.get_mut(transition.index)).map(|one| &mut one.guard);
        let Some(Guard::When { lasting: Some((time, _)), .. } | Guard::After { time, .. }) = guard else {
            return Err(ThresholdError::NoConstant);
        };
        if !self.is_constant(*time, &written(&self.program)) {
            return Err(ThresholdError::NoConstant);
        }
        *time = new;
        Ok(())
    }

    /// The parts of the condition of a transition, in the order of the text.
    fn leaves(&self, transition: TransitionId) -> Vec<&Leaf> {
        let condition = self.transition(transition).and_then(|transition| transition.condition.as_ref());
        condition.map_or_else(Vec::new, |condition| condition.judge(&[]).iter().map(|judged| judged.leaf).collect())
    }

    /// The register of the constant with which a part compares.
    fn constant(&self, leaf: &Leaf, is_written: &[bool]) -> Option<(Register, Comparison)> {
        let compared = leaf.compared.filter(|compared| !compared.is_equality)?;
        let register = [compared.right, compared.left].into_iter().find(|&one| self.is_constant(one, is_written))?;
        Some((register, compared))
    }

    /// True if no operation writes a register, and no parameter is in it.
    fn is_constant(&self, register: Register, is_written: &[bool]) -> bool {
        let index = usize::from(register);
        index >= self.program.parameters.len() && is_written.get(index) == Some(&false)
    }
}

/// The guard of a transition.
fn guard(program: &Program, transition: TransitionId) -> Option<&Guard> {
    let all = transition.state.map_or(Some(&program.always), |state| Some(&program.states.get(state)?.transitions))?;
    Some(&all.get(transition.index)?.guard)
}

/// The register of the time that a guard needs.
fn time(guard: &Guard) -> Option<Register> {
    match guard {
        Guard::When { lasting, .. } => lasting.map(|(time, _)| time),
        Guard::After { time, .. } => Some(*time),
    }
}

/// For each register, true if an operation writes it.
fn written(program: &Program) -> Vec<bool> {
    let mut is_written = vec![false; program.initial_registers.len()];
    for op in &program.code {
        for span in op.operands().writes {
            for register in span.registers() {
                if let Some(written) = is_written.get_mut(register) {
                    *written = true;
                }
            }
        }
    }
    is_written
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::explain::explain;
    use vibrissa_text::diagnostic::Source;

    #[test]
    fn only_constants_in_comparisons_are_thresholds_and_each_is_set_alone() {
        let text = "machine m  param late = 3 s  initial A  state A { stop  when time > 2 s and time > late -> B } \
            state B { stop  when body.blocked for 2 s -> A  after 7 s -> A }";
        let explained = explain(&Source::new("m.fsm", text)).unwrap();
        let thresholds = explained.thresholds();
        let texts: Vec<_> = thresholds.iter().map(|threshold| (threshold.text.as_str(), threshold.value)).collect();
        assert_eq!(texts, [("time > 2 s", 2.0), ("body.blocked for 2 s", 2.0), ("after 7 s", 7.0)]);
        let mut changed = explained.program.clone();
        explained.set_threshold(&mut changed, thresholds[0].transition, thresholds[0].part, 5.0).unwrap();
        let differing = changed.code.iter().zip(&explained.program.code).filter(|(a, b)| a != b).count();
        assert_eq!((differing, changed.initial_registers.last()), (1, Some(&5.0)));
        explained.set_threshold(&mut changed, thresholds[1].transition, None, 1.0).unwrap();
        assert_ne!(changed.states[1], explained.program.states[1]);
        assert!(changed.verify().is_ok());
        let other = explained.set_threshold(&mut changed, thresholds[0].transition, Some(1), 1.0);
        assert_eq!(other, Err(ThresholdError::NoConstant));
    }
}
