//! The codes of diagnostics of scenarios, rigs and sweeps.

/// The text is not YAML.
pub const SYNTAX: &str = "S0001";
/// The text is empty.
pub const EMPTY: &str = "S0002";
/// A key occurs twice in a mapping.
pub const DUPLICATE_KEY: &str = "S0003";
/// The text contains several documents.
pub const DOCUMENTS: &str = "S0004";
/// The text is too large, or its aliases make it so.
pub const TOO_LARGE: &str = "S0005";
/// A key is unknown.
pub const UNKNOWN_KEY: &str = "S0101";
/// A key is missing.
pub const MISSING_KEY: &str = "S0102";
/// A value has the wrong type.
pub const TYPE: &str = "S0103";
/// A word is none of the possible ones.
pub const CHOICE: &str = "S0104";
/// A number has no unit.
pub const BARE_NUMBER: &str = "S0201";
/// A text is not a number with a unit.
pub const QUANTITY: &str = "S0202";
/// A unit does not exist.
pub const UNIT: &str = "S0203";
/// A unit has the wrong dimension.
pub const DIMENSION: &str = "S0204";
/// A number is out of range.
pub const RANGE: &str = "S0301";
/// A shape is impossible.
pub const SHAPE: &str = "S0302";
/// Rates and times are inconsistent.
pub const TIMING: &str = "S0303";
/// The rig overlaps an object at the start.
pub const OVERLAP: &str = "S0304";
/// A name is invalid.
pub const NAME: &str = "S0305";
/// The rig is inconsistent.
pub const RIG: &str = "S0306";
/// A file cannot be read.
pub const FILE: &str = "S0401";
/// A file contains no outline.
pub const OUTLINE: &str = "S0402";
/// This build has no reader for a file.
pub const NOT_BUILT: &str = "S0403";
/// A sweep would execute a run twice.
pub const REPEATED: &str = "S0501";
/// A policy does not accept a value of a sweep.
pub const UNFIT: &str = "S0502";
/// A sweep varies a key that another of its keys determines.
pub const ENTANGLED: &str = "S0503";
