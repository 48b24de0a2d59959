//! Tests of a policy.

use crate::policy::ast::Test;
use crate::policy::grammar::Rule;

use super::{Parsed, Reader, bound, text};

pub(super) fn test(reader: &mut Reader<'_>) -> Parsed<Test> {
    let (title, scenario) = (text(reader)?, text(reader)?);
    let mut test = Test { title, scenario, settings: Vec::new(), expectations: Vec::new() };
    while let Some(pair) = reader.rest() {
        let rule = pair.as_rule();
        let mut reader = Reader::new(pair);
        if rule == Rule::setting {
            test.settings.push((reader.name()?, bound(reader.take(Rule::bound)?)?));
        } else {
            test.expectations.push(reader.expression()?);
        }
    }
    Ok(test)
}
