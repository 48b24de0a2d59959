//! Set-up, demonstration and checks of Vibrissa, one command each.
//!
//! A command has a file of its name and a line in `arguments.rs`. The checks of `cargo x test` are in `checks.rs`, the published
//! pages in `results/pages.rs`, and their tables in `results/tables.rs`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command talks to its user")]
#![allow(clippy::disallowed_methods, reason = "it writes what Git has an old version of, or prepares it aside")]

mod arguments;
mod bench;
mod book;
mod cargo;
mod checkout;
mod checks;
mod comments;
mod commits;
mod cross;
mod demo;
mod fuzz;
mod gallery;
mod hash;
mod instructions;
mod json;
mod links;
mod nightly;
mod pack;
mod pi;
mod pieces;
mod platform;
mod playground;
mod prose;
mod python;
mod release;
mod results;
mod runtime;
mod setup;
mod sign_of_life;
mod sources;
mod stamp;
mod standard_library;
mod web;
mod wheel;
// The program and the pages state the same intervals.
#[path = "../../crates/lab/src/results/wilson.rs"]
mod wilson;

use std::env;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arguments::{Command, USAGE};

fn main() -> ExitCode {
    let command = match Command::parse(env::args_os().skip(1)) {
        Ok(command) => command,
        Err(error) => {
            eprintln!("error: {error}\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let Some(root) = checkout_root() else {
        eprintln!("error: this program knows its checkout only through Cargo: run it as `cargo x`");
        return ExitCode::from(2);
    };
    match command {
        Command::Help => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        Command::Setup(options) => status(setup::setup(&root, &options)),
        Command::Demo => demo::demo(&root).unwrap_or_else(|error| status(Err(error))),
        Command::Test { chosen } => status(checks::run(&root, chosen)),
        Command::Prose => prose(&root),
        Command::Links => status(links::check(&root)),
        Command::Book => status(book::build(&root).map(|page| println!("Open {} in a browser.", page.display()))),
        Command::Bench { save } => status(bench::bench(&root, save)),
        Command::Instructions(options) => status(instructions::instructions(&root, &options)),
        Command::Results(selection) => status(results::write(&root, &selection)),
        Command::Stale => status(results::check(&root).map(|()| println!("No page is stale."))),
        Command::Nightly(options) => status(nightly::nightly(&root, &options)),
        Command::Pieces(options) => status(pieces::write(&root, &options)),
        Command::Python => status(python::test(&root)),
        Command::Pi => status(pi::pack(&root).map(|_| ())),
        Command::Release => {
            status(release::release(&root).map(|folder| println!("All files are in {}.", folder.display())))
        }
        Command::Web => status(web::write(&root)),
        Command::Playground => status(playground::build(&root).map(|folder| println!("{}", folder.display()))),
        Command::Fuzz(texts) => status(fuzz::fuzz(&root, texts)),
    }
}

/// Measures the pages and the doc comments.
fn prose(root: &Path) -> ExitCode {
    match prose::check(root) {
        Ok(()) => status(comments::check(root)),
        Err(error) => status(Err(error)),
    }
}

/// The workspace's directory. Read at run time, not compiled in: several checkouts may share a target directory.
fn checkout_root() -> Option<PathBuf> {
    let xtask = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR")?);
    xtask.parent().map(Path::to_path_buf)
}

fn status<E: std::error::Error>(result: Result<(), E>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
