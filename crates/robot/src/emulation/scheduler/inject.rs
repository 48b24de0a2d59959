//! Injection of faults.

use std::sync::atomic::Ordering;

use vibrissa_mlx90393_emulator::{BusFault, SensorFault};

use super::Emulation;
use crate::emulation::injection::{Injection, InjectionKind};
use crate::emulation::plant::Plant;

/// Faults outside the buses that are present now.
#[derive(Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "independent switches")]
pub(super) struct Switches {
    pub(super) has_no_pose: bool,
    pub(super) is_pose_invalid: bool,
    pub(super) is_actuator_silent: bool,
    pub(super) does_control_stall: bool,
    pub(super) does_control_panic: bool,
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
            self.switch(injection, begins);
        }
    }

    fn switch(&mut self, injection: Injection, begins: bool) {
        let part = injection.part;
        match injection.kind {
            InjectionKind::StaleSensor => self.sensor_fault(part, begins, SensorFault::ClockStopped),
            InjectionKind::BrownOut if begins => self.sensor_fault(part, true, SensorFault::BrownOut),
            InjectionKind::BrownOut => {}
            InjectionKind::NoAcknowledge => {
                self.sensor_fault(part, begins, SensorFault::NoAcknowledge { transactions: None });
            }
            InjectionKind::GarbledBytes => {
                self.sensor_fault(part, begins, SensorFault::BitFlip { byte: 0, mask: 0x0C, answers: u32::MAX });
            }
            InjectionKind::SaturatedField => {
                self.sensor_fault(part, begins, SensorFault::Saturated { negative: false });
            }
            InjectionKind::OverbentWhisker => {
                if let Some(bent) = self.timeline.borrow_mut().bent.get_mut(usize::from(part)) {
                    *bent = begins.then_some(self.overbent_moment);
                }
            }
            InjectionKind::StuckBus => {
                let count = self.buses.len();
                if let Some(thread) = self.buses.get_mut(usize::from(part) % count.max(1)) {
                    thread.switch_bus_fault(begins, BusFault::STUCK);
                }
            }
            InjectionKind::NoPose => self.switches.has_no_pose = begins,
            InjectionKind::PoseNotANumber => self.switches.is_pose_invalid = begins,
            InjectionKind::SilentActuator => self.switches.is_actuator_silent = begins,
            InjectionKind::NoBroker => self.vitals.is_broker_gone.store(begins, Ordering::Release),
            InjectionKind::ControlStalls => self.switches.does_control_stall = begins,
            InjectionKind::ControlPanics => self.switches.does_control_panic = true,
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
