//! The reader of inputs, in the controller.

use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use rtrb::Producer;

use super::inputs::{Inputs, Session};
use crate::array::{Round, StampedPose, period_ns};
use crate::config::{Config, ConfigError};
use crate::drive::StepTime;
use crate::link::{Order, Place, SenderClock};
use crate::sensor::SensorModel;
use crate::vitals::Vitals;

/// Reads inputs and passes them to the control task. It repeats the decoding of the driver.
#[derive(Debug)]
pub struct InputReader {
    sensor: SensorModel,
    /// The whiskers of each bus.
    whiskers: Vec<Vec<usize>>,
    sample_period_ns: u64,
    rates: [f64; 2],
    session: Option<Session>,
    order: Order,
    clock: SenderClock,
    rounds: Vec<Producer<Round>>,
    poses: Producer<StampedPose>,
    steps: SyncSender<StepTime>,
    vitals: Arc<Vitals>,
}

/// Inputs that the controller cannot use. It must end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InputsError {
    /// The message has another form.
    #[error("the inputs of the sensor IO cannot be read: {0}; use the same version of the program on both computers")]
    Unreadable(String),
    /// The sensor IO has other rates.
    #[error(
        "the sensor IO has a sample rate of {} Hz and a control rate of {} Hz, and the controller {} Hz and {} Hz; use the same \
         configuration on both computers",
        sensor_io[0], sensor_io[1], controller[0], controller[1]
    )]
    Rates {
        /// Sample rate and control rate of the sensor IO (Hz).
        sensor_io: [f64; 2],
        /// Those of the controller (Hz).
        controller: [f64; 2],
    },
    /// The sensor IO has another array, or other settings of its sensors.
    #[error(
        "the sensor IO has another array or other settings of its sensors; use the same configuration on both computers"
    )]
    Array,
    /// The sensor IO has been started again, so its neutral values and its times begin anew.
    #[error("the sensor IO has been started again; start the controller again too")]
    Session,
}

/// The configuration of the controller. Samples and poses arrive once per control period, so their timeouts are longer by
/// that.
#[must_use]
pub fn controller_config(config: &Config) -> Config {
    let mut config = config.clone();
    let period = config.rig.sensing.control_rate.recip();
    for timeout in [&mut config.timeouts.bus, &mut config.timeouts.sensor, &mut config.timeouts.pose] {
        *timeout += period;
    }
    config
}

impl InputReader {
    /// The reader of a robot with this configuration. It passes rounds, poses and the times of steps on.
    ///
    /// # Errors
    /// [`ConfigError`] if the sensors do not permit their settings.
    pub fn new(
        config: &Config,
        rounds: Vec<Producer<Round>>,
        poses: Producer<StampedPose>,
        steps: SyncSender<StepTime>,
        vitals: Arc<Vitals>,
    ) -> Result<Self, ConfigError> {
        let sensing = &config.rig.sensing;
        Ok(Self {
            sensor: config.sensor()?,
            whiskers: (0..config.buses.len()).map(|bus| config.whiskers_on(bus)).collect(),
            sample_period_ns: period_ns(sensing.sample_rate),
            rates: [sensing.sample_rate, sensing.control_rate],
            session: None,
            order: Order::new(config.timeouts.control_ns()),
            clock: SenderClock::default(),
            rounds,
            poses,
            steps,
            vitals,
        })
    }

    /// Takes a message that arrives at `now_ns` of the controller's time. One that is repeated or out of order is ignored.
    ///
    /// # Errors
    /// [`InputsError`] if the controller must end.
    pub fn take(&mut self, message: &[u8], now_ns: u64) -> Result<(), InputsError> {
        let inputs: Inputs =
            serde_json::from_slice(message).map_err(|error| InputsError::Unreadable(error.to_string()))?;
        self.check(inputs.session)?;
        if self.order.place(inputs.sent_ns, now_ns) == Place::Out {
            return Ok(());
        }
        // The age of an event when the message was sent counts back from the sending, on this clock. So clocks need not agree.
        let sent_ns = now_ns.saturating_sub(self.clock.age_ns(inputs.sent_ns, now_ns));
        let arrival = |time_ns: u64| sent_ns.saturating_sub(inputs.sent_ns.saturating_sub(time_ns));
        for message in &inputs.rounds {
            let mut round = message.decoded(&self.sensor).map_err(|_| InputsError::Array)?;
            let (Some(queue), Some(whiskers)) = (self.rounds.get_mut(message.bus()), self.whiskers.get(message.bus()))
            else {
                return Err(InputsError::Array);
            };
            if usize::from(round.count) != whiskers.len() {
                return Err(InputsError::Array);
            }
            (round.started_ns, round.ended_ns) = (arrival(round.started_ns), arrival(round.ended_ns));
            self.vitals.round_ended(&round, whiskers);
            // A full queue means that control hangs, and its own watch reports that.
            let _ = queue.push(round);
        }
        for message in &inputs.poses {
            let stamped = StampedPose::from(message);
            if self.vitals.pose_arrived(&stamped.pose, sent_ns) {
                let _ = self.poses.push(stamped);
            }
        }
        let Inputs { last_slot, origin_ns, .. } = inputs;
        let newest_ns = arrival(origin_ns.saturating_add(last_slot.saturating_mul(self.sample_period_ns)));
        let _ = self.steps.try_send(StepTime { due_ns: now_ns, last_slot, origin_ns, newest_ns });
        Ok(())
    }

    fn check(&mut self, session: Session) -> Result<(), InputsError> {
        let first = *self.session.get_or_insert(session);
        let rates = [session.sample_rate_hz, session.control_rate_hz];
        if rates.iter().zip(self.rates).any(|(remote, own)| (remote / own - 1.0).abs() > 1e-9) {
            return Err(InputsError::Rates { sensor_io: rates, controller: self.rates });
        }
        if first == session { Ok(()) } else { Err(InputsError::Session) }
    }
}
