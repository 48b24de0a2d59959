//! The prose of the documentation, measured: words per sentence, words of the book, semicolons in tables, terms that are not the
//! field's, and measured figures outside of the pages that a command makes.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Most words per sentence in the mean: of the two pages that are read first, and of the others.
const MOST_WORDS_FIRST: f64 = 18.0;
const MOST_WORDS: f64 = 22.0;
/// The pages that are read first.
const FIRST: [&str; 2] = ["README.md", "ARCHITECTURE.md"];
/// The folders with pages, each without the folders in it. Those of `docs/results` are generated.
const FOLDERS: [&str; 5] = ["", "docs", "docs/decisions", "docs/howto", "editors"];
/// The folders of the book's hand-written pages. Their tables must not have more than [`MOST_FIGURES`] measured figures, because
/// `cargo x results` keeps these in pages of their own, and they have at most [`MOST_WORDS_TOGETHER`] words.
const HAND_WRITTEN: [&str; 2] = ["docs/", "docs/howto/"];
/// Most words of the hand-written pages together, counted as `wc -w` does. Beyond them, pages repeat each other.
const MOST_WORDS_TOGETHER: usize = 55_000;
/// Pages in these folders that are generated, or that only list the others or pictures.
const NOT_COUNTED: [&str; 3] = ["docs/gallery.md", "docs/reference.md", "docs/SUMMARY.md"];
/// Most cells of a table that are nothing but a decimal number. A few may be constants of a method.
const MOST_FIGURES: usize = 6;
/// A page that is not measured, because it grows.
const LEFT_OUT: &str = "CHANGELOG.md";

/// Terms of this project's earlier texts, and the field's terms. Only those that have no other meaning are here.
pub(crate) const TERMS: [(&str, &str); 39] = [
    ("tip model", "contact estimator"),
    ("tip models", "contact estimators"),
    ("springs off", "slips off"),
    ("sprang off", "slipped off"),
    ("sinks in", "penetrates"),
    ("sink in", "penetrate"),
    ("square to", "perpendicular to"),
    ("drawn by chance", "sampled at random"),
    ("drawn evenly", "sampled uniformly"),
    ("within the band", "within the 95 % interval"),
    ("hard cases", "stress tests"),
    ("nose whiskers", "forward-facing whiskers"),
    ("rule that holds", "global transition"),
    ("written out", "inlined"),
    ("chain limit", "microstep limit"),
    ("on the front", "Pareto-optimal"),
    ("worlds against each other", "simulator comparison"),
    ("told", "estimated, reported"),
    ("tier", "simulation"),
    ("tiers", "simulations"),
    ("carriage", "platform dynamics"),
    ("dear", "expensive"),
    ("feelers", "forward-facing whiskers"),
    ("crab", "yaw offset"),
    ("slant", "yaw offset"),
    ("tuck", "yaw offset"),
    ("tilt", "yaw offset"),
    ("tilted", "with a yaw offset"),
    ("places", "positions"),
    ("way", "path, direction, tangent"),
    ("ways", "paths, directions, tangents"),
    ("room", "module, capacity"),
    ("failsafe", "fallback transition"),
    ("swipe", "contour following"),
    ("spread", "standard deviation"),
    ("spreads", "standard deviations"),
    ("judge", "evaluation"),
    ("tape", "recording"),
    ("rings", "vibrates"),
];

/// Why the prose is not as it should be.
#[derive(Debug, Error)]
pub(crate) enum ProseError {
    #[error("cannot read {}: {cause}", path.display())]
    Read { path: PathBuf, cause: io::Error },
    #[error("rewrite these places in plain technical English:\n  {0}")]
    Findings(String),
}

/// Measures every page of the checkout at `root`.
pub(crate) fn check(root: &Path) -> Result<(), ProseError> {
    let mut findings = Vec::new();
    let mut words = 0;
    for path in pages(root)? {
        let text =
            fs::read_to_string(root.join(&path)).map_err(|cause| ProseError::Read { path: path.clone(), cause })?;
        let name = path.display().to_string();
        findings.extend(Page::new(&text).findings(&name));
        words += counted_words(&name, &text);
    }
    findings.extend(too_long(words));
    if findings.is_empty() { Ok(()) } else { Err(ProseError::Findings(findings.join("\n  "))) }
}

