//! What the laws of the standard library command, and that a left whisker is a right one in a mirror.

mod felt;
mod guard;
mod law;
mod mirror;
mod mounting;
mod platform;
mod retrieval;
mod swiping;
