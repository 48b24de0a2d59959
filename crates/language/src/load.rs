//! A policy with all files that it uses.

use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

use super::ast::{File, FileKind, Use};
use super::expand::{self, Behaviours, Expanded};
use super::path::{is_same, resolve, standard};
use super::recover::{Recovery, parse_all};

/// The maximum number of files of a policy.
pub(super) const FILE_LIMIT: usize = 64;
/// The maximum size of all files together (bytes).
const TEXT_LIMIT: usize = 1 << 20;

/// Returns the text of a file by its path, or the reason for which it cannot be read.
pub type Library<'l> = dyn FnMut(&str) -> Result<String, String> + 'l;

/// The parsed files of a policy.
pub(super) struct Loaded {
    /// All texts.
    pub(super) source: Source,
    /// The syntax trees, that of the policy first. `None` for a file that cannot be parsed.
    files: Vec<Option<File>>,
    /// For every `use` of every file, the index of the used file.
    links: Vec<Vec<Option<usize>>>,
    recovery: Recovery,
}

/// Consistent files: all used files exist and are libraries, and none uses itself.
pub(super) struct Files {
    /// The requested policy or library. For a test file, the machine with the tests of that file.
    pub(super) main: File,
    /// The files that it uses directly or indirectly.
    pub(super) libraries: Vec<File>,
    /// For every `use` of every file, the index of the used library.
    pub(super) links: Vec<Vec<usize>>,
    /// The states of the policy, with copies of the behaviours that they use.
    pub(super) machine: Expanded,
    /// For every file, its behaviours alone. The policy comes first. Those of the standard library are left out.
    pub(super) behaviours: Vec<Vec<Expanded>>,
}

impl Files {
    /// The files, with the behaviours expanded.
    fn new(main: File, libraries: Vec<File>, links: Vec<Vec<usize>>) -> Self {
        let all: Vec<&File> = std::iter::once(&main).chain(&libraries).collect();
        let known = Behaviours::new(&all, &links);
        let machine = expand::machine(&known);
        // Tests ensure that the standard library has no errors.
        let is_checked = |number: usize| number == 0 || !all[number].is_standard;
        let mut copied = 0;
        let behaviours = (0..all.len())
            .map(|number| if is_checked(number) { expand::alone(&known, number, &mut copied) } else { Vec::new() })
            .collect();
        Self { main, libraries, links, machine, behaviours }
    }
}

/// Parses a policy and the files that it uses. Files that are not parts of the source come from `library`.
pub(super) fn load(source: &Source, library: &mut Library<'_>) -> Loaded {
    let mut loaded =
        Loaded { source: source.clone(), files: Vec::new(), links: Vec::new(), recovery: Recovery::default() };
    while loaded.files.len() < loaded.source.count() {
        let index = loaded.files.len();
        let span = loaded.source.part_span(index);
        let part = Source::new(loaded.source.part_name(index), loaded.source.slice(span));
        let file = match loaded.source.absence(index) {
            None => parse_all(&part, span.start, &mut loaded.recovery),
            Some(_) => None,
        };
        let uses = file.iter().flat_map(|file| &file.uses);
        let links = uses.map(|used| loaded.link(&part.name, used, library)).collect();
        loaded.links.push(links);
        loaded.files.push(file);
    }
    loaded
}

/// A source with the standard modules that lines of its texts name.
pub(super) fn modules(source: &Source) -> Source {
    let mut whole = source.clone();
    let mut part = 0;
    while part < whole.count() {
        let text = whole.slice(whole.part_span(part)).to_owned();
        let used = text.lines().filter_map(|line| line.strip_prefix("use ")?.split([' ', '(']).next());
        for name in used {
            let is_new = (1..whole.count()).all(|part| whole.part_name(part) != name);
            if let Some(text) = standard(name).filter(|_| is_new) {
                whole.add(name, Ok(text));
            }
        }
        part += 1;
    }
    whole
}

/// The text of the file `name`, if the policy does not exceed its limits with it.
pub(super) fn text_of(source: &Source, name: &str, library: &mut Library<'_>) -> Result<String, String> {
    let text = standard(name).map_or_else(|| library(name), |text| Ok(text.to_owned()))?;
    let fits = source.text.len() + text.len() < TEXT_LIMIT;
    if fits { Ok(text) } else { Err("with this file, the policy has more than 1 MiB of text".to_owned()) }
}

impl Loaded {
    fn report(&mut self, fault: Diagnostic) {
        self.recovery.report(fault);
    }

