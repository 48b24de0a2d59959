//! Studies over many trials.

mod bench;
mod compare;
mod estimators;
mod pareto;
mod worlds;