/// The number of words of a page that count for [`MOST_WORDS_TOGETHER`].
fn counted_words(name: &str, text: &str) -> usize {
    let is_counted = HAND_WRITTEN.contains(&folder(name)) && !NOT_COUNTED.contains(&name);
    if is_counted { hand_written(text).flat_map(str::split_whitespace).count() } else { 0 }
}

/// The lines of a page without the tables that a test writes. Such a table is behind its marker.
fn hand_written(text: &str) -> impl Iterator<Item = &str> {
    let mut is_table = false;
    text.lines().filter(move |line| {
        is_table = line.starts_with("<!-- table of ") || is_table && (line.is_empty() || line.starts_with('|'));
        !is_table
    })
}

/// What is wrong with this number of words of all hand-written pages.
fn too_long(words: usize) -> Option<String> {
    (words > MOST_WORDS_TOGETHER).then(|| {
        format!(
            "docs: the hand-written pages have {words} words, more than {MOST_WORDS_TOGETHER}; \
             state each fact on one page, and link to it"
        )
    })
}

/// The folder of a page, with the slash behind it.
fn folder(name: &str) -> &str {
    name.rfind('/').map_or("", |end| &name[..=end])
}

/// The pages, by their paths from the root, in order.
fn pages(root: &Path) -> Result<Vec<PathBuf>, ProseError> {
    let mut pages = Vec::new();
    for folder in FOLDERS {
        let read = |cause| ProseError::Read { path: folder.into(), cause };
        for entry in fs::read_dir(root.join(folder)).map_err(read)? {
            let path = Path::new(folder).join(entry.map_err(read)?.file_name());
            let is_page = path.extension().is_some_and(|extension| extension == "md");
            if is_page && path != Path::new(LEFT_OUT) {
                pages.push(path);
            }
        }
    }
    pages.sort();
    Ok(pages)
}

/// A page without its code.
#[derive(Debug, Default, PartialEq)]
struct Page {
    /// The paragraphs and items of lists, each with the number of its first line.
    blocks: Vec<(usize, String)>,
    /// The lines of tables, with their numbers.
    rows: Vec<(usize, String)>,
}

impl Page {
    fn new(text: &str) -> Self {
        let mut page = Self::default();
        let mut is_code = false;
        let mut is_comment = false;
        // Whether the next line goes on with the last block.
        let mut goes_on = false;
        let mut was_blank = true;
        for (number, line) in (1..).zip(text.lines()) {
            let trimmed = line.trim();
            if trimmed.starts_with("```") {
                is_code = !is_code;
            }
            is_comment |= trimmed.starts_with("<!--");
            let is_indented = line.starts_with("    ") && (was_blank || !goes_on);
            let is_prose = !is_code && !is_comment && !is_indented && !trimmed.starts_with(['#', '`', '<', '!']);
            was_blank = trimmed.is_empty();
            if is_comment && trimmed.ends_with("-->") {
                is_comment = false;
            }
            if is_prose && trimmed.starts_with('|') {
                page.rows.push((number, plain(trimmed)));
                goes_on = false;
            } else if is_prose && !trimmed.is_empty() {
                let item = trimmed.strip_prefix("- ").or_else(|| numbered(trimmed));
                match page.blocks.last_mut() {
                    Some((_, block)) if goes_on && item.is_none() => *block = format!("{block} {trimmed}"),
                    _ => page.blocks.push((number, item.unwrap_or(trimmed).to_owned())),
                }
                goes_on = true;
            } else if !is_indented {
                goes_on = false;
            }
        }
        for (_, block) in &mut page.blocks {
            *block = plain(block);
        }
        page
    }

