//! The labels of transitions with the same ends, as a block of lines.

use svg::node::element::{Group, Rectangle};

use super::label::{LINE, Label};
use super::layout::{Position, Size};
use super::wrap::letters;
use crate::report::style::{self, Anchor, px, text};

/// Size of the letters (px).
const LETTERS: f64 = 11.0;
/// Width of a letter (px), approximately that of monospaced fonts.
const LETTER: f64 = 0.61 * LETTERS;
/// Height of a line (px).
const LINE_HEIGHT: f64 = 14.5;
/// Space between the labels of a block (px).
const GAP: f64 = 4.0;
/// Margins of the block (px): at the sides, above and below.
const MARGIN: (f64, f64) = (6.0, 3.0);

/// Letters in a line of an overview, lines of a guard or a reason, and labels of an arrow.
const BRIEF_LINE: usize = 16;
const BRIEF_LINES: usize = 2;
const BRIEF_LABELS: usize = 3;

/// A block of labels, one below the other.
pub(super) struct Caption {
    entries: Vec<Entry>,
    /// Width of the numbers in letters.
    numbers: usize,
}

struct Entry {
    number: Option<usize>,
    lines: Vec<(&'static str, String)>,
}

impl Caption {
    /// The block of `labels`. Their effects have this `colour`.
    pub(super) fn new(labels: &[Label], colour: &'static str) -> Self {
        let entry = |label: &Label| {
            let guard = label.guard_lines(LINE).into_iter().map(|line| (style::INK, line));
            let effects = label.effect_lines(LINE).into_iter().map(|line| (colour, line));
            Entry { number: label.number, lines: guard.chain(effects).collect() }
        };
        Self::of(labels.iter().map(entry).collect())
    }

    /// A block for an overview: the first lines of the first `labels`, and the number of the others.
    pub(super) fn brief(labels: &[Label], colour: &'static str) -> Self {
        let entry = |label: &Label| {
            let guard = shortened(label.brief_guard_lines(BRIEF_LINE)).into_iter().map(|line| (style::INK, line));
            // The arguments of a state are a detail, the reason of a failure is not.
            let effects = if colour == style::ALARM { shortened(label.effect_lines(BRIEF_LINE)) } else { Vec::new() };
            // Transitions of inner states have no number, so the numbers of the others would be of little use.
            Entry { number: None, lines: guard.chain(effects.into_iter().map(|line| (colour, line))).collect() }
        };
        let shown = if labels.len() > BRIEF_LABELS { BRIEF_LABELS - 1 } else { labels.len() };
        let mut entries: Vec<Entry> = labels[..shown].iter().map(entry).collect();
        if shown < labels.len() {
            entries.push(Entry {
                number: None,
                lines: vec![(style::GREY, format!("and {} others", labels.len() - shown))],
            });
        }
        Self::of(entries)
    }

    fn of(entries: Vec<Entry>) -> Self {
        let digits = entries.iter().filter_map(|entry| entry.number).max().map(|number| number.to_string().len());
        Self { entries, numbers: digits.map_or(0, |digits| digits + 1) }
    }

    /// The size of the block (px). Zero without labels.
    pub(super) fn size(&self) -> Size {
        if self.entries.is_empty() {
            return (0.0, 0.0);
        }
        let lines = self.entries.iter().flat_map(|entry| &entry.lines);
        let widest = lines.clone().map(|(_, line)| letters(line)).max().unwrap_or(0);
        let gaps = self.entries.len().saturating_sub(1) as f64;
        let height = LINE_HEIGHT * lines.count() as f64 + GAP * gaps;
        (LETTER * (self.numbers + widest) as f64 + 2.0 * MARGIN.0, height + 2.0 * MARGIN.1)
    }

    /// The block around `centre`, on a ground that covers the line behind it.
    pub(super) fn draw(&self, centre: Position) -> Group {
        if self.entries.is_empty() {
            return Group::new();
        }
        let (width, height) = self.size();
        let (left, top) = (centre.0 - 0.5 * width, centre.1 - 0.5 * height);
        let ground = Rectangle::new().set("x", px(left)).set("y", px(top)).set("width", px(width));
        let ground = ground.set("height", px(height)).set("rx", 4).set("fill", style::SOLID);
        let mut group = Group::new().set("font-family", style::CODE_FONT).add(ground);
        let (left, mut y) = (left + MARGIN.0, top + MARGIN.1 + 0.75 * LINE_HEIGHT);
        let indented = left + LETTER * self.numbers as f64;
        for entry in &self.entries {
            if let Some(number) = entry.number {
                group = group.add(text(left, y, Anchor::Start, LETTERS, style::GREY, &number.to_string()));
            }
            for (colour, line) in &entry.lines {
                let blanks = line.len() - line.trim_start().len();
                let x = indented + LETTER * blanks as f64;
                group = group.add(text(x, y, Anchor::Start, LETTERS, colour, line.trim_start()));
                y += LINE_HEIGHT;
            }
            y += GAP;
        }
        group
    }
}

/// The first of some lines, with a sign for further ones.
fn shortened(mut lines: Vec<String>) -> Vec<String> {
    if lines.len() > BRIEF_LINES {
        lines.truncate(BRIEF_LINES);
        if let Some(last) = lines.last_mut() {
            last.push('…');
        }
    }
    lines
}
