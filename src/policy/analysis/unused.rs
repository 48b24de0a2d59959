//! Names that are given and never used.

use crate::diagnostic::Diagnostic;
use crate::policy::ast::{Argument, File, Name};

use super::names::Names;

/// Warns of parameters, whiskers, laws, derived values and arguments that nothing uses.
pub(super) fn unused(file: &File, warnings: &mut Vec<Diagnostic>) {
    let (mut used, mut unread) = (Names::default(), Vec::new());
    let mut part = |names: &Names<'_>, arguments: &[Argument], of: &str| {
        for argument in arguments.iter().filter(|argument| !names.has(&argument.name.text)) {
            let hint = format!("use it, or leave it out here and wherever `{of}` is given its values");
            warnings.push(never_used("P0507", "argument", &argument.name, hint));
        }
    };
    for derived in &file.derived {
        let names = Names::of(|names| names.expression(&derived.value));
        part(&names, &derived.arguments, &derived.name.text);
        used.extend(names);
    }
    for law in &file.laws {
        let names = Names::of(|names| names.statements(&law.body));
        part(&names, &law.arguments, &law.name.text);
        used.extend(names);
    }
    for state in &file.states {
        let names = Names::of(|names| {
            state.memory.iter().for_each(|(_, value)| names.expression(value));
            for statements in [&state.entry, &state.body, &state.exit] {
                names.statements(statements);
            }
            names.transitions(&state.transitions);
            names.targets(&state.failsafes);
        });
        part(&names, &state.arguments, &state.name.text);
        let idle = state.memory.iter().filter(|(name, _)| !names.has(&name.text)).map(|(name, _)| name);
        unread.extend(idle);
        used.extend(names);
    }
    used.transitions(&file.always);
    used.targets(&file.failsafes);
    for name in unread {
        warnings.push(never_used("P0507", "memory", name, "read it somewhere, or leave it out with what sets it"));
    }

    let parameters = file.parameters.iter().map(|parameter| ("P0504", "parameter", &parameter.name));
    let whiskers = file.whiskers.iter().map(|whisker| ("P0505", "whisker", whisker));
    let laws = file.laws.iter().map(|law| ("P0506", "law", &law.name));
    let derived = file.derived.iter().map(|derived| ("P0506", "derived value", &derived.name));
    for (code, kind, name) in parameters.chain(whiskers).chain(laws).chain(derived) {
        if !used.has(&name.text) {
            warnings.push(never_used(code, kind, name, "use it or leave it out"));
        }
    }
}

fn never_used(code: &'static str, kind: &str, name: &Name, hint: impl Into<String>) -> Diagnostic {
    let message = format!("the {kind} `{}` is never used", name.text);
    Diagnostic::warning(code, message, name.span, "never used").hint(hint)
}
