//! Perception: samples to contacts.

mod blocked;
mod contact_estimators;
mod fitted;
mod gaps;
mod moment_and_shear;
mod perception;
mod polynomial;
mod sliding;
mod tip_curve;
mod truth;
