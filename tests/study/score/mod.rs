//! Scores against the exact geometry.

mod corners;
mod map_figures;
mod passage;
mod reach;
mod response;
mod retrieval;
#[expect(clippy::module_inception, reason = "the score as a whole")]
mod score;
mod united;
mod verdicts;
