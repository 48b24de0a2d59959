//! The YAML format of a sweep.

use super::axis::{Axis, AxisValue, AxisValues};
use super::definition::Sweep;
use super::family_axis;
use super::scenes::{ScenesOf, SweepScenes};
use crate::family::Family;
use std::collections::BTreeMap;
use vibrissa_declare::catalogue::ENTRIES;
use vibrissa_runtime::machine::ParameterValue;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_world::scenario::{self, Change, name, reference};
use vibrissa_world::scene::FileReference;
use vibrissa_yaml::{Entry, Fields, Node, Placed, Reader, fault, parse, root_place};

const SCENES: &str = "[{family: convex-corner, trials: 100}]";
const POLICIES: &str = "[../policies/vibrissa.fsm]";
const VALUES: &str = "[2 cm/s, 5 cm/s]";

/// The most trials of one source of scenes, and the most runs of a sweep. A merge holds the figures of all results in memory.
const MAX_RUNS: u64 = 1_000_000;

/// Reads a sweep. The list of errors is not empty and in the order of the text.
pub(super) fn read(source: &Source) -> Result<Sweep, Vec<Diagnostic>> {
    let (tree, faults) = parse(source, "sweep")?;
    let mut no_files = |_: &str| Err("a sweep has no files of its own".to_owned());
    let mut reader = Reader::new(source, &mut no_files, faults);
    let sweep = read_sweep(&mut reader, &tree);
    reader.finish(sweep)
}

fn read_sweep(reader: &mut Reader<'_>, tree: &Placed<Node>) -> Option<Sweep> {
    let hint = "write at least `name`, `policies` and `scenes`; see sweeps/corners.yaml";
    let span = root_place(reader, tree, "sweep", hint)?;
    let mut fields = Fields::of(reader, tree, "a sweep", span)?;
    let name = fields
        .required("name", "corners")
        .and_then(|entry| name(reader, entry, "a sweep", "results are filed under this name"));
    let policies = fields.required("policies", POLICIES).and_then(|entry| policies(reader, entry));
    let scenes_entry = fields.required("scenes", SCENES);
    let scenes = scenes_entry.and_then(|entry| scenes(reader, entry));
    let axes = match fields.entry("vary") {
        Some(entry) => axes(reader, entry, scenes.as_deref()),
        None => Some(Vec::new()),
    };
    fields.finish(reader);
    let sweep = Sweep { name: name?, policies: policies?, scenes: scenes?, axes: axes? };
    match (sweep.count(), scenes_entry) {
        (None, Some(entry)) => too_many(reader, entry.key.span),
        (Some(runs), Some(entry)) if runs > MAX_RUNS => too_many(reader, entry.key.span),
        _ => return Some(sweep),
    }
    None
}

fn too_many(reader: &mut Reader<'_>, span: Span) {
    let message = format!("a sweep has at most {MAX_RUNS} runs");
    let label = "the values and policies give more runs";
    let fault = Diagnostic::error(fault::RANGE, message, span, label);
    reader.report(fault.hint("split the sweep, or reduce `trials`"));
}

/// The items of a list that is not empty.
fn some<'n>(reader: &mut Reader<'_>, entry: &'n Entry, expected: &str, example: &str) -> Option<&'n [Placed<Node>]> {
    let items = reader.items(&entry.value, expected, example)?;
    if items.is_empty() {
        let message = format!("`{}` is empty, so the sweep has no run", entry.key.value);
        let fault = Diagnostic::error(fault::RANGE, message, entry.key.span, "needs at least one item");
        reader.report(fault.hint(format!("for example `{}: {example}`", entry.key.value)));
        return None;
    }
    Some(items)
}

/// Reports a repeated item, whose runs would be the same.
fn check_new<K: Ord>(reader: &mut Reader<'_>, seen: &mut BTreeMap<K, Span>, key: K, span: Span, name: &str) {
    if let Some(first) = seen.get(&key) {
        let message = format!("`{name}` occurs twice, so its runs would be repeated");
        let fault = Diagnostic::error(fault::REPEATED, message, span, "the second one");
        reader.report(fault.note(*first, "the first one").hint("remove one of them, or make them different"));
    } else {
        seen.insert(key, span);
    }
}

