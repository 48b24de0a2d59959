//! A plant without objects.

use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::math;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

use super::plant::{Plant, PlantFault, PlantState};

/// A platform that follows every command at once. Something sways its whiskers once it has moved. It serves for tests
/// of the loop, which need no mechanics.
#[derive(Debug, Clone)]
pub struct SwayingPlant {
    state: PlantState,
    period: f64,
    time: f64,
    travelled: f64,
}

/// Largest base moment (N m) and the frequency (Hz) of the swaying.
const MOMENT: f64 = 200e-6;
const FREQUENCY: f64 = 0.7;
/// Distance (m) after which it begins.
const REST: f64 = 0.01;

impl SwayingPlant {
    /// A plant at the origin, with this sample period (s).
    #[must_use]
    pub fn new(period: f64) -> Self {
        let pose = Pose { position: Point2::origin(), heading: 0.0 };
        let state = PlantState { pose, base_moments: [0.0; MAX_WHISKERS] };
        Self { state, period, time: 0.0, travelled: 0.0 }
    }
}

impl Plant for SwayingPlant {
    fn start(&self) -> PlantState {
        self.state
    }

    fn advance(&mut self, command: &Command) -> Result<PlantState, PlantFault> {
        self.time += self.period;
        self.travelled += command.velocity_world.norm() * self.period;
        self.state.pose.position += command.velocity_world * self.period;
        self.state.pose.heading += command.yaw_rate * self.period;
        let amplitude = if self.travelled > REST { MOMENT } else { 0.0 };
        for (moment, phase) in self.state.base_moments.iter_mut().zip(0_u8..) {
            *moment = amplitude * math::sin(std::f64::consts::TAU * FREQUENCY * self.time + f64::from(phase));
        }
        Ok(self.state)
    }
}
