//! The figures of a run: their names, units, meanings, and where they are shown. `lab` computes their values.

mod figure;
mod group;
#[cfg(test)]
mod pages;
mod table;

pub use figure::{Better, Bound, Cell, Column, Compared, Figure, Kind};
pub use group::{GROUPS, Group};
pub use table::{FIGURES, Metric};
