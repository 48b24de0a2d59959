//! `vibrissa check`

use std::fmt::Write;
use std::path::Path;

use serde::Serialize;

use crate::diagnostic::{Position, Record, records};
use crate::machine::{Artifact, FORMAT, State};
use crate::policy::compile_with_warnings;
use crate::units::format_si;

use super::arguments::CheckArguments;
use super::exit::{Exit, Failure};
use super::input::PolicyFile;
use super::{input, output};

/// What is known of one policy.
#[derive(Debug, Serialize)]
struct Checked {
    file: String,
    /// `null` if the policy is at fault.
    machine: Option<Summary>,
    /// What a compiled machine comes from; `null` for a policy's text.
    compiled: Option<Compiled>,
    diagnostics: Vec<Record>,
}

#[derive(Debug, Serialize)]
struct Summary {
    name: String,
    whiskers: Vec<String>,
    parameters: Vec<ParameterSummary>,
    states: Vec<StateSummary>,
    /// Bytes of a running machine's registers.
    memory_bytes: usize,
}

#[derive(Debug, Serialize)]
struct Compiled {
    file: String,
    text_sha256: String,
    compiler: String,
    format: u32,
}

#[derive(Debug, Serialize)]
struct ParameterSummary {
    name: String,
    value: String,
    range: Option<[String; 2]>,
}

#[derive(Debug, Serialize)]
struct StateSummary {
    name: String,
    /// Where it is in the policy's text.
    #[serde(flatten)]
    place: Position,
    /// The state that it lies in.
    parent: Option<String>,
    /// Whether the run, or the state that it lies in, begins in it.
    initial: bool,
    transitions: usize,
    /// The most operations that a tick in this state does without leaving it, with those of the states that it lies in.
    operations: usize,
    /// How many states it lies in.
    #[serde(skip)]
    depth: usize,
}

pub(super) fn check(arguments: &CheckArguments) -> Result<Exit, Failure> {
    let checked = arguments.policies.iter().map(|path| check_one(path, arguments.json));
    let checked = checked.collect::<Result<Vec<_>, _>>()?;
    if arguments.json {
        output::json(&checked)?;
    }
    let is_refused =
        |policy: &Checked| policy.machine.is_none() || (arguments.deny_warnings && !policy.diagnostics.is_empty());
    Ok(if checked.iter().any(is_refused) { Exit::Unusable } else { Exit::Done })
}

fn check_one(path: &Path, json: bool) -> Result<Checked, Failure> {
    let source = match input::policy_file(path)?.value {
        PolicyFile::Text(source) => source,
        PolicyFile::Machine(artifact) => return check_machine(path, &artifact, json),
    };
    let (machine, diagnostics) = match compile_with_warnings(&source) {
        Ok(compiled) => (Some(summary(&compiled.artifact)), compiled.warnings),
        Err(faults) => (None, faults),
    };
    if !json {
        output::diagnostics(&source, &diagnostics);
        if let Some(machine) = &machine {
            output::result(describe(&source.name, machine))?;
        }
    }
    Ok(Checked { file: source.name.clone(), machine, compiled: None, diagnostics: records(&source, &diagnostics) })
}

fn check_machine(path: &Path, artifact: &Artifact, json: bool) -> Result<Checked, Failure> {
    let file = path.display().to_string();
    let machine = summary(artifact);
    let origin = &artifact.origin;
    if !json {
        output::result(describe(&file, &machine))?;
        output::result(format_args!("compiled from {} by vibrissa {}", origin.file, origin.compiler))?;
    }
    let compiled = Compiled {
        file: origin.file.clone(),
        text_sha256: input::hex(&origin.text_sha256),
        compiler: origin.compiler.clone(),
        format: FORMAT,
    };
    Ok(Checked { file, machine: Some(machine), compiled: Some(compiled), diagnostics: Vec::new() })
}

fn summary(artifact: &Artifact) -> Summary {
    let Artifact { program, places, .. } = artifact;
    let parameter = |(parameter, &value): (&crate::machine::Parameter, &f64)| ParameterSummary {
        name: parameter.name.clone(),
        value: format_si(value, parameter.dimension),
        range: parameter.range.map(|(low, high)| [low, high].map(|end| format_si(end, parameter.dimension))),
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
        operations: program.operations(index),
        depth: program.outward(index).skip(1).count(),
    };
    Summary {
        name: program.name.clone(),
        whiskers: program.whiskers.clone(),
        parameters: program.parameters.iter().zip(&program.image).map(parameter).collect(),
        states: program.states.iter().enumerate().map(state).collect(),
        memory_bytes: std::mem::size_of_val(program.image.as_slice()),
    }
}

fn describe(file: &str, machine: &Summary) -> String {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["state", "transitions", "operations a tick, at most"]);
    for state in &machine.states {
        let initial = if state.initial { " (initial)" } else { "" };
        table.add_row([
            format!("{:indent$}{}{initial}", "", state.name, indent = 2 * state.depth),
            state.transitions.to_string(),
            state.operations.to_string(),
        ]);
    }
    let mut text = format!(
        "{file}: machine {}, whiskers {}, {} bytes of memory\n",
        machine.name,
        machine.whiskers.join(", "),
        machine.memory_bytes
    );
    for parameter in &machine.parameters {
        // Writing to a string cannot fail.
        let _ = write!(text, "  {} = {}", parameter.name, parameter.value);
        if let Some([low, high]) = &parameter.range {
            let _ = write!(text, " in {low} .. {high}");
        }
        text += "\n";
    }
    text + &table.trim_fmt()
}
