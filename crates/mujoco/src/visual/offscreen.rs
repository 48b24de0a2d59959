//! Pictures without a window.

use mujoco_rs::renderer::{MjRenderer, RendererError};
use mujoco_rs::wrappers::mj_visualization::{MjtCamera, MjvCamera};

use crate::world::MujocoError;
use vibrissa_world::scene::Scene;

use super::camera::Camera;
use super::drawing::{Drawing, MOST_SEGMENTS};
use super::model::VisualModel;
use super::whole_message;

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
pub(crate) struct OffscreenRenderer {
    visual: VisualModel,
    renderer: MjRenderer,
}

impl OffscreenRenderer {
    /// Opens OpenGL on the calling thread, for pictures of this width and height (px).
    ///
    /// # Errors
    /// [`RenderError`] if the model cannot be built, or if there is no OpenGL.
    pub(crate) fn new(scene: &Scene, camera: &Camera, [width, height]: [u32; 2]) -> Result<Self, RenderError> {
        let visual = VisualModel::new(scene, camera, [width, height])?;
        let [elevation, azimuth] = Camera::angles_deg();
        let camera = MjvCamera {
            type_: MjtCamera::mjCAMERA_FREE as i32,
            lookat: camera.looks_at.coords.into(),
            distance: camera.distance(),
            azimuth,
            elevation,
            ..MjvCamera::default()
        };
        let builder = MjRenderer::builder().width(width).height(height).camera(camera);
        let capacity = u32::try_from(MOST_SEGMENTS).unwrap_or(u32::MAX);
        let renderer = builder.num_visual_user_geom(capacity).build(visual.model());
        let renderer = renderer.map_err(|error| match error {
            RendererError::GlutinError(_) => RenderError::NoContext(whole_message(&error)),
            _ => RenderError::Draw(whole_message(&error)),
        })?;
        Ok(Self { visual, renderer })
    }

    /// Draws a picture: red, green and blue of every pixel, row by row from the top left.
    ///
    /// # Errors
    /// [`RenderError::Draw`].
    pub(crate) fn picture(&mut self, drawing: &Drawing) -> Result<&[u8], RenderError> {
        let failed = |error: &dyn std::error::Error| RenderError::Draw(whole_message(error));
        self.visual.place(&drawing.body);
        drawing.draw(self.renderer.user_scene_mut());
        self.renderer.sync_data(&mut self.visual.data).map_err(|error| failed(&error))?;
        self.renderer.render().map_err(|error| failed(&error))?;
        self.renderer.rgb_flat().ok_or_else(|| RenderError::Draw("it has no colours".to_owned()))
    }
}
