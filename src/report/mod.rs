//! What people and programs get to see of a run: the result, a table, a picture; and of a policy: its statechart.

mod chart;
mod document;
mod number;
mod outline;
mod picture;
mod result;
mod results_table;
mod shade;
mod style;
mod table;
mod tick_line;

pub use chart::{ChartTooLarge, chart_dot, chart_mermaid, chart_svg};
pub use document::{Document, Versioned};
pub use picture::{picture, profile_picture};
pub use result::{
    Collisions, Corners, ErrorMm, Failsafes, Hashes, Identity, MeanP95Max, MeanStd, MeanStdMax, Passage, Retrieval,
    RunResult, TickUs, TipErrorMm,
};
pub use results_table::results_table;
pub use table::Table;
pub use tick_line::{TickLine, tick_lines};

pub(crate) use number::{mean_std, millimetres};
pub(crate) use picture::{FrontPoint, front_picture};
pub(crate) use table::{NONE, percent};