    /// The mean number of words of a sentence; `None` without one.
    fn words_per_sentence(&self) -> Option<f64> {
        let sentences = self.blocks.iter().flat_map(|(_, block)| sentences(block));
        let counts: Vec<usize> = sentences.map(|sentence| sentence.split_whitespace().count()).collect();
        (!counts.is_empty()).then(|| counts.iter().sum::<usize>() as f64 / counts.len() as f64)
    }

    /// The first line of each table, and how many of its cells are nothing but a decimal number with its unit. Names, texts with
    /// numbers, code and whole numbers are no measured figures: they are defaults, limits and parameters.
    fn figures(&self) -> Vec<(usize, usize)> {
        let mut tables: Vec<(usize, usize, usize)> = Vec::new();
        for (line, row) in &self.rows {
            let count = row.split('|').filter(|cell| is_figure(cell)).count();
            match tables.last_mut() {
                Some((_, last, sum)) if *last + 1 == *line => (*last, *sum) = (*line, *sum + count),
                _ => tables.push((*line, *line, count)),
            }
        }
        tables.into_iter().map(|(first, _, count)| (first, count)).collect()
    }

    /// What is wrong with the page of this name, a line each.
    fn findings(&self, name: &str) -> Vec<String> {
        let mut findings = Vec::new();
        let most = if FIRST.contains(&name) { MOST_WORDS_FIRST } else { MOST_WORDS };
        if let Some(words) = self.words_per_sentence().filter(|words| *words > most) {
            findings.push(format!("{name}: {words:.1} words per sentence in the mean, more than {most}"));
        }
        if HAND_WRITTEN.contains(&folder(name)) {
            for (line, count) in self.figures().into_iter().filter(|&(_, count)| count > MOST_FIGURES) {
                findings.push(format!(
                    "{name}:{line}: a table with {count} measured figures; let `cargo x results` make it, in docs/results"
                ));
            }
        }
        for (line, row) in &self.rows {
            if row.contains(';') {
                findings.push(format!("{name}:{line}: a semicolon in a table; one cell has one quantity"));
            }
        }
        for (line, text) in self.blocks.iter().chain(&self.rows) {
            let text = text.to_lowercase();
            for (term, better) in TERMS {
                if has_words(&text, term) {
                    findings.push(format!("{name}:{line}: `{term}`: the field's term is `{better}`"));
                }
            }
        }
        findings
    }
}

/// An item of a numbered list without its number.
fn numbered(line: &str) -> Option<&str> {
    let (number, item) = line.split_once(". ")?;
    (!number.is_empty() && number.chars().all(|letter| letter.is_ascii_digit())).then_some(item)
}

/// A text with a letter in the place of code, and the text of links without where they lead.
fn plain(text: &str) -> String {
    // The bar that Markdown does not take for the end of a cell.
    let text = text.replace("&#124;", "|");
    let mut parts = text.split('`');
    let mut plain = parts.next().unwrap_or_default().to_owned();
    while let (Some(_code), Some(rest)) = (parts.next(), parts.next()) {
        plain.push('x');
        plain.push_str(rest);
    }
    while let Some(middle) = plain.find("](") {
        let Some(end) = plain[middle..].find(')') else { break };
        plain.replace_range(middle..=middle + end, "");
        if let Some(start) = plain[..middle].rfind('[') {
            plain.remove(start);
        }
    }
    plain
}

/// The sentences of a block. A mark ends one only before a space.
fn sentences(block: &str) -> impl Iterator<Item = &str> {
    let ends = block.match_indices(['.', '!', '?']).map(|(at, _)| at + 1);
    let ends: Vec<usize> = ends.filter(|&end| block[end..].starts_with(' ')).chain([block.len()]).collect();
    let starts = std::iter::once(0).chain(ends.clone());
    let sentences = starts.zip(ends).map(|(start, end)| block[start..end].trim());
    sentences.filter(|sentence| sentence.contains(char::is_alphanumeric))
}

