//! The live page as a browser meets it: the real program and a real WebSocket.

mod access;
mod counterfactual;
mod foxglove;
mod frame;
mod run;
mod session;
