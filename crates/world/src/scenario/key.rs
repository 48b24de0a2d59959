//! Keys with a numeric value.

pub(crate) use vibrissa_runtime::units::Key;
