//! The program, run.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub(crate) const ROOT: &str = env!("CARGO_MANIFEST_DIR");

pub(crate) fn vibrissa(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vibrissa")).args(arguments).current_dir(ROOT).output().unwrap()
}

/// The same with a text at its standard input.
pub(crate) fn vibrissa_reading(arguments: &[&str], text: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

pub(crate) fn bad(kind: &str) -> Vec<String> {
    let directory = Path::new(ROOT).join("tests/fixtures").join(kind).join("bad");
    let files = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some()).map(|file| file.display().to_string()).collect()
}

/// A directory of its own for one test, emptied before.
pub(crate) fn directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).unwrap();
    directory
}

/// Lines of JSON without the origin, which only the first line of a file has.
pub(crate) fn without_origin(lines: &str) -> String {
    let Some((before, origin)) = lines.split_once("\"provenance\":{") else { return lines.to_owned() };
    let origin = format!("{{{origin}");
    let mut documents = serde_json::Deserializer::from_str(&origin).into_iter::<serde_json::Value>();
    documents.next().unwrap().unwrap();
    format!("{before}\"provenance\":null{}", &origin[documents.byte_offset()..])
}
