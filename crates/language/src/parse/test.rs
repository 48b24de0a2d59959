//! Tests and properties of a policy.

use crate::ast::{Range, Test, TestScenes};
use crate::grammar::Rule;
use crate::parse_tree::Pair;

use super::{Parsed, Reader, bound, named, setting, text};

pub(super) fn test(reader: &mut Reader<'_>) -> Parsed<Test> {
    let (title, scenario) = (text(reader)?, text(reader)?);
    body(reader, Test { title, scenes: TestScenes::Scenario(scenario), settings: Vec::new(), expectations: Vec::new() })
}

pub(super) fn property(reader: &mut Reader<'_>) -> Parsed<Test> {
    let (title, family) = (text(reader)?, named(reader.take(Rule::family)?));
    let ranges = if reader.has(Rule::ranges) { ranges(reader.take(Rule::ranges)?)? } else { Vec::new() };
    let scenes = TestScenes::Family { family, ranges };
    body(reader, Test { title, scenes, settings: Vec::new(), expectations: Vec::new() })
}

/// Reads the content of the braces into a `test` without any.
fn body(reader: &mut Reader<'_>, mut test: Test) -> Parsed<Test> {
    while let Some(pair) = reader.rest() {
        let rule = pair.as_rule();
        let mut reader = Reader::new(pair);
        if rule == Rule::setting {
            test.settings.push((reader.name()?, setting(&mut reader)?));
        } else {
            test.expectations.push(reader.expression()?);
        }
    }
    Ok(test)
}

fn ranges(pair: Pair<'_>) -> Parsed<Vec<Range>> {
    let mut reader = Reader::new(pair);
    let mut ranges = Vec::new();
    while reader.has(Rule::range) {
        let mut range = Reader::new(reader.take(Rule::range)?);
        let (name, low) = (range.name()?, bound(range.take(Rule::bound)?)?);
        let high = if range.has(Rule::bound) { Some(bound(range.take(Rule::bound)?)?) } else { None };
        ranges.push(Range { name, low, high });
    }
    Ok(ranges)
}
