//! Contracts.

use crate::ast::{Contract, ContractKind};
use crate::grammar::Rule;
use crate::parse_tree::Pair;

use super::{Parsed, Reader};

pub(super) fn contract(pair: Pair<'_>) -> Parsed<Contract> {
    let kind = match pair.as_rule() {
        Rule::assume => ContractKind::Assume,
        Rule::never => ContractKind::Never,
        _ => ContractKind::Always,
    };
    let span = pair.span();
    let mut reader = Reader::new(pair);
    let condition = reader.expression()?;
    let time = if reader.has(Rule::expression) { Some(reader.expression()?) } else { None };
    Ok(Contract { kind, condition, time, span })
}
