//! What can be written at a place.

use crate::diagnostic::Span;
use crate::policy::builtins::{self, FUNCTIONS, MemberSource};
use crate::policy::types::{DIMENSIONS, Type};
use crate::units::{Dimension, units_of};

use super::context::{Context, Expected, Level, context};
use super::symbol::{Symbol, SymbolKind};
use super::words::{Place, Word, word, words_of};
use super::{Index, meaning};

/// What a candidate is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CandidateKind {
    /// A word of the language.
    Word,
    /// A function of the language.
    Function,
    /// A member of a whisker, a contour or the body.
    Member,
    /// A type.
    Type,
    /// A unit.
    Unit,
    /// A name that the policy gives.
    Symbol(SymbolKind),
}

/// Something that can be written at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// The word itself.
    pub label: String,
    /// What it is.
    pub kind: CandidateKind,
    /// Its type, or how it is used.
    pub detail: String,
    /// What it means; may be empty.
    pub meaning: String,
    /// What to write, with `${1:…}` for what is to be filled in; the word itself if there is nothing.
    pub snippet: String,
}

/// Dimensions of which a policy is likely to write numbers.
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
    /// What can be written at a byte, and the part of a word that it takes the place of.
    #[must_use]
    pub fn candidates(&self, at: usize) -> (Span, Vec<Candidate>) {
        let context = context(&self.source.text, self.source.text.floor_char_boundary(at));
        (context.typed, self.expected(&context))
    }

    fn expected(&self, context: &Context) -> Vec<Candidate> {
        let of_kind = |kinds: &'static [SymbolKind]| {
            self.known(context).filter(|symbol| kinds.contains(&symbol.kind)).map(|symbol| self.symbol(symbol))
        };
        match context.expected {
            Expected::Nothing => Vec::new(),
            Expected::Member(dot) => {
                self.resolved.owners.get(&dot).map_or_else(Vec::new, |&owner| members(owner).collect())
            }
            Expected::Target => of_kind(&[SymbolKind::State]).chain(words_of(Place::Target).map(of_word)).collect(),
            Expected::Initial => {
                let states = self.known(context).filter(|symbol| symbol.kind == SymbolKind::State);
                states.filter(|state| state.arguments.is_empty()).map(|state| self.symbol(state)).collect()
            }
            Expected::Law => of_kind(&[SymbolKind::Law]).collect(),
            Expected::Memory => of_kind(&[SymbolKind::Memory]).collect(),
            Expected::Type => ["whisker", "truth", "vector"].into_iter().map(of_type).chain(dimensions()).collect(),
            Expected::Dimension => dimensions().collect(),
            Expected::Unit => units().collect(),
            Expected::Value => self.values(context),
            Expected::Machine => words_of(Place::File).map(of_word).collect(),
            Expected::Only(text) => word(text).map(of_word).into_iter().collect(),
            Expected::Statement(level) => statements(level).collect(),
            Expected::More(level, words) => {
                words.iter().filter_map(|text| word(text)).map(of_word).chain(statements(level)).collect()
            }
        }
    }

    /// The symbols that are known at a place.
    fn known(&self, context: &Context) -> impl Iterator<Item = &Symbol> {
        let at = context.typed.start;
        self.symbols.iter().filter(move |symbol| {
            (symbol.visible.start..=symbol.visible.end).contains(&at)
                && context.statement != Some(symbol.whole.start)
                && !(context.in_transition && symbol.kind == SymbolKind::Local)
        })
    }

    fn values(&self, context: &Context) -> Vec<Candidate> {
        let named = self.known(context).filter(|symbol| symbol.kind.is_value()).map(|symbol| self.symbol(symbol));
        let functions = FUNCTIONS.iter().map(|&(name, _, usage)| Candidate {
            label: name.to_owned(),
            kind: CandidateKind::Function,
            detail: usage.to_owned(),
            meaning: meaning::of_function(name).to_owned(),
            snippet: call_snippet(usage),
        });
        named.chain(words_of(Place::Value).map(of_word)).chain(functions).collect()
    }

    fn symbol(&self, symbol: &Symbol) -> Candidate {
        let detail = symbol.r#type.map_or_else(|| self.head(symbol), |r#type| r#type.to_string());
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

/// What begins a statement in such braces.
fn statements(level: Level) -> impl Iterator<Item = Candidate> {
    let place = match level {
        Level::Outside => Place::Item,
        Level::State => Place::State,
        Level::Block => Place::Statement,
    };
    words_of(place).map(of_word)
}

fn of_word(word: &'static Word) -> Candidate {
    Candidate {
        label: word.text.to_owned(),
        kind: CandidateKind::Word,
        detail: String::new(),
        meaning: word.meaning.to_owned(),
        snippet: word.snippet.to_owned(),
    }
}

fn members(owner: Type) -> impl Iterator<Item = Candidate> {
    builtins::members(owner).iter().map(move |member| {
        let snippet = match member.source {
            MemberSource::TipAt => format!("{}(${{1:deflection}})", member.name),
            _ => member.name.to_owned(),
        };
        Candidate {
            label: member.name.to_owned(),
            kind: CandidateKind::Member,
            detail: member.r#type.to_string(),
            meaning: meaning::of_member(owner, member.name).to_owned(),
            snippet,
        }
    })
}

fn of_type(name: &str) -> Candidate {
    Candidate {
        label: name.to_owned(),
        kind: CandidateKind::Type,
        detail: Type::named(name, None).map(|r#type| r#type.to_string()).unwrap_or_default(),
        meaning: String::new(),
        snippet: name.to_owned(),
    }
}

fn dimensions() -> impl Iterator<Item = Candidate> {
    DIMENSIONS.iter().map(|&(name, _)| of_type(name))
}

fn units() -> impl Iterator<Item = Candidate> {
    WRITTEN.into_iter().flat_map(|dimension| {
        units_of(dimension).into_iter().map(move |unit| {
            // In a policy a unit has no blanks in it.
            let unit = unit.replace(' ', "*");
            Candidate {
                label: unit.clone(),
                kind: CandidateKind::Unit,
                detail: dimension.phrase(),
                meaning: String::new(),
                snippet: unit,
            }
        })
    })
}

/// A call with its values to be filled in: `turn(from, to)` as `turn(${1:from}, ${2:to})`.
fn call_snippet(usage: &str) -> String {
    let Some((name, values)) = usage.split_once('(') else { return usage.to_owned() };
    let values = values.trim_end_matches(')').split(", ").filter(|value| !value.is_empty()).enumerate();
    let values: Vec<String> = values.map(|(index, value)| format!("${{{}:{value}}}", index + 1)).collect();
    format!("{name}({})", values.join(", "))
}
