//! The store.

use std::collections::BTreeSet;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use vibrissa_runtime::machine::{ARTIFACT_LIMIT, Artifact};

use super::answer::Answer;
use super::claims::Claims;
use super::disk::{Disk, Folder, Lock, is_temporary, replace};
use super::frame::SIGNATURE_LIMIT;
use super::keys::Keys;
use super::local_disk::{LOCK_FILE, LocalDisk};
use super::machine_hash::MachineHash;
use super::signed_machine::SignedMachine;
use super::state::{Role, State};
use super::state_file::{self, STATE_FILE, STATE_LIMIT};
use super::store_error::{ReceiveError, StoreError};
use super::verified_machine::{Refusal, VerifiedMachine};

/// The usual directory of a store.
pub const DEFAULT_STORE: &str = "/var/lib/vibrissa";
/// Endings of the files in the folder `machines`.
const MACHINE_ENDING: &str = ".machine";
const SIGNATURE_ENDING: &str = ".machine.minisig";

/// A directory with signed machines. Several programs may use it at once.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    disk: Box<dyn Disk>,
    /// Name of the robot, if it is known.
    robot: Option<String>,
    /// The keys with which a machine is verified again when it is loaded.
    keys: Option<Keys>,
}

/// A machine of a store that is safe to run.
#[derive(Debug, Clone)]
pub struct StoredMachine {
    /// Its hash.
    pub hash: MachineHash,
    /// Its role.
    pub role: Role,
    /// The machine.
    pub artifact: Artifact,
}

