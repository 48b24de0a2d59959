//! A simulated rig as the plant of an emulated array.

use vibrissa_robot::emulation::{Plant, PlantFault, PlantState};
use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Sample};

use vibrissa_world::geometry::Point2;
use vibrissa_world::world::{Fault, OutOfPlane, World};

/// A world that is simulated one sample period at a time. Its base moments are those of the hinges.
pub struct WorldPlant {
    world: Box<dyn World>,
    start: Pose,
    hinge_stiffness: [f64; MAX_WHISKERS],
    fault: Option<Fault>,
    /// Events since the last [`next_tick`](Self::next_tick).
    has_body_touched: bool,
    has_snapped_off: [bool; MAX_WHISKERS],
    out_of_plane: [Option<OutOfPlane>; MAX_WHISKERS],
    /// The samples of the newest tick.
    samples: Vec<Sample>,
}

impl WorldPlant {
    /// The plant of a world without sensor noise, whose control period is one sample period.
    #[must_use]
    pub fn new(world: Box<dyn World>, rig: &Rig, start: Pose) -> Self {
        let mut hinge_stiffness = [0.0; MAX_WHISKERS];
        for (stiffness, whisker) in hinge_stiffness.iter_mut().zip(&rig.whiskers) {
            *stiffness = whisker.hinge.stiffness;
        }
        Self {
            world,
            start,
            hinge_stiffness,
            fault: None,
            has_body_touched: false,
            has_snapped_off: [false; MAX_WHISKERS],
            out_of_plane: [None; MAX_WHISKERS],
            samples: Vec::new(),
        }
    }

    /// The samples with which the machine has executed its newest tick, oldest first.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Forgets the events of the last tick.
    pub fn next_tick(&mut self) {
        (self.has_body_touched, self.has_snapped_off) = (false, [false; MAX_WHISKERS]);
        self.out_of_plane = [None; MAX_WHISKERS];
    }

    /// The fault that has ended the simulation.
    #[must_use]
    pub fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }
}

impl Plant for WorldPlant {
    fn start(&self) -> PlantState {
        PlantState { pose: self.start, base_moments: [0.0; MAX_WHISKERS] }
    }

    fn advance(&mut self, command: &Command) -> Result<PlantState, PlantFault> {
        let samples = self.world.advance(command).map_err(|fault| {
            let message = PlantFault(fault.to_string());
            self.fault = Some(fault);
            message
        })?;
        let sample = samples.last().copied().ok_or_else(|| PlantFault("the simulator gave no sample".to_owned()))?;
        self.has_body_touched |= self.world.body_touches();
        let mut base_moments = [0.0; MAX_WHISKERS];
        for (whisker, moment) in base_moments.iter_mut().enumerate() {
            // Further whiskers have no stiffness.
            if self.hinge_stiffness[whisker] > 0.0 {
                *moment = sample.whiskers[whisker].base_angle * self.hinge_stiffness[whisker];
                self.has_snapped_off[whisker] |= self.world.snapped_off(whisker);
                if let Some(now) = self.world.out_of_plane(whisker) {
                    self.out_of_plane[whisker].get_or_insert_default().include(now);
                }
            }
        }
        Ok(PlantState { pose: sample.body, base_moments })
    }

    fn ticked(&mut self, samples: &[Sample]) {
        self.samples.clear();
        self.samples.extend_from_slice(samples);
    }
}

/// The simulator as the monitor of a run sees it.
impl World for WorldPlant {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.world.advance(command)
    }

    fn body_touches(&self) -> bool {
        self.has_body_touched
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.has_snapped_off[whisker]
    }

    fn out_of_plane(&self, whisker: usize) -> Option<OutOfPlane> {
        self.out_of_plane[whisker]
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }
}
