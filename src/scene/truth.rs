//! What a run is measured against.

use crate::geometry::{Contour, ContourSet, TunnelAxis};

/// The exact geometry that the estimates of a run are measured against, in world coordinates.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The outlines of all solids: the error of an estimate is its distance from the nearest of them.
    pub surfaces: ContourSet,
    /// What there is to be traced, for coverage and the Hausdorff distance: the outline of a plain object, the inner sides of
    /// a tunnel's walls.
    pub reference: ContourSet,
    /// The lines in the middle of tunnels, for the thesis's axis error (section 5.3).
    pub axes: Vec<TunnelAxis>,
}

impl From<Contour> for Truth {
    /// The truth about a single plain object.
    fn from(outline: Contour) -> Self {
        let surfaces = ContourSet::from(outline);
        Self { reference: surfaces.clone(), surfaces, axes: Vec::new() }
    }
}
