//! Which values reach which registers.

use std::collections::BTreeSet;

use vibrissa_runtime::machine::{Op, Place, Program, Register};

/// More values than these are as good as any.
const VALUE_LIMIT: usize = 16;
/// More registers than these are not followed.
const REACH_LIMIT: usize = 256;

/// How a register comes by its value while a policy runs.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// It holds what it held at the start.
    Start,
    /// It is copied from one of these.
    Copies(Vec<Register>),
    /// It is computed.
    Computed,
}

/// Which values reach which registers, whatever the order in which code runs. A register that code writes is taken to be
/// written before it is read.
#[derive(Debug)]
pub(super) struct Flow(Vec<Origin>);

impl Flow {
    pub(super) fn new(program: &Program) -> Self {
        let mut origins = vec![Origin::Start; program.image.len()];
        for op in &program.code {
            match *op {
                Op::Copy { to, a } => {
                    if let Some(origin) = origins.get_mut(usize::from(to)) {
                        match origin {
                            Origin::Start => *origin = Origin::Copies(vec![a]),
                            Origin::Copies(sources) => sources.push(a),
                            Origin::Computed => {}
                        }
                    }
                }
                _ => {
                    for register in op.operands().writes.into_iter().flat_map(Place::registers) {
                        if let Some(origin) = origins.get_mut(register) {
                            *origin = Origin::Computed;
                        }
                    }
                }
            }
        }
        Self(origins)
    }

    /// Whether code writes a register.
    pub(super) fn is_written(&self, register: Register) -> bool {
        self.0.get(usize::from(register)).is_none_or(|origin| *origin != Origin::Start)
    }

    /// The values that a register can have, if they are few and known.
    pub(super) fn values(&self, program: &Program, register: Register) -> Option<Vec<f64>> {
        let (mut seen, mut open, mut values) = (BTreeSet::from([register]), vec![register], Vec::new());
        while let Some(register) = open.pop() {
            match self.0.get(usize::from(register))? {
                Origin::Computed => return None,
                // A run may set parameters.
                Origin::Start if usize::from(register) < program.parameters.len() => return None,
                Origin::Start => values.push(*program.image.get(usize::from(register))?),
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
