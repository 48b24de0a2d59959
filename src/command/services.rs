//! `vibrissa setup services`

use std::path::PathBuf;

use clap::{Args, Subcommand};
use vibrissa_robot::config::Config;
use vibrissa_runtime::rig::Rig;

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::trials::make_directory;
use crate::services::{lines_of_messages, service_files};
use vibrissa_lab::load::{self, LoadError};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa setup services generate thesis.machine --config array.yaml --out services\n\nExit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";
const LINES_EXAMPLE: &str = "Example:\n  mosquitto_sub -t 'vibrissa/#' -F '%U %t %p' > messages.txt\n  vibrissa setup services lines messages.txt | curl --data-binary @- 'http://localhost:8086/write?db=vibrissa'\n\nExit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";
/// Name of a robot without a configuration.
const ROBOT: &str = "array";
/// Largest size of a file with messages (bytes).
const MESSAGES_LIMIT: usize = 1 << 30;

/// The arguments of `vibrissa setup services`.
#[derive(Debug, Args)]
pub(super) struct ServicesArguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write the files of the services for a policy: broker, database, dashboard and logs
    Generate(GenerateArguments),
    /// Print recorded messages of a broker as points for a database, in the line protocol of InfluxDB
    Lines(LinesArguments),
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
struct GenerateArguments {
    /// Compiled machine, or a policy
    #[arg(value_name = "MACHINE")]
    machine: PathBuf,
    /// Directory of the files
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Configuration of the robot, for its name and its limits. By default, those of the reference rig
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Name of the robot in the topics, in place of the one of the configuration
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
}

#[derive(Debug, Args)]
#[command(after_help = LINES_EXAMPLE)]
struct LinesArguments {
    /// File with messages: in each line the time, the topic and the payload
    #[arg(value_name = "MESSAGES")]
    messages: PathBuf,
}

pub(super) fn services(arguments: &ServicesArguments) -> Result<Exit, Failure> {
    match &arguments.command {
        Command::Generate(arguments) => generate(arguments),
        Command::Lines(arguments) => lines(arguments),
    }
}

fn generate(arguments: &GenerateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let program = load::program(&arguments.machine, &mut files)?.value;
    let config = match &arguments.config {
        Some(path) => super::drive::config(path, &mut files)?.0,
        None => Config { name: ROBOT.to_owned(), ..Config::emulated(Rig::default(), 0.0) },
    };
    let config = match &arguments.name {
        Some(name) => config.named(name).map_err(Failure::RobotName)?,
        None => config,
    };
    let written = service_files(&program, &config);
    for file in &written {
        make_directory(arguments.out.join(file.path).parent())?;
    }
    let outputs = written.iter().map(|file| files.output("--out", &arguments.out.join(file.path)));
    let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
    for (output, file) in outputs.into_iter().zip(&written) {
        output.write(&file.text)?;
    }
    let out = arguments.out.display();
    output::result(format_args!(
        "{out}: {} files for the robot {} and the machine {}; next: copy env.example to .env and set its passwords",
        written.len(),
        config.name,
        program.name
    ))?;
    Ok(Exit::Done)
}

fn lines(arguments: &LinesArguments) -> Result<Exit, Failure> {
    let path = &arguments.messages;
    let text = CommandFiles::new().read(path, MESSAGES_LIMIT).map_err(LoadError::read(path))?;
    let lines = lines_of_messages(&text).map_err(Failure::at(path))?;
    output::text(lines.join("\n") + "\n")?;
    Ok(Exit::Done)
}
