//! What people and programs get to see of a run: the result, a table, a picture.

mod result;

pub use result::{ErrorMm, Hashes, Identity, MeanStd, Retrieval, RunResult, TickUs};
