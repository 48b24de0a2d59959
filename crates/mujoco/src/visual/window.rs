//! MuJoCo's window.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use mujoco_rs::viewer::{MjViewer, egui};

use crate::world::MujocoError;
use vibrissa_world::scene::Scene;

use super::camera::Camera;
use super::drawing::{Drawing, MOST_SEGMENTS};
use super::model::VisualModel;
use super::whole_message;

/// The reason why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// The drawn model cannot be built.
    #[error(transparent)]
    Model(#[from] MujocoError),
    /// The system has no desktop, or no OpenGL for it.
    #[error("the window cannot be opened ({0}); run on a desktop with OpenGL, or write a video with --video")]
    Open(String),
    /// A picture could not be drawn.
    #[error("the window cannot be drawn: {0}")]
    Draw(String),
}

/// The state of a window after a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// It is open.
    Open,
    /// It is open, and the user has paused it.
    Paused,
    /// The user has closed it.
    Closed,
}

/// MuJoCo's window with a scene. Its mouse and keys move the camera. The space bar pauses it.
pub struct Window {
    visual: VisualModel,
    viewer: MjViewer,
    is_paused: Arc<AtomicBool>,
}

impl Window {
    /// Opens the window. A process can do this once, on its main thread.
    ///
    /// # Errors
    /// [`WindowError`] if the model cannot be built, or if there is no desktop.
    pub fn open(scene: &Scene, camera: &Camera) -> Result<Self, WindowError> {
        let visual = VisualModel::new(scene, camera, [1, 1])?;
        let title = format!("Vibrissa: {}", scene.name);
        let builder = MjViewer::builder().window_name(title).max_user_geoms(MOST_SEGMENTS);
        let viewer = builder.build_passive(visual.model());
        let mut viewer = viewer.map_err(|error| WindowError::Open(whole_message(&error)))?;
        let is_paused = Arc::new(AtomicBool::new(false));
        let switch = Arc::clone(&is_paused);
        viewer.add_ui_callback(move |ui, _| {
            if ui.input(|input| input.key_pressed(egui::Key::Space)) {
                switch.fetch_xor(true, Ordering::Relaxed);
            }
        });
        Ok(Self { visual, viewer, is_paused })
    }

    /// Replaces what the window shows.
    pub fn set(&mut self, drawing: &Drawing) {
        self.visual.place(&drawing.body);
        self.viewer.sync_data(&mut self.visual.data);
        // Only a panic of another holder poisons the lock, and there is none.
        let _ = self.viewer.with_state_lock(|mut state| {
            state.user_scene_mut().clear_geom();
            drawing.draw(state.user_scene_mut());
        });
    }

    /// Draws it, and answers mouse and keys.
    ///
    /// # Errors
    /// [`WindowError::Draw`].
    pub fn draw(&mut self) -> Result<Shown, WindowError> {
        if !self.viewer.running() {
            return Ok(Shown::Closed);
        }
        self.viewer.render().map_err(|error| WindowError::Draw(whole_message(&error)))?;
        Ok(match (self.viewer.running(), self.is_paused.load(Ordering::Relaxed)) {
            (false, _) => Shown::Closed,
            (true, true) => Shown::Paused,
            (true, false) => Shown::Open,
        })
    }
}
