//! Completion.

use std::collections::HashMap;

use crate::ast::{Name, TypeName};
use crate::builtins::{self, FUNCTIONS, LIST_MEMBERS, MAP_EVENTS, MemberSource};
use crate::standard::{self, ROOT};
use crate::types::{Compound, DIMENSIONS, PLAIN_TYPES, Type};
use crate::unit::units_of;
use vibrissa_declare::catalogue;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Span;

use super::applied::is_part;
use super::context::{Context, Expected, Level, context};
use super::import::{exports, heading};
use super::operands::Owner;
use super::symbol::{Symbol, SymbolKind};
use super::{Index, text};
use crate::word::{Position, Word};
use crate::words::{word, words_at};

/// The kind of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CandidateKind {
    /// A keyword.
    Keyword,
    /// A built-in function.
    Function,
    /// A member of a whisker, a contour or the body.
    Member,
    /// A type.
    Type,
    /// A unit.
    Unit,
    /// A module of the standard library.
    Module,
    /// A family of scenes.
    Family,
    /// A declared name.
    Symbol(SymbolKind),
}

/// A proposed completion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// The proposed word.
    pub label: String,
    /// The kind.
    pub kind: CandidateKind,
    /// The type or the notation.
    pub detail: String,
    /// The meaning. It may be empty.
    pub meaning: String,
    /// The text to insert, with placeholders `${1:…}`. The word itself if there are none.
    pub snippet: String,
}

/// Dimensions of numbers that occur in policies.
const WRITTEN: [Dimension; 10] = [
    Dimension::LENGTH,
    Dimension::ANGLE,
    Dimension::TIME,
    Dimension::SPEED,
    Dimension::ANGULAR_SPEED,
    Dimension::FREQUENCY,
    Dimension::ACCELERATION,
    Dimension::ANGULAR_ACCELERATION,
    Dimension::FORCE,
    Dimension::MOMENT,
];

impl Index {
    /// Candidates at a byte, and the span of the partial word that they replace.
    #[must_use]
    pub fn candidates(&self, at: usize) -> (Span, Vec<Candidate>) {
        let text = text(&self.source);
        let context = context(text, text.floor_char_boundary(at));
        (context.typed, self.expected(&context))
    }

