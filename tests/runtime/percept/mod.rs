//! Perception: samples to contacts.

mod blocked;
mod contact_estimators;
mod contours;
mod fitted;
mod gaps;
mod loop_watch;
mod moment_and_shear;
mod perception;
mod polynomial;
mod sliding;
mod tip_curve;
mod truth;
