//! The program with faults in its system calls.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::command::program::{ROOT, directory};

/// What becomes of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Nothing.
    None,
    /// The program is killed before it.
    Kill,
    /// From this call on nothing has room on the disk.
    Full,
    /// It alone fails.
    Broken,
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Kill => "kill",
            Self::Full => "full",
            Self::Broken => "broken",
        }
    }
}

/// The library that is preloaded.
#[derive(Debug, Clone)]
pub(super) struct Shim {
    library: PathBuf,
}

/// What came of a run.
#[derive(Debug)]
pub(super) struct Ran {
    /// `None` if it was killed.
    pub(super) status: Option<i32>,
    /// Its standard error.
    pub(super) told: String,
    /// The calls by which it read or changed the folder, each with its path.
    pub(super) calls: Vec<(String, String)>,
}

impl Shim {
    /// Built with the C compiler that Rust links with, once; `None`, and a message, where it cannot be.
    pub(super) fn built() -> Option<Self> {
        static BUILT: OnceLock<Option<Shim>> = OnceLock::new();
        BUILT.get_or_init(Self::build).clone()
    }

    fn build() -> Option<Self> {
        let library = directory("fault-shim").join("shim.so");
        let source = Path::new(ROOT).join("tests/program/faults/shim.c");
        let mut compiler = Command::new("cc");
        compiler.args(["-O1", "-shared", "-fPIC", "-o"]).arg(&library).arg(source).arg("-ldl");
        match compiler.output() {
            Ok(output) if output.status.success() => Some(Self { library }),
            Ok(output) => panic!("shim.c: {}", String::from_utf8_lossy(&output.stderr)),
            Err(cause) => {
                #[expect(clippy::print_stderr, reason = "a check is left out")]
                {
                    eprintln!("left out, since there is no C compiler `cc`: {cause}");
                }
                None
            }
        }
    }

    /// Runs the program with a fault in the call `at`, counted from 1, of those in the folder `within`.
    pub(super) fn run(&self, arguments: &[String], within: &Path, kind: Kind, at: usize) -> Ran {
        static RUNS: AtomicUsize = AtomicUsize::new(0);
        let log = self.library.with_extension(format!("{}.log", RUNS.fetch_add(1, Ordering::Relaxed)));
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        command.args(arguments).env("LD_PRELOAD", &self.library).env("FAULT_LOG", &log).env("FAULT_IN", within);
        let output = command.env("FAULT_KIND", kind.word()).env("FAULT_AT", at.to_string()).output().unwrap();
        let text = fs::read_to_string(&log).unwrap_or_default();
        let _ = fs::remove_file(&log);
        let calls = text.lines().map(|line| line.split_once(' ').unwrap());
        Ran {
            status: output.status.code(),
            told: String::from_utf8_lossy(&output.stderr).into_owned(),
            calls: calls.map(|(call, path)| (call.to_owned(), path.to_owned())).collect(),
        }
    }
}
