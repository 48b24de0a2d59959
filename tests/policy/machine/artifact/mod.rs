//! Artifacts: what comes back, and what does not get in.

mod damage;
mod erratic;
mod fixture;
mod format;
mod policies;
mod round_trip;
mod unsound;
