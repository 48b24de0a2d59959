//! The table of figures in `docs/metrics.md`, generated from the declarations.
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

use std::fmt::Write;

use super::{Better, FIGURES, Figure, GROUPS, Kind};

const BEGIN: &str = "<!-- figures: a test writes this table, see howto/extend.md -->\n";
const END: &str = "<!-- end of figures -->\n";

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/metrics.md");

#[test]
fn the_table_of_all_figures_is_up_to_date() {
    let found = std::fs::read_to_string(PAGE).unwrap_or_else(|cause| panic!("{PAGE}: {cause}"));
    let (before, rest) = found.split_once(BEGIN).unwrap_or_else(|| panic!("{PAGE} has no line {BEGIN}"));
    let (_, after) = rest.split_once(END).unwrap_or_else(|| panic!("{PAGE} has no line {END}"));
    let wanted = format!("{before}{BEGIN}\n{}\n{END}{after}", table());
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(PAGE, &wanted).unwrap_or_else(|cause| panic!("{PAGE}: {cause}"));
    } else {
        assert!(
            found == wanted,
            "docs/metrics.md is stale; run `INSTA_UPDATE=always cargo test --workspace --lib figures`"
        );
    }
}

/// All figures with their groups, in the order of the document.
fn table() -> String {
    let mut page = "| in `--json` | in `expect` | in tests | better | meaning |\n|---|---|---|---|---|\n".to_owned();
    let mut written = Vec::new();
    for figure in &FIGURES {
        let key = figure.key.unwrap_or_default();
        for group in GROUPS.iter().filter(|group| key.starts_with(&format!("{}.", group.key))) {
            if !written.contains(&group.key) {
                written.push(group.key);
                row(&mut page, [&code(group.key), "", "", "", group.meaning]);
            }
        }
        let name = figure.name.unwrap_or_default();
        let better = match figure.better {
            Some(Better::Smaller) => "smaller",
            Some(Better::Larger) => "larger",
            None => "",
        };
        let expected = figure.bound.map_or_else(String::new, |_| code(name));
        let tested = if figure.is_in_tests { code(&format!("run.{name}")) } else { String::new() };
        row(&mut page, [&code(key), &expected, &tested, better, figure.meaning]);
    }
    page
}

fn code(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("`{text}`") }
}

fn row<const N: usize>(page: &mut String, cells: [&str; N]) {
    let _ = writeln!(page, "| {} |", cells.join(" | "));
}

#[test]
fn every_declaration_is_complete_and_no_name_or_key_stands_twice() {
    for (index, figure) in FIGURES.iter().enumerate() {
        let Figure { key, name, better, bound, is_in_tests, .. } = *figure;
        let others = || FIGURES.iter().skip(index + 1);
        assert!(key.is_some() || name.is_some(), "{}", figure.meaning);
        assert!(name.is_none() || others().all(|other| other.name != name), "{name:?}");
        assert!(key.is_none() || others().all(|other| other.key != key), "{key:?}");
        assert!(name.is_some() || bound.is_none() && !is_in_tests, "{key:?} has no name");
        assert!(better.is_some() || bound.is_none() && figure.compared.is_none(), "{key:?} has no direction");
        // What is missing from 1 is to be small.
        assert!(name.is_none() || !figure.larger_is_better() || figure.kind == Kind::Share, "{name:?}");
        let units = match figure.kind {
            Kind::Length => &["_mm", "_m"][..],
            Kind::Area => &["_m2"],
            Kind::Time => &["_s", "_us"],
            Kind::Angle => &["_rad"],
            Kind::Share | Kind::Ratio | Kind::Count | Kind::Truth => &[""],
        };
        let has_unit = |key: &str| key.split('.').any(|part| units.iter().any(|unit| part.ends_with(unit)));
        assert!(key.is_none_or(has_unit), "{key:?} does not name its unit");
        let groups = key.unwrap_or_default().match_indices('.').map(|(dot, _)| &key.unwrap_or_default()[..dot]);
        assert!(groups.into_iter().all(|group| GROUPS.iter().any(|known| known.key == group)), "{key:?}");
    }
    let used = |key: &str| FIGURES.iter().any(|figure| figure.key.is_some_and(|figure| figure.starts_with(key)));
    assert!(GROUPS.iter().all(|group| used(&format!("{}.", group.key))));
}
