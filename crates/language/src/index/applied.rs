//! Uses of behaviours by states, and of monitors by other monitors.

use std::collections::HashMap;

use super::declare::behaviour_around;
use super::symbol::{Meaning, Role, Symbol, SymbolKind};

/// The uses of behaviours and monitors before a position that moves through the text.
#[derive(Debug, Default)]
pub(super) struct Applied {
    /// The state or the monitor that was declared last.
    declared: Option<usize>,
    /// What it uses.
    used: Option<usize>,
    /// For each pair of open braces, what the state before them uses.
    frames: Vec<Option<usize>>,
}

impl Applied {
    /// Reads a token with its meaning. `is_used` is true after `is`. Adds uses to `all`: by the index of the state or the
    /// monitor, that of the behaviour or of the other monitor.
    pub(super) fn read(
        &mut self,
        (text, is_used): (&str, bool),
        meaning: Option<Meaning>,
        symbols: &[Symbol],
        all: &mut HashMap<usize, usize>,
    ) {
        match (text, meaning) {
            ("{", _) => self.frames.push(self.used.take()),
            ("}", _) => {
                self.frames.pop();
            }
            (_, Some(Meaning::Symbol(symbol, Role::Declares))) if has_content(&symbols[symbol]) => {
                (self.declared, self.used) = (Some(symbol), None);
            }
            (_, Some(Meaning::Symbol(symbol, _))) if is_used && is_content(&symbols[symbol]) => {
                self.used = Some(symbol);
                all.extend(self.declared.map(|declared| (declared, symbol)));
            }
            _ => {}
        }
    }

    /// The exit with a name of the behaviour that the state around the position uses.
    pub(super) fn exit(&self, symbols: &[Symbol], name: &str) -> Option<Meaning> {
        let behaviour = self.frames.last().copied().flatten()?;
        inside(symbols, behaviour, SymbolKind::Exit, name).map(|exit| Meaning::Symbol(exit, Role::Reads))
    }
}

/// True if a symbol may use a behaviour or another monitor.
fn has_content(symbol: &Symbol) -> bool {
    matches!(symbol.kind, SymbolKind::State | SymbolKind::Monitor)
}

/// True if a symbol may be used by `is`.
fn is_content(symbol: &Symbol) -> bool {
    matches!(symbol.kind, SymbolKind::Behaviour | SymbolKind::Monitor)
}

/// The state with a name in the behaviour that the state `outer` uses, or the memory or the event of a monitor. `None` for a
/// state that uses no behaviour.
pub(super) fn inner(symbols: &[Symbol], all: &HashMap<usize, usize>, outer: usize, name: &str) -> Option<usize> {
    let used = all.get(&outer).copied();
    if symbols[outer].kind == SymbolKind::State {
        return inside(symbols, used?, SymbolKind::State, name);
    }
    let content = used.unwrap_or(outer);
    symbols.iter().position(|symbol| is_part(symbol, content) && symbol.name == name)
}

/// True if a symbol is the memory or an event of a monitor.
pub(super) fn is_part(symbol: &Symbol, monitor: usize) -> bool {
    matches!(symbol.kind, SymbolKind::Memory | SymbolKind::Event) && symbol.owner == Some(monitor)
}

/// The symbol of a kind and a name in a behaviour.
fn inside(symbols: &[Symbol], behaviour: usize, kind: SymbolKind, name: &str) -> Option<usize> {
    let is_meant = |&index: &usize| {
        let symbol = &symbols[index];
        symbol.kind == kind && symbol.name == name && behaviour_around(symbols, index) == Some(behaviour)
    };
    (behaviour..symbols.len()).find(is_meant)
}
