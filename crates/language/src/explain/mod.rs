//! Policies whose guards can be explained while they run.
//!
//! The program is not optimised, so that every part of a condition has a register of its own. Its results are the same, bit by
//! bit.

mod build;
mod condition;
mod non_finite;
mod threshold;
mod variable;

pub use condition::{Condition, Judged, Leaf};
pub use threshold::{Threshold, ThresholdError};
pub use variable::{Variable, VariableValue};

use vibrissa_runtime::machine::{ContractId, Program, TransitionId};

use vibrissa_text::diagnostic::{Diagnostic, Position, Source, Span};

use super::ast;
use super::lower::{Lowered, Origins};
use build::Builder;

/// A policy with explanations of its transitions.
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::explain::explain;
/// let source = Source::new(
///     "late.fsm",
///     "machine late  initial Still  state Still { stop  when time > 3 s and not body.blocked -> Failure(\"late\") }",
/// );
/// let explained = explain(&source)?;
/// let guard = &explained.states[0][0];
/// assert_eq!(guard.text, "time > 3 s and not body.blocked");
/// # Ok::<(), Vec<vibrissa_text::diagnostic::Diagnostic>>(())
/// ```
#[derive(Debug)]
pub struct Explained {
    /// The program.
    pub program: Program,
    /// The global transitions, in the order of the text.
    pub always: Vec<ExplainedTransition>,
    /// The transitions of each state, in the order of the text.
    pub states: Vec<Vec<ExplainedTransition>>,
    /// The contracts of the machine that are not proved.
    pub contracts: Vec<ExplainedContract>,
    /// The contracts of each state that are not proved.
    pub contracts_of_states: Vec<Vec<ExplainedContract>>,
    /// The memory of the machine.
    pub memory: Vec<Variable>,
    /// The arguments and the memory of each state.
    pub memory_of_states: Vec<Vec<Variable>>,
    source: Source,
    origins: Origins,
}

/// A transition with its texts and its condition.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplainedTransition {
    /// The guard as written, on one line, with `for` and its time.
    pub text: String,
    /// The target: name of the state, `exit` and its name, `Failure` or `Success`.
    pub target: String,
    /// The file that contains the guard. `None` for the policy itself.
    pub file: Option<String>,
    /// The position of the guard in the text of its file.
    pub position: Position,
    /// The condition. `None` for `after`.
    pub condition: Option<Condition>,
}

/// A contract with the condition of its violation.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplainedContract {
    /// The contract as written, on one line.
    pub text: String,
    /// The file that contains it. `None` for the policy itself.
    pub file: Option<String>,
    /// Its position in the text of its file.
    pub position: Position,
    /// The condition of its violation.
    pub violation: Condition,
}

impl Explained {
    /// A contract by its identifier.
    #[must_use]
    pub fn contract(&self, id: ContractId) -> Option<&ExplainedContract> {
        id.state.map_or(Some(&self.contracts), |state| self.contracts_of_states.get(state))?.get(id.index)
    }

    /// The program with the values that the parameters of a program of the same policy have.
    #[must_use]
    pub fn with_parameters_of(&self, other: &Program) -> Program {
        let mut program = self.program.clone();
        let values = other.initial_registers.iter().take(other.parameters.len());
        program.initial_registers.iter_mut().zip(values).for_each(|(own, value)| *own = *value);
        program
    }

    /// A transition by its identifier.
    #[must_use]
    pub fn transition(&self, id: TransitionId) -> Option<&ExplainedTransition> {
        let transitions = id.state.map_or(Some(&self.always), |state| self.states.get(state))?;
        transitions.get(id.index)
    }
}

/// Compiles a policy and explains its transitions.
///
/// # Errors
/// Those of [`compile`](super::compile).
pub fn explain(source: &Source) -> Result<Explained, Vec<Diagnostic>> {
    let (source, files, lowered) = super::front(source, super::load(source), super::Analysis::Whole)?;
    let builder = Builder { program: &lowered.program, source: &source, origins: &lowered.origins };
    let explained = |written: &[ast::Transition], compiled: &[vibrissa_runtime::machine::Transition]| {
        let both = written.iter().zip(compiled);
        both.map(|(written, compiled)| ExplainedTransition {
            text: guard_text(&source, &written.guard),
            target: if written.target.is_exit {
                format!("exit {}", written.target.name.text)
            } else {
                written.target.name.text.clone()
            },
            file: file_of(&source, written.guard.span()),
            position: source.line_column(written.guard.span().start),
            condition: builder.condition(&compiled.guard),
        })
        .collect::<Vec<_>>()
    };
    let main = &files.main;
    let always = explained(&main.always, &lowered.program.always);
    let states = files.machine.states.iter().zip(&lowered.program.states);
    let states = states.map(|(written, compiled)| explained(&written.transitions, &compiled.transitions)).collect();
    let contracts = |written: &[ast::Contract], compiled: &[vibrissa_runtime::machine::Contract]| {
        let both = written.iter().zip(compiled);
        both.map(|(written, compiled)| ExplainedContract {
            text: compiled.text.to_string(),
            file: file_of(&source, written.span),
            position: source.line_column(written.span.start),
            violation: builder.condition_in(&compiled.code, compiled.violated),
        })
        .collect::<Vec<_>>()
    };
    let own_contracts = contracts(&main.contracts, &lowered.program.contracts);
    let both = files.machine.states.iter().zip(&lowered.program.states);
    let contracts_of_states =
        both.map(|(written, compiled)| contracts(&written.contracts, &compiled.contracts)).collect();
    let variables = |names: &[(String, super::types::Value)]| {
        names.iter().map(|name| Variable::new(name, &lowered.choices)).collect()
    };
    let memory = variables(&lowered.memory.machine);
    let memory_of_states = lowered.memory.states.iter().map(|names| variables(names)).collect();
    let Lowered { program, origins, .. } = lowered;
    let contracts = own_contracts;
    Ok(Explained { program, always, states, contracts, contracts_of_states, memory, memory_of_states, source, origins })
}

/// The name of the file that contains a span. `None` for the policy itself.
fn file_of(source: &Source, span: Span) -> Option<String> {
    match source.part_at(span.start) {
        0 => None,
        part => Some(source.part_name(part).to_owned()),
    }
}

fn guard_text(source: &Source, guard: &ast::Guard) -> String {
    match guard {
        ast::Guard::When { condition, lasting: None } => source.on_one_line(condition.span),
        ast::Guard::When { condition, lasting: Some(time) } => {
            format!("{} for {}", source.on_one_line(condition.span), source.on_one_line(time.span))
        }
        ast::Guard::After(time) => format!("after {}", source.on_one_line(time.span)),
    }
}
