//! Everything beside the records that a replay needs.

use std::collections::BTreeMap;
use std::sync::Arc;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{Artifact, ArtifactError, Program};

use super::head::FORMAT;
use crate::config::{Config, ConfigError};

/// Name and media type of the attachment with the artifact.
pub(super) const MACHINE: (&str, &str) = ("machine", "application/octet-stream");
/// Name and media type of the attachment with every value of the configuration.
pub(super) const CONFIGURATION: (&str, &str) = ("configuration.json", "application/json");
/// Name and media type of the attachment with the text of the configuration.
pub(super) const CONFIGURATION_TEXT: (&str, &str) = ("configuration.yaml", "application/yaml");

/// Entry of the metadata with the number of the part.
pub(super) const PART: &str = "part";
/// The kind of recording of this module: the loop of a robot.
pub(super) const KIND: &str = "robot";

/// The machine and the configuration of a run. A recording contains both, so that it can be replayed by itself.
#[derive(Debug, Clone)]
pub struct Setup {
    config: Config,
    configuration: Vec<u8>,
    configuration_text: Option<String>,
    machine: Vec<u8>,
    program: Arc<Program>,
}

/// A machine or a configuration that cannot be recorded.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// The artifact is not valid.
    #[error(transparent)]
    Artifact(#[from] ArtifactError),
    /// The configuration is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

/// The origin of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// Name and version of the program that records.
    pub program: String,
    /// SHA-256 of the program's file, if it can be read.
    pub program_sha256: Option<String>,
    /// Further entries, such as the time or the scenario.
    pub details: BTreeMap<String, String>,
}

impl Setup {
    /// The setup of a run by an artifact. `configuration_text` is the file that `config` was read from, if there is one.
    ///
    /// # Errors
    /// [`SetupError`] if the artifact is not valid, or if a path of the configuration is not UTF-8 text.
    pub fn new(config: Config, configuration_text: Option<String>, artifact: Artifact) -> Result<Self, SetupError> {
        let machine = artifact.to_bytes()?;
        let program = Arc::new(artifact.program);
        let configuration = config.to_json()?;
        Ok(Self { config, configuration, configuration_text, machine, program })
    }

    /// The setup in the attachments of a recording.
    pub(super) fn from_attachments(
        machine: Vec<u8>,
        configuration: Vec<u8>,
        configuration_text: Option<String>,
    ) -> Result<Self, SetupError> {
        let program = Arc::new(Artifact::from_bytes(&machine)?.program);
        let config = Config::from_json(&configuration)?;
        Ok(Self { config, configuration, configuration_text, machine, program })
    }

    /// The configuration.
    #[must_use]
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The program of the machine.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// The attachments: name, media type and content.
    pub(super) fn attachments(&self) -> impl Iterator<Item = ((&'static str, &'static str), &[u8])> {
        let text = self.configuration_text.as_ref().map(|text| (CONFIGURATION_TEXT, text.as_bytes()));
        [(MACHINE, self.machine.as_slice()), (CONFIGURATION, self.configuration.as_slice())].into_iter().chain(text)
    }

    /// The metadata of a recording: what was recorded by which program.
    pub(super) fn identity(&self, origin: &Origin) -> Result<BTreeMap<String, String>, SetupError> {
        let text = |error: serde_json::Error| SetupError::Config(ConfigError::Text(error.to_string()));
        let rig = serde_json::to_vec(&self.config.rig).map_err(text)?;
        let calibrations: Vec<_> = self.config.rig.whiskers.iter().map(|whisker| &whisker.calibration).collect();
        let calibration = serde_json::to_vec(&calibrations).map_err(text)?;
        let is_calibrated = calibrations.iter().any(|calibration| calibration.is_some());
        let mut identity = origin.details.clone();
        let mut set = |key: &str, value: &str| {
            identity.insert(key.to_owned(), value.to_owned());
        };
        set("format", FORMAT);
        set("kind", KIND);
        set("robot", &self.config.name);
        set("machine", &self.program.name);
        set("program", &origin.program);
        if let Some(hash) = &origin.program_sha256 {
            set("program_sha256", hash);
        }
        for (name, hash) in self.hashes() {
            set(&format!("{name}_sha256"), &hash);
        }
        set("rig_sha256", &sha256(&rig));
        if is_calibrated {
            set("calibration_sha256", &sha256(&calibration));
        }
        Ok(identity)
    }

    /// SHA-256 of every attachment.
    fn hashes(&self) -> impl Iterator<Item = (&'static str, String)> {
        self.attachments().map(|((name, _), content)| (name, sha256(content)))
    }
}

/// SHA-256 in hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    crate::hex::encode(&Sha256::digest(bytes))
}
