//! Files packed so that the same commit gives the same bytes.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::{fs, io};

use thiserror::Error;

/// The time (s since 1970) of all packed files. It is 2026-01-01.
pub(crate) const TIME: &str = "1767225600";

/// Why nothing was packed, and what to do.
#[derive(Debug, Error)]
pub(crate) enum PackError {
    #[error("{program}: it failed ({status}); what it said is above")]
    Failed { program: &'static str, status: ExitStatus },
    #[error("there is no `{program}`, which packs the files. Install it (Debian, Ubuntu: `apt-get install {package}`)")]
    NoProgram { program: &'static str, package: &'static str },
    #[error("cannot {action} {}: {source}", path.display())]
    Disk { action: &'static str, path: PathBuf, source: io::Error },
}

/// Packs the folder `name` of `staging` as `name.tar.gz` in `folder`, and gives its path.
pub(crate) fn archive(staging: &Path, name: &str, folder: &Path) -> Result<PathBuf, PackError> {
    set_modes(&staging.join(name))?;
    let path = folder.join(format!("{name}.tar.gz"));
    let mut command = Command::new("tar");
    command.args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--format=gnu"]);
    // gzip by itself would write the time of packing.
    command.arg(format!("--mtime=@{TIME}")).args(["--use-compress-program", "gzip -9 --no-name"]);
    command.arg("--create").arg("--file").arg(&path).arg("--directory").arg(staging).arg(name);
    succeed(&mut command, "tar", "tar")?;
    Ok(path)
}

/// Copies a file or a folder, and creates the folder around it.
pub(crate) fn copy(from: &Path, to: &Path) -> Result<(), PackError> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(disk("create", folder))?;
    }
    if !from.is_dir() {
        fs::copy(from, to).map_err(disk("read", from))?;
        return Ok(());
    }
    fs::create_dir_all(to).map_err(disk("create", to))?;
    for entry in fs::read_dir(from).map_err(disk("read", from))? {
        let entry = entry.map_err(disk("read", from))?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

/// Makes a folder empty.
pub(crate) fn clear(folder: &Path) -> Result<(), PackError> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(disk("clear", folder))?;
    }
    fs::create_dir_all(folder).map_err(disk("create", folder))
}

/// Sets the modes of all files, which otherwise depend on the umask of the user and of the checkout.
pub(crate) fn set_modes(folder: &Path) -> Result<(), PackError> {
    succeed(Command::new("chmod").args(["-R", "u=rwX,go=rX"]).arg(folder), "chmod", "coreutils")
}

/// Runs a program of a Debian package.
pub(crate) fn succeed(command: &mut Command, program: &'static str, package: &'static str) -> Result<(), PackError> {
    // What these programs print says the summary too.
    match command.stdout(Stdio::null()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(PackError::Failed { program, status }),
        Err(source) if source.kind() == io::ErrorKind::NotFound => Err(PackError::NoProgram { program, package }),
        Err(source) => Err(PackError::Disk { action: "run", path: program.into(), source }),
    }
}

/// The error of a file.
pub(crate) fn disk(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> PackError {
    let path = path.to_path_buf();
    move |source| PackError::Disk { action, path, source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::sha256;

    #[test]
    fn the_same_files_give_the_same_bytes_whenever_they_were_written() -> Result<(), PackError> {
        let folder = std::env::temp_dir().join(format!("xtask-pack-{}", std::process::id()));
        let mut hashes = Vec::new();
        for round in ["first", "second"] {
            let staging = folder.join(round);
            clear(&staging)?;
            // In another order each time.
            let names = if round == "first" { ["a", "b"] } else { ["b", "a"] };
            for name in names {
                let file = staging.join("packed/deep").join(name);
                copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"), &file)?;
            }
            let packed = archive(&staging, "packed", &staging)?;
            hashes.push(sha256(&packed).map_err(disk("read", &packed))?);
        }
        fs::remove_dir_all(&folder).map_err(disk("clear", &folder))?;
        assert_eq!(hashes[0], hashes[1]);
        Ok(())
    }
}
