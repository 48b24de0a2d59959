//! Perception: from samples to the values that policies read. It contains filtered base angles, contact estimators, the
//! local contour behind a tip, and the detection of a blocked body.

mod base_angle;
mod command_delay;
mod contact;
mod contact_estimator;
mod creep;
mod disturbance;
mod filtered_base_angle;
mod inertia;
mod local_contour;
mod loop_watch;
mod low_pass;
mod measured_noise;
mod moment_and_shear;
mod motions;
mod newest;
mod offsets;
mod one_channel;
mod perception;
mod platform_motion;
mod pose_delay;
mod pose_noise;
mod recent_line;
mod recorded_contour;
mod recursive;
mod robust_variance;
mod shaft_rest;
mod sliding;
mod sliding_contact;
mod tip_bias;
mod tip_curve;
mod tip_table;
mod truth;
mod whisker;

pub(crate) use base_angle::MODEL_DEVIATION;
pub use contact::Contact;
pub use contact_estimator::ContactEstimator;
pub use local_contour::LocalContour;
pub use loop_watch::LoopWatch;
pub use low_pass::{CutoffError, LowPass};
pub(crate) use offsets::TOLERATED as TOLERATED_OFFSET;
pub use perception::{Perception, PerceptionError};
pub use pose_delay::Misfit;
pub(crate) use shaft_rest::SURE_AFTER;
pub use tip_curve::{TipCurve, TipCurveError};
pub use tip_table::{TipPosition, TipTable};
