//! What holds for every contour, tried on thousands of random ones.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod distance;
mod measure;
mod motion;
mod offset;
mod oracle;
mod random;
mod set;
mod simple;
