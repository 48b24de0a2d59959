//! The scripts and style sheets of the pages: their sources in `web/src`, bundled into `web/dist`, which the program contains.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::{env, fs, io};

use thiserror::Error;

use crate::cargo::target_directory;
use crate::playground::{MODULE, folder};

/// The names of the bundles: the script and the style sheet of each page.
const BUNDLES: [&str; 4] = ["report.js", "report.css", "live.js", "live.css"];

/// The browser that all pages are used in.
const CHROMIUM: &str = "/usr/bin/chromium";
/// The browser that the playground runs in too.
const FIREFOX: &str = "/usr/bin/firefox-esr";

/// A fault of the scripts, or of the tools that check them.
#[derive(Debug, Error)]
pub(crate) enum WebError {
    #[error("there is no npm; install Node.js 20 or newer with npm, then try again")]
    NoNpm,
    #[error("there is no Chromium at {CHROMIUM}; install the Debian package `chromium`")]
    NoChromium,
    #[error("`{command}` failed ({status}); what it found is above")]
    Failed { command: String, status: ExitStatus },
    #[error("web/dist/{0} differs from the bundle of web/src; write it by `cargo x web`")]
    Outdated(&'static str),
    #[error("cannot {action} {}: {source}", path.display())]
    Disk { action: &'static str, path: PathBuf, source: io::Error },
}

/// Checks the types and writes the bundles into `web/dist`.
pub(crate) fn write(root: &Path) -> Result<(), WebError> {
    let web = root.join("web");
    prepare(&web)?;
    run(&web, "npm", &["run", "--silent", "bundle", "dist"])
}

/// Checks the types and writes the scripts of the playground into a folder.
pub(crate) fn bundle_playground(root: &Path, folder: &Path) -> Result<(), WebError> {
    let web = root.join("web");
    prepare(&web)?;
    fs::create_dir_all(folder).map_err(|source| WebError::Disk { action: "make", path: folder.to_owned(), source })?;
    run(&web, "npm", &["run", "--silent", "bundle", &folder.to_string_lossy(), "playground"])
}

/// Checks the types, and that `web/dist` has the bundles of the sources.
pub(crate) fn check(root: &Path) -> Result<(), WebError> {
    let web = root.join("web");
    prepare(&web)?;
    let fresh = target_directory(root).join("web");
    run(&web, "npm", &["run", "--silent", "bundle", &fresh.to_string_lossy()])?;
    for name in BUNDLES {
        let read = |path: PathBuf| fs::read(&path).map_err(|source| WebError::Disk { action: "read", path, source });
        if read(web.join("dist").join(name))? != read(fresh.join(name))? {
            return Err(WebError::Outdated(name));
        }
    }
    Ok(())
}

/// Uses the pages of the tested program in Chromium: a report of the bench, one of a sweep, the live page, and the
/// playground if it is built.
pub(crate) fn browse(root: &Path) -> Result<(), WebError> {
    if !Path::new(CHROMIUM).exists() {
        return Err(WebError::NoChromium);
    }
    let reports = target_directory(root).join("web/reports");
    let program = target_directory(root).join("debug/vibrissa").with_extension(env::consts::EXE_EXTENSION);
    let program = program.to_string_lossy().into_owned();
    let [bench, sweep] = ["bench", "sweep"].map(|name| reports.join(name).to_string_lossy().into_owned());
    run(root, &program, &["bench", "--ideal", "--simulator", "quasistatic", "--out", &bench])?;
    run(root, &program, &["sweep", "web/test/sweep.yaml", "--out", &sweep])?;
    let pages = [bench, sweep].map(|directory| format!("{directory}/index.html"));
    let web = root.join("web");
    run(&web, "node", &["test/pages.mjs", &pages[0], &pages[1]])?;
    run(&web, "node", &["test/live.mjs", &program])?;
    let playground = folder(root);
    if !playground.join(MODULE).exists() {
        println!("      left out: the playground, which is not built (cargo x playground)");
        return Ok(());
    }
    let playground = playground.to_string_lossy();
    run(&web, "node", &["test/bits.mjs", &program, &playground])?;
    run(&web, "node", &["test/playground.mjs", &program, &playground])?;
    if !Path::new(FIREFOX).exists() {
        println!("      left out: the playground in Firefox, which is not installed ({FIREFOX})");
        return Ok(());
    }
    run(&web, "node", &["test/firefox.mjs", &program, &playground, FIREFOX])
}

/// Installs the pinned tools, checks the types, and tests the parts that need no browser.
fn prepare(web: &Path) -> Result<(), WebError> {
    if Command::new("npm").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err() {
        return Err(WebError::NoNpm);
    }
    run(web, "npm", &["ci", "--silent", "--no-audit", "--no-fund"])?;
    run(web, "npm", &["run", "--silent", "check"])?;
    run(web, "npm", &["run", "--silent", "test"])
}

fn run(web: &Path, program: &str, arguments: &[&str]) -> Result<(), WebError> {
    let status = Command::new(program).args(arguments).current_dir(web).status();
    let status = status.map_err(|source| WebError::Disk { action: "run", path: program.into(), source })?;
    let command = || format!("{program} {}", arguments.join(" "));
    if status.success() { Ok(()) } else { Err(WebError::Failed { command: command(), status }) }
}
