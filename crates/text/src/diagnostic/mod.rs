//! Errors and warnings in texts that the user wrote: one type with its position, and its renderings.

mod kind;
mod printable;
mod record;
mod source;
#[cfg(feature = "terminal")]
mod terminal;
mod utf8;

pub use kind::{Diagnostic, FAULT_LIMIT, Label, Severity};
pub use printable::{printable, printable_json};
pub use record::{Record, RecordLabel, records};
pub use source::{Source, Span};
#[cfg(feature = "terminal")]
pub use terminal::{Colour, terminal};
pub use utf8::NotUtf8;
pub use utf8::utf8;
pub use vibrissa_runtime::machine::Position;
