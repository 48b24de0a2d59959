//! The pictures of the book's gallery: runs of scenes by a program that is built already.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::time::SystemTime;
use std::{fs, io};

use thiserror::Error;

use crate::cargo::target_directory;
use crate::pack::{PackError, copy};
use crate::results::BENCH;

/// The shapes of the zoo that the page shows.
const ZOO: [&str; 4] = ["cad-bracket", "star5", "plus", "letter-e"];
/// The options of the runs. The quasi-static simulator needs no library and seconds, and has the same bits on every computer.
const OPTIONS: [&str; 5] = ["--policy", "vibrissa", "--simulator", "quasistatic", "--out"];
/// The folder of the pictures, in the target directory and beside the pages of the book.
const FOLDER: &str = "gallery";

/// Why the gallery has no pictures.
#[derive(Debug, Error)]
pub(crate) enum GalleryError {
    #[error("the program for the gallery, {}, cannot be run: {source}", path.display())]
    Program { path: PathBuf, source: io::Error },
    #[error(
        "the program for the gallery, {}, failed ({status}). Build it from this checkout, or remove it for a book without pictures. It \
         said:\n{said}",
        path.display()
    )]
    Failed { path: PathBuf, status: ExitStatus, said: String },
    #[error(transparent)]
    Copy(#[from] PackError),
}

/// Puts the pictures into a built book. They are made anew if the program is newer than they are.
pub(crate) fn add(root: &Path, book: &Path) -> Result<(), GalleryError> {
    add_from(&target_directory(root), book)
}

/// Takes the program from a target directory, and keeps the pictures there.
fn add_from(target: &Path, book: &Path) -> Result<(), GalleryError> {
    let Some((program, built)) = newest(["release", "debug"].map(|profile| target.join(profile).join("vibrissa")))
    else {
        println!("The gallery has no pictures, because no program is built (cargo build --release).");
        return Ok(());
    };
    let made = target.join(FOLDER);
    let picture = |folder: &Path, name: &str| folder.join(name).with_extension("svg");
    let names: Vec<&str> = BENCH.into_iter().chain(ZOO).collect();
    if !names.iter().all(|name| written(&picture(&made, name)).is_some_and(|time| time > built)) {
        println!("Drawing {} runs for the gallery. This is done once after each build.", names.len());
        draw(&program, &made)?;
    }
    for name in names {
        copy(&picture(&made, name), &picture(&book.join(FOLDER), name))?;
    }
    Ok(())
}

/// Runs the scenes, and writes their pictures into a folder. A run that does not meet its expectations has a picture, too.
fn draw(program: &Path, folder: &Path) -> Result<(), GalleryError> {
    let scenes = BENCH.into_iter().map(str::to_owned).chain(ZOO.map(|shape| format!("zoo/{shape}")));
    let output = Command::new(program).arg("run").args(scenes).args(OPTIONS).arg(folder).output();
    let output = output.map_err(|source| GalleryError::Program { path: program.to_owned(), source })?;
    match output.status.code() {
        Some(0 | 1) => Ok(()),
        _ => Err(GalleryError::Failed {
            path: program.to_owned(),
            status: output.status,
            said: String::from_utf8_lossy(&output.stderr).into_owned(),
        }),
    }
}

/// The file that was written last, and when. `None` if there is none of them.
fn newest<const N: usize>(files: [PathBuf; N]) -> Option<(PathBuf, SystemTime)> {
    files.into_iter().filter_map(|file| written(&file).map(|time| (file, time))).max_by_key(|(_, time)| *time)
}

/// When a file was written. `None` if it is not there.
fn written(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|file| file.modified()).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn the_page_shows_each_picture_once_and_no_other() {
        let page = include_str!("../../docs/gallery.md");
        let mut shown: Vec<&str> =
            page.split("src=\"gallery/").skip(1).filter_map(|rest| rest.split(".svg\"").next()).collect();
        let mut made: Vec<&str> = BENCH.into_iter().chain(ZOO).collect();
        shown.sort_unstable();
        made.sort_unstable();
        assert_eq!(shown, made);
        // Each has a name for readers who do not see it.
        assert_eq!(page.matches("<img ").count(), page.matches(" alt=\"").count());
    }

    #[test]
    #[cfg(unix)]
    fn pictures_are_made_by_the_newest_program_and_only_after_a_build() {
        use std::os::unix::fs::PermissionsExt;
        let root = std::env::temp_dir().join(format!("vibrissa-gallery-{}", std::process::id()));
        let (book, program) = (root.join("book"), root.join("release/vibrissa"));
        fs::create_dir_all(program.parent().unwrap()).unwrap();
        // Without a program, the book stays without pictures.
        add_from(&root, &book).unwrap();
        assert!(!book.join(FOLDER).exists());
        // It draws its own number of calls, and ends as if an expectation did not hold.
        let script = "#!/bin/sh\ncd \"$(dirname \"$0\")\"\necho >> calls\nfor last; do :; done\nmkdir -p \"$last\"\nshift\n\
            for name; do wc -l < calls > \"$last/$(basename -- \"$name\").svg\"; done\nexit 1\n";
        fs::write(&program, script).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let old = SystemTime::now() - std::time::Duration::from_mins(1);
        let set = |time| fs::File::options().append(true).open(&program).unwrap().set_modified(time).unwrap();
        let picture = |name: &str| fs::read_to_string(book.join(FOLDER).join(name)).unwrap().trim().to_owned();
        set(old);
        add_from(&root, &book).unwrap();
        add_from(&root, &book).unwrap();
        assert_eq!([picture("disk.svg"), picture("star5.svg")], ["1", "1"]);
        set(SystemTime::now() + std::time::Duration::from_mins(1));
        add_from(&root, &book).unwrap();
        assert_eq!(picture("disk.svg"), "2");
        fs::write(&program, "#!/bin/sh\necho no library >&2\nexit 2\n").unwrap();
        set(SystemTime::now() + std::time::Duration::from_mins(1));
        let failure = add_from(&root, &book).unwrap_err().to_string();
        assert!(failure.contains("no library") && failure.contains("Build it"), "{failure}");
        fs::remove_dir_all(&root).unwrap();
    }
}
