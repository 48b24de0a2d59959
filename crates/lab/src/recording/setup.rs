//! Everything beside the ticks that a replay needs.

use std::collections::BTreeMap;

use vibrissa_robot::recording::{Attachment, FORMAT, Head, sha256};
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

use super::error::{ReadRecordingError, RecordError};
use crate::trial::Trial;
use vibrissa_text::diagnostic::Source;

/// The kind of recording of this module: a simulated run.
pub(super) const KIND: &str = "run";
/// Name of the metadata record that identifies a recording.
pub(super) const IDENTITY: &str = "vibrissa";
/// Name of the metadata record with the outcome.
pub(super) const OUTCOME: &str = "outcome";
/// Name of the attachment with the artifact.
pub(super) const MACHINE: &str = "machine";
/// Name of the attachment with the rig that control assumes.
pub(super) const RIG: &str = "rig.json";
/// Name of the attachment with the text of the policy.
pub(super) const POLICY: &str = "policy.fsm";
/// Beginning of the names of attachments with the files that the policy uses, in their order.
const LIBRARY: &str = "library";

/// What a recording begins with.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The machine with the parameters of the run.
    pub(super) machine: Vec<u8>,
    /// The rig that control assumes.
    pub(super) rig: Rig,
    /// The text of the policy with those of the files that it uses. `None` for a compiled machine.
    pub(super) policy: Option<Source>,
    /// Names and hashes that identify the run.
    pub(super) identity: BTreeMap<String, String>,
}

impl Setup {
    /// The setup of a trial with the machine `artifact`. `policy` is the text of that machine, if there is one.
    ///
    /// # Errors
    /// [`RecordError`] if a value cannot be encoded.
    pub fn of_trial(trial: &Trial, artifact: &Artifact, policy: Option<Source>) -> Result<Self, RecordError> {
        let mut artifact = artifact.clone();
        artifact.program = trial.program.as_ref().clone();
        let named = trial.identity();
        let simulated = [
            ("scenario", named.scenario),
            ("scenario_hash", named.hash.scenario),
            ("policy_hash", named.hash.policy),
            ("world", named.world),
            ("engine_hash", named.hash.engine),
            ("seed", named.seed.to_string()),
        ];
        Self::new(&artifact, &trial.assumed_rig, policy, simulated)
    }

    /// The setup of the machine `artifact` with the rig that its control assumes. `identity` has what else identifies the run.
    ///
    /// # Errors
    /// [`RecordError`] if a value cannot be encoded.
    pub(super) fn new<const N: usize>(
        artifact: &Artifact,
        rig: &Rig,
        policy: Option<Source>,
        identity: [(&str, String); N],
    ) -> Result<Self, RecordError> {
        let machine = artifact.to_bytes()?;
        let rig_text = serde_json::to_vec(rig)?;
        let entries = [
            ("format", FORMAT.to_owned()),
            ("kind", KIND.to_owned()),
            ("program", concat!("vibrissa ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("machine", artifact.program.name.clone()),
            ("machine_sha256", sha256(&machine)),
            ("rig_sha256", sha256(&rig_text)),
        ];
        let identity = entries.into_iter().chain(identity).map(|(key, value)| (key.to_owned(), value)).collect();
        Ok(Self { machine, rig: rig.clone(), policy, identity })
    }

    /// The attachments.
    pub(super) fn attachments(&self) -> Result<Vec<Attachment>, RecordError> {
        let rig = serde_json::to_vec(&self.rig)?;
        let mut all = vec![
            Attachment { name: MACHINE.to_owned(), data: self.machine.clone() },
            Attachment { name: RIG.to_owned(), data: rig },
        ];
        if let Some(policy) = &self.policy {
            let text = |part| policy.slice(policy.part_span(part)).as_bytes().to_vec();
            all.push(Attachment { name: POLICY.to_owned(), data: text(0) });
            let parts = (1..policy.count()).filter(|&part| policy.absence(part).is_none());
            let name = |part| format!("{LIBRARY} {part:04} {}", policy.part_name(part));
            all.extend(parts.map(|part| Attachment { name: name(part), data: text(part) }));
        }
        Ok(all)
    }

    /// The setup in the attachments of a recording.
    pub(super) fn from_head(mut head: Head) -> Result<Self, ReadRecordingError> {
        let mut take = |name, hash| head.take(name, hash)?.ok_or(ReadRecordingError::Missing(name));
        let (machine, rig) = (take(MACHINE, "machine_sha256")?, take(RIG, "rig_sha256")?);
        let rig = serde_json::from_slice(&rig).map_err(|error| ReadRecordingError::Message {
            topic: RIG,
            message: 0,
            reason: error.to_string(),
        })?;
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        let Head { identity, mut attachments } = head;
        let policy = attachments.remove(POLICY).map(|policy| {
            let mut source = Source::new(POLICY, text(policy));
            // The map is in the order of the numbers in the names.
            for (name, content) in attachments {
                if let Some((_, name)) = name.strip_prefix(LIBRARY).and_then(|rest| rest.trim_start().split_once(' ')) {
                    source.add(name, Ok(&text(content)));
                }
            }
            source
        });
        Ok(Self { machine, rig, policy, identity })
    }
}
