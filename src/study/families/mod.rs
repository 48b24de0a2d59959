//! Families of scenes under a policy: what completes, and what does not.

mod run;
mod table;
mod tally;

pub use run::FamilyRun;
pub use table::families_table;
pub use tally::FamilyTally;
