//! A window that shows a run in real time.

use std::thread::sleep;
use std::time::{Duration, Instant};

use vibrissa_runtime::machine::Observer;

use vibrissa_lab::run::{Trace, Watcher};
use vibrissa_mujoco::visual::{Camera, Shown, Window, WindowError, top};
use vibrissa_world::scene::Scene;
use vibrissa_world::world::World;

use super::sketch::{Sketch, area};

/// Width of the window over its height.
const ASPECT: f64 = 16.0 / 9.0;
/// Time between two pictures while the run waits for the clock.
const REFRESH: Duration = Duration::from_millis(15);
/// A run that is slower than real time shows a picture at the first tick after this time.
const SLOWEST: Duration = Duration::from_millis(100);

/// Shows a run in real time. The run waits while the window is paused, and goes on without the window if it is closed.
pub struct RunWindow {
    window: Option<Window>,
    sketch: Sketch,
    /// The clock time of the simulated time 0. `None` before the first tick.
    start: Option<Instant>,
    last_picture: Instant,
    failure: Option<WindowError>,
}

impl RunWindow {
    /// Opens the window of a scene. A process can do this once, on its main thread.
    ///
    /// # Errors
    /// [`WindowError`] if there is no desktop.
    pub fn open(scene: &Scene) -> Result<Self, WindowError> {
        let camera = Camera::around(&area(scene, [&scene.start]), top(&scene.physics), ASPECT);
        let window = Window::open(scene, &camera)?;
        let sketch = Sketch::new(scene);
        Ok(Self { window: Some(window), sketch, start: None, last_picture: Instant::now(), failure: None })
    }

    /// Closes the window after the run.
    ///
    /// # Errors
    /// [`WindowError`] if it could not be drawn to the end of the run.
    pub fn close(self) -> Result<(), WindowError> {
        self.failure.map_or(Ok(()), Err)
    }

    /// Shows the window until this simulated time (s). Returns false if the window is gone.
    fn show_until(&mut self, time: f64) -> Result<bool, WindowError> {
        let Some(window) = &mut self.window else { return Ok(false) };
        let time = Duration::try_from_secs_f64(time).unwrap_or_default();
        let mut start = *self.start.get_or_insert_with(Instant::now);
        loop {
            let before = Instant::now();
            let shown = window.draw()?;
            self.last_picture = Instant::now();
            match shown {
                Shown::Closed => return Ok(false),
                Shown::Paused => {
                    sleep(REFRESH);
                    start += before.elapsed();
                }
                Shown::Open => {
                    let left = time.saturating_sub(start.elapsed());
                    if left.is_zero() {
                        // A run that was slow goes on in real time, not faster.
                        let is_behind = start.elapsed().saturating_sub(time) > SLOWEST;
                        start = Instant::now().checked_sub(time).filter(|_| is_behind).unwrap_or(start);
                        break;
                    }
                    sleep(left.min(REFRESH));
                }
            }
        }
        self.start = Some(start);
        Ok(true)
    }
}

impl Observer for RunWindow {}

impl Watcher for RunWindow {
    fn in_world(&mut self, trace: &Trace, world: &dyn World) {
        let (Some(window), Some(posture)) = (&mut self.window, world.posture()) else { return };
        self.sketch.add(trace, trace.ticks.len().saturating_sub(1), &posture.body);
        let time = trace.ticks.last().map_or(0.0, |tick| tick.time);
        let is_late = self.start.is_some_and(|start| start.elapsed().as_secs_f64() > time);
        if is_late && self.last_picture.elapsed() < SLOWEST {
            return;
        }
        window.set(&self.sketch.drawing(&posture));
        match self.show_until(time) {
            Ok(true) => {}
            Ok(false) => self.window = None,
            Err(failure) => (self.window, self.failure) = (None, Some(failure)),
        }
    }
}
