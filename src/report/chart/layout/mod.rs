//! A layout in layers, after Sugiyama, Tagawa and Toda (1981): every arrow leads from layer to layer, and its label stands in a
//! layer of labels between, as a node would. So nothing can lie on anything, whatever the chart.

mod net;
mod order;
mod rank;
mod settle;

pub(super) use net::layout;
pub(super) use rank::ranks;

/// A size: width, height (px).
pub(super) type Size = (f64, f64);

/// A place: to the right, down (px).
pub(super) type Place = (f64, f64);

/// An edge of all that is laid out, where arrows come in and go out.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    Top,
    Bottom,
}

/// A box that arrows lead to and leave from, or a place at an edge.
#[derive(Clone, Copy)]
pub(super) struct Node {
    /// The edge at which it is; what is at the top and has a size comes first there, on the left.
    pub(super) edge: Option<Edge>,
    /// Its size; it may come out wider, so that its arrows have room.
    pub(super) size: Size,
    /// The room beside it, to the right, for arrows to itself and their label; zero if there are none.
    pub(super) beside: Size,
}

/// An arrow from one node to another.
#[derive(Clone, Copy)]
pub(super) struct Arrow {
    /// Index of the node that it leaves.
    pub(super) from: usize,
    /// Index of another node, that it leads to.
    pub(super) to: usize,
    /// The size of its label; zero if it has none.
    pub(super) label: Size,
    /// Where it leaves and where it reaches its nodes, to the right of their axes (px), if that is given.
    pub(super) ports: [Option<f64>; 2],
}

/// Where everything is; the upper left corner of all is the origin.
pub(super) struct Layout {
    /// The centre and the width of each node.
    pub(super) nodes: Vec<(Place, f64)>,
    /// Each arrow's way.
    pub(super) ways: Vec<Way>,
    /// The size of all.
    pub(super) size: Size,
}

/// The way of an arrow.
pub(super) struct Way {
    /// Where it goes through, from its start to its end. It leaves and reaches every point vertically.
    pub(super) points: Vec<Place>,
    /// The centre of its label.
    pub(super) label: Place,
}
