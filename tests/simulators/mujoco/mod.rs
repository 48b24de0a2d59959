//! The MuJoCo world, its model and its pruning.

#[cfg(feature = "sim")]
mod cable;
mod explain;
#[cfg(feature = "sim")]
mod first_mode;
#[cfg(feature = "sim")]
mod friction;
#[cfg(feature = "sim")]
mod pruning;
#[cfg(feature = "sim")]
mod seams;
#[cfg(feature = "sim")]
mod spatial;
#[cfg(feature = "sim")]
mod stability;
#[cfg(feature = "sim")]
mod world;
