//! The control loop in a world.

mod hostile;
mod ticks;
mod way;
