//! Run time against error: settings of a scene's world and of its perception, what each costs and what it is worth.

mod front;
mod measure;
mod row;
mod setting;

pub use front::front;
pub use measure::measure;
pub use row::{Front, Pareto, ParetoRow};
pub use setting::{Change, Setting};
