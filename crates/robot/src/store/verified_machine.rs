//! A machine with a valid signature that is safe to run.

use minisign_verify::{Error as MinisignError, Signature};
use vibrissa_runtime::machine::{Artifact, ArtifactError, OnlySimulated};

use super::claims::Claims;
use super::keys::Keys;
use super::machine_hash::MachineHash;
use super::signed_machine::SignedMachine;

/// A machine that was signed with one of some [`Keys`], and whose artifact is safe to run. Only [`Keys::verify`] makes it.
#[derive(Debug, Clone)]
pub struct VerifiedMachine {
    signed: SignedMachine,
    hash: MachineHash,
    artifact: Artifact,
    signer: String,
    trusted_comment: String,
    claims: Claims,
}

/// The reason for which a machine is refused.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// The signature is empty.
    #[error("the machine is not signed; run `minisign -Sm FILE` and push it again")]
    Unsigned,
    /// The signature is not in the format of minisign.
    #[error("the signature is not one of minisign, or it is damaged; sign the machine again with `minisign -Sm FILE`")]
    NotASignature,
    /// The signature was made with another key.
    #[error(
        "the machine is signed with a key that is not trusted; sign it with one of these keys: {}, or add the public key of its \
         signer to the trusted ones", trusted.join(", ")
    )]
    UnknownKey {
        /// Names of the files of the trusted keys.
        trusted: Vec<String>,
    },
    /// The signature does not fit the machine or its own trusted comment.
    #[error(
        "the signature does not fit: the machine, the signature or its trusted comment was changed after signing; \
         sign the machine again with `minisign -Sm FILE`"
    )]
    Changed,
    /// The signature is in the legacy format.
    #[error(
        "the signature is in the legacy format of minisign; sign the machine with `minisign -Sm FILE` without the option -l"
    )]
    Legacy,
    /// A word of the trusted comment is no claim.
    #[error(
        "`{word}` in the trusted comment is not `robot:NAME` or `counter:N`, or occurs twice; sign the machine again"
    )]
    Claim {
        /// The word.
        word: String,
    },
    /// The machine was signed for another robot.
    #[error(
        "the machine was signed for the robot `{robot}`, and this one is `{name}`; sign it again with `-t 'robot:{name}'`"
    )]
    OtherRobot {
        /// The robot of the trusted comment.
        robot: String,
        /// The name of this robot.
        name: String,
    },
    /// The signature is valid, but the content is not a machine that this program can run.
    #[error(transparent)]
    Artifact(#[from] ArtifactError),
    /// The signature is valid, but no robot can run the machine.
    #[error(transparent)]
    OnlySimulated(#[from] OnlySimulated),
}

impl VerifiedMachine {
    /// Verifies the signature with its trusted comment, and then the artifact.
    pub(super) fn new(signed: SignedMachine, keys: &Keys) -> Result<Self, Refusal> {
        let (signer, trusted_comment) = verify_signature(&signed, keys)?;
        let artifact = Artifact::from_bytes(signed.artifact())?;
        artifact.program.check_for_robot()?;
        let claims = Claims::of(&trusted_comment)?;
        Ok(Self { hash: signed.hash(), signed, artifact, signer, trusted_comment, claims })
    }

    /// The bytes of the artifact and the signature.
    #[must_use]
    pub fn signed(&self) -> &SignedMachine {
        &self.signed
    }

    /// The hash of the artifact.
    #[must_use]
    pub fn hash(&self) -> MachineHash {
        self.hash
    }

    /// The artifact, decoded and verified.
    #[must_use]
    pub fn artifact(&self) -> &Artifact {
        &self.artifact
    }

    /// Name of the file with the public key that fits the signature.
    #[must_use]
    pub fn signer(&self) -> &str {
        &self.signer
    }

    /// What the trusted comment says about the machine.
    #[must_use]
    pub fn claims(&self) -> &Claims {
        &self.claims
    }

    /// The comment that the signature covers. By default, minisign writes the time and the name of the file into it.
    #[must_use]
    pub fn trusted_comment(&self) -> &str {
        &self.trusted_comment
    }
}

/// Returns the name of the key and the trusted comment.
fn verify_signature(machine: &SignedMachine, keys: &Keys) -> Result<(String, String), Refusal> {
    if machine.signature().trim().is_empty() {
        return Err(Refusal::Unsigned);
    }
    let signature = Signature::decode(machine.signature()).map_err(|_| Refusal::NotASignature)?;
    let mut refusal = None;
    for (name, key) in keys.iter() {
        match key.verify(machine.artifact(), &signature, false) {
            Ok(()) => return Ok((name.to_owned(), signature.trusted_comment().to_owned())),
            Err(MinisignError::UnexpectedKeyId) => {}
            Err(MinisignError::UnexpectedAlgorithm) => refusal = Some(Refusal::Legacy),
            Err(_) => refusal = Some(Refusal::Changed),
        }
    }
    Err(refusal.unwrap_or_else(|| Refusal::UnknownKey { trusted: keys.names() }))
}
