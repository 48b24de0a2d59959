//! What is said of a word when a person points at it.

use crate::diagnostic::Span;
use crate::policy::types::Type;
use crate::units::{Dimension, format_si, parse_unit, units_of};

use super::description::description;
use super::symbol::{Meaning, Symbol};
use super::words::word;
use super::{Index, meaning};

/// What is said of a word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hover {
    /// The word.
    pub span: Span,
    /// What is said, in Markdown.
    pub text: String,
}

impl Index {
    /// What is to be said of the word at a byte.
    #[must_use]
    pub fn hover(&self, at: usize) -> Option<Hover> {
        let known = self.use_at(at)?;
        let text = match known.meaning {
            Meaning::Symbol(index, _) => self.explain(&self.symbols[index]),
            Meaning::Function(_, usage) => {
                let name = usage.split('(').next().unwrap_or(usage);
                paragraphs(&[code(usage), meaning::of_function(name).to_owned()])
            }
            Meaning::Member(owner, member) => {
                let head = code(&format!("{}.{}", owner_name(owner), member.name));
                paragraphs(&[head, type_line(member.r#type), meaning::of_member(owner, member.name).to_owned()])
            }
            Meaning::Type(r#type) => paragraphs(&[code(self.source.slice(known.span)), type_line(r#type)]),
            Meaning::Unit(dimension) => {
                let unit = self.source.slice(known.span);
                paragraphs(&[code(unit), unit_line(unit, dimension)])
            }
            Meaning::Word(text) => {
                let word = word(text)?;
                paragraphs(&[code(&word.usage()), word.meaning.to_owned()])
            }
            Meaning::Unknown => return None,
        };
        Some(Hover { span: known.span, text })
    }

    fn explain(&self, symbol: &Symbol) -> String {
        let types = symbol.r#type.map(type_line).unwrap_or_default();
        paragraphs(&[code(&self.head(symbol)), types, self.description(symbol)])
    }

    /// What the comments beside a symbol say of it.
    #[must_use]
    pub fn description(&self, symbol: &Symbol) -> String {
        description(&self.source.text, symbol.whole)
    }
}

fn paragraphs(parts: &[String]) -> String {
    let parts: Vec<&str> = parts.iter().map(String::as_str).filter(|part| !part.is_empty()).collect();
    parts.join("\n\n")
}

fn code(text: &str) -> String {
    format!("```fsm\n{text}\n```")
}

/// The type, and the units that it is written in.
fn type_line(r#type: Type) -> String {
    match r#type {
        Type::Scalar(dimension) if dimension != Dimension::NUMBER => {
            format!("{}, in {}", r#type, units_of(dimension).join(", "))
        }
        other => other.to_string(),
    }
}

fn unit_line(unit: &str, dimension: Dimension) -> String {
    let size = parse_unit(&unit.replace('*', " ")).map_or(f64::NAN, |unit| unit.to_si(1.0));
    let si = dimension.si_unit();
    if si == unit {
        format!("the SI unit of {}", dimension.phrase())
    } else {
        format!("a unit of {}: {} {si}", dimension.phrase(), format_si(size, Dimension::NUMBER))
    }
}

fn owner_name(owner: Type) -> &'static str {
    match owner {
        Type::Whisker => "whisker",
        Type::Contour => "contour",
        _ => "body",
    }
}
