//! A layout in layers, after Sugiyama, Tagawa and Toda (1981): every arrow leads from layer to layer, and its label stands in a
//! layer of labels between, as a node would. So nothing can lie on anything, whatever the chart.

mod net;
mod order;
mod rank;
mod settle;

pub(super) use net::layout;

/// A size: width, height (px).
pub(super) type Size = (f64, f64);

/// A place: to the right, down (px).
pub(super) type Place = (f64, f64);

/// A box that arrows lead to and leave from.
#[derive(Clone, Copy)]
pub(super) struct Node {
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
