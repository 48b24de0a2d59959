//! What editors are told of the places in a policy.

mod any_text;
mod behaviour;
mod candidate;
mod definition;
mod hover;
mod policies;
mod rename;
mod state_candidate;
