//! Records and lists: types with several values.
//!
//! A record has its fields in consecutive registers. A list has the number of its elements, and behind it the elements from
//! the newest on. Both are values: no operation changes them, and memory is set as a whole.

use std::collections::{HashMap, HashSet};

use crate::ast::{Argument, Compound, Content, Expression, File, Name, TypeName};
use crate::builtins::LIST_MEMBERS;
use crate::load::Files;
use crate::suggestion::did_you_mean;
use crate::types::{self, Type, Value};
use vibrissa_runtime::machine::{Op, Register};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::call::usage;
use super::scope::Scope;

/// The maximum number of registers of a value.
pub(super) const WIDTH_LIMIT: u16 = 64;
/// The maximum number of elements of a list.
const LENGTH_LIMIT: u16 = 16;

/// The registers of a record or a list.
#[derive(Debug, Clone)]
pub(super) struct Layout<'f> {
    pub(super) name: &'f Name,
    width: u16,
    parts: Parts<'f>,
}

#[derive(Debug, Clone)]
enum Parts<'f> {
    /// The fields.
    Record(Vec<(&'f Name, Type)>),
    /// The type of the elements, and their maximum number.
    List { element: Type, most: u16 },
}

impl Layout<'_> {
    pub(super) fn r#type(&self) -> Type {
        Type::Compound(types::Compound { declared: self.name.span, width: self.width })
    }
}

impl<'f> Compiler<'f> {
    /// Determines the registers of all records and lists.
    pub(super) fn gather_compounds(&mut self, files: &'f Files) {
        let all: Vec<&'f File> = std::iter::once(&files.main).chain(&files.libraries).collect();
        for (number, file) in all.iter().enumerate() {
            for item in &file.compounds {
                self.layout(number, item);
            }
        }
    }

    /// Determines the registers of a type, and before those of its parts. Without recursion, because a chain of types may be as long as
    /// the text.
    fn layout(&mut self, file: usize, item: &'f Compound) {
        let mut is_open = HashSet::from([item.name.span]);
        // The types that wait for their parts, each with its parts that have not been looked at.
        let mut open = vec![(file, item, item.types())];
        if self.layouts.contains_key(&item.name.span) {
            return;
        }
        while let Some((file, item, types)) = open.last_mut() {
            let (file, item) = (*file, *item);
            let Some(part) = types.next() else {
                let layout = self.within(file, |compiler| compiler.layout_of_parts(item));
                self.layouts.insert(item.name.span, layout);
                open.pop();
                continue;
            };
            let part = self.within(file, |compiler| compiler.compound_named(part));
            let part = part.filter(|(_, part)| !self.layouts.contains_key(&part.name.span));
            if let Some((file, part)) = part
                && is_open.insert(part.name.span)
            {
                open.push((file, part, part.types()));
            }
        }
    }

    /// The record or list with a name in the current file, and the number of its file.
    fn compound_named(&self, name: &TypeName) -> Option<(usize, &'f Compound)> {
        let is_plain = name.of.is_none() && name.factors.is_empty();
        self.names().compounds.get(name.base.text.as_str()).copied().filter(|_| is_plain)
    }

    /// True if a name means a record or a list with an error, which has been reported.
    pub(super) fn has_no_layout(&self, name: &TypeName) -> bool {
        self.compound_named(name).is_some_and(|(_, item)| matches!(self.layouts.get(&item.name.span), Some(None)))
    }

