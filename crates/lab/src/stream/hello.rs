//! The first message of a run.

use std::collections::HashMap;

use vibrissa_runtime::machine::{OutputKind, Plot, Program, Target, Transition, TransitionId};
use vibrissa_runtime::rig::Rig;

use super::change::Changeable;
use super::frame::{drawn_pose, rounded};
use super::guards::GuardNumbers;
use super::message::{
    BreakpointInfo, Capabilities, ChartInfo, GuardInfo, Hello, Outline, PROTOCOL, PartInfo, PlotInfo, RigInfo,
    StateInfo, TransitionInfo, WhiskerInfo,
};
use super::setup::RunSetup;
use super::shape::outline_points;
use crate::inspect::{Breakpoint, Breakpoints};
use vibrissa_language::explain::{Explained, Judged};
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_world::geometry::Contour;
use vibrissa_world::scene::Scene;

/// The first message of a run under `program`, the numbers of its guards and the values that may be changed. `policy` is the
/// explained policy, if it has a text, and `bound` are the whiskers that it binds, by their indices in the rig.
pub fn hello(
    setup: &RunSetup,
    program: &Program,
    policy: Option<&Breakpoints>,
    bound: &[usize],
) -> (Hello, GuardNumbers, Changeable) {
    let numbers = policy.map(GuardNumbers::new).unwrap_or_default();
    let guards = policy.map(|policy| guards(&policy.explained, &numbers)).unwrap_or_default();
    let thresholds = policy.map(|policy| policy.explained.thresholds()).unwrap_or_default();
    let (changeable, parameters) =
        Changeable::new(program, thresholds, |threshold| numbers.number(threshold.transition));
    let sensing = &setup.rig.sensing;
    let hello = Hello {
        protocol: PROTOCOL,
        version: env!("CARGO_PKG_VERSION"),
        run: 0,
        command: setup.command,
        scenario: setup.scenario.clone(),
        policy: program.name.clone(),
        world: setup.world.clone(),
        duration: setup.duration,
        known_ticks: setup.known_ticks,
        control_period: sensing.control_rate.recip(),
        dt: sensing.sample_rate.recip(),
        capabilities: Capabilities {
            step: true,
            breakpoints: policy.is_some(),
            counterfactual: true,
            closed_loop: setup.trial.is_some(),
        },
        whiskers: bound.iter().filter_map(|&index| Some(setup.rig.whiskers.get(index)?.name.clone())).collect(),
        no_guards: setup.no_guards.clone().filter(|_| guards.is_empty()),
        chart: chart(program, &guards, &numbers, behaviours(setup)),
        guards,
        parameters,
        scene: setup.scene.as_ref().map(outlines),
        rig: rig(&setup.rig, bound),
        start: setup.start.as_ref().map(drawn_pose),
        plots: setup.program.outputs.plots.iter().map(plot).collect(),
        breakpoints: policy.map(breakpoints).unwrap_or_default(),
    };
    (hello, numbers, changeable)
}

/// The breakpoints of a policy.
#[must_use]
pub fn breakpoints(policy: &Breakpoints) -> Vec<BreakpointInfo> {
    let info = |breakpoint: &Breakpoint| BreakpointInfo { text: breakpoint.text.clone(), state: breakpoint.state() };
    policy.breakpoints.iter().map(info).collect()
}

/// A policy with the breakpoints of these texts, as far as it can have them. It must have the `new` one.
///
/// # Errors
/// What is wrong with the new one, for people.
pub fn breakpoints_with(source: &Source, texts: &[String], new: Option<&String>) -> Result<Breakpoints, String> {
    let fault = |faults: Vec<Diagnostic>| faults.first().map_or_else(String::new, |fault| fault.message.clone());
    if let Some(new) = new {
        Breakpoints::new(source, std::slice::from_ref(new)).map_err(|(_, faults)| fault(faults))?;
    }
    Breakpoints::possible(source, texts).map(|(policy, _)| policy).map_err(fault)
}