    fn expected(&self, context: &Context) -> Vec<Candidate> {
        let of_kind = |kinds: &'static [SymbolKind]| {
            self.known(context).filter(|symbol| kinds.contains(&symbol.kind)).map(|symbol| self.symbol(symbol))
        };
        match context.expected {
            Expected::Nothing => Vec::new(),
            Expected::Member(dot) => match self.resolved.owners.get(&dot) {
                Some(Owner::Value(Type::Run)) if context.level != Level::Test => Vec::new(),
                Some(&Owner::Value(Type::Compound(of))) => self.members_of(of),
                Some(Owner::Value(Type::Map)) if context.tells => map_events().collect(),
                Some(&Owner::Value(owner)) => members(owner).collect(),
                Some(&Owner::State(monitor)) if self.symbols[monitor].kind != SymbolKind::State => {
                    let content = self.resolved.behaviours.get(&monitor).copied().unwrap_or(monitor);
                    let is_wanted = |symbol: &&Symbol| {
                        is_part(symbol, content) && (symbol.kind == SymbolKind::Event) == context.tells
                    };
                    self.symbols.iter().filter(is_wanted).map(|symbol| self.symbol(symbol)).collect()
                }
                Some(&Owner::State(outer)) => self.inner_states(outer),
                Some(&Owner::Enumeration(owner)) => {
                    let choices = self.symbols.iter().filter(|symbol| symbol.owner == Some(owner));
                    choices.map(|symbol| self.symbol(symbol)).collect()
                }
                None => Vec::new(),
            },
            Expected::Target => self.targets(context),
            Expected::Initial => self.beginnings(context),
            Expected::Resumed => self.resumable(context),
            Expected::State => {
                let states = self.known(context).filter(|symbol| symbol.kind == SymbolKind::State);
                states.map(|state| Candidate { snippet: state.name.clone(), ..self.symbol(state) }).collect()
            }
            Expected::Parameter => of_kind(&[SymbolKind::Parameter]).collect(),
            Expected::Contour => of_kind(&[SymbolKind::Contour]).collect(),
            Expected::Mark => words_at(Position::Mark).map(of_keyword).collect(),
            Expected::Need => words_at(Position::Need).map(of_keyword).collect(),
            Expected::TipModel => words_at(Position::TipModel).map(of_keyword).collect(),
            Expected::File => modules(&format!("{ROOT}.")).collect(),
            Expected::Module => modules("").collect(),
            Expected::Chosen => self.exported(context),
            Expected::Value if context.level == Level::Test => self.values_of_a_run(context),
            Expected::Law => of_kind(&[SymbolKind::Law]).collect(),
            Expected::Behaviour => of_kind(&[SymbolKind::Behaviour]).collect(),
            Expected::Monitor => of_kind(&[SymbolKind::Monitor]).collect(),
            Expected::Exit => of_kind(&[SymbolKind::Exit]).collect(),
            Expected::Connected => self.connected(context),
            Expected::Memory => of_kind(&[SymbolKind::Memory]).collect(),
            Expected::Type => {
                let built_in = PLAIN_TYPES.into_iter().map(of_type).chain(dimensions());
                built_in.chain(of_kind(&[SymbolKind::Enumeration])).chain(self.compounds(context)).collect()
            }
            Expected::Dimension => dimensions().collect(),
            Expected::Unit => units().collect(),
            Expected::Value => self.values(context),
            Expected::Machine => words_at(Position::File).map(of_keyword).collect(),
            Expected::Family => families().collect(),
            Expected::FamilyParameter(family) => family_parameters(family).collect(),
            Expected::Only(text) => word(text).map(of_keyword).into_iter().collect(),
            Expected::Statement(level) => self.statements(level).collect(),
            Expected::More(level, words) => {
                words.iter().filter_map(|text| word(text)).map(of_keyword).chain(self.statements(level)).collect()
            }
        }
    }

    /// The symbols that are visible at a position. Inner ones hide outer ones with the same name.
    pub(super) fn known(&self, context: &Context) -> impl Iterator<Item = &Symbol> {
        let at = context.typed.start;
        let known = self.symbols.iter().filter(move |symbol| {
            !matches!(symbol.kind, SymbolKind::Choice | SymbolKind::Field)
                && (symbol.visible.start..=symbol.visible.end).contains(&at)
                && context.statement != Some(symbol.whole.start)
                && (symbol.kind != SymbolKind::Local || self.is_known_local(symbol, context))
                && (symbol.kind != SymbolKind::Memory || symbol.span.start < context.memory_end)
                && (symbol.kind != SymbolKind::Memory || symbol.owner.is_some() || !context.in_behaviour)
        });
        let mut innermost: HashMap<&str, usize> = HashMap::new();
        for symbol in known.clone() {
            let start = innermost.entry(&symbol.name).or_default();
            *start = symbol.visible.start.max(*start);
        }
        known.filter(move |symbol| innermost.get(symbol.name.as_str()) == Some(&symbol.visible.start))
    }

    /// True if a named value of a statement is visible at a later position. It is not visible in transitions of its
    /// state, or in inner states.
    fn is_known_local(&self, local: &Symbol, context: &Context) -> bool {
        let owner = local.owner.and_then(|owner| self.symbols.get(owner));
        let is_beyond = owner.is_some_and(|owner| owner.kind == SymbolKind::State && Some(owner.span) != context.state);
        !context.in_transition && !is_beyond
    }

    fn values(&self, context: &Context) -> Vec<Candidate> {
        let is_value = |symbol: &&Symbol| {
            symbol.kind.is_value() || matches!(symbol.kind, SymbolKind::Enumeration | SymbolKind::Compound)
        };
        let named = self.known(context).filter(is_value).map(|symbol| self.symbol(symbol));
        named.chain(words_at(Position::Value).map(of_keyword)).chain(functions()).collect()
    }

    /// The records and lists, as types.
    fn compounds(&self, context: &Context) -> impl Iterator<Item = Candidate> {
        let compounds = self.known(context).filter(|symbol| symbol.kind == SymbolKind::Compound);
        compounds.map(|symbol| Candidate { snippet: symbol.name.clone(), ..self.symbol(symbol) })
    }

    /// The fields of a record, or the members of a list.
    fn members_of(&self, of: Compound) -> Vec<Candidate> {
        let Some(owner) = self.symbols.iter().position(|symbol| symbol.span == of.declared) else { return Vec::new() };
        let fields = self.symbols.iter().filter(|symbol| symbol.owner == Some(owner));
        let fields: Vec<Candidate> = fields.map(|symbol| self.symbol(symbol)).collect();
        if !fields.is_empty() {
            return fields;
        }
        let members = LIST_MEMBERS.iter().map(|&(name, usage, meaning)| Candidate {
            label: name.to_owned(),
            kind: CandidateKind::Member,
            detail: usage.to_owned(),
            meaning: meaning.to_owned(),
            snippet: call_snippet(usage),
        });
        members.collect()
    }

    /// Values that expectations of tests can read.
    fn values_of_a_run(&self, context: &Context) -> Vec<Candidate> {
        let kinds = [SymbolKind::Parameter, SymbolKind::Derived];
        let named = self.known(context).filter(|symbol| kinds.contains(&symbol.kind)).map(|symbol| self.symbol(symbol));
        words_at(Position::Run).map(of_keyword).chain(named).chain(functions()).collect()
    }

    /// Names that the file of the current `use` provides.
    fn exported(&self, context: &Context) -> Vec<Candidate> {
        let import = self.imports.iter().find(|import| Some(import.start) == context.statement);
        let Some(part) = import.and_then(|import| import.part(&self.source)) else { return Vec::new() };
        let candidate = |symbol: &Symbol| Candidate { snippet: symbol.name.clone(), ..self.symbol(symbol) };
        exports(&self.source, part).iter().map(candidate).collect()
    }

    /// Keywords that begin a statement or an item at this level of braces.
    fn statements(&self, level: Level) -> impl Iterator<Item = Candidate> {
        let heading = self.symbols().iter().find(|symbol| symbol.kind == SymbolKind::Machine);
        let is_library = heading.is_some_and(|heading| self.source.slice(heading.whole).starts_with("library"));
        let position = match level {
            Level::Outside if is_library => Position::Library,
            Level::Outside => Position::Item,
            Level::State => Position::State,
            Level::Test => Position::Test,
            Level::Block => Position::Statement,
        };
        words_at(position).map(of_keyword)
    }

    pub(super) fn symbol(&self, symbol: &Symbol) -> Candidate {
        let r#type = symbol.r#type.filter(|_| symbol.kind != SymbolKind::Compound);
        let detail = r#type.map_or_else(|| self.head(symbol), |r#type| self.phrase(r#type));
        let usage = format!("{}({})", symbol.name, symbol.arguments.join(", "));
        let snippet = if symbol.arguments.is_empty() && symbol.kind != SymbolKind::Law {
            symbol.name.clone()
        } else {
            call_snippet(&usage)
        };
        let kind = CandidateKind::Symbol(symbol.kind);
        Candidate { label: symbol.name.clone(), kind, detail, meaning: self.description(symbol), snippet }
    }
}

