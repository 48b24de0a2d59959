//! A layered layout after Sugiyama, Tagawa and Toda (1981). Every arrow leads from layer to layer. Its label is in a
//! layer of labels between them, like a node. Therefore no two elements overlap.
//!
//! Why: docs/decisions/reports.md#the-statechart-layout-is-our-own.

mod net;
mod order;
mod rank;
mod settle;

pub(super) use net::layout;
pub(super) use rank::ranks;

/// A size: width, height (px).
pub(super) type Size = (f64, f64);

/// A position: to the right, down (px).
pub(super) type Position = (f64, f64);

/// A side of the layout at which arrows enter and leave.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    Top,
    Bottom,
}

/// A box with arrows, or a point at a side of the layout.
#[derive(Clone, Copy)]
pub(super) struct Node {
    /// The side of the layout at which it is. A node at the top with a size is the leftmost there.
    pub(super) edge: Option<Edge>,
    /// Its size. The layout may increase its width for its arrows.
    pub(super) size: Size,
    /// The space to the right for arrows from the node to itself and their label. Zero if there are none.
    pub(super) beside: Size,
}

/// An arrow from one node to another.
#[derive(Clone, Copy)]
pub(super) struct Arrow {
    /// Index of the node at its start.
    pub(super) from: usize,
    /// Index of the node at its end, another one.
    pub(super) to: usize,
    /// The size of its label. Zero without a label.
    pub(super) label: Size,
    /// Given offsets of its start and its end from the axes of its nodes, to the right positive (px).
    pub(super) ports: [Option<f64>; 2],
}

/// Positions of all nodes and arrows. The origin is the upper left corner.
pub(super) struct Layout {
    /// The centre and the width of each node.
    pub(super) nodes: Vec<(Position, f64)>,
    /// The path of each arrow.
    pub(super) routes: Vec<Route>,
    /// The size of the layout.
    pub(super) size: Size,
}

/// The path of an arrow.
pub(super) struct Route {
    /// The points of the path from its start to its end. It is vertical at every point.
    pub(super) points: Vec<Position>,
    /// The centre of its label.
    pub(super) label: Position,
}