/// True if a cell is a decimal number such as `0.037`, `2.5 %` or `1.1 ± 0.2 mm`.
fn is_figure(cell: &str) -> bool {
    let mut words = cell.split_whitespace();
    let is_decimal = |word: &str| word.contains('.') && word.parse::<f64>().is_ok();
    let is_unit = |word: &str| word.chars().count() <= 3 || word.parse::<f64>().is_ok();
    words.next().is_some_and(|word| is_decimal(word.trim_end_matches(','))) && words.all(is_unit)
}

/// True if a text has a phrase of whole words.
pub(crate) fn has_words(text: &str, phrase: &str) -> bool {
    let is_letter = |letter: Option<char>| letter.is_some_and(char::is_alphanumeric);
    text.match_indices(phrase).any(|(at, _)| {
        !is_letter(text[..at].chars().next_back()) && !is_letter(text[at + phrase.len()..].chars().next())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_headings_and_tables_are_no_sentences() {
        let page = Page::new(
            "# A heading\n\nOne two\nthree. Four `a b c` six.\n\n    code here\n\n```\nmore\n```\n\n- an item\n- another\n  one\n\n| a | b |\n",
        );
        assert_eq!(
            page.blocks,
            [(3, "One two three. Four x six.".to_owned()), (12, "an item".to_owned()), (13, "another one".to_owned())]
        );
        assert_eq!(page.rows.len(), 1);
        assert_eq!(page.words_per_sentence(), Some(2.5));
    }

    #[test]
    fn a_long_sentence_a_semicolon_in_a_table_and_an_old_term_are_found() {
        let long = ["word"; 19].join(" ");
        let page = Page::new(&format!("{long}.\n\n| 1 mm; 2 mm |\n\nIt uses a [tip model](a.md#b).\n"));
        let findings = page.findings("README.md");
        assert_eq!(findings.len(), 2, "{findings:?}");
        assert!(
            findings[0].contains("README.md:3") && findings[1].contains("README.md:5: `tip model`"),
            "{findings:?}"
        );
        let findings = Page::new(&format!("{long}.")).findings("README.md");
        assert!(findings[0].contains("19.0 words"), "{findings:?}");
        assert!(Page::new(&format!("{long}.")).findings("docs/language.md").is_empty());
    }

    #[test]
    fn a_table_of_measured_figures_belongs_to_the_results() {
        let row = "| disk | 0.072 | 0.03 ± 0.01 mm |\n";
        let table = format!("One.\n\n| scene | a | b |\n|---|---|---|\n{}\n", row.repeat(4));
        let found = |name: &str, text: &str| Page::new(text).findings(name);
        assert!(found("docs/bench.md", &table)[0].starts_with("docs/bench.md:3: a table with 8 measured"));
        assert!(found("docs/results/bench.md", &table).is_empty() && found("README.md", &table).is_empty());
        assert!(found("docs/decisions/files.md", &table).is_empty());
        let small = table.replace(row, "| disk | 0.072 | a |\n");
        assert!(found("docs/bench.md", &format!("{small}{small}")).is_empty(), "two tables are not one");
        let keys = "| `step` | `0.5556 ms` | from 0.1 ms to 33.3 ms | 10 | 0.5 of the length |\n".repeat(9);
        assert!(found("docs/scenarios.md", &keys).is_empty(), "defaults and limits are no measurements");
    }

    #[test]
    fn the_hand_written_pages_together_have_a_bound() {
        let counted = |name: &str| counted_words(name, "# Two\n\n| three | words |\n");
        assert_eq!([counted("docs/bench.md"), counted("docs/howto/extend.md")], [7, 7]);
        for name in
            ["README.md", "docs/reference.md", "docs/SUMMARY.md", "docs/decisions/0001.md", "docs/results/bench.md"]
        {
            assert_eq!(counted(name), 0, "{name}");
        }
        assert_eq!(too_long(MOST_WORDS_TOGETHER), None);
        assert!(too_long(MOST_WORDS_TOGETHER + 1).is_some_and(|finding| finding.contains("55001 words")));
    }

    #[test]
    fn only_whole_words_are_terms() {
        assert!(has_words("a tip model.", "tip model") && !has_words("a tip modeller", "tip model"));
    }
}
