//! The control loop in a world.

mod arrays;
mod hostile;
mod mapped;
mod mismatch;
mod stepped_run;
mod ticks;
mod true_tips;
mod way;
