//! Pictures without a window.

use mujoco_rs::wrappers::mj_rendering::{MjrContext, MjrRectangle};
use mujoco_rs::wrappers::mj_visualization::{MjtCamera, MjvCamera, MjvOption, MjvPerturb, MjvScene};

use crate::world::MujocoError;
use vibrissa_world::scene::Scene;

use super::camera::Camera;
use super::drawing::{Drawing, MOST_SEGMENTS};
use super::egl::Context;
use super::model::VisualModel;

/// Capacity of a scene for what MuJoCo adds to the geoms of its model.
const OF_MUJOCO: usize = 100;
/// Bytes of a pixel: red, green and blue.
const PIXEL: usize = 3;

/// The reason why no picture can be drawn.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The drawn model cannot be built.
    #[error(transparent)]
    Model(#[from] MujocoError),
    /// The system has no OpenGL without a window.
    #[error(
        "OpenGL without a window is not available ({0}); install EGL with a driver, on Debian and Ubuntu the packages libegl1, libgl1 and \
         libgl1-mesa-dri"
    )]
    NoContext(String),
    /// A picture could not be drawn or read.
    #[error("a picture could not be drawn: {0}")]
    Draw(String),
}

/// Draws pictures of a scene into memory.
pub struct OffscreenRenderer {
    visual: VisualModel,
    camera: MjvCamera,
    scene: MjvScene,
    /// What MuJoCo keeps in OpenGL.
    drawn: MjrContext,
    context: Context,
    /// Width and height (px).
    area: MjrRectangle,
    /// Rows from the bottom, as OpenGL gives them, and rows from the top.
    pixels: [Vec<u8>; 2],
}

impl OffscreenRenderer {
    /// Opens OpenGL on the calling thread, for pictures of this width and height (px).
    ///
    /// # Errors
    /// [`RenderError`] if the model cannot be built, or if there is no OpenGL.
    pub fn new(scene: &Scene, camera: &Camera, size: [u32; 2]) -> Result<Self, RenderError> {
        let visual = VisualModel::new(scene, camera, size)?;
        let context = Context::open().map_err(RenderError::NoContext)?;
        #[expect(unsafe_code, reason = "MuJoCo draws into the context that is current")]
        // SAFETY: `context` is current on this thread. It is dropped after `drawn`, whose model never changes.
        let mut drawn = unsafe { MjrContext::new(visual.model()) };
        drawn.offscreen();
        let geoms = usize::try_from(visual.model().ffi().ngeom).unwrap_or(0);
        let scene = MjvScene::new(visual.model(), geoms + OF_MUJOCO + MOST_SEGMENTS);
        let [elevation, azimuth] = Camera::angles_deg();
        let camera = MjvCamera {
            type_: MjtCamera::mjCAMERA_FREE as i32,
            lookat: camera.looks_at.coords.into(),
            distance: camera.distance(),
            azimuth,
            elevation,
            ..MjvCamera::default()
        };
        let [width, height] = size.map(|side| i32::try_from(side).unwrap_or(i32::MAX));
        let bytes = size.iter().fold(PIXEL, |bytes, side| bytes.saturating_mul(*side as usize));
        let pixels = [vec![0; bytes], Vec::with_capacity(bytes)];
        Ok(Self { visual, camera, scene, drawn, context, area: MjrRectangle::new(0, 0, width, height), pixels })
    }

    /// Draws a picture: red, green and blue of every pixel, row by row from the top left.
    ///
    /// # Errors
    /// [`RenderError::Draw`].
    pub fn picture(&mut self, drawing: &Drawing) -> Result<&[u8], RenderError> {
        self.context.make_current().map_err(RenderError::Draw)?;
        self.visual.place(&drawing.body);
        let (option, perturbation) = (MjvOption::default(), MjvPerturb::default());
        self.scene.update(&mut self.visual.data, &option, &perturbation, &mut self.camera);
        drawing.draw(&mut self.scene);
        self.scene.render(&self.area, &self.drawn);
        let [from_below, from_above] = &mut self.pixels;
        let read = self.drawn.read_pixels(Some(from_below), None, &self.area);
        read.map_err(|error| RenderError::Draw(error.to_string()))?;
        from_above.clear();
        let row = PIXEL * usize::try_from(self.area.width).unwrap_or(0).max(1);
        from_below.rchunks_exact(row).for_each(|row| from_above.extend_from_slice(row));
        Ok(from_above)
    }
}

impl Drop for OffscreenRenderer {
    fn drop(&mut self) {
        // MuJoCo frees what it keeps in the current context. Without it, the process keeps that until its end.
        let _ = self.context.make_current();
    }
}
