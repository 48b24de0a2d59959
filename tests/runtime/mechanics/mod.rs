//! The elastica against closed solutions, against the chain, and against what holds of every equilibrium.

mod closed_form;
mod equilibria;
mod fine_chain;
mod locate;
mod whisker;
