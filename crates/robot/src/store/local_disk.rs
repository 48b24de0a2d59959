//! The files of a store on a real disk.

use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind, Result, Write};
use std::os::fd::OwnedFd;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use rustix::fs::{
    AtFlags, CWD, Dir, Gid, Mode, OFlags, Uid, fchmod, fchown, fstat, fsync, mkdirat, openat, renameat, unlinkat,
};
use rustix::io::Errno;

use super::disk::{Disk, Folder, Lock};
use super::file::read_at_most;

/// Name of the file that is locked.
pub(super) const LOCK_FILE: &str = "lock";
/// The longest time to wait for another program. A change takes milliseconds.
const PATIENCE: Duration = Duration::from_secs(10);
const PAUSE: Duration = Duration::from_millis(5);
/// Modes of new folders and files, before the umask.
const FOLDER_MODE: Mode = Mode::from_raw_mode(0o755);
const FILE_MODE: Mode = Mode::from_raw_mode(0o644);
const LOCK_MODE: Mode = Mode::from_raw_mode(0o600);

/// The folders of a store, open. All files are opened relative to them, so nobody can exchange a folder for a link.
#[derive(Debug)]
pub(super) struct LocalDisk {
    root: OwnedFd,
    machines: OwnedFd,
}

impl LocalDisk {
    /// Opens the store at `root`. Creates the folder `machines` in it if it is missing, but not the store itself.
    pub(super) fn open(root: &Path) -> Result<Self> {
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC;
        let root = openat(CWD, root, flags, Mode::empty())?;
        let name = Folder::Machines.path();
        let open = || openat(&root, name, flags | OFlags::NOFOLLOW, Mode::empty());
        let machines = match open() {
            Err(Errno::NOENT) => {
                // Another program may create it at the same time.
                match mkdirat(&root, name, FOLDER_MODE) {
                    Err(Errno::EXIST) => {}
                    made => made?,
                }
                open()?
            }
            Err(Errno::NOTDIR | Errno::LOOP) => return Err(not_regular(name, "directory")),
            opened => opened?,
        };
        Ok(Self { root, machines })
    }

    fn folder(&self, folder: Folder) -> &OwnedFd {
        match folder {
            Folder::Root => &self.root,
            Folder::Machines => &self.machines,
        }
    }

    /// Opens a regular file. A pipe does not make it wait.
    fn open_file(&self, folder: Folder, name: &str, flags: OFlags) -> Result<File> {
        let flags = flags | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let file = match openat(self.folder(folder), name, flags, FILE_MODE) {
            Err(Errno::LOOP) => return Err(not_regular(name, "regular file")),
            opened => File::from(opened?),
        };
        if file.metadata()?.is_file() { Ok(file) } else { Err(not_regular(name, "regular file")) }
    }
}

impl LocalDisk {
    /// Leaves the lock to the owner of the store, because everybody who can read a file can lock it. A lock that root has
    /// made is given to the owner too. Another user's lock stays as it is.
    fn protect(&self, file: &File) {
        if let (Ok(lock), Ok(root)) = (fstat(file), fstat(&self.root)) {
            if lock.st_uid != root.st_uid {
                let _ = fchown(file, Some(Uid::from_raw(root.st_uid)), Some(Gid::from_raw(root.st_gid)));
            }
            if lock.st_mode & 0o777 != LOCK_MODE.as_raw_mode() {
                let _ = fchmod(file, LOCK_MODE);
            }
        }
    }
}

fn not_regular(name: &str, kind: &str) -> Error {
    Error::new(ErrorKind::InvalidInput, format!("{name} is a symbolic link or something else than a {kind}"))
}

impl Disk for LocalDisk {
    fn lock(&self) -> Result<Lock> {
        let file = self.open_file(Folder::Root, LOCK_FILE, OFlags::RDONLY | OFlags::CREATE)?;
        self.protect(&file);
        let until = Instant::now() + PATIENCE;
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(Lock(Some(file))),
                Err(TryLockError::Error(cause)) => return Err(cause),
                Err(TryLockError::WouldBlock) if Instant::now() >= until => return Err(ErrorKind::WouldBlock.into()),
                Err(TryLockError::WouldBlock) => thread::sleep(PAUSE),
            }
        }
    }

    fn read(&self, folder: Folder, name: &str, limit: usize) -> Result<Vec<u8>> {
        read_at_most(self.open_file(folder, name, OFlags::RDONLY)?, limit)
    }

    fn names(&self, folder: Folder) -> Result<Vec<String>> {
        let mut names = Vec::new();
        for entry in Dir::read_from(self.folder(folder))? {
            if let Ok(name) = entry?.file_name().to_str() {
                names.push(name.to_owned());
            }
        }
        Ok(names)
    }

    fn create(&self, folder: Folder, name: &str, content: &[u8]) -> Result<()> {
        let mut file = self.open_file(folder, name, OFlags::WRONLY | OFlags::CREATE | OFlags::EXCL)?;
        file.write_all(content)?;
        file.sync_all()
    }

    fn rename(&self, folder: Folder, from: &str, to: &str) -> Result<()> {
        let folder = self.folder(folder);
        Ok(renameat(folder, from, folder, to)?)
    }

    fn remove(&self, folder: Folder, name: &str) -> Result<()> {
        Ok(unlinkat(self.folder(folder), name, AtFlags::empty())?)
    }

    fn sync(&self, folder: Folder) -> Result<()> {
        match fsync(self.folder(folder)) {
            // Some file systems cannot synchronise a folder.
            Err(Errno::INVAL | Errno::OPNOTSUPP) => Ok(()),
            done => Ok(done?),
        }
    }
}
