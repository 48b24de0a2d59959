//! A policy's statechart: as a picture, and as text for Mermaid and for Graphviz.

mod caption;
mod dot;
mod label;
mod layout;
mod lines;
mod mermaid;
mod nest;
mod svg;
mod symbol;
mod wrap;

pub use dot::chart_dot;
pub use mermaid::chart_mermaid;
pub use svg::{ChartTooLarge, chart_svg};
