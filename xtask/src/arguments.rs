//! What the user asks for.

use std::ffi::OsString;
use std::path::PathBuf;

use thiserror::Error;

use crate::checks::Chosen;
use crate::instructions;
use crate::nightly;
use crate::pieces;
use crate::results::Selection;
use crate::setup::Options;

/// The help text.
pub(crate) const USAGE: &str = "\
Usage: cargo x COMMAND

Commands:
  setup   fetch MuJoCo's library and plugin into .mujoco, unless they are there already
            --force        fetch them again
            --wheel FILE   take them from this wheel, on a machine without network
  demo    set up, build in release, run the disk scenario and print where its report is
  test    set up, then every test and every lint
            --from K       begin with check number K, after the cause of a failure is corrected
            --part PART    `lints`, which are all before the tests, or `tests`, which are the rest
  prose   measure the sentences and terms of the documentation
  links   follow the links between the pages of the documentation
  book    build the documentation as a book in target/book
  web     check the scripts of the pages and bundle them into web/dist; needs npm
  bench   run all benches and compare them with benches/baseline.csv
            --save         make them the baseline
  playground  build the playground for the browser in target/playground; needs npm and the target wasm32-unknown-unknown
  instructions  count the instructions of whole runs with Valgrind and compare them with benches/instructions.csv
            --accept WHY   store the changed counts with this reason
            --program FILE use this program instead of building it
  results [NAME...]  write the pages of measured figures into docs/results; without names, those of less than two minutes
            --stale        only the pages whose inputs have changed, all of them without names; goes on where it was stopped
            --check        only say which pages that are
            --program FILE use this program of the same commit instead of building it
  nightly run the families of docs/results/families.md again and print the verdicts that changed; calibrate drawn arrays
            --count N      only the first N scenes of each family
            --program FILE use this program instead of building it
  pieces  remove each part of vibrissa.fsm in turn and write what it is worth into target/pieces; goes on where it was stopped
            --count N      run N scenes of each family (5)
            --program FILE use this program instead of building it
  python  build the wheel of the Python package, install it into a fresh virtual environment and run its tests
  pi      build the robot's program for the Raspberry Pi and pack it in target/pi
  release build, check and list everything that a tag publishes, in target/release-files; takes half an hour
  fuzz N  try N mutated and generated policies in release; FUZZ_SEED=K tries others
  help    print this";

/// One command of `cargo x`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Command {
    Help,
    Setup(Options),
    Demo,
    /// Checks.
    Test {
        chosen: Chosen,
    },
    Prose,
    Links,
    Book,
    Bench {
        save: bool,
    },
    Instructions(instructions::Options),
    Results(Selection),
    /// Says which published pages are stale.
    Stale,
    Nightly(nightly::Options),
    Pieces(pieces::Options),
    Python,
    Pi,
    Release,
    Web,
    Playground,
    Fuzz(u64),
}

/// Why a command line was not understood.
#[derive(Debug, PartialEq, Eq, Error)]
pub(crate) enum ArgumentError {
    #[error("there is no command `{0}`")]
    UnknownCommand(String),
    #[error("`{command}` does not take `{argument}`")]
    UnexpectedArgument { command: String, argument: String },
    #[error("`--wheel` needs the file that it is to take")]
    NoWheelFile,
    #[error("`--program` needs the file that it is to run")]
    NoProgram,
    #[error("`--accept` needs the reason of the change, without a line end")]
    NoReason,
    #[error("`--from` needs the number of a check, such as `cargo x test --from 12`")]
    NoCheck,
    #[error("`--part` is `lints` or `tests`")]
    NoPart,
    #[error("`--count` needs how many scenes of each family to run")]
    NoScenes,
    #[error("`fuzz` needs how many policies to try, such as `cargo x fuzz 100000`")]
    NoCount,
}

impl Command {
    /// Reads the arguments that follow the program's name.
    pub(crate) fn parse(mut arguments: impl Iterator<Item = OsString>) -> Result<Self, ArgumentError> {
        let Some(name) = arguments.next() else { return Ok(Self::Help) };
        let name = name.to_string_lossy().into_owned();
        let command = match name.as_str() {
            "help" | "--help" | "-h" => Self::Help,
            "setup" => return parse_setup(arguments),
            "demo" => Self::Demo,
            "test" => return parse_test(arguments),
            "prose" => Self::Prose,
            "links" => Self::Links,
            "book" => Self::Book,
            "bench" => {
                let mut arguments = arguments.peekable();
                let save = arguments.next_if(|argument| argument == "--save").is_some();
                return end("bench", arguments, Self::Bench { save });
            }
            "instructions" => return parse_instructions(arguments),
            "results" => return parse_results(arguments),
            "nightly" => return parse_nightly(arguments),
            "pieces" => return parse_pieces(arguments),
            "python" => Self::Python,
            "pi" => Self::Pi,
            "release" => Self::Release,
            "web" => Self::Web,
            "playground" => Self::Playground,
            "fuzz" => {
                let count = arguments.next().and_then(|count| count.to_str()?.parse().ok());
                Self::Fuzz(count.ok_or(ArgumentError::NoCount)?)
            }
            _ => return Err(ArgumentError::UnknownCommand(name)),
        };
        end(&name, arguments, command)
    }
}