    /// The layout of a type, if its parts have one and it is not too large.
    fn layout_of_parts(&mut self, item: &'f Compound) -> Option<Layout<'f>> {
        let parts = match &item.content {
            Content::Record(fields) => {
                let mut known: HashMap<&'f str, Span> = HashMap::with_capacity(fields.len());
                let mut parts: Vec<Option<(&'f Name, Type)>> = Vec::with_capacity(fields.len());
                for field in fields {
                    if let Some(&first) = known.get(field.name.text.as_str()) {
                        let message = format!("`{}` has the field `{}` twice", item.name.text, field.name.text);
                        let diagnostic = Diagnostic::error("P0202", message, field.name.span, "again here");
                        self.report(diagnostic.note(first, "first here").hint("keep one of them"));
                    }
                    known.entry(&field.name.text).or_insert(field.name.span);
                    let r#type = self.part_type(&field.type_name);
                    if let (Some(r#type), Some(types)) = (r#type, &mut self.types) {
                        types.insert(field.name.span, r#type);
                    }
                    parts.push(r#type.map(|r#type| (&field.name, r#type)));
                }
                Parts::Record(parts.into_iter().collect::<Option<_>>()?)
            }
            Content::List { most, element } => {
                let element = self.part_type(element);
                if let (Some(element), Some(types)) = (element, &mut self.types) {
                    types.insert(item.name.span, element);
                }
                let most = self.most(most);
                Parts::List { element: element?, most: most? }
            }
        };
        // No part is wider than the limit, and no text has so many parts that the sum is too large.
        let width: usize = match &parts {
            Parts::Record(fields) => fields.iter().map(|(_, r#type)| usize::from(r#type.width())).sum(),
            Parts::List { element, most } => 1 + usize::from(*most) * usize::from(element.width()),
        };
        let fitting = u16::try_from(width).ok().filter(|width| *width <= WIDTH_LIMIT);
        let Some(width) = fitting else {
            let message = format!("`{}` has {width} numbers", item.name.text);
            let diagnostic = Diagnostic::error("P0417", message, item.name.span, "exceeds the limit");
            self.report(diagnostic.hint(format!(
                "a record or a list has at most {WIDTH_LIMIT}; a vector is two, and a list has one more"
            )));
            return None;
        };
        Some(Layout { name: &item.name, width, parts })
    }

    /// The type of a field or an element. `None` if it has an error, which has been reported.
    fn part_type(&mut self, name: &TypeName) -> Option<Type> {
        if let Some((_, part)) = self.compound_named(name) {
            let Some(layout) = self.layouts.get(&part.name.span) else {
                // It waits for this one.
                let message = format!("`{}` contains itself", part.name.text);
                let diagnostic = Diagnostic::error("P0401", message, part.name.span, "has no finite size");
                self.report(diagnostic.hint("a record or a list can only contain other types"));
                return None;
            };
            return layout.as_ref().map(Layout::r#type);
        }
        let found = self.type_of(name);
        if let Some(Type::Monitor(_)) = found {
            let message = "a monitor cannot be a part of a record or a list";
            let diagnostic = Diagnostic::error("P0204", message, name.base.span, "is a monitor");
            self.report(diagnostic.hint("give it to laws, behaviours and monitors as an argument of its own"));
            return None;
        }
        found
    }

    /// The maximum number of elements of a list.
    fn most(&mut self, given: &Name) -> Option<u16> {
        let most = given.text.parse().ok().filter(|most| (1..=LENGTH_LIMIT).contains(most));
        if most.is_none() {
            let message = format!("a list has from 1 to {LENGTH_LIMIT} elements");
            let diagnostic = Diagnostic::error("P0417", message, given.span, "not possible");
            self.report(diagnostic.hint("write a whole number in this range"));
        }
        most
    }

    /// Lowers `Edge(place, way)`, or an empty list, `Places()`.
    pub(super) fn compound_value(
        &mut self,
        scope: &Scope<'f>,
        (file, item): (usize, &'f Compound),
        values: Option<&'f [Expression]>,
        span: Span,
    ) -> Option<Value> {
        let fields: &'f [Argument] = match &item.content {
            Content::Record(fields) => fields,
            Content::List { .. } => &[],
        };
        let Some(values) = values else {
            let message = format!("`{}` is a type", item.name.text);
            let diagnostic = Diagnostic::error("P0301", message, span, "not a value");
            let hint = match &item.content {
                Content::Record(fields) => format!("write `{}`", usage(&item.name.text, fields)),
                Content::List { .. } => format!("`{}()` is an empty list", item.name.text),
            };
            self.report(diagnostic.note(item.name.span, "declared here").hint(hint));
            return None;
        };
        if fields.is_empty() && !values.is_empty() {
            let message = format!("`{}()` takes no values", item.name.text);
            let diagnostic = Diagnostic::error("P0304", message, span, "has values");
            self.report(
                diagnostic.hint(format!("it is an empty list; `{}().with(value)` has one element", item.name.text)),
            );
            return None;
        }
        let inner = self.arguments(scope, file, &item.name, fields, values, span)?;
        let layout = self.known_layout(item.name.span)?.clone();
        let to = self.code.allocate(layout.width);
        match layout.parts {
            Parts::Record(fields) => {
                let mut at = to;
                for (name, _) in fields {
                    let value = inner.get(&name.text).flatten()?;
                    self.code.copy(at, value.register, value.r#type.width());
                    at += value.r#type.width();
                }
            }
            Parts::List { element, most } => {
                let zero = self.code.constant(0.0);
                self.code.push(Op::Copy { to, a: zero });
                let unknown = self.unknown(element);
                for place in 0..most {
                    for (part, &a) in (0..).zip(&unknown) {
                        let width = element.width();
                        self.code.push(Op::Copy { to: to + 1 + place * width + part, a });
                    }
                }
            }
        }
        Some(Value { r#type: self.known_layout(item.name.span)?.r#type(), register: to })
    }

    /// The registers of an element that a list does not have: numbers are NaN, and everything else is 0.
    fn unknown(&mut self, element: Type) -> Vec<Register> {
        let zero = self.code.constant(0.0);
        let is_number = |r#type: Type| matches!(r#type, Type::Scalar(_)) || r#type.components().is_some();
        let mut parts = vec![(String::new(), Value { r#type: element, register: 0 })];
        parts = self.parts(parts);
        let mut registers = Vec::new();
        for (_, part) in parts {
            let register =
                if is_number(part.r#type) { self.code.scalar(|to| Op::Divide { to, a: zero, b: zero }) } else { zero };
            registers.extend(std::iter::repeat_n(register, usize::from(part.r#type.width())));
        }
        // Lists within an element have more registers than named parts.
        registers.resize(usize::from(element.width()), zero);
        registers
    }

    /// Lowers a member of a record or a list.
    pub(super) fn compound_member(
        &mut self,
        scope: &Scope<'f>,
        owner: Value,
        declared: Span,
        name: &'f Name,
        values: Option<&'f [Expression]>,
    ) -> Option<Value> {
        let layout = self.known_layout(declared)?.clone();
        match layout.parts {
            Parts::Record(fields) => {
                if values.is_some() {
                    self.report_call(format!("`{}` takes no values", name.text), name.span);
                    return None;
                }
                let mut register = owner.register;
                for (field, r#type) in &fields {
                    if field.text == name.text {
                        return Some(Value { r#type: *r#type, register });
                    }
                    register += r#type.width();
                }
                let known: Vec<&str> = fields.iter().map(|(field, _)| field.text.as_str()).collect();
                self.no_member(layout.name, name, &known);
                None
            }
            Parts::List { element, most } => self.list_member(scope, owner, (layout.name, element, most), name, values),
        }
    }

    fn no_member(&mut self, of: &Name, name: &Name, known: &[&str]) {
        if self.is_told("P0203", name.span) {
            return;
        }
        let message = format!("a `{}` has no `{}`", of.text, name.text);
        let diagnostic = Diagnostic::error("P0203", message, name.span, "unknown member");
        let diagnostic = did_you_mean(diagnostic, &name.text, known.iter().copied());
        self.report(diagnostic.note(of.span, "declared here").hint(format!("it has {}", known.join(", "))));
    }

    fn list_member(
        &mut self,
        scope: &Scope<'f>,
        list: Value,
        (of, element, most): (&'f Name, Type, u16),
        name: &'f Name,
        values: Option<&'f [Expression]>,
    ) -> Option<Value> {
        let (count, first, width) = (list.register, list.register + 1, element.width());
        let takes = match name.text.as_str() {
            "count" | "newest" | "oldest" => None,
            "element" => Some((Type::NUMBER, "index")),
            "with" => Some((element, "value")),
            "nearest" if element == Type::Position => Some((Type::Position, "position")),
            _ => {
                let has = |&member: &&str| member != "nearest" || element == Type::Position;
                let known: Vec<&str> = LIST_MEMBERS.iter().map(|&(member, ..)| member).filter(has).collect();
                self.no_member(of, name, &known);
                return None;
            }
        };
        let given = match (takes, values) {
            (None, None) => 0,
            (None, Some(_)) => {
                self.report_call(format!("`{}` takes no values", name.text), name.span);
                return None;
            }
            (Some((wanted, _)), Some([value])) => self.expect(scope, value, wanted)?.register,
            (Some((_, what)), _) => {
                let message = format!("`{}` needs one value, the {what}", name.text);
                let diagnostic = Diagnostic::error("P0304", message, name.span, format!("which {what}?"));
                self.report(diagnostic.hint(format!("write `{}({what})`", name.text)));
                return None;
            }
        };
        let at = |place: u16| first + place * width;
        let register = match name.text.as_str() {
            "count" => return Some(Value { r#type: Type::NUMBER, register: count }),
            "newest" => first,
            "oldest" => {
                let one = self.code.constant(1.0);
                let last = self.code.scalar(|to| Op::Subtract { to, a: count, b: one });
                self.element(list, (element, most), last)
            }
            "element" => self.element(list, (element, most), given),
            "nearest" => {
                let mut nearest = self.copied(Value { r#type: element, register: first }).register;
                let mut least = self.code.scalar(|to| Op::Distance { to, a: first, b: given });
                for place in 1..most {
                    let distance = self.code.scalar(|to| Op::Distance { to, a: at(place), b: given });
                    // An element that the list does not have is at no distance.
                    let is_nearer = self.code.scalar(|to| Op::Less { to, a: distance, b: least });
                    least = self.code.scalar(|to| Op::Select { to, condition: is_nearer, a: distance, b: least });
                    nearest = self.select_all(is_nearer, at(place), nearest, width);
                }
                nearest
            }
            _ => {
                let to = self.code.allocate(list.r#type.width());
                let (one, limit) = (self.code.constant(1.0), self.code.constant(f64::from(most)));
                let more = self.code.scalar(|to| Op::Add { to, a: count, b: one });
                self.code.push(Op::Minimum { to, a: more, b: limit });
                self.code.copy(to + 1, given, width);
                self.code.copy(to + 1 + width, first, (most - 1) * width);
                return Some(Value { r#type: list.r#type, register: to });
            }
        };
        Some(Value { r#type: element, register })
    }

    /// The element with an index, which counts from 0 for the newest. Unknown if the list does not have it.
    fn element(&mut self, list: Value, (element, most): (Type, u16), index: Register) -> Register {
        let (first, width) = (list.register + 1, element.width());
        let unknown = self.unknown(element);
        let mut found = self.code.allocate(width);
        for (to, &a) in (found..).zip(&unknown) {
            self.code.push(Op::Copy { to, a });
        }
        for place in 0..most {
            let number = self.code.constant(f64::from(place));
            let is_it = self.code.scalar(|to| Op::Equal { to, a: index, b: number });
            found = self.select_all(is_it, first + place * width, found, width);
        }
        found
    }

    fn select_all(&mut self, condition: Register, a: Register, b: Register, width: u16) -> Register {
        let to = self.code.allocate(width);
        for part in 0..width {
            self.code.push(Op::Select { to: to + part, condition, a: a + part, b: b + part });
        }
        to
    }

    /// The layout of the type with this declaration.
    pub(super) fn known_layout(&self, declared: Span) -> Option<&Layout<'f>> {
        self.layouts.get(&declared)?.as_ref()
    }

    /// The values with names, with the parts of records and lists instead of these: `edge.place`, `seen.count`, `seen.newest`.
    pub(super) fn parts(&self, values: Vec<(String, Value)>) -> Vec<(String, Value)> {
        let mut parts = Vec::with_capacity(values.len());
        for (mut name, value) in values {
            // The parts that are left, the last one first: each with its name and the length of the name that precedes it.
            let mut open = vec![(0, "", value)];
            if !matches!(value.r#type, Type::Compound(_)) {
                parts.push((name, value));
                continue;
            }
            let whole = name.len();
            while let Some((len, own, value)) = open.pop() {
                name.truncate(whole + len);
                if !name.is_empty() && !own.is_empty() {
                    name.push('.');
                }
                name.push_str(own);
                let Type::Compound(of) = value.r#type else {
                    parts.push((name.clone(), value));
                    continue;
                };
                let Some(layout) = self.known_layout(of.declared) else { continue };
                let (len, first, mut register) = (name.len() - whole, open.len(), value.register);
                match &layout.parts {
                    Parts::Record(fields) => {
                        for (field, r#type) in fields {
                            open.push((len, field.text.as_str(), Value { r#type: *r#type, register }));
                            register += r#type.width();
                        }
                    }
                    Parts::List { element, .. } => {
                        open.push((len, "count", Value { r#type: Type::NUMBER, register }));
                        open.push((len, "newest", Value { r#type: *element, register: register + 1 }));
                    }
                }
                open[first..].reverse();
            }
        }
        parts
    }
}