    /// The index of the file that `used` means in the file `using`.
    fn link(&mut self, using: &str, used: &Use, library: &mut Library<'_>) -> Option<usize> {
        let name = resolve(using, used).map_err(|fault| self.report(*fault)).ok()?;
        let known = (0..self.source.count()).find(|&index| match index {
            0 => is_same(self.source.part_name(0), &name),
            _ => self.source.part_name(index) == name,
        });
        let index = known.or_else(|| {
            if self.source.count() >= FILE_LIMIT {
                let message = format!("the policy consists of more than {FILE_LIMIT} files");
                self.report(
                    Diagnostic::error("P0602", message, used.span, "one too many").hint("combine some of them"),
                );
                return None;
            }
            let text = text_of(&self.source, &name, library);
            self.source.add(&name, text.as_deref().map_err(Clone::clone));
            Some(self.source.count() - 1)
        })?;
        if let Some(reason) = self.source.absence(index) {
            let message = format!("cannot use `{name}`");
            let fault = Diagnostic::error("P0602", message, used.span, reason);
            self.report(fault.hint("a path is relative to the folder of the file that contains it"));
            return None;
        }
        Some(index)
    }

    /// True if the first file is a library, as far as it can be parsed.
    pub(super) fn is_library(&self) -> bool {
        self.files.first().into_iter().flatten().any(File::is_library)
    }

    /// True if the first file has tests of another file, as far as it can be parsed.
    pub(super) fn is_test_file(&self) -> bool {
        self.files.first().into_iter().flatten().any(|file| file.kind == FileKind::Tests)
    }

    /// True if the first file has no syntax errors.
    pub(super) fn is_read(&self) -> bool {
        !self.recovery.has_syntax_fault(self.source.part_span(0))
    }

    /// For every file, the `use` in the first file that leads to it, directly or indirectly. `None` for the first file.
    pub(super) fn root_uses(&self) -> Vec<Option<Span>> {
        let mut root_uses = vec![None; self.files.len()];
        let uses = self.files.first().into_iter().flatten().flat_map(|file| &file.uses);
        let links = self.links.first().into_iter().flatten().copied().zip(uses.map(|used| used.span));
        // A breadth-first search, so that direct uses precede indirect ones.
        let mut found: Vec<(usize, Span)> = links.filter_map(|(link, root_use)| Some((link?, root_use))).collect();
        let mut next = 0;
        while let Some(&(file, root_use)) = found.get(next) {
            next += 1;
            if file > 0 && root_uses.get(file) == Some(&None) {
                root_uses[file] = Some(root_use);
                found.extend(self.links.get(file).into_iter().flatten().flatten().map(|&link| (link, root_use)));
            }
        }
        root_uses
    }

    /// All texts, and the files. The first file alone if they are inconsistent.
    pub(super) fn known(self) -> (Source, Option<Files>) {
        let first = self.files.first().cloned().flatten();
        let (source, files, _) = self.files();
        let alone = || Some(Files::new(first?, Vec::new(), Vec::new()));
        (source, files.or_else(alone))
    }

    /// All texts, the files if they are consistent, and the omitted parts.
    pub(super) fn files(mut self) -> (Source, Option<Files>, Recovery) {
        let mut misfits = Vec::new();
        let uses: Vec<Vec<Use>> =
            self.files.iter().map(|file| file.as_ref().map_or_else(Vec::new, |file| file.uses.clone())).collect();
        for (number, (uses, links)) in uses.iter().zip(&self.links).enumerate() {
            let mut pairs = uses.iter().zip(links).filter_map(|(used, link)| Some((used, (*link)?)));
            if self.files.get(number).into_iter().flatten().any(|file| file.kind == FileKind::Tests) {
                misfits.extend(pairs.next().and_then(|(used, link)| self.unfit(used, link, FileKind::Machine)));
            }
            misfits.extend(pairs.filter_map(|(used, link)| self.unfit(used, link, FileKind::Library)));
        }
        misfits.extend(self.cycle(&uses));
        misfits.extend(self.files.iter().flatten().filter_map(misplaced));
        let fit = misfits.is_empty();
        for fault in misfits {
            self.recovery.report(fault);
        }
        if fit {
            self.put_machine_first();
        }
        let links: Option<Vec<Vec<usize>>> = self
            .links
            .iter()
            .map(|links| links.iter().map(|link| link.and_then(|index| index.checked_sub(1))).collect())
            .collect();
        let files: Option<Vec<File>> = self.files.into_iter().collect();
        let files = match (files, links) {
            (Some(mut files), Some(links)) if fit && !files.is_empty() => {
                let main = files.remove(0);
                Some(Files::new(main, files, links))
            }
            _ => None,
        };
        (self.source, files, self.recovery)
    }

