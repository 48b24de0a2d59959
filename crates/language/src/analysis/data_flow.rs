//! Data flow: the values that can reach a register.

use std::collections::BTreeSet;

use vibrissa_runtime::machine::{Op, Program, Register, RegisterSpan};

/// The maximum number of values per register. More are treated as unknown.
const VALUE_LIMIT: usize = 16;
/// The maximum number of registers that are followed.
const REACH_LIMIT: usize = 256;

/// The origin of a register's value while a policy runs.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// The initial value.
    Start,
    /// A copy of one of these registers.
    Copies(Vec<Register>),
    /// A computed value.
    Computed,
}

/// The origins of all registers, independent of the order of execution. A register that code writes is assumed to be
/// written before it is read.
#[derive(Debug)]
pub(super) struct Flow(Vec<Origin>);

/// Adds copies of registers to the origins of a register.
fn copy(origins: &mut [Origin], to: Register, from: &[Register]) {
    match origins.get_mut(usize::from(to)) {
        Some(origin @ Origin::Start) => *origin = Origin::Copies(from.to_vec()),
        Some(Origin::Copies(sources)) => sources.extend(from),
        Some(Origin::Computed) | None => {}
    }
}

impl Flow {
    pub(super) fn new(program: &Program) -> Self {
        let mut origins = vec![Origin::Start; program.initial_registers.len()];
        for op in &program.code {
            match *op {
                Op::Copy { to, a } => copy(&mut origins, to, &[a]),
                Op::Select { to, a, b, .. } => copy(&mut origins, to, &[a, b]),
                _ => {
                    for register in op.operands().writes.into_iter().flat_map(RegisterSpan::registers) {
                        if let Some(origin) = origins.get_mut(register) {
                            *origin = Origin::Computed;
                        }
                    }
                }
            }
        }
        Self(origins)
    }

    /// True if code writes a register.
    pub(super) fn is_written(&self, register: Register) -> bool {
        self.0.get(usize::from(register)).is_none_or(|origin| *origin != Origin::Start)
    }

    /// The possible values of a register, if they are few and known.
    pub(super) fn values(&self, program: &Program, register: Register) -> Option<Vec<f64>> {
        let (mut seen, mut open, mut values) = (BTreeSet::from([register]), vec![register], Vec::new());
        while let Some(register) = open.pop() {
            match self.0.get(usize::from(register))? {
                Origin::Computed => return None,
                // A run may set parameters.
                Origin::Start if usize::from(register) < program.parameters.len() => return None,
                Origin::Start => values.push(*program.initial_registers.get(usize::from(register))?),
                Origin::Copies(sources) => open.extend(sources.iter().filter(|&&source| seen.insert(source))),
            }
            if values.len() > VALUE_LIMIT || seen.len() > REACH_LIMIT {
                return None;
            }
        }
        values.sort_by(f64::total_cmp);
        values.dedup();
        (!values.is_empty()).then_some(values)
    }
}
