//! The reference page, generated from the tables of the compiler and of the words for editors.

use std::fmt::Write;

use crate::ast::{Argument, Behaviour, Content, Name};
use crate::description::{description, whole_description};
use crate::parse::parse;
use crate::standard::{ROOT, modules};
use crate::types::{DIMENSIONS, Type};
use crate::unit::units_of;
use crate::word_reference::words;
use vibrissa_declare::catalogue::{self, Parameter};
use vibrissa_runtime::machine::MapQuestion;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Source;

use super::{At, FUNCTIONS, LIST_MEMBERS, MAP_EVENTS, MemberSource, map_event_usage, members};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference.md");

#[test]
#[expect(clippy::disallowed_methods, reason = "a test may open files")]
fn the_reference_page_is_up_to_date() {
    let page = page();
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(PAGE, &page).unwrap_or_else(|cause| panic!("{PAGE}: {cause}"));
    }
    let found = std::fs::read_to_string(PAGE).unwrap_or_default();
    assert!(
        found == page,
        "docs/reference.md is stale; run `INSTA_UPDATE=always cargo test --workspace --lib reference`"
    );
}

fn page() -> String {
    let mut page = "\
# Reference of the policy language

The types, members, functions and words of policies. [The tour of the language](language.md) explains how to use them.

A test generates this page from the tables of the compiler. To change it, change the tables, and run
`INSTA_UPDATE=always cargo test --workspace --lib reference`.

Unless stated otherwise, positions and directions are in the world frame (x right, y up).

## Types

| type | units |
|---|---|
| `bool` | `true` or `false` |
| `whisker` | one of the bound whiskers |
| `contour` | the contour of a whisker: `w.contour` |
"
    .to_owned();
    for (name, dimension) in DIMENSIONS {
        let units = if dimension == Dimension::NUMBER {
            "a plain number, without a unit".to_owned()
        } else {
            units_of(dimension).iter().map(|unit| format!("`{unit}`")).collect::<Vec<_>>().join(", ")
        };
        row(&mut page, [&format!("`{name}`"), &units]);
    }
    page += "\
| `position` | a point of the world frame, with `x` and `y`. The difference of two positions is a displacement, `vector of length` |
| `direction` | a unit vector, with `x` and `y`. It is also a `vector` |
| `vector`, `vector of length`, \u{2026} | two components `x` and `y`, plain or with one dimension |
| `angular_speed / length`, `vector of length / time`, \u{2026} | products and quotients of dimensions |

## Names

| name | type | meaning |
|---|---|---|
";
    row(&mut page, ["`time`", &shown(Type::TIME), "the time since the start of the run"]);
    row(&mut page, ["`state_time`", &shown(Type::TIME), "the time since the entry of the state that contains it"]);
    for (owner, prefix) in [
        (Type::Body, "body"),
        (Type::Map, "map"),
        (Type::Target, "map.next"),
        (Type::Route, "map.route"),
        (Type::Whisker, "w"),
        (Type::Contour, "c"),
        (Type::Run, "run"),
    ] {
        page += match owner {
            Type::Body | Type::Map | Type::Target | Type::Route => "",
            Type::Whisker => "\n## Members of a whisker `w`\n\n| member | type | meaning |\n|---|---|---|\n",
            Type::Run => {
                "\n## Members of `run`, in the expectations of tests and properties\n\n| member | type | meaning |\n|---|---|---|\n"
            }
            _ => {
                "\n## Members of a contour `c`, such as `w.contour`\n\nA distance `back` is a length along the \
                 curve, limited to the beginning of the curve.\n\n| member | type | meaning |\n|---|---|---|\n"
            }
        };
        for member in members(owner) {
            let plain = format!("`{prefix}.{}`", member.name);
            let with_value = member.at.map(|at| format!("`{prefix}.{}({})`", member.name, value(at)));
            let usage = match (member.source, with_value) {
                (MemberSource::At, Some(usage)) => usage,
                (MemberSource::Visits | MemberSource::TimeIn, _) => format!("`{prefix}.{}(State)`", member.name),
                (MemberSource::Plot(_), _) => format!("`{prefix}.{}(plot)`", member.name),
                (_, Some(usage)) => format!("{plain}, {usage}"),
                (_, None) => plain,
            };
            let r#type = match member.source {
                MemberSource::Plot(_) => "as the plot".to_owned(),
                _ => shown(member.r#type),
            };
            row(&mut page, [&usage, &r#type, member.meaning]);
        }
    }
    page += "\n### Members of a list\n\n| member | meaning |\n|---|---|\n";
    for (_, usage, meaning) in LIST_MEMBERS {
        row(&mut page, [&format!("`list.{usage}`"), meaning]);
    }
    page += "\n### What the map can be told\n\n| statement | meaning |\n|---|---|\n";
    for (name, takes, meaning) in MAP_EVENTS {
        row(&mut page, [&format!("`{}`", map_event_usage(name, takes)), meaning]);
    }
    page += "\n## Functions\n\n| function | arguments | result |\n|---|---|---|\n";
    for (_, function, usage, meaning) in FUNCTIONS {
        row(&mut page, [&format!("`{usage}`"), function.takes(), meaning]);
    }
    families(&mut page);
    standard(&mut page);
    words(&mut page);
    page
}

/// The families of scenes that properties name.
fn families(page: &mut String) {
    *page += "\n## Families of scenes, in properties\n\nA parameter that a property does not name is drawn from the \
              range of the family. A failing case is made simpler towards the simplest values.\n";
    for entry in catalogue::ENTRIES {
        let _ = write!(
            page,
            "\n### `{}`\n\n{}\n\n| parameter | range | possible values | simplest | meaning |\n|---|---|---|---|---|\n",
            entry.name, entry.about
        );
        // Numbered parameters differ only in their number.
        let stem = |parameter: &Parameter| parameter.name.trim_end_matches(|last: char| last.is_ascii_digit());
        for group in entry.parameters.chunk_by(|one, next| stem(one) == stem(next) && stem(one).ends_with('_')) {
            let (parameter, last) = (group[0], group[group.len() - 1]);
            let span = |(low, high)| format!("{} to {}", parameter.text(low), parameter.text(high));
            let simplest = parameter.text(parameter.simplest);
            let name = match group {
                [only] => format!("`{}`", only.name),
                _ => format!("`{}` to `{}`", parameter.name, last.name),
            };
            row(page, [&name, &span(parameter.range), &span(parameter.limits), &simplest, parameter.about]);
        }
    }
}

/// The standard library, described by the comments in its files.
fn standard(page: &mut String) {
    *page += "\n## The standard library\n";
    for (module, text) in modules() {
        let source = Source::new(*module, *text);
        let file = parse(&source, 0).unwrap_or_else(|fault| panic!("{module}: {fault:?}"));
        let about =
            text.lines().take_while(|line| line.starts_with('#')).map(|line| line.trim_start_matches(['#', ' ']));
        let about = about.collect::<Vec<_>>().join(" ");
        let _ = write!(page, "\n### `use {ROOT}.{module}`\n\n{about}\n\n| item | meaning |\n|---|---|\n");
        let laws = file.laws.iter().map(|law| ("law", &law.name, &law.arguments));
        let values = file.derived.iter().map(|value| ("let", &value.name, &value.arguments));
        let behaviours = file.behaviours.iter().map(|item| ("behaviour", &item.name, &item.root().arguments));
        let monitors = file.monitors.iter().map(|item| ("monitor", &item.name, &item.arguments));
        let items = laws.chain(values).chain(behaviours).chain(monitors);
        let mut items: Vec<(&str, &Name, &Vec<Argument>)> = items.collect();
        items.sort_by_key(|(_, name, _)| name.span.start);
        for item in &file.enumerations {
            let values = item.values.iter().map(|value| value.text.as_str()).collect::<Vec<_>>().join(" or ");
            let said = whole_description(&source, item.name.span)
                .unwrap_or_else(|| panic!("{} has no description", item.name.text));
            row(page, [&format!("`type {} = {values}`", item.name.text), &said]);
        }
        for item in &file.compounds {
            let said = whole_description(&source, item.name.span)
                .unwrap_or_else(|| panic!("{} has no description", item.name.text));
            let content = match &item.content {
                Content::Record(fields) => format!("({})", typed(&source, fields)),
                Content::List { most, element } => {
                    format!(" = list of {} {}", most.text, source.slice(element.span()))
                }
            };
            row(page, [&format!("`type {}{content}`", item.name.text), &said]);
        }
        for (kind, name, arguments) in items {
            let arguments = typed(&source, arguments);
            let arguments = if arguments.is_empty() && kind == "let" { arguments } else { format!("({arguments})") };
            let said =
                whole_description(&source, name.span).unwrap_or_else(|| panic!("{} has no description", name.text));
            row(page, [&format!("`{kind} {}{arguments}`", name.text), &said]);
        }
        file.behaviours.iter().for_each(|item| behaviour(page, (module, &source), item));
    }
}

/// Arguments or fields with their types.
fn typed(source: &Source, arguments: &[Argument]) -> String {
    let arguments = arguments.iter().map(|one| {
        let end = one.default.as_ref().map_or(one.type_name.span(), |default| default.span);
        format!("{}: {}", one.name.text, source.slice(one.type_name.span().to(end)))
    });
    arguments.collect::<Vec<_>>().join(", ")
}

/// The exits and contracts of a behaviour, and how to draw its chart.
fn behaviour(page: &mut String, (module, source): (&str, &Source), item: &Behaviour) {
    let (name, root) = (&item.name.text, item.root());
    let depth = if item.states.iter().any(|state| state.behaviour.is_some()) { " --depth 1" } else { "" };
    let _ = write!(
        page,
        "\n#### `{name}`\n\nIts tests are in `policies/tests/{module}.fsm`. This is its [statechart](pictures/behaviours/{name}.svg), as \
         `vibrissa graph policies/std/{module}.fsm --state {name}{depth}` draws it:\n\n\
         ![Statechart of {name}](pictures/behaviours/{name}.svg)\n\n| exit | meaning |\n|---|---|\n"
    );
    for exit in root.exits.iter() {
        let values =
            exit.arguments.iter().map(|one| format!("{}: {}", one.name.text, source.slice(one.type_name.span())));
        let values = values.collect::<Vec<_>>().join(", ");
        let values = if values.is_empty() { values } else { format!("({values})") };
        let said = description(source, exit.name.span).unwrap_or_default();
        row(page, [&format!("`{}{values}`", exit.name.text), &said]);
    }
    let contracts = item.states.iter().flat_map(|state| state.contracts.iter().map(move |contract| (state, contract)));
    let contracts: Vec<_> = contracts.collect();
    if contracts.is_empty() {
        return;
    }
    *page += "\n| contract | of |\n|---|---|\n";
    for (state, contract) in contracts {
        // A bar would end the cell.
        let text = source.on_one_line(contract.span).replace('|', "\\|");
        row(page, [&format!("`{text}`"), &format!("`{}`", state.name.text)]);
    }
}

/// The name of a member's argument.
fn value(at: At) -> &'static str {
    match at {
        At::Tip => "base_angle",
        At::Contour(_) => "back",
        At::LoopClosed => "within, after",
        At::Map(MapQuestion::IsClear) => "position, heading",
        At::Map(_) => "position",
    }
}

fn row<const N: usize>(page: &mut String, cells: [&str; N]) {
    let _ = writeln!(page, "| {} |", cells.join(" | "));
}

/// A type in words, without an article.
fn shown(r#type: Type) -> String {
    let shown = r#type.to_string();
    shown.strip_prefix("a ").or_else(|| shown.strip_prefix("an ")).unwrap_or(&shown).to_owned()
}
