//! The same text always gives the same.

use std::path::Path;
use std::process::Command;
use std::{fs, thread};

use vibrissa::diagnostic::{Diagnostic, Source};
use vibrissa::policy::compile_with_warnings;

use crate::answered::source;
use crate::random::Random;
use crate::{THESIS, mutate};

/// What a text gives: the bytes of its machine and the warnings, or the faults.
fn result(text: &str) -> Result<(Vec<u8>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let compiled = compile_with_warnings(&source(text))?;
    Ok((compiled.artifact.to_bytes().unwrap(), compiled.warnings))
}

/// Every thread, and every process, has seeds of its own for the order of its hash tables.
#[test]
fn the_same_text_gives_the_same_bytes_or_the_same_faults_in_every_thread() {
    let corpus = mutate::corpus();
    let generated = (0..300).map(|seed| mutate::input(&corpus, &mut Random(seed)));
    let texts: Vec<String> = corpus.right.iter().chain(&corpus.wrong).cloned().chain(generated).collect();
    let all = || texts.iter().map(|text| result(text)).collect::<Vec<_>>();
    let once = all();
    thread::scope(|scope| {
        for again in [scope.spawn(all), scope.spawn(all)] {
            for ((text, once), again) in texts.iter().zip(&once).zip(again.join().unwrap()) {
                assert!(*once == again, "{once:?} is not {again:?}:\n{text}");
            }
        }
    });
    assert!(once.iter().filter(|result| result.is_ok()).count() > 50);
}

#[test]
fn the_same_text_gives_the_same_bytes_in_every_process() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let compiled = |name: &str| {
        let file = folder.join(name);
        let policy = Path::new(env!("CARGO_MANIFEST_DIR")).join("policies/thesis.fsm");
        let run = Command::new(env!("CARGO_BIN_EXE_vibrissa")).arg("compile").arg(policy).arg("-o").arg(&file).output();
        assert!(run.unwrap().status.success());
        fs::read(file).unwrap()
    };
    let (once, again) = (compiled("once.machine"), compiled("again.machine"));
    let here = compile_with_warnings(&Source::new("thesis.fsm", THESIS)).unwrap().artifact.to_bytes().unwrap();
    assert!(once == again && once == here);
}
