//! What people and programs get to see of a run: the result, a table, a picture.

mod number;
mod picture;
mod result;
mod table;

pub use picture::picture;
pub use result::{ErrorMm, Hashes, Identity, MeanStd, Retrieval, RunResult, TickUs};
pub use table::table;
