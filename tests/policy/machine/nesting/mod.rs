//! States in states: what they mean, by example and against an interpreter of their own.

mod claims;
mod cycles;
mod interpreter;
mod oracle;
mod tree;
