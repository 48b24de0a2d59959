//! Injection of faults.

use std::sync::atomic::Ordering;

use vibrissa_mlx90393_emulator::{BusFault, SensorFault};

use super::Emulation;
use crate::emulation::injection::{Injection, InjectionKind};
use crate::emulation::plant::Plant;

/// Number of faults of each kind that are present now.
#[derive(Debug, Default)]
pub(in super::super) struct Present([usize; InjectionKind::ALL.len()]);

impl Present {
    /// True if a fault of this kind is present.
    pub(in super::super) fn has(&self, kind: InjectionKind) -> bool {
        self.0.get(kind.index()).is_some_and(|count| *count > 0)
    }

    fn switch(&mut self, kind: InjectionKind, begins: bool) {
        if let Some(count) = self.0.get_mut(kind.index()) {
            *count = if begins { *count + 1 } else { count.saturating_sub(1) };
        }
    }
}

impl<P: Plant> Emulation<P> {
    /// Injects and clears the faults that are due.
    pub(super) fn inject(&mut self) {
        let Some(begun_ns) = self.begun_ns else { return };
        let due: Vec<usize> = (0..self.injections.len())
            .filter(|&index| self.injections[index].due_ns(begun_ns).is_some_and(|due_ns| due_ns <= self.now_ns))
            .collect();
        for index in due {
            let Some(pending) = self.injections.get_mut(index) else { continue };
            let injection = pending.injection;
            let begins = !pending.is_injected;
            if begins {
                pending.is_injected = true;
            } else {
                pending.is_cleared = true;
            }
            // A thread that has panicked is gone.
            if begins || injection.kind != InjectionKind::ControlPanics {
                self.present.switch(injection.kind, begins);
            }
            self.switch(injection, begins);
        }
    }

    fn switch(&mut self, injection: Injection, begins: bool) {
        let part = injection.part;
        match injection.kind {
            InjectionKind::StaleSensor => self.sensor_fault(part, begins, SensorFault::ClockStopped),
            InjectionKind::BrownOut if begins => self.sensor_fault(part, true, SensorFault::BrownOut),
            InjectionKind::NoAcknowledge => {
                self.sensor_fault(part, begins, SensorFault::NoAcknowledge { transactions: None });
            }
            InjectionKind::GarbledBytes => {
                for thread in &mut self.buses {
                    thread.switch_garbled(part, begins);
                }
            }
            InjectionKind::SaturatedField => {
                self.sensor_fault(part, begins, SensorFault::Saturated { negative: false });
            }
            InjectionKind::OverbentWhisker => {
                let mut timeline = self.timeline.borrow_mut();
                // It is bent further to the side to which it is bent already. The other one would be a wrapped field.
                let now = timeline.at(self.now_ns).base_moments.get(usize::from(part)).copied().unwrap_or(0.0);
                let moment = self.overbent_moment.copysign(now);
                if let Some(bent) = timeline.bent.get_mut(usize::from(part)) {
                    *bent = begins.then_some(moment);
                }
            }
            InjectionKind::StuckBus => {
                let count = self.buses.len();
                if let Some(thread) = self.buses.get_mut(usize::from(part) % count.max(1)) {
                    thread.switch_bus_fault(begins, BusFault::STUCK);
                }
            }
            InjectionKind::NoBroker => {
                self.vitals.is_broker_gone.store(self.present.has(InjectionKind::NoBroker), Ordering::Release);
            }
            InjectionKind::LocalisationRestarts if begins => self.links.restart_localisation(),
            // Some happen at their begin only. The links and the scheduler look whether the others are present.
            InjectionKind::BrownOut
            | InjectionKind::LocalisationRestarts
            | InjectionKind::NoPose
            | InjectionKind::PoseNotANumber
            | InjectionKind::DisplacedPose
            | InjectionKind::ForeignPoses
            | InjectionKind::WrappedHeadings
            | InjectionKind::SilentActuator
            | InjectionKind::LateAcknowledgements
            | InjectionKind::RepeatedAcknowledgements
            | InjectionKind::FutureAcknowledgements
            | InjectionKind::ControlStalls
            | InjectionKind::ControlPanics => {}
            InjectionKind::MachineFails => self.vitals.has_machine_failed.store(true, Ordering::Release),
            InjectionKind::Terminate => self.vitals.is_terminated.store(true, Ordering::Release),
        }
    }

    fn sensor_fault(&mut self, whisker: u8, begins: bool, fault: SensorFault) {
        for thread in &mut self.buses {
            thread.switch_sensor_fault(whisker, begins, fault);
        }
    }
}