impl Store {
    /// Opens the store at `path`. Creates the folder `machines` in it if it is missing, but not the directory itself.
    ///
    /// # Errors
    /// [`StoreError::Open`].
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        match LocalDisk::open(path) {
            Ok(disk) => Ok(Self::on(path, Box::new(disk))),
            Err(cause) => Err(StoreError::Open { path: path.to_owned(), cause }),
        }
    }

    /// A store on another disk. The path is used in messages only.
    pub(super) fn on(path: &Path, disk: Box<dyn Disk>) -> Self {
        Self { path: path.to_owned(), disk, robot: None, keys: None }
    }

    /// Sets the name of the robot. A machine that was signed for another one is refused when it is received and when it is loaded.
    #[must_use]
    pub fn of_robot(self, name: &str) -> Self {
        Self { robot: Some(name.to_owned()), ..self }
    }

    /// Verifies the signature of a machine again when it is loaded, with the keys that the robot trusts then.
    #[must_use]
    pub fn trusting(self, keys: Keys) -> Self {
        Self { keys: Some(keys), ..self }
    }

    /// The roles of the machines, and the reason for which the last one was given up.
    ///
    /// # Errors
    /// The state cannot be read.
    pub fn status(&self) -> Result<State, StoreError> {
        match self.disk.read(Folder::Root, STATE_FILE, STATE_LIMIT) {
            Ok(bytes) => state_file::decode(&bytes)
                .map_err(|cause| StoreError::State { path: self.at(Folder::Root, STATE_FILE), cause }),
            Err(cause) if cause.kind() == ErrorKind::NotFound => Ok(State::default()),
            Err(cause) => Err(StoreError::Read { path: self.at(Folder::Root, STATE_FILE), cause }),
        }
    }

    /// The machine to run: the tentative one, or else the good one. This function counts no start.
    ///
    /// # Errors
    /// The state cannot be read, there is no machine, or it cannot be used.
    pub fn current(&self) -> Result<StoredMachine, StoreError> {
        let state = self.status()?;
        let (hash, role) = state.current().ok_or_else(|| StoreError::NoMachine { rejected: state.rejected.clone() })?;
        self.load_again(hash, role, &state)
    }

    /// Receives one push from a stream and verifies it with the trusted `keys`. Then the machine becomes tentative.
    ///
    /// If it is the good machine, it stays good, and the tentative one is withdrawn. The function reads up to the end of the
    /// stream, so the sender must close it.
    ///
    /// # Errors
    /// [`ReceiveError`]. The machine was not taken, except if only the synchronisation at the end failed.
    pub fn receive(&self, from: impl Read, keys: &Keys) -> Result<Answer, ReceiveError> {
        // The lock is taken after the stream was read, because a slow sender must not hold up the control program.
        let signed = SignedMachine::read_frame(from)?;
        let verified = keys.verify(signed)?;
        self.check_robot(&verified)?;
        Ok(self.take(&verified)?)
    }

    /// Makes a verified machine tentative.
    pub(super) fn take(&self, machine: &VerifiedMachine) -> Result<Answer, StoreError> {
        let _lock = self.lock()?;
        let mut state = self.status()?;
        let hash = machine.hash();
        // The good machine may be pushed again.
        if state.good != Some(hash) {
            check_counter(machine.claims(), &state)?;
        }
        let signed = machine.signed();
        self.write(Folder::Machines, &file_name(hash, MACHINE_ENDING), signed.artifact())?;
        self.write(Folder::Machines, &file_name(hash, SIGNATURE_ENDING), signed.signature().as_bytes())?;
        self.sync(Folder::Machines)?;
        let role = state.receive(hash);
        self.save(&state)?;
        Ok(Answer { hash, state: role })
    }

    /// The machine for the run that begins now. A start of the tentative machine is counted and durable before this
    /// function returns.
    ///
    /// A tentative machine that was started before, or that cannot be loaded, is given up. Then the good machine is returned.
    ///
    /// # Errors
    /// The state cannot be read or written, there is no machine, or it cannot be used.
    pub fn begin_run(&self) -> Result<StoredMachine, StoreError> {
        let _lock = self.lock()?;
        let mut state = self.status()?;
        let before = state.clone();
        if let Some(tentative) = &mut state.tentative {
            let hash = tentative.hash;
            let reason = if tentative.starts > 0 {
                "it was started and not marked good".to_owned()
            } else {
                match self.load_again(hash, Role::Tentative, &before) {
                    Ok(machine) => {
                        tentative.starts += 1;
                        self.save(&state)?;
                        return Ok(machine);
                    }
                    Err(cause) => cause.to_string(),
                }
            };
            state.reject(hash, &reason);
            self.save(&state)?;
        }
        let hash = state.good.ok_or_else(|| StoreError::NoMachine { rejected: state.rejected.clone() })?;
        self.load_again(hash, Role::Good, &state)
    }

    /// Takes back a start of the tentative machine, because the run ended before the machine was executed.
    ///
    /// # Errors
    /// [`StoreError::NotTentative`] if the machine is not tentative, or the state cannot be read or written.
    pub fn undo_start(&self, hash: MachineHash) -> Result<(), StoreError> {
        self.change(hash, |state| state.undo_start(hash))
    }

    /// Marks the tentative machine good after a run that went well. Marking the good machine again changes nothing.
    ///
    /// # Errors
    /// [`StoreError::NotTentative`] if the machine is neither, or the state cannot be read or written.
    pub fn mark_good(&self, hash: MachineHash) -> Result<(), StoreError> {
        // Without a counter of its own, the machine leaves the one of before.
        let signed = self.signed(hash).ok();
        let claims = signed.and_then(|signed| Claims::of(signed.unverified_comment()?).ok()).unwrap_or_default();
        self.change(hash, |state| {
            let is_marked = state.mark_good(hash);
            if is_marked {
                state.counter = state.counter.max(claims.counter);
            }
            is_marked
        })
    }

    /// Gives the tentative machine up. The good machine returns. The status shows the reason.
    ///
    /// # Errors
    /// [`StoreError::NotTentative`] if the machine is not tentative, or the state cannot be read or written.
    pub fn reject(&self, hash: MachineHash, reason: &str) -> Result<(), StoreError> {
        self.change(hash, |state| state.reject(hash, reason))
    }

    fn change(&self, hash: MachineHash, change: impl FnOnce(&mut State) -> bool) -> Result<(), StoreError> {
        let _lock = self.lock()?;
        let old = self.status()?;
        let mut new = old.clone();
        if !change(&mut new) {
            return Err(StoreError::NotTentative { hash });
        }
        if new == old { Ok(()) } else { self.save(&new) }
    }

    /// A machine of the store and its signature, not yet verified.
    ///
    /// # Errors
    /// [`StoreError::Unusable`] if one of its files cannot be read or was changed.
    pub fn signed(&self, hash: MachineHash) -> Result<SignedMachine, StoreError> {
        let artifact = self.artifact(hash)?;
        let unusable = |cause| StoreError::Unusable { hash, cause };
        let signature = self.disk.read(Folder::Machines, &file_name(hash, SIGNATURE_ENDING), SIGNATURE_LIMIT);
        let signature = signature.map_err(|cause| unusable(format!("its signature cannot be read: {cause}")))?;
        let signature = String::from_utf8(signature).map_err(|_| unusable("its signature is not text".to_owned()))?;
        Ok(SignedMachine::new(artifact, signature))
    }

    /// Loads a machine, and verifies its signature again if the store has keys.
    fn load_again(&self, hash: MachineHash, role: Role, state: &State) -> Result<StoredMachine, StoreError> {
        if let Some(keys) = &self.keys {
            let unusable = |cause: Refusal| StoreError::Unusable { hash, cause: cause.to_string() };
            let verified = keys.verify(self.signed(hash)?).map_err(unusable)?;
            self.check_robot(&verified).map_err(unusable)?;
            check_counter(verified.claims(), state)?;
        }
        self.load(hash, role)
    }

    fn check_robot(&self, machine: &VerifiedMachine) -> Result<(), Refusal> {
        self.robot.as_deref().map_or(Ok(()), |name| machine.claims().check_robot(name))
    }

    /// Reads a machine and verifies it again, because the disk may have damaged it.
    pub(super) fn load(&self, hash: MachineHash, role: Role) -> Result<StoredMachine, StoreError> {
        let artifact = Artifact::from_bytes(&self.artifact(hash)?)
            .map_err(|cause| StoreError::Unusable { hash, cause: cause.to_string() })?;
        Ok(StoredMachine { hash, role, artifact })
    }

    /// The bytes of a machine, which fit its hash.
    fn artifact(&self, hash: MachineHash) -> Result<Vec<u8>, StoreError> {
        let bytes = self.disk.read(Folder::Machines, &file_name(hash, MACHINE_ENDING), ARTIFACT_LIMIT);
        match bytes {
            Ok(bytes) if MachineHash::of(&bytes) == hash => Ok(bytes),
            Ok(_) => Err(StoreError::Unusable { hash, cause: "its file was changed or damaged".to_owned() }),
            Err(cause) => Err(StoreError::Unusable { hash, cause: cause.to_string() }),
        }
    }

    /// Writes the state, which puts it into force. Then removes files that are no longer needed.
    fn save(&self, state: &State) -> Result<(), StoreError> {
        let path = || self.at(Folder::Root, STATE_FILE);
        let bytes = state_file::encode(state).map_err(|cause| StoreError::State { path: path(), cause })?;
        self.write(Folder::Root, STATE_FILE, &bytes)?;
        self.sync(Folder::Root)?;
        self.prune(state);
        Ok(())
    }

    /// Removes the files of machines that the state does not name. Files that cannot be removed now are removed after the
    /// next change.
    fn prune(&self, state: &State) {
        let kept: BTreeSet<_> = state.kept().collect();
        for name in self.disk.names(Folder::Machines).unwrap_or_default() {
            let hash = name.strip_suffix(SIGNATURE_ENDING).or(name.strip_suffix(MACHINE_ENDING));
            let hash = hash.and_then(|hash| hash.parse().ok());
            if is_temporary(&name) || hash.is_some_and(|hash: MachineHash| !kept.contains(&hash)) {
                let _ = self.disk.remove(Folder::Machines, &name);
            }
        }
    }

    fn lock(&self) -> Result<Lock, StoreError> {
        self.disk.lock().map_err(|cause| match cause.kind() {
            ErrorKind::WouldBlock => StoreError::Busy { path: self.path.clone() },
            _ => StoreError::Write { path: self.at(Folder::Root, LOCK_FILE), cause },
        })
    }

    fn write(&self, folder: Folder, name: &str, content: &[u8]) -> Result<(), StoreError> {
        replace(&*self.disk, folder, name, content)
            .map_err(|cause| StoreError::Write { path: self.at(folder, name), cause })
    }

    fn sync(&self, folder: Folder) -> Result<(), StoreError> {
        self.disk.sync(folder).map_err(|cause| StoreError::Write { path: self.at(folder, ""), cause })
    }

    /// The path of a file, for messages.
    fn at(&self, folder: Folder, name: &str) -> PathBuf {
        self.path.join(folder.path()).join(name)
    }
}

/// Returns an error for a machine that is older than the good one.
fn check_counter(claims: &Claims, state: &State) -> Result<(), StoreError> {
    match state.counter {
        Some(least) if claims.counter < state.counter => Err(StoreError::RolledBack { found: claims.counter, least }),
        _ => Ok(()),
    }
}

fn file_name(hash: MachineHash, ending: &str) -> String {
    format!("{hash}{ending}")
}
