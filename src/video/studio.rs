//! Draws a film, and encodes it.

use vibrissa_lab::run::Trace;
use vibrissa_mujoco::visual::{Camera, OffscreenRenderer, top};
use vibrissa_world::scene::Scene;

use super::encoder::Encoder;
use super::error::VideoError;
use super::film::{Film, MOST_FRAMES};
use super::settings::{Format, Settings};
use super::sketch::{Sketch, area};

/// Makes the video of one run.
///
/// It is set up before the run, so that a missing program or driver costs no simulation.
pub struct Studio {
    settings: Settings,
    encoder: Encoder,
}

impl Studio {
    /// Checks that a video of the scene can be made.
    ///
    /// # Errors
    /// [`VideoError`] if OpenGL or ffmpeg is missing.
    pub fn new(scene: &Scene, format: Format, settings: Settings) -> Result<Self, VideoError> {
        let camera = Camera::around(&area(scene, [&scene.start]), top(&scene.physics), aspect(&settings));
        // OpenGL belongs to a thread, and the run may use it for other things, so that it is opened again later.
        OffscreenRenderer::new(scene, &camera, settings.size)?;
        Ok(Self { settings, encoder: Encoder::new(format, &settings)? })
    }

    /// The camera of a film: the nearest one that shows the whole run.
    #[must_use]
    pub fn camera(&self, scene: &Scene, film: &Film) -> Camera {
        Camera::around(&area(scene, film.bodies()), top(&scene.physics), aspect(&self.settings))
    }

    /// The content of the video's file. `progress` receives the number of finished frames and of all frames.
    ///
    /// # Errors
    /// [`VideoError`] if the film is empty or too long, or if a frame cannot be drawn or encoded.
    pub fn develop(
        mut self,
        scene: &Scene,
        film: &Film,
        trace: &Trace,
        mut progress: impl FnMut(usize, usize),
    ) -> Result<Vec<u8>, VideoError> {
        let frames = film.frames();
        let count = frames.len();
        if count > MOST_FRAMES {
            return Err(VideoError::TooLong { frames: count, most: MOST_FRAMES });
        }
        let camera = self.camera(scene, film);
        let mut renderer = OffscreenRenderer::new(scene, &camera, self.settings.size)?;
        // The last frame has the colours of all trails.
        let last = frames.last().ok_or(VideoError::Empty)?;
        let mut whole = Sketch::new(scene);
        for (tick, body) in film.bodies().iter().enumerate() {
            whole.add(trace, tick, body);
        }
        self.encoder.sample(renderer.picture(&whole.drawing(&last.posture))?);

        let mut sketch = Sketch::new(scene);
        let mut bodies = film.bodies().iter().enumerate().peekable();
        for (frame, shot) in frames.into_iter().enumerate() {
            while let Some((tick, body)) = bodies.next_if(|(tick, _)| *tick <= shot.tick) {
                sketch.add(trace, tick, body);
            }
            self.encoder.add(renderer.picture(&sketch.drawing(&shot.posture))?)?;
            progress(frame + 1, count);
        }
        self.encoder.finish()
    }
}

fn aspect(settings: &Settings) -> f64 {
    let [width, height] = settings.size.map(f64::from);
    width / height
}
