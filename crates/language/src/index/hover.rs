//! Hover texts.

use crate::builtins::{FUNCTIONS, LIST_MEMBERS, MAP_EVENTS, Member, MemberSource, map_event_usage};
use crate::description::description;
use crate::types::Type;
use crate::unit::units_of;
use vibrissa_runtime::units::{Dimension, format_si, parse_unit};
use vibrissa_text::diagnostic::Span;

use super::Index;
use super::import::{exports, heading};
use super::symbol::{Meaning, Symbol, SymbolKind};
use crate::words::word;

/// The maximum length of a line that is searched for a comment (bytes). It bounds the time for a text with many names.
const LINE_LIMIT: usize = 4096;

/// A hover text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hover {
    /// Span of the word.
    pub span: Span,
    /// The hover text in Markdown.
    pub text: String,
}

impl Index {
    /// The hover text for the word at a byte.
    #[must_use]
    pub fn hover(&self, at: usize) -> Option<Hover> {
        let known = self.use_at(at)?;
        let text = match known.meaning {
            Meaning::Symbol(index, _) => self.explain(&self.symbols[index]),
            Meaning::Function(function) => {
                let (_, function, usage, meaning) = FUNCTIONS.get(function)?;
                paragraphs(&[code(usage), (*meaning).to_owned(), format!("It takes {}.", function.takes())])
            }
            Meaning::Member(owner, member) => {
                let head = code(&usages(owner, &member).join("\n"));
                paragraphs(&[head, type_line(member.r#type), member.meaning.to_owned()])
            }
            Meaning::ListMember(list, member) => {
                let (_, usage, meaning) = LIST_MEMBERS[member];
                paragraphs(&[
                    code(&format!("list.{usage}")),
                    format!("of a `{}`", self.symbols[list].name),
                    meaning.to_owned(),
                ])
            }
            Meaning::MapEvent(event) => {
                let (name, takes, meaning) = MAP_EVENTS[event];
                paragraphs(&[code(&map_event_usage(name, takes)), meaning.to_owned()])
            }
            Meaning::File(part) => self.explain_file(part),
            Meaning::Type(r#type) => paragraphs(&[code(self.source.slice(known.span)), type_line(r#type)]),
            Meaning::Unit(dimension) => {
                let unit = self.source.slice(known.span);
                paragraphs(&[code(unit), unit_line(unit, dimension)])
            }
            Meaning::Keyword(text) => {
                let word = word(text)?;
                paragraphs(&[code(&word.usage()), word.meaning.to_owned()])
            }
            Meaning::Family(entry) => {
                let names = entry.parameters.iter().map(|parameter| format!("`{}`", parameter.name));
                let names = names.collect::<Vec<_>>().join(", ");
                paragraphs(&[code(entry.name), entry.about.to_owned(), format!("Its parameters are {names}.")])
            }
            Meaning::FamilyParameter(parameter) => {
                let (low, high) = parameter.limits;
                let limits = format!("From {} to {}.", parameter.text(low), parameter.text(high));
                let types = type_line(Type::Scalar(parameter.dimension));
                paragraphs(&[code(parameter.name), types, parameter.about.to_owned(), limits])
            }
            Meaning::Unknown => return None,
        };
        Some(Hover { span: known.span, text })
    }

    fn explain(&self, symbol: &Symbol) -> String {
        let r#type = symbol.r#type.filter(|_| symbol.kind != SymbolKind::Compound);
        let types = r#type.map(|r#type| self.type_line(r#type)).unwrap_or_default();
        let file = self.file_of(symbol).map(|file| format!("from `{file}`")).unwrap_or_default();
        paragraphs(&[code(&self.head(symbol)), types, self.description(symbol), file])
    }

    /// The type and its units.
    fn type_line(&self, r#type: Type) -> String {
        if let Type::Choice(_) | Type::Compound(_) = r#type { self.phrase(r#type) } else { type_line(r#type) }
    }

    /// A type in texts.
    pub(super) fn phrase(&self, r#type: Type) -> String {
        let is_it = |symbol: &&Symbol, declared| symbol.span == declared;
        let item = match r#type {
            Type::Choice(choices) => self.symbols.iter().find(|symbol| is_it(symbol, choices.declared)),
            Type::Compound(of) => self.symbols.iter().find(|symbol| is_it(symbol, of.declared)),
            _ => None,
        };
        item.map_or_else(|| r#type.to_string(), |item| format!("a `{}`", item.name))
    }

    /// The laws, derived values and enumerations of a file.
    fn explain_file(&self, part: usize) -> String {
        let offered = exports(&self.source, part);
        let heads: Vec<String> = offered.iter().map(|symbol| self.head(symbol)).collect();
        let name = self.source.part_name(part);
        let about = heading(self.source.slice(self.source.part_span(part)));
        paragraphs(&[format!("`{name}`"), about, code(&heads.join("\n"))])
    }

    /// The description of a symbol in the comments beside it.
    #[must_use]
    pub fn description(&self, symbol: &Symbol) -> String {
        // A comment beside an argument describes the item that contains the argument.
        let behind = self.source.slice(Span::new(symbol.span.start, symbol.span.start + LINE_LIMIT + 1));
        let is_line = behind.len() <= LINE_LIMIT || behind.contains('\n');
        let is_described = symbol.kind != SymbolKind::Argument && is_line;
        is_described.then(|| description(&self.source, symbol.span)).flatten().unwrap_or_default()
    }
}

fn paragraphs(parts: &[String]) -> String {
    let parts: Vec<&str> = parts.iter().map(String::as_str).filter(|part| !part.is_empty()).collect();
    parts.join("\n\n")
}

fn code(text: &str) -> String {
    format!("```fsm\n{text}\n```")
}

/// The type and its units.
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

/// The notations of a member.
fn usages(owner: Type, member: &Member) -> Vec<String> {
    let plain = format!("{}.{}", owner_name(owner), member.name);
    let with_value = member.at.map(|at| {
        let values: Vec<&str> = at.takes().iter().map(|&(value, ..)| value).collect();
        format!("{plain}({})", values.join(", "))
    });
    match member.source {
        MemberSource::At => with_value.into_iter().collect(),
        MemberSource::Visits | MemberSource::TimeIn => vec![format!("{plain}(State)")],
        MemberSource::Plot(_) => vec![format!("{plain}(plot)")],
        _ => std::iter::once(plain).chain(with_value).collect(),
    }
}

fn owner_name(owner: Type) -> &'static str {
    match owner {
        Type::Whisker => "whisker",
        Type::Contour => "contour",
        Type::Run => "run",
        Type::Map => "map",
        Type::Target => "map.next",
        Type::Route => "map.route",
        _ => "body",
    }
}
