//! Unused names.

use crate::ast::{Argument, Name};
use crate::load::Files;
use vibrissa_text::diagnostic::Diagnostic;

use super::names::Names;

/// Warns about parameters, whiskers, laws, derived values, arguments and imports that nothing uses. Laws and derived
/// values of a library are exports, so they are never unused.
pub(super) fn unused<'f>(files: &'f Files, warnings: &mut Vec<Diagnostic>) {
    let file = &files.main;
    let (mut used, mut used_by_defaults, mut unread) = (Names::default(), Names::default(), Vec::new());
    let mut part = |names: &mut Names<'f>, arguments: &'f [Argument], of: &str| {
        let defaults = Names::of(|names| names.defaults(arguments));
        names.give(arguments.iter().map(|argument| &argument.name));
        for argument in arguments.iter().filter(|argument| !names.has(&argument.name.text)) {
            let hint = format!("use it, or remove it here and wherever `{of}` is used");
            warnings.push(never_used("P0507", "argument", &argument.name, hint));
        }
        used_by_defaults.extend(&defaults);
        used_by_defaults.types(arguments);
    };
    for derived in &file.derived {
        let mut names = Names::of(|names| names.expression(&derived.value));
        part(&mut names, &derived.arguments, &derived.name.text);
        used.extend(&names);
    }
    for law in &file.laws {
        let mut names = Names::of(|names| names.statements(&law.body));
        part(&mut names, &law.arguments, &law.name.text);
        used.extend(&names);
    }
    for monitor in &file.monitors {
        let mut names = Names::of(|names| {
            if let Some(step) = &monitor.used {
                names.step(step);
            }
            monitor.memory.iter().for_each(|(_, value)| names.expression(value));
            names.statements(&monitor.body);
        });
        for event in &monitor.events {
            let mut of_event = Names::of(|names| names.statements(&event.body));
            part(&mut of_event, &event.arguments, &event.name.text);
            names.extend(&of_event);
        }
        part(&mut names, &monitor.arguments, &monitor.name.text);
        // Others read the memory.
        names.give(monitor.memory.iter().map(|(name, _)| name));
        used.extend(&names);
    }
    let behaviours = file.behaviours.iter().map(|behaviour| behaviour.states.as_slice());
    for states in behaviours.chain([file.states.as_slice()]) {
        let mut of_states: Vec<Names<'f>> = states.iter().map(|state| Names::of(|names| names.state(state))).collect();
        // Inner states know the names of a state. They follow it.
        while let (Some(mut names), Some(state)) = (of_states.pop(), states.get(of_states.len())) {
            part(&mut names, &state.arguments, &state.name.text);
            names.give(state.memory.iter().map(|(name, _)| name));
            let idle = state.memory.iter().filter(|(name, _)| !names.has(&name.text)).map(|(name, _)| name);
            unread.extend(idle);
            match state.parent {
                Some(parent) => of_states[parent].extend(&names),
                None => used.extend(&names),
            }
        }
    }
    used.extend(&used_by_defaults);
    file.compounds.iter().for_each(|item| used.compound(item));
    file.memory.iter().for_each(|(_, value)| used.expression(value));
    used.statements(&file.body);
    used.transitions(&file.always);
    used.targets(&file.failsafes);
    used.contracts(&file.contracts);
    unread.extend(file.memory.iter().map(|(name, _)| name).filter(|name| !used.has(&name.text)));
    file.tests.iter().for_each(|test| used.expressions(&test.expectations));
    for name in unread {
        warnings.push(never_used(
            "P0507",
            "memory",
            name,
            "read it somewhere, or remove it and the statements that set it",
        ));
    }

    unused_imports(files, &used, warnings);
    if file.is_library() {
        return;
    }
    let parameters = file.parameters.iter().map(|parameter| ("P0504", "parameter", &parameter.name));
    let whiskers = file.whiskers.iter().map(|whisker| ("P0505", "whisker", whisker));
    let contours = file.contours.iter().map(|contour| ("P0505", "contour", &contour.name));
    let laws = file.laws.iter().map(|law| ("P0506", "law", &law.name));
    let enumerations = file.enumerations.iter().map(|item| ("P0506", "type", &item.name));
    let compounds = file.compounds.iter().map(|item| ("P0506", "type", &item.name));
    let derived = file.derived.iter().map(|derived| ("P0506", "derived value", &derived.name));
    let behaviours = file.behaviours.iter().map(|behaviour| ("P0506", "behaviour", &behaviour.name));
    let monitors = file.monitors.iter().map(|monitor| ("P0506", "monitor", &monitor.name));
    for (code, kind, name) in parameters
        .chain(whiskers)
        .chain(contours)
        .chain(laws)
        .chain(derived)
        .chain(behaviours)
        .chain(monitors)
        .chain(enumerations)
        .chain(compounds)
    {
        if !used.has(&name.text) {
            warnings.push(never_used(code, kind, name, "use it or leave it out"));
        }
    }
}

fn never_used(code: &'static str, kind: &str, name: &Name, hint: impl Into<String>) -> Diagnostic {
    let message = format!("the {kind} `{}` is never used", name.text);
    Diagnostic::warning(code, message, name.span, "never used").hint(hint)
}

/// Warns about imports that nothing uses.
fn unused_imports(files: &Files, used: &Names<'_>, warnings: &mut Vec<Diagnostic>) {
    let file = &files.main;
    for (import, &library) in file.uses.iter().zip(files.links.first().into_iter().flatten()) {
        let Some(library) = files.libraries.get(library) else { continue };
        let mut own = library.exports();
        match &import.names {
            Some(names) => {
                let idle = names.iter().filter(|name| !used.has(&name.text));
                warnings.extend(idle.map(|name| never_used("P0506", "name", name, "leave it out of the list")));
            }
            None if own.any(|name| used.has(&name.text)) => {}
            None => {
                let message = format!("the library `{}` is never used", library.name.text);
                let warning = Diagnostic::warning("P0506", message, import.span, "never used");
                warnings.push(warning.hint("use it, or remove this line"));
            }
        }
    }
}
