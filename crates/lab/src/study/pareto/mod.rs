//! Run time against error over the settings of a scene's world and of its perception.

mod front;
mod measure;
mod row;
mod setting;

pub use front::front;
pub use measure::measure;
pub use row::{Front, Pareto, ParetoRow};
pub use setting::{Change, Setting};
