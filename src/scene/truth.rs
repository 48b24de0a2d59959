//! The exact geometry of a scene.

use crate::geometry::{Contour, ContourSet, TunnelAxis};

/// The exact geometry against which a run is scored (world frame).
#[derive(Debug, Clone)]
pub struct Truth {
    /// The outlines of all solids. The error of an estimate is its distance from the nearest.
    pub surfaces: ContourSet,
    /// The reference for coverage and Hausdorff distance: the outline of a plain object, or the inner sides of a
    /// tunnel.
    pub reference: ContourSet,
    /// The centre lines of tunnels, for the baseline's axis error (section 5.3).
    pub axes: Vec<TunnelAxis>,
}

impl From<Contour> for Truth {
    /// The geometry of a single plain object.
    fn from(outline: Contour) -> Self {
        let surfaces = ContourSet::from(outline);
        Self { reference: surfaces.clone(), surfaces, axes: Vec::new() }
    }
}
