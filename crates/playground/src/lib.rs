//! The playground's machine: texts in, frames and figures out.
//!
//! The page holds it as WebAssembly in a worker. Both sides exchange JSON texts in the memory of the module, so that neither needs
//! generated code. [`Playground::answer`] is the whole interface, and `export` the doors to it.
//!
//! A new request is a variant in `request.rs` with its answer in `playground.rs`. The texts of lessons and shapes are in the files of
//! these names. The page itself is `web/src/playground`.

mod export;
mod lessons;
mod playground;
mod request;
mod shapes;
mod simulation;

pub use playground::Playground;
