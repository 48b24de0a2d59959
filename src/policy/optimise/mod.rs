//! Shorter code of the same meaning, to the last bit.
//!
//! Lowering writes every law and derived value where it is used, as plainly as it can, and the analysis reads that. What runs
//! need not ask twice for what it knows (`reuse`), compute what nothing reads (`dead`), compute in every tick what parameters
//! fix for a whole run (`invariant`), or take several operations where one says the same (`fuse`, `jumps`).
//!
//! All of them rely on this: jumps lead ahead within their block, so that walking a block from its start sees every write
//! before the reads that it can reach; and no register is read before the code that belongs to it has written it.

mod dead;
mod draft;
mod fuse;
mod invariant;
mod jumps;
mod reuse;

use vibrissa_runtime::machine::{Operands, Program};

use draft::Draft;

/// The same program with less to do in a tick.
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
