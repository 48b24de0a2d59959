//! The optimiser. Its results are bit-identical to those of the original program.
//!
//! Lowering inlines every law and derived value without optimisation, and the analysis reads that code. The passes here
//! eliminate common subexpressions (`reuse`) and dead code (`dead`), hoist invariants of a run (`invariant`), fuse
//! operations (`fuse`) and shorten jumps (`jumps`).
//!
//! All passes rely on two properties. Jumps lead forward within their block, so a walk from its start sees every write
//! before the reads that it can reach. No register is read before the code to which it belongs has written it.

mod dead;
mod draft;
mod fuse;
mod invariant;
mod jumps;
mod reuse;

use vibrissa_runtime::machine::{Operands, Program};

use draft::Draft;

/// The program with fewer operations per tick.
pub(super) fn optimise(program: Program) -> Program {
    let mut draft = Draft::new(program);
    reuse::reuse(&mut draft);
    let operands: Vec<Operands> = draft.ops.iter().map(|op| op.operands()).collect();
    let reads = dead::remove(&mut draft, &operands);
    invariant::hoist(&mut draft, &operands);
    fuse::fuse(&mut draft, &reads);
    jumps::shorten(&mut draft);
    draft.finish()
}