fn guards(policy: &Explained, numbers: &GuardNumbers) -> Vec<GuardInfo> {
    let info = |id| {
        let transition = policy.transition(id)?;
        let parts = transition.condition.as_ref().map(|condition| condition.judge(&[])).unwrap_or_default();
        let part = |part: &Judged<'_>| PartInfo {
            text: part.leaf.text.clone(),
            unit: part.margin.map(|(_, dimension)| dimension.si_unit()),
        };
        Some(GuardInfo {
            index: numbers.number(id)?,
            state: id.state,
            target: transition.target.clone(),
            text: transition.text.clone(),
            file: transition.file.clone(),
            line: transition.position.line,
            parts: parts.iter().map(part).collect(),
        })
    };
    numbers.transitions().filter_map(info).collect()
}

/// The behaviours of states, with their arguments, by the indices of the states.
fn behaviours(setup: &RunSetup) -> HashMap<usize, String> {
    let chart = setup.policy.as_ref().and_then(|text| vibrissa_language::chart(text).ok());
    let states = chart.into_iter().flat_map(|chart| chart.states);
    states.filter_map(|state| Some((state.index, state.behaviour?))).collect()
}

fn chart(
    program: &Program,
    guards: &[GuardInfo],
    numbers: &GuardNumbers,
    mut behaviours: HashMap<usize, String>,
) -> ChartInfo {
    let outermost = program.outward(program.initial).last();
    let is_initial = |index: usize, parent: Option<usize>| match parent.and_then(|parent| program.states.get(parent)) {
        Some(parent) => parent.initial.as_ref().is_some_and(|(initial, _)| *initial == index),
        None => Some(index) == outermost,
    };
    let states = program.states.iter().enumerate().map(|(index, state)| StateInfo {
        name: state.name.to_string(),
        parent: state.parent,
        initial: is_initial(index, state.parent),
        behaviour: behaviours.remove(&index),
    });
    let drawn = |state: Option<usize>, target: &Target, guard: Option<usize>, text: String| {
        let (target, end) = match target {
            Target::State { state, .. } => (Some(*state), None),
            Target::Failure(_) => (None, Some("failure")),
            Target::Success(_) => (None, Some("success")),
        };
        TransitionInfo { state, target, end, guard, text }
    };
    let of = |state: Option<usize>, transitions: &[Transition], fallback: Option<&Target>| {
        let tried = transitions.iter().enumerate().filter_map(|(index, transition)| {
            let id = TransitionId { state, index };
            let guard = numbers.number(id);
            // Those of breakpoints have no number. Without explanations no guard has one.
            if guard.is_none() && !guards.is_empty() {
                return None;
            }
            let text = guard.and_then(|guard| guards.get(guard)).map_or_else(String::new, |guard| guard.text.clone());
            Some(drawn(state, &transition.target, guard, text))
        });
        let mut all: Vec<TransitionInfo> = tried.collect();
        all.extend(fallback.map(|target| drawn(state, target, None, "failsafe".to_owned())));
        all
    };
    let mut transitions = of(None, &program.always, program.fallback.as_ref());
    for (index, state) in program.states.iter().enumerate() {
        transitions.extend(of(Some(index), &state.transitions, state.fallback.as_ref()));
    }
    ChartInfo { states: states.collect(), transitions }
}

fn plot(plot: &Plot) -> PlotInfo {
    let (unit, choices) = match &plot.kind {
        OutputKind::Number(dimension) => (dimension.si_unit(), Vec::new()),
        OutputKind::Truth => (String::new(), ["false", "true"].map(str::to_owned).to_vec()),
        OutputKind::Choice(names) => (String::new(), names.clone()),
        // No plot is one of these.
        OutputKind::Vector(_) | OutputKind::Whisker => (String::new(), Vec::new()),
    };
    PlotInfo { name: plot.name.clone(), unit, choices }
}

fn outlines(scene: &Scene) -> Vec<Outline> {
    let outline = |contour: &Contour| Outline {
        points: outline_points(contour).into_iter().map(|point| [point.x, point.y].map(rounded)).collect(),
        closed: contour.is_closed(),
    };
    scene.truth.surfaces.contours().map(outline).collect()
}

fn rig(rig: &Rig, bound: &[usize]) -> RigInfo {
    let whisker = |&index: &usize| {
        let whisker = rig.whiskers.get(index)?;
        Some(WhiskerInfo {
            base: whisker.base_body.into(),
            direction: whisker.direction_body,
            length: whisker.shaft.length,
            threshold: rig.sensing.contact_threshold,
        })
    };
    RigInfo {
        platform: rig.platform.outline_body().map(Into::into).to_vec(),
        whiskers: bound.iter().filter_map(whisker).collect(),
    }
}