fn policies(reader: &mut Reader<'_>, entry: &Entry) -> Option<Vec<FileReference>> {
    let items = some(reader, entry, "a list of paths", POLICIES)?;
    let policies: Vec<_> = items.iter().map(|item| reference(reader, item)).collect();
    let policies: Vec<_> = policies.into_iter().collect::<Option<_>>()?;
    let mut seen = BTreeMap::new();
    for FileReference { name, span, .. } in &policies {
        check_new(reader, &mut seen, name, *span, name);
    }
    Some(policies)
}

fn scenes(reader: &mut Reader<'_>, entry: &Entry) -> Option<Vec<SweepScenes>> {
    let items = some(reader, entry, "a list of scenes", SCENES)?;
    let scenes: Vec<_> = items.iter().map(|item| read_scenes(reader, item)).collect();
    let scenes: Vec<_> = scenes.into_iter().collect::<Option<_>>()?;
    let mut seen = BTreeMap::new();
    for (scenes, item) in scenes.iter().zip(items) {
        let seed = match scenes.of {
            ScenesOf::Family(_) => Some(scenes.family_seed()),
            ScenesOf::Scenario(_) => scenes.seed,
        };
        let key = (scenes.kind_word(), scenes.name(), seed);
        check_new(reader, &mut seen, key, item.span, scenes.name());
    }
    Some(scenes)
}

fn read_scenes(reader: &mut Reader<'_>, item: &Placed<Node>) -> Option<SweepScenes> {
    let mut fields = Fields::of(reader, item, "a source of scenes", reader.extent(item))?;
    let (family_entry, scenario_entry) = (fields.entry("family"), fields.entry("scenario"));
    let trials = match fields.entry("trials") {
        Some(entry) => reader.count(&entry.value, "trials", 1..=MAX_RUNS, 100),
        None => Some(1),
    };
    let seed = match fields.entry("seed") {
        Some(entry) => reader.count(&entry.value, "seed", 0..=u64::MAX, 1).map(Some),
        None => Some(None),
    };
    fields.finish(reader);
    let of = match (family_entry, scenario_entry) {
        (Some(entry), None) => family(reader, entry).map(ScenesOf::Family),
        (None, Some(entry)) => reference(reader, &entry.value).map(ScenesOf::Scenario),
        (family, _) => {
            let label = if family.is_some() { "both are given" } else { "neither is given" };
            let message = "a source of scenes is a `family` or a `scenario`";
            let fault = Diagnostic::error(fault::MISSING_KEY, message, reader.extent(item), label);
            reader.report(fault.hint("for example `{family: convex-corner, trials: 100}` or `{scenario: disk.yaml}`"));
            None
        }
    };
    Some(SweepScenes { of: of?, trials: trials?, seed: seed? })
}

fn family(reader: &mut Reader<'_>, entry: &Entry) -> Option<Family> {
    let index = reader.choice(&entry.value, "a family", &ENTRIES.map(|family| family.name))?;
    ENTRIES.get(index).and_then(|entry| Family::named(entry.name))
}

/// Reads the axes. Without `scenes`, which have errors, those of families are not read.
fn axes(reader: &mut Reader<'_>, entry: &Entry, scenes: Option<&[SweepScenes]>) -> Option<Vec<Axis>> {
    let mut fields = Fields::of(reader, &entry.value, "what varies", entry.key.span)?;
    let (policy, family, scenario) = (fields.entry("policy"), fields.entry("family"), fields.entry("scenario"));
    fields.finish(reader);
    check_names(reader, policy, family, scenario);
    let mut axes = named(reader, policy, "speed: [2 cm/s, 5 cm/s]", parameters);
    if let Some(scenes) = scenes {
        let values = |reader: &mut Reader<'_>, name: &Placed<String>, items: &[Placed<Node>]| {
            family_axis::values(reader, scenes, name, items)
        };
        axes.extend(named(reader, family, "angle: [30 deg, 60 deg]", values));
    }
    axes.extend(named(reader, scenario, "rig.physics.friction: [0, 0.1]", changes));
    axes.into_iter().collect()
}

/// Keys of a scenario that the sweep sets, with a hint.
const GIVEN: [(&str, &str); 2] = [
    ("policy", "list the policies in the sweep's own `policies`"),
    ("seed", "use `trials`: each trial has its own noise, and `seed` is the seed of the first"),
];

