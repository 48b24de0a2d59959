//! A program during optimisation.

use vibrissa_runtime::machine::{Block, Guard, Op, Program, Register, Target, Transition};

/// A program during optimisation. Passes mark operations as removed, and `finish` compacts the code.
pub(super) struct Draft {
    program: Program,
    pub(super) ops: Vec<Op>,
    /// For each operation, true if it is kept.
    pub(super) is_kept: Vec<bool>,
    /// Code that is executed once, at the start of a run.
    pub(super) start: Vec<Op>,
    /// Ranges of the code that are executed from start to end.
    pub(super) runs: Vec<std::ops::Range<usize>>,
}

impl Draft {
    pub(super) fn new(mut program: Program) -> Self {
        let ops = std::mem::take(&mut program.code);
        let runs = runs(&program);
        Self { is_kept: vec![true; ops.len()], ops, start: Vec::new(), runs, program }
    }

    /// Number of registers.
    pub(super) fn registers(&self) -> usize {
        self.program.initial_registers.len()
    }

    /// Registers that transitions, contracts and outputs read.
    pub(super) fn read_outside(&self) -> impl Iterator<Item = Register> {
        let contracts =
            self.program.contracts.iter().chain(self.program.states.iter().flat_map(|state| &state.contracts));
        let of_contracts = contracts.flat_map(|contract| {
            [Some(contract.violated), contract.lasting, contract.margin.map(|(register, _)| register)]
        });
        let of_states = self.program.states.iter().flat_map(|state| &state.transitions);
        self.program
            .always
            .iter()
            .chain(of_states)
            .flat_map(|transition| match transition.guard {
                Guard::When { truth, lasting, .. } => [Some(truth), lasting.map(|(duration, _)| duration)],
                Guard::After { time, .. } => [Some(time), None],
            })
            .chain(of_contracts)
            .flatten()
            .chain(self.read_by_outputs())
    }

    fn read_by_outputs(&self) -> impl Iterator<Item = Register> {
        let outputs = &self.program.outputs;
        let of_plots = outputs.plots.iter().flat_map(|plot| [plot.value, plot.number]);
        let of_messages = outputs.messages.iter().flat_map(|message| {
            let of_values = message.values.iter().flat_map(|value| (value.value..).take(value.kind.width()));
            of_values.chain([message.number])
        });
        of_plots.chain(of_messages)
    }

    /// For every operation, true if it is the target of a jump.
    pub(super) fn targets(&self) -> Vec<bool> {
        let mut is_target = vec![false; self.ops.len() + 1];
        for target in self.ops.iter().filter_map(|op| op.target()) {
            is_target[target as usize] = true;
        }
        is_target
    }

    /// The program without the removed operations.
    pub(super) fn finish(mut self) -> Program {
        // The new index of each operation. A removed operation has that of the next kept one.
        let mut indices = Vec::with_capacity(self.ops.len() + 1);
        let mut index = 0;
        for &is_kept in &self.is_kept {
            indices.push(index);
            index += u32::from(is_kept);
        }
        indices.push(index);
        let moved = |index: u32| indices[index as usize];
        let kept = self.ops.into_iter().zip(self.is_kept).filter(|(_, is_kept)| *is_kept);
        self.program.code = kept
            .map(|(mut op, _)| {
                if let Some(target) = op.target_mut() {
                    *target = moved(*target);
                }
                op
            })
            .collect();
        for block in blocks(&mut self.program) {
            *block = moved(block.start)..moved(block.end);
        }
        self.program.code.append(&mut self.start);
        self.program.start = index..u32::try_from(self.program.code.len()).unwrap_or(index);
        self.program
    }
}

/// Ranges of the code that are executed from start to end: all guards of a source together, and every other block
/// separately.
fn runs(program: &Program) -> Vec<std::ops::Range<usize>> {
    let of_target = |target: &Target| match target {
        Target::State { arguments, .. } => arguments.clone(),
        Target::Failure(_) | Target::Success(_) => 0..0,
    };
    let of_list = |list: &[Transition]| {
        let guards = list.first().zip(list.last());
        let guards = guards.map(|(first, last)| first.guard.code().start..last.guard.code().end);
        guards.into_iter().chain(list.iter().map(|one| of_target(&one.target))).collect::<Vec<Block>>()
    };
    let mut blocks = of_list(&program.always);
    blocks.extend(program.fallback.iter().map(of_target));
    blocks.extend(program.contracts.iter().map(|contract| contract.code.clone()));
    blocks.extend([&program.entry, &program.monitors, &program.body].map(Block::clone));
    for state in &program.states {
        blocks.extend(of_list(&state.transitions));
        blocks.extend([&state.entry, &state.body, &state.exit].map(Block::clone));
        blocks.extend(state.initial.iter().map(|(_, values)| values.clone()));
        blocks.extend(state.fallback.iter().map(of_target));
        blocks.extend(state.contracts.iter().map(|contract| contract.code.clone()));
    }
    blocks.retain(|block| !block.is_empty());
    blocks.sort_by_key(|block| block.start);
    blocks.into_iter().map(|block| block.start as usize..block.end as usize).collect()
}

/// All blocks of a program.
fn blocks(program: &mut Program) -> Vec<&mut Block> {
    fn of_target(target: &mut Target) -> Option<&mut Block> {
        match target {
            Target::State { arguments, .. } => Some(arguments),
            Target::Failure(_) | Target::Success(_) => None,
        }
    }
    fn of_list(list: &mut [Transition]) -> impl Iterator<Item = &mut Block> {
        list.iter_mut().flat_map(|Transition { guard, target }| {
            let (Guard::When { code, .. } | Guard::After { code, .. }) = guard;
            [Some(code), of_target(target)].into_iter().flatten()
        })
    }
    let mut blocks: Vec<&mut Block> = of_list(&mut program.always).collect();
    blocks.extend(program.fallback.as_mut().and_then(of_target));
    blocks.extend(program.contracts.iter_mut().map(|contract| &mut contract.code));
    blocks.extend([&mut program.entry, &mut program.monitors, &mut program.body]);
    for state in &mut program.states {
        blocks.extend(of_list(&mut state.transitions));
        blocks.extend([&mut state.entry, &mut state.body, &mut state.exit]);
        blocks.extend(state.initial.as_mut().map(|(_, values)| values));
        blocks.extend(state.fallback.as_mut().and_then(of_target));
        blocks.extend(state.contracts.iter_mut().map(|contract| &mut contract.code));
    }
    blocks
}
