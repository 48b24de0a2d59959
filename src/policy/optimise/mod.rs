//! The optimiser. Its results are bit-identical to those of the original program.
//!
//! Lowering inlines every law and derived value without optimisation, and the analysis reads that code. The passes here
//! eliminate common subexpressions (`common_subexpression`) and dead code (`dead_code`), hoist invariants of a run (`run_invariant`), fuse
//! operations (`fusion`) and shorten jumps (`jump_threading`).
//!
//! All passes rely on two properties. Jumps lead forward within their block, so a walk from its start sees every write
//! before the reads that it can reach. No register is read before the code to which it belongs has written it.
//!
//! Why: docs/decisions/compiler.md#the-optimiser-keeps-results-bit-identical.

mod common_subexpression;
mod dead_code;
mod draft;
mod fusion;
mod jump_threading;
mod run_invariant;

use vibrissa_runtime::machine::{Operands, Program};

use draft::Draft;

/// The program with fewer operations per tick.
pub(super) fn optimise(program: Program) -> Program {
    let mut draft = Draft::new(program);
    common_subexpression::eliminate(&mut draft);
    let operands: Vec<Operands> = draft.ops.iter().map(|op| op.operands()).collect();
    let reads = dead_code::remove(&mut draft, &operands);
    run_invariant::hoist(&mut draft, &operands);
    fusion::fuse(&mut draft, &reads);
    jump_threading::thread(&mut draft);
    draft.finish()
}