pub(super) fn of_keyword(word: &'static Word) -> Candidate {
    Candidate {
        label: word.text.to_owned(),
        kind: CandidateKind::Keyword,
        detail: String::new(),
        meaning: word.meaning.to_owned(),
        snippet: word.snippet.to_owned(),
    }
}

fn members(owner: Type) -> impl Iterator<Item = Candidate> {
    builtins::members(owner).iter().map(move |member| {
        let values: Vec<&str> = match (member.source, member.at) {
            (MemberSource::At, Some(at)) => at.takes().iter().map(|&(value, ..)| value).collect(),
            (MemberSource::Visits | MemberSource::TimeIn, _) => vec!["State"],
            (MemberSource::Plot(_), _) => vec!["plot"],
            _ => Vec::new(),
        };
        let fields = (1..).zip(values).map(|(number, value)| format!("${{{number}:{value}}}"));
        let fields = fields.collect::<Vec<_>>().join(", ");
        Candidate {
            label: member.name.to_owned(),
            kind: CandidateKind::Member,
            detail: member.r#type.to_string(),
            meaning: member.meaning.to_owned(),
            snippet: if fields.is_empty() { member.name.to_owned() } else { format!("{}({fields})", member.name) },
        }
    })
}

/// The events of the map.
fn map_events() -> impl Iterator<Item = Candidate> {
    MAP_EVENTS.iter().map(|&(name, takes, meaning)| {
        let fields = (1..).zip(takes).map(|(number, (value, ..))| format!("${{{number}:{value}}}"));
        let fields = fields.collect::<Vec<_>>().join(", ");
        Candidate {
            label: name.to_owned(),
            kind: CandidateKind::Member,
            detail: String::new(),
            meaning: meaning.to_owned(),
            snippet: if fields.is_empty() { name.to_owned() } else { format!("{name}({fields})") },
        }
    })
}

