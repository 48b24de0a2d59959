//! Tests of the store.
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::disallowed_methods,
    reason = "a test may panic, and it makes files that the store must refuse"
)]

mod claims;
mod crash;
mod damage;
mod fixture;
mod interrupted_disk;
mod pushing;
mod receiving;
mod roles;
mod sequences;
mod simulated_disk;
