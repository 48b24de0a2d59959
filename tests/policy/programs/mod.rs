//! Whole random programs mean in a machine what they mean to a plain interpreter.

mod arithmetic;
mod evaluate;
mod explained;
mod filter;
mod generate;
mod grow;
mod interpreter;
mod side_by_side;
mod signal;
mod statement;
mod text;
mod tree;
mod work;

pub(crate) use generate::programs;
pub(crate) use side_by_side::{machine, scripts};