fn functions() -> impl Iterator<Item = Candidate> {
    FUNCTIONS.iter().map(|&(name, _, usage, meaning)| Candidate {
        label: name.to_owned(),
        kind: CandidateKind::Function,
        detail: usage.to_owned(),
        meaning: meaning.to_owned(),
        snippet: call_snippet(usage),
    })
}

/// The modules of the standard library, after the typed prefix.
fn modules(prefix: &str) -> impl Iterator<Item = Candidate> {
    standard::modules().iter().map(move |(module, text)| {
        let label = format!("{prefix}{module}");
        Candidate {
            kind: CandidateKind::Module,
            detail: format!("use {ROOT}.{module}"),
            meaning: heading(text),
            snippet: label.clone(),
            label,
        }
    })
}

fn families() -> impl Iterator<Item = Candidate> {
    catalogue::ENTRIES.iter().map(|entry| Candidate {
        label: entry.name.to_owned(),
        kind: CandidateKind::Family,
        detail: String::new(),
        meaning: entry.about.to_owned(),
        snippet: entry.name.to_owned(),
    })
}

fn family_parameters(family: &str) -> impl Iterator<Item = Candidate> {
    catalogue::entry(family).into_iter().flat_map(|entry| entry.parameters).map(|parameter| {
        let (low, high) = parameter.range;
        let (low, high) = (parameter.text(low), parameter.text(high));
        Candidate {
            label: parameter.name.to_owned(),
            kind: CandidateKind::Member,
            detail: Type::Scalar(parameter.dimension).to_string(),
            meaning: parameter.about.to_owned(),
            snippet: format!("{} in ${{1:{low}}} .. ${{2:{high}}}", parameter.name),
        }
    })
}

fn of_type(name: &str) -> Candidate {
    let base = Name { text: name.to_owned(), span: Span::default() };
    let r#type = Type::named(&TypeName { base, of: None, factors: Vec::new() });
    Candidate {
        label: name.to_owned(),
        kind: CandidateKind::Type,
        detail: r#type.map(|r#type| r#type.to_string()).unwrap_or_default(),
        meaning: String::new(),
        snippet: name.to_owned(),
    }
}

fn dimensions() -> impl Iterator<Item = Candidate> {
    DIMENSIONS.iter().map(|&(name, _)| of_type(name))
}

fn units() -> impl Iterator<Item = Candidate> {
    WRITTEN.into_iter().flat_map(|dimension| {
        units_of(dimension).into_iter().map(move |unit| Candidate {
            label: unit.clone(),
            kind: CandidateKind::Unit,
            detail: dimension.phrase(),
            meaning: String::new(),
            snippet: unit,
        })
    })
}

/// A call with placeholders for its values: `turn(from, to)` as `turn(${1:from}, ${2:to})`.
fn call_snippet(usage: &str) -> String {
    let Some((name, values)) = usage.split_once('(') else { return usage.to_owned() };
    let values = values.trim_end_matches(')').split(", ").filter(|value| !value.is_empty()).enumerate();
    let values: Vec<String> = values.map(|(index, value)| format!("${{{}:{value}}}", index + 1)).collect();
    format!("{name}({})", values.join(", "))
}
