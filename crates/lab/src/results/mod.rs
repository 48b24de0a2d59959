//! Results as JSON documents: runs, ticks, and counts over runs.

mod calibration_identity;
mod collisions;
mod contract_result;
mod document;
#[cfg(feature = "robot")]
mod drive_result;
mod ending;
mod failsafes;
mod inclination;
mod largest_error;
mod provenance;
mod rate;
mod refused;
#[cfg(feature = "robot")]
mod replay_result;
mod run_result;
mod section;
mod shown_value;
mod tally;
mod tick_line;
mod whisker_response;
mod wilson;

pub use calibration_identity::{CalibrationIdentity, CalibrationKind};
pub use collisions::Collisions;
pub use contract_result::{ContractResult, SmallestMargin};
pub use document::{Document, Versioned};
#[cfg(feature = "robot")]
pub use drive_result::{DriveResult, FaultRecord, UndetectedFault};
pub use ending::{Ending, unmet};
pub use failsafes::Failsafes;
pub use inclination::Inclination;
pub use largest_error::LargestError;
pub use provenance::{
    InputHash, InputHashes, JitterRecord, MismatchRecord, Provenance, RunOrigin, SeedRange, Simulator, add_seed,
    add_seeds,
};
pub use rate::Rate;
#[cfg(feature = "robot")]
pub use replay_result::{DifferenceRecord, ReplayResult};
pub use run_result::marked;
pub use run_result::{Hashes, Identity, MismatchIdentity, ObjectFriction, OutOfPlane, RunResult, policy_label};
pub use section::figure_in;
pub use shown_value::{ShownNumber, ShownValue};
pub use tally::{Figures, Rates, Tally, TipShares};
pub use tick_line::{MessageLine, MessageValueLine, OutOfPlaneLine, PlotLine, TickLine, tick_lines};
pub use whisker_response::WhiskerResponse;