/// Checks that the axes are independent. Otherwise results would be listed under values that their runs did not have.
fn check_names(reader: &mut Reader<'_>, policy: Option<&Entry>, family: Option<&Entry>, scenario: Option<&Entry>) {
    let names = |entry: Option<&'_ Entry>| match entry.map(|entry| &entry.value.value) {
        Some(Node::Mapping(entries)) => entries.iter().map(|entry| entry.key.clone()).collect(),
        _ => Vec::new(),
    };
    let keys: Vec<Placed<String>> = names(scenario);
    let spans: BTreeMap<&str, Span> = keys.iter().map(|key| (key.value.as_str(), key.span)).collect();
    let kinds = [
        ("as a parameter of the policies", names(policy)),
        ("as a parameter of the families", names(family)),
        ("as a key of the scenarios", keys.clone()),
    ];
    let mut seen: BTreeMap<&str, (Span, &str)> = BTreeMap::new();
    for (kind, names) in &kinds {
        for Placed { value, span } in names {
            let Some((first, first_kind)) = seen.insert(value, (*span, kind)) else { continue };
            let message = format!("the name `{value}` is varied twice");
            let fault = Diagnostic::error(fault::ENTANGLED, message, first, first_kind);
            reader.report(fault.note(*span, *kind).hint("split the sweep, or rename the parameter of the policies"));
        }
    }
    for Placed { value, span } in &keys {
        if let Some((_, hint)) = GIVEN.iter().find(|(given, _)| given == value) {
            let message = format!("the key `{value}` of a scenario cannot be varied");
            let label = "the sweep sets it for every run";
            reader.report(Diagnostic::error(fault::ENTANGLED, message, *span, label).hint(*hint));
        }
        for (end, _) in value.match_indices(['.', '[']) {
            let above = &value[..end];
            if let Some(&outer) = spans.get(above) {
                let message = format!("`{above}` and `{value}` cannot both vary");
                let fault = Diagnostic::error(fault::ENTANGLED, message, *span, "this key");
                let fault = fault.note(outer, "this key contains it");
                reader.report(fault.hint(format!("vary either `{above}` or the keys in it")));
            }
        }
    }
}

/// The axes with their names. `read` reads their values.
fn named(
    reader: &mut Reader<'_>,
    entry: Option<&Entry>,
    example: &str,
    read: impl Fn(&mut Reader<'_>, &Placed<String>, &[Placed<Node>]) -> Option<AxisValues>,
) -> Vec<Option<Axis>> {
    let Some(entry) = entry else { return Vec::new() };
    let Node::Mapping(entries) = &entry.value.value else {
        reader.wrong_type(&entry.value, "a mapping", format!("write every name with a list of values, `{example}`"));
        return vec![None];
    };
    let mut axis = |entry: &Entry| {
        let items = some(reader, entry, "a list of values", VALUES)?;
        let values = read(reader, &entry.key, items)?;
        let mut seen = BTreeMap::new();
        for (index, item) in items.iter().enumerate().take(values.len()) {
            let text = values.text(index);
            check_new(reader, &mut seen, text.clone(), reader.extent(item), &text);
        }
        Some(Axis { name: entry.key.value.clone(), values })
    };
    entries.iter().map(&mut axis).collect()
}

fn parameters(reader: &mut Reader<'_>, _: &Placed<String>, items: &[Placed<Node>]) -> Option<AxisValues> {
    let values: Vec<_> = items.iter().map(|item| parameter(reader, item)).collect();
    Some(AxisValues::Parameter(values.into_iter().collect::<Option<_>>()?))
}

fn parameter(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<AxisValue<ParameterValue>> {
    let (value, text) = scenario::parameter(reader, node)?;
    Some(AxisValue { value, text, span: reader.extent(node) })
}

#[expect(clippy::unnecessary_wraps, reason = "it stands beside `parameters`")]
fn changes(_: &mut Reader<'_>, path: &Placed<String>, items: &[Placed<Node>]) -> Option<AxisValues> {
    Some(AxisValues::Scenario(items.iter().map(|item| Change::new(path.clone(), item.clone())).collect()))
}

/// The error of a policy, or of a value for one, at a span.
pub(super) fn unfit(span: Span, reason: &str) -> Diagnostic {
    let fault = Diagnostic::error(fault::UNFIT, "the policy does not fit the sweep", span, reason);
    fault.hint("vary only parameters that all policies have; for scenes of families, policies need a parameter `speed`")
}
