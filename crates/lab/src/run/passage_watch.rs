//! The progress of a platform through a tunnel.

use vibrissa_world::geometry::{Pose, TunnelAxis};

/// Measures the longest passage through a tunnel, in either direction.
#[derive(Debug)]
pub struct PassageWatch {
    axis: TunnelAxis,
    /// The current stretch of the axis, if the platform is between the walls.
    stretch: Option<Stretch>,
    /// Length (m) of the longest stretch.
    longest: f64,
}

/// A stretch of the axis along which the platform remained between the walls. On a closed axis, arc lengths count the rounds.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    /// The smallest, the largest and the newest arc length (m).
    least: f64,
    greatest: f64,
    newest: f64,
}

impl PassageWatch {
    /// A passage that has not begun.
    #[must_use]
    pub fn new(axis: &TunnelAxis) -> Self {
        Self { axis: axis.clone(), stretch: None, longest: 0.0 }
    }

    /// Adds the next pose of the platform (world frame).
    pub fn add(&mut self, body: &Pose) {
        let line = self.axis.line();
        let along = self.axis.arc_length_between(body.position).filter(|_| body.is_finite());
        self.stretch = along.map(|along| match self.stretch {
            None => Stretch { least: along, greatest: along, newest: along },
            Some(Stretch { least, greatest, newest }) => {
                let mut step = along - newest;
                if line.is_closed() {
                    step -= line.length() * (step / line.length()).round();
                }
                let along = newest + step;
                Stretch { least: least.min(along), greatest: greatest.max(along), newest: along }
            }
        });
        if let Some(Stretch { least, greatest, .. }) = self.stretch {
            self.longest = self.longest.max(greatest - least);
        }
    }

    /// The longest stretch of the axis along which the platform's centre of mass remained between the walls, as a share of
    /// the axis's length (0 to 1).
    #[must_use]
    pub fn share(&self) -> f64 {
        (self.longest / self.axis.line().length()).min(1.0)
    }
}
