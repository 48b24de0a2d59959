//! Parameters of a policy that are set on the command line.

use clap::Args;
use sha2::{Digest, Sha256};

use vibrissa_runtime::machine::SetError;
use vibrissa_runtime::units::{Quantity, parse_quantity};

use super::input::{Loaded, Policy};

/// The parameters that are set.
#[derive(Debug, Args)]
pub(super) struct Settings {
    /// Set a parameter of the policy, with its unit: --set "speed=80 mm/s"
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parse_setting)]
    settings: Vec<Setting>,
}

/// A parameter and the value to give it.
#[derive(Debug, Clone)]
struct Setting {
    name: String,
    value: Quantity,
}

impl Settings {
    /// Whether a parameter is set.
    pub(super) fn has(&self, name: &str) -> bool {
        self.settings.iter().any(|setting| setting.name == name)
    }

    /// A policy with its parameters set, and a hash that says so.
    ///
    /// # Errors
    /// [`SetError`] when the policy has no such parameter, or that cannot have the value.
    pub(super) fn of(&self, mut policy: Loaded<Policy>) -> Result<Loaded<Policy>, SetError> {
        for Setting { name, value } in &self.settings {
            policy.value.artifact.program.set(name, value.value_si, value.dimension)?;
        }
        let settings = self.settings.iter().map(|setting| (setting.name.as_str(), setting.value.value_si));
        Ok(Loaded { hash: with_settings(policy.hash, settings), ..policy })
    }
}

/// The hash of a policy with parameters that are set, by name, to values (SI).
pub(super) fn with_settings<'s>(policy: Sha256, settings: impl Iterator<Item = (&'s str, f64)>) -> Sha256 {
    settings.fold(policy, |hash, (name, value)| hash.chain_update(format!("\0{name}={value}")))
}

/// A parameter with its value, `NAME=VALUE`.
fn parse_setting(text: &str) -> Result<Setting, String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE, such as \"speed=80 mm/s\"")?;
    let value = parse_quantity(value.trim()).map_err(|error| format!("{error}; {}", error.hint()))?;
    Ok(Setting { name: name.trim().to_owned(), value })
}