    /// The diagnostic for a file of a kind that the text at `used` cannot name. `needed` is the kind that it can.
    fn unfit(&self, used: &Use, index: usize, needed: FileKind) -> Option<Diagnostic> {
        let file = self.files.get(index).filter(|_| index > 0)?.as_ref()?;
        if file.kind == needed {
            return None;
        }
        let (cannot, hint) = match needed {
            FileKind::Machine => {
                ("tested", "name a file that begins with `machine`; a behaviour is tested in a machine that uses it")
            }
            FileKind::Library | FileKind::Tests => {
                ("used", "move the shared laws into a file that begins with `library` and a name")
            }
        };
        let message = format!("`{}` is {}, not {}", self.source.part_name(index), file.kind.phrase(), needed.phrase());
        let fault = Diagnostic::error("P0603", message, used.span, format!("cannot be {cannot}"));
        Some(fault.note(file.name.span, file.kind.phrase()).hint(hint))
    }

    /// Gives the machine of a test file the place of that file, and its tests.
    fn put_machine_first(&mut self) {
        let Some(&Some(machine)) = self.links.first().and_then(|links| links.first()) else { return };
        let Some((Some(first), others)) = self.files.split_first_mut() else { return };
        let (FileKind::Tests, Some(Some(tested))) = (first.kind, others.get_mut(machine - 1)) else { return };
        tested.tests = std::mem::take(&mut first.tests);
        first.uses.clear();
        self.links.first_mut().into_iter().for_each(Vec::clear);
        self.files.swap(0, machine);
        self.links.swap(0, machine);
        for link in self.links.iter_mut().flatten().flatten() {
            if *link == 0 {
                *link = machine;
            }
        }
    }

    /// The first path from a file through others back to itself.
    fn cycle(&self, uses: &[Vec<Use>]) -> Option<Diagnostic> {
        let mut is_done = vec![false; self.files.len()];
        // The path from the first file to the current one: files, each with the number of its uses that were followed.
        let mut path = vec![(0, 0)];
        while let Some((file, followed)) = path.last_mut() {
            let (file, next) = (*file, *followed);
            *followed += 1;
            let Some(link) = self.links.get(file)?.get(next) else {
                is_done[file] = true;
                path.pop();
                continue;
            };
            let Some(used) = *link else { continue };
            if let Some(first) = path.iter().position(|&(file, _)| file == used) {
                let names = path[first..].iter().map(|&(file, _)| file).chain([used]);
                let names: Vec<String> = names.map(|file| format!("`{}`", self.source.part_name(file))).collect();
                let message = format!("a file uses itself: {}", names.join(" uses "));
                let span = uses.get(file)?.get(next)?.span;
                return Some(
                    Diagnostic::error("P0604", message, span, "leads back")
                        .hint("move the shared laws into a third file, and use it in both"),
                );
            }
            if !is_done[used] {
                path.push((used, 0));
            }
        }
        None
    }
}

/// The diagnostic for an item that is not allowed in a library or a test file.
fn misplaced(file: &File) -> Option<Diagnostic> {
    let tests = file.tests.iter().map(|test| test.title.span);
    let (first, message, label, note, hint) = match file.kind {
        FileKind::Machine => return None,
        FileKind::Library => (
            items_of_machines(file).chain(tests).min_by_key(|span| span.start)?,
            "a library has only laws, derived values, types, behaviours and monitors with braces",
            "belongs to a machine",
            "a library",
            "pass values to a law or a behaviour as arguments; only a machine has its own states, whiskers, needs, parameters, memory and tests",
        ),
        FileKind::Tests => {
            let exports = file.exports().map(|name| name.span);
            let uses = file.uses.iter().skip(1).map(|used| used.span);
            (
                items_of_machines(file).chain(exports).chain(uses).min_by_key(|span| span.start)?,
                "a test file has only tests and properties",
                "is neither",
                "a test file",
                "the tests can read the parameters, derived values and states of the machine; declare other items there",
            )
        }
    };
    Some(Diagnostic::error("P0603", message, first, label).note(file.name.span, note).hint(hint))
}

/// The spans of the items that only a machine has, without its tests.
fn items_of_machines(file: &File) -> impl Iterator<Item = Span> {
    let parameters = file.parameters.iter().map(|parameter| parameter.name.span);
    let needs = file.needs.iter().map(|need| need.name.span);
    let states = file.states.iter().map(|state| state.name.span);
    let names = file.whiskers.iter().chain(&file.initial).map(|name| name.span);
    let rules = file.always.iter().map(|rule| &rule.target).chain(&file.failsafes).map(|target| target.span);
    let running = file.monitors.iter().filter(|monitor| monitor.used.is_some()).map(|monitor| monitor.name.span);
    let memory = file.memory.iter().map(|(name, _)| name.span);
    parameters.chain(needs).chain(states).chain(names).chain(rules).chain(memory).chain(running).chain(file.acts)
}