/// A command, if its arguments end here.
fn end(name: &str, mut arguments: impl Iterator<Item = OsString>, command: Command) -> Result<Command, ArgumentError> {
    match arguments.next() {
        None => Ok(command),
        Some(argument) => Err(unexpected(name, &argument)),
    }
}

fn parse_setup(mut arguments: impl Iterator<Item = OsString>) -> Result<Command, ArgumentError> {
    let mut options = Options::default();
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--force") => options.force = true,
            Some("--wheel") => {
                options.wheel = Some(arguments.next().map(PathBuf::from).ok_or(ArgumentError::NoWheelFile)?);
            }
            Some("--help" | "-h") => return Ok(Command::Help),
            _ => return Err(unexpected("setup", &argument)),
        }
    }
    Ok(Command::Setup(options))
}

fn parse_test(arguments: impl Iterator<Item = OsString>) -> Result<Command, ArgumentError> {
    let mut arguments = arguments.peekable();
    let mut chosen = Chosen::From(1);
    if arguments.next_if(|argument| argument == "--from").is_some() {
        let number = arguments.next().and_then(|number| number.to_str()?.parse().ok());
        chosen = number.filter(|&number| number > 0).map(Chosen::From).ok_or(ArgumentError::NoCheck)?;
    } else if arguments.next_if(|argument| argument == "--part").is_some() {
        chosen = match arguments.next().as_ref().and_then(|part| part.to_str()) {
            Some("lints") => Chosen::Lints,
            Some("tests") => Chosen::Tests,
            _ => return Err(ArgumentError::NoPart),
        };
    }
    end("test", arguments, Command::Test { chosen })
}

fn parse_instructions(mut arguments: impl Iterator<Item = OsString>) -> Result<Command, ArgumentError> {
    let mut options = instructions::Options::default();
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--accept") => {
                let reason = arguments.next().and_then(|reason| reason.into_string().ok());
                let reason = reason.filter(|reason| !reason.trim().is_empty() && !reason.contains('\n'));
                options.accept = Some(reason.ok_or(ArgumentError::NoReason)?);
            }
            Some("--program") => options.program = Some(program(&mut arguments)?),
            Some("--help" | "-h") => return Ok(Command::Help),
            _ => return Err(unexpected("instructions", &argument)),
        }
    }
    Ok(Command::Instructions(options))
}

fn parse_results(mut arguments: impl Iterator<Item = OsString>) -> Result<Command, ArgumentError> {
    let mut selection = Selection::default();
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--check") if selection == Selection::default() => return end("results", arguments, Command::Stale),
            Some("--stale") => selection.stale = true,
            Some("--program") => selection.program = Some(program(&mut arguments)?),
            Some("--help" | "-h") => return Ok(Command::Help),
            Some(name) if !name.starts_with('-') => selection.names.push(name.to_owned()),
            _ => return Err(unexpected("results", &argument)),
        }
    }
    Ok(Command::Results(selection))
}

fn parse_nightly(mut arguments: impl Iterator<Item = OsString>) -> Result<Command, ArgumentError> {
    let mut options = nightly::Options::default();
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--count") => options.count = Some(scenes(&mut arguments)?),
            Some("--program") => options.program = Some(program(&mut arguments)?),
            Some("--help" | "-h") => return Ok(Command::Help),
            _ => return Err(unexpected("nightly", &argument)),
        }
    }
    Ok(Command::Nightly(options))
}

fn parse_pieces(mut arguments: impl Iterator<Item = OsString>) -> Result<Command, ArgumentError> {
    let mut options = pieces::Options::default();
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--count") => options.count = scenes(&mut arguments)?,
            Some("--program") => options.program = Some(program(&mut arguments)?),
            Some("--help" | "-h") => return Ok(Command::Help),
            _ => return Err(unexpected("pieces", &argument)),
        }
    }
    Ok(Command::Pieces(options))
}

/// The number behind `--count`.
fn scenes(arguments: &mut impl Iterator<Item = OsString>) -> Result<u64, ArgumentError> {
    let count = arguments.next().and_then(|count| count.to_str()?.parse().ok()).filter(|&count| count > 0);
    count.ok_or(ArgumentError::NoScenes)
}

/// The file behind `--program`.
fn program(arguments: &mut impl Iterator<Item = OsString>) -> Result<PathBuf, ArgumentError> {
    arguments.next().map(PathBuf::from).ok_or(ArgumentError::NoProgram)
}

