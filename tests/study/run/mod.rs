//! The control loop in a world.

mod hostile;
mod ticks;
mod true_tips;
mod way;
