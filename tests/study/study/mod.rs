//! Studies over many trials.

mod bench;
mod compare;
mod estimators;
mod latency;
mod pareto;
mod worlds;
