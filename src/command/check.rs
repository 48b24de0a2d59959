//! `vibrissa check`

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use vibrissa_runtime::machine::{Artifact, FORMAT, Needs, Program, RateRange, State, Target};
use vibrissa_runtime::units::{Dimension, format_si};

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::provenance::provenance;
use vibrissa_lab::load::{self, LoadError, PolicyFile};
use vibrissa_lab::report::Table;
use vibrissa_lab::results::Document;
use vibrissa_language::{Checked as Found, ProvedContract};
use vibrissa_text::diagnostic::{Position, Record, records};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa check policies/thesis.fsm --deny-warnings\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa check`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct CheckArguments {
    /// Policy files, compiled machines or names of built-in policies such as `thesis`
    #[arg(value_name = "POLICY", required = true)]
    policies: Vec<PathBuf>,
    /// Treat warnings as errors: exit status 2
    #[arg(long)]
    deny_warnings: bool,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// The result for one policy.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Checked {
    file: String,
    /// The error of reading the file. `null` if it was read.
    error: Option<String>,
    /// The machine. `null` if the file has errors or is a library.
    machine: Option<Summary>,
    /// The library. `null` if the file has errors or is a machine.
    library: Option<LibrarySummary>,
    /// The origin of a compiled machine. `null` for the text of a policy.
    compiled: Option<Compiled>,
    diagnostics: Vec<Record>,
}

impl Document for Checked {
    const FORMAT: &'static str = "check";
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Summary {
    name: String,
    whiskers: Vec<String>,
    needs: NeedsSummary,
    parameters: Vec<ParameterSummary>,
    states: Vec<StateSummary>,
    contracts: Vec<ContractSummary>,
    /// Target of the fallback transition of states without their own.
    failsafe: Option<String>,
    /// Bytes of memory of a running machine.
    memory_bytes: usize,
    /// A bound on the operations of any tick with eight transitions.
    most_operations: usize,
}

/// The needs that a policy states. `null` for those that it does not state.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct NeedsSummary {
    /// Lowest and highest control rate.
    control_rate: Option<[String; 2]>,
    /// Lowest and highest sample rate.
    sample_rate: Option<[String; 2]>,
    /// Least and largest age of a sample.
    sample_age: Option<[String; 2]>,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct LibrarySummary {
    name: String,
    laws: Vec<String>,
    values: Vec<String>,
    behaviours: Vec<String>,
    monitors: Vec<String>,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Compiled {
    file: String,
    text_sha256: String,
    compiler: String,
    format: u32,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ParameterSummary {
    name: String,
    value: String,
    range: Option<[String; 2]>,
    /// The names of the values that the parameter can have. Empty for a number.
    choices: Vec<String>,
    /// Description from the policy. It may be empty.
    description: String,
}

/// The keys of a [`Position`], for the JSON schema.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[allow(dead_code, reason = "only the names and types matter")]
struct PositionSchema {
    /// The line, from 1.
    line: usize,
    /// The column, from 1, in characters.
    column: usize,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ContractSummary {
    /// The state. `null` for a contract of the whole machine.
    state: Option<String>,
    /// The text of the contract.
    contract: String,
    /// True if no run can violate it. False if runs watch it.
    proved: bool,
}

#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct StateSummary {
    name: String,
    /// Position in the policy's text.
    #[serde(flatten)]
    #[cfg_attr(test, schemars(with = "PositionSchema"))]
    place: Position,
    /// The state that contains it.
    parent: Option<String>,
    /// True if the run, or the state that contains it, begins in it.
    initial: bool,
    transitions: usize,
    /// Target of the fallback transition. `null` for that of the machine.
    failsafe: Option<String>,
    /// The most operations of a tick that stays in this state, with those of the states that contain it.
    operations: usize,
    /// Number of states that contain it.
    #[serde(skip)]
    depth: usize,
}

impl StateSummary {
    /// True for a state inside of a behaviour. Its name begins with that of the state that uses the behaviour.
    fn is_of_behaviour(&self) -> bool {
        self.name.contains('.')
    }
}

pub(super) fn check(arguments: &CheckArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let checked = arguments.policies.iter().map(|path| {
        check_one(path, &mut files, arguments.json).or_else(|failure| match failure {
            // After an error in one file, the other files are still checked.
            Failure::Load(
                LoadError::Read { .. }
                | LoadError::Missing { .. }
                | LoadError::Name { .. }
                | LoadError::Artifact { .. },
            ) => Ok(unreadable(path, &failure, arguments.json)),
            other => Err(other),
        })
    });
    let checked = checked.collect::<Result<Vec<_>, _>>()?;
    if arguments.json {
        output::json_list(&provenance(), &checked)?;
    }
    let is_refused = |file: &Checked| {
        (file.machine.is_none() && file.library.is_none()) || (arguments.deny_warnings && !file.diagnostics.is_empty())
    };
    Ok(if checked.iter().any(is_refused) { Exit::Unusable } else { Exit::Done })
}

fn unreadable(path: &Path, failure: &Failure, json: bool) -> Checked {
    if !json {
        failure.report();
    }
    let (file, error) = (path.display().to_string(), Some(failure.to_string()));
    Checked { file, error, machine: None, library: None, compiled: None, diagnostics: Vec::new() }
}

fn check_one(path: &Path, files: &mut CommandFiles, json: bool) -> Result<Checked, Failure> {
    let source = match load::policy_file(path, files)?.value {
        PolicyFile::Text(source) => load::with_libraries(&source, files),
        PolicyFile::Machine(artifact) => return check_machine(path, &artifact, json),
    };
    let (machine, library, diagnostics) = match vibrissa_language::check(&source) {
        Ok(Found::Machine(compiled)) => (Some(summary(&compiled.artifact, &compiled.proved)), None, compiled.warnings),
        Ok(Found::Library { name, laws, values, behaviours, monitors, warnings }) => {
            (None, Some(LibrarySummary { name, laws, values, behaviours, monitors }), warnings)
        }
        Err(faults) => (None, None, faults),
    };
    if !json {
        output::diagnostics(&source, &diagnostics);
        if let Some(machine) = &machine {
            output::result(describe(&source.name, machine))?;
        }
        if let Some(LibrarySummary { name, laws, values, behaviours, monitors }) = &library {
            let mut parts = vec![count(laws.len(), "law"), count(values.len(), "value")];
            let others = [(behaviours.len(), "behaviour"), (monitors.len(), "monitor")];
            parts.extend(others.iter().filter(|(number, _)| *number > 0).map(|&(number, of)| count(number, of)));
            output::result(format_args!("{}: library {name}, {}", source.name, parts.join(", ")))?;
        }
    }
    let (file, diagnostics) = (source.name.clone(), records(&source, &diagnostics));
    Ok(Checked { file, error: None, machine, library, compiled: None, diagnostics })
}

/// Bytes in hexadecimal digits.
fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::with_capacity(2 * bytes.len()), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn count(number: usize, of: &str) -> String {
    format!("{number} {of}{}", if number == 1 { "" } else { "s" })
}

fn check_machine(path: &Path, artifact: &Artifact, json: bool) -> Result<Checked, Failure> {
    let file = path.display().to_string();
    // Only the compiler knows proofs, and an artifact does not contain what is proved.
    let machine = summary(artifact, &[]);
    let origin = &artifact.origin;
    if !json {
        output::result(describe(&file, &machine))?;
        output::result(format_args!("compiled from {} by vibrissa {}", origin.file, origin.compiler))?;
    }
    let compiled = Compiled {
        file: origin.file.clone(),
        text_sha256: hexadecimal(&origin.text_sha256),
        compiler: origin.compiler.clone(),
        format: FORMAT,
    };
    let compiled = Some(compiled);
    Ok(Checked { file, error: None, machine: Some(machine), library: None, compiled, diagnostics: Vec::new() })
}

fn summary(artifact: &Artifact, proved: &[ProvedContract]) -> Summary {
    let Artifact { program, positions: places, .. } = artifact;
    let parameter = |(parameter, &value): (&vibrissa_runtime::machine::Parameter, &f64)| ParameterSummary {
        name: parameter.name.clone(),
        value: parameter.text(value),
        range: parameter.range.map(|(low, high)| [low, high].map(|end| parameter.text(end))),
        choices: parameter.choices.clone(),
        description: parameter.description.clone(),
    };
    let state = |(index, state): (usize, &State)| StateSummary {
        name: state.name.to_string(),
        place: places.states[index].name,
        parent: state.parent.map(|parent| program.states[parent].name.to_string()),
        initial: match state.parent {
            None => index == program.initial,
            Some(parent) => program.states[parent].initial.as_ref().is_some_and(|&(inner, _)| inner == index),
        },
        transitions: state.transitions.len(),
        failsafe: state.fallback.as_ref().map(|target| name(program, target)),
        operations: program.operations(index),
        depth: program.outward(index).skip(1).count(),
    };
    Summary {
        failsafe: program.fallback.as_ref().map(|target| name(program, target)),
        name: program.name.clone(),
        whiskers: program.whiskers.clone(),
        needs: needs(&program.needs),
        parameters: program.parameters.iter().zip(&program.initial_registers).map(parameter).collect(),
        states: program.states.iter().enumerate().map(state).collect(),
        contracts: contracts(program, proved),
        memory_bytes: program.memory_bytes(),
        most_operations: artifact.most_operations,
    }
}

fn contracts(program: &Program, proved: &[ProvedContract]) -> Vec<ContractSummary> {
    let of = |state: Option<&str>, contract: &str, proved| ContractSummary {
        state: state.map(str::to_owned),
        contract: contract.to_owned(),
        proved,
    };
    let proved = proved.iter().map(|contract| of(contract.state.as_deref(), &contract.text, true));
    let own = program.contracts.iter().map(|contract| of(None, &contract.text, false));
    let of_states = program
        .states
        .iter()
        .flat_map(|state| state.contracts.iter().map(|contract| of(Some(&state.name), &contract.text, false)));
    proved.chain(own).chain(of_states).collect()
}

fn needs(needs: &Needs) -> NeedsSummary {
    let rates = |range: RateRange| [range.low, range.high].map(|rate| format_si(rate, Dimension::FREQUENCY));
    NeedsSummary {
        control_rate: needs.control_rate.map(rates),
        sample_rate: needs.sample_rate.map(rates),
        sample_age: needs.sample_age.map(|most| [0.0, most].map(|age| format_si(age, Dimension::TIME))),
    }
}

/// The name of a target.
fn name(program: &Program, target: &Target) -> String {
    match target {
        Target::State { state, .. } => program.states[*state].name.to_string(),
        Target::Success(reason) => format!("Success(\"{reason}\")"),
        Target::Failure(reason) => format!("Failure(\"{reason}\")"),
    }
}

fn describe(file: &str, machine: &Summary) -> String {
    let has_failsafe = machine.states.iter().any(|state| state.failsafe.is_some());
    let headings = ["state", "transitions", "operations in a tick that stays"];
    let headings = headings.into_iter().chain(has_failsafe.then_some("failsafe"));
    let (inner, own): (Vec<_>, Vec<_>) = machine.states.iter().partition(|state| state.is_of_behaviour());
    let states = own.iter().map(|state| {
        let initial = if state.initial { " (initial)" } else { "" };
        let name = format!("{:indent$}{}{initial}", "", state.name, indent = 2 * state.depth);
        let cells = [name, state.transitions.to_string(), state.operations.to_string()];
        let failsafe = state.failsafe.clone().unwrap_or_default();
        cells.into_iter().chain(has_failsafe.then_some(failsafe)).collect()
    });
    let states = Table::new(4, headings, states);
    let parameters = machine.parameters.iter().map(|ParameterSummary { name, value, range, choices, description }| {
        let range = match range {
            _ if !choices.is_empty() => choices.join(" or "),
            Some([low, high]) => format!("{low} .. {high}"),
            None => String::new(),
        };
        vec![name.clone(), value.clone(), range, description.clone()]
    });
    let parameters = Table::new(4, ["parameter", "value", "range", "description"], parameters);
    let mut text = format!(
        "{file}: machine {}, whiskers {}, {} bytes of memory, at most {} operations a tick\n",
        machine.name,
        machine.whiskers.join(", "),
        machine.memory_bytes,
        machine.most_operations
    );
    let NeedsSummary { control_rate, sample_rate, sample_age } = &machine.needs;
    let needs = [("control_rate", control_rate), ("sample_rate", sample_rate), ("sample_age", sample_age)];
    for (name, [low, high]) in needs.into_iter().filter_map(|(name, range)| Some((name, range.as_ref()?))) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "needs {name} in {low} .. {high}");
    }
    if !machine.parameters.is_empty() {
        text += &(parameters.fitted() + "\n");
    }
    if let Some(failsafe) = &machine.failsafe {
        text.extend(["failsafe -> ", failsafe, "\n"]);
    }
    text += &states.fitted();
    if !inner.is_empty() {
        let operations = inner.iter().map(|state| state.operations).max().unwrap_or_default();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "\n{} in behaviours, with at most {operations} operations in a tick that stays; `--json` lists them",
            count(inner.len(), "further state")
        );
    }
    if !machine.contracts.is_empty() {
        let contracts = machine.contracts.iter().map(|ContractSummary { state, contract, proved }| {
            let how = if *proved { "proved" } else { "watched in runs" };
            vec![state.clone().unwrap_or_default(), contract.clone(), how.to_owned()]
        });
        text.push('\n');
        text += &Table::new(3, ["state", "contract", ""], contracts).fitted();
    }
    text
}