fn unexpected(command: &str, argument: &OsString) -> ArgumentError {
    ArgumentError::UnexpectedArgument { command: command.to_owned(), argument: argument.to_string_lossy().into_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &[&str]) -> Result<Command, ArgumentError> {
        Command::parse(arguments.iter().map(OsString::from))
    }

    #[test]
    fn nothing_asks_for_help() {
        assert_eq!(parse(&[]), Ok(Command::Help));
    }

    #[test]
    fn setup_takes_a_wheel_and_force_in_any_order() {
        let options = Options { force: true, wheel: Some(PathBuf::from("a.whl")) };
        assert_eq!(parse(&["setup", "--wheel", "a.whl", "--force"]), Ok(Command::Setup(options.clone())));
        assert_eq!(parse(&["setup", "--force", "--wheel", "a.whl"]), Ok(Command::Setup(options)));
    }

    #[test]
    fn benches_are_compared_unless_they_are_to_be_saved() {
        assert_eq!(parse(&["bench"]), Ok(Command::Bench { save: false }));
        assert_eq!(parse(&["bench", "--save"]), Ok(Command::Bench { save: true }));
    }

    #[test]
    fn changed_instructions_are_accepted_with_a_reason() {
        let options = instructions::Options { accept: Some("a new solver".to_owned()), program: None };
        assert_eq!(parse(&["instructions", "--accept", "a new solver"]), Ok(Command::Instructions(options)));
        for reason in [&["instructions", "--accept"][..], &["instructions", "--accept", " "]] {
            assert_eq!(parse(reason), Err(ArgumentError::NoReason));
        }
    }

    #[test]
    fn results_take_names_and_a_program() {
        let selection = Selection { names: vec!["bench".to_owned()], stale: false, program: Some(PathBuf::from("v")) };
        assert_eq!(parse(&["results", "--program", "v", "bench"]), Ok(Command::Results(selection.clone())));
        let selection = Selection { stale: true, ..selection };
        assert_eq!(parse(&["results", "--stale", "bench", "--program", "v"]), Ok(Command::Results(selection)));
        assert_eq!(parse(&["results", "--check"]), Ok(Command::Stale));
        assert!(parse(&["results", "--check", "bench"]).is_err() && parse(&["results", "bench", "--check"]).is_err());
        assert_eq!(parse(&["results"]), Ok(Command::Results(Selection::default())));
        assert_eq!(parse(&["results", "--program"]), Err(ArgumentError::NoProgram));
        assert!(parse(&["results", "--all"]).is_err());
    }

    #[test]
    fn a_night_may_be_short_and_may_use_a_program() {
        let options = nightly::Options { count: Some(3), program: Some(PathBuf::from("v")) };
        assert_eq!(parse(&["nightly", "--count", "3", "--program", "v"]), Ok(Command::Nightly(options)));
        assert_eq!(parse(&["nightly"]), Ok(Command::Nightly(nightly::Options::default())));
        assert_eq!(parse(&["nightly", "--count", "0"]), Err(ArgumentError::NoScenes));
        assert!(parse(&["nightly", "disk"]).is_err());
    }

    #[test]
    fn the_python_package_has_a_command_without_arguments() {
        assert_eq!(parse(&["python"]), Ok(Command::Python));
        assert!(parse(&["python", "--release"]).is_err());
    }

    #[test]
    fn what_is_not_understood_is_named() {
        assert!(parse(&["bench", "--save", "--save"]).is_err());
        assert_eq!(parse(&["tset"]), Err(ArgumentError::UnknownCommand("tset".to_owned())));
        assert_eq!(
            parse(&["demo", "box"]),
            Err(ArgumentError::UnexpectedArgument { command: "demo".to_owned(), argument: "box".to_owned() })
        );
        assert_eq!(parse(&["setup", "--wheel"]), Err(ArgumentError::NoWheelFile));
        assert_eq!(parse(&["fuzz", "many"]), Err(ArgumentError::NoCount));
    }

    #[test]
    fn the_checks_begin_with_the_first_or_with_the_given_one() {
        let test = |chosen| Ok(Command::Test { chosen });
        assert_eq!(parse(&["test"]), test(Chosen::From(1)));
        assert_eq!(parse(&["test", "--from", "7"]), test(Chosen::From(7)));
        assert_eq!(parse(&["test", "--part", "lints"]), test(Chosen::Lints));
        assert_eq!(parse(&["test", "--part", "tests"]), test(Chosen::Tests));
        assert_eq!(parse(&["test", "--part", "all"]), Err(ArgumentError::NoPart));
        for arguments in [&["test", "--from"][..], &["test", "--from", "0"], &["test", "--from", "lints"]] {
            assert_eq!(parse(arguments), Err(ArgumentError::NoCheck));
        }
    }
}
