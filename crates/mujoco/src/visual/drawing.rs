//! What is drawn beside the model.

use mujoco_rs::mujoco_c::mjtGeom;
use mujoco_rs::wrappers::mj_visualization::MjvScene;
use nalgebra::Point3;

use vibrissa_world::geometry::Pose;

/// The capacity of a scene in segments.
pub(super) const MOST_SEGMENTS: usize = 20_000;

/// A moment of a run.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// The pose of the platform (world frame).
    pub body: Pose,
    /// The strokes. Segments beyond the first 20,000 are left out.
    pub strokes: Vec<Stroke>,
}

/// A line through points.
#[derive(Debug, Clone)]
pub struct Stroke {
    /// The points (m, world frame).
    pub points: Vec<Point3<f64>>,
    /// Red, green, blue and opacity, from 0 to 1.
    pub colour: [f32; 4],
    /// Width (px).
    pub width: f64,
}

impl Drawing {
    /// Adds the strokes to a scene.
    pub(super) fn draw(&self, scene: &mut MjvScene) {
        let segments = self
            .strokes
            .iter()
            .flat_map(|stroke| stroke.points.windows(2).map(move |ends| (ends, stroke.colour, stroke.width)));
        for (ends, colour, width) in segments {
            let [from, to] = ends else { continue };
            #[expect(unsafe_code, reason = "a geom may have numbers of materials and textures")]
            // SAFETY: `try_create_geom` sets the numbers of material, texture and object to none, and nothing changes them.
            let line = unsafe { scene.try_create_geom(mjtGeom::mjGEOM_LINE, None, None, None, Some(colour)) };
            let Ok(line) = line else { return };
            line.connect(width, from.coords.into(), to.coords.into());
        }
    }
}
