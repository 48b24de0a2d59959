//! The stored figures of the scenes under one policy in one world.

use std::fmt;
use std::str::FromStr;

use super::figures::{FIGURES, Values};

/// The text of a figure that a run does not have.
const NONE: &str = "–";
/// The smallest and the largest tolerance relative to the value. The smaller covers rounding on other machines. The larger is clear of a
/// change of 20 %.
const RELATIVE: [f64; 2] = [0.01, 0.15];
/// The tolerance relative to the standard deviation.
const DEVIATIONS: f64 = 3.0;

/// The figures of one scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SceneFigures {
    pub(super) scene: String,
    pub(super) outcome: String,
    /// In the order of [`FIGURES`].
    pub(super) figures: Vec<Guarded>,
}

/// A figure with the range in which it may be.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Guarded {
    pub(super) path: String,
    /// `None` if the run does not have it.
    pub(super) value: Option<f64>,
    /// The largest permitted difference, in the unit of the value.
    pub(super) tolerance: f64,
    /// Its standard deviation over displaced starts, from which the tolerance was computed.
    pub(super) deviation: f64,
}

impl SceneFigures {
    /// The figures of a run, with the standard deviations over `starts`, of which each is a run from another start.
    pub(super) fn new(scene: &str, outcome: &str, values: &Values, starts: &[Values]) -> Self {
        let figure = |(index, path): (usize, &&str)| {
            let all = starts.iter().chain([values]).filter_map(|values| values[index]);
            let deviation = standard_deviation(&all.collect::<Vec<_>>());
            Guarded {
                path: (*path).to_owned(),
                value: values[index],
                tolerance: tolerance(values[index], deviation),
                deviation,
            }
        };
        let figures = FIGURES.iter().enumerate().map(figure).collect();
        Self { scene: scene.to_owned(), outcome: outcome.to_owned(), figures }
    }

    /// What differs in `found` from these figures by more than the tolerance.
    pub(super) fn differences(&self, found: &Self) -> Vec<String> {
        let mut differences = Vec::new();
        if self.outcome != found.outcome {
            differences.push(format!("outcome: {} -> {}", self.outcome, found.outcome));
        }
        for found in &found.figures {
            let Some(stored) = self.figures.iter().find(|stored| stored.path == found.path) else {
                differences.push(format!("{}: not stored", found.path));
                continue;
            };
            if !stored.permits(found.value) {
                differences.push(stored.difference(found.value));
            }
        }
        let is_gone = |stored: &&Guarded| found.figures.iter().all(|found| found.path != stored.path);
        differences
            .extend(self.figures.iter().filter(is_gone).map(|stored| format!("{}: no figure any more", stored.path)));
        differences
    }
}

impl Guarded {
    fn permits(&self, found: Option<f64>) -> bool {
        match (self.value, found) {
            (Some(stored), Some(found)) => (found - stored).abs() <= self.tolerance,
            (stored, found) => stored.is_none() && found.is_none(),
        }
    }

    fn difference(&self, found: Option<f64>) -> String {
        let text = |value| number(value, 4);
        let change = format!("{}: {} -> {}", self.path, text(self.value), text(found));
        match (self.value, found) {
            (Some(stored), Some(found)) if stored != 0.0 => {
                let percent = |part: f64| 100.0 * part / stored.abs();
                format!("{change} ({:+.1} %, permitted {:.1} %)", percent(found - stored), percent(self.tolerance))
            }
            _ => change,
        }
    }
}

/// Three standard deviations, but at least and at most some per cent of the value. A figure of zero stays zero.
fn tolerance(value: Option<f64>, deviation: f64) -> f64 {
    let magnitude = value.unwrap_or(0.0).abs();
    (DEVIATIONS * deviation).clamp(RELATIVE[0] * magnitude, RELATIVE[1] * magnitude)
}

fn standard_deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    if count > 1.0 { (squares / (count - 1.0)).sqrt() } else { 0.0 }
}

/// A number whose most significant digit is followed by so many others.
fn number(value: Option<f64>, digits: usize) -> String {
    let rounded = |value| format!("{value:.digits$e}").parse::<f64>().unwrap().to_string();
    value.map_or_else(|| NONE.to_owned(), rounded)
}

impl fmt::Display for SceneFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.scene, self.outcome)?;
        for Guarded { path, value, tolerance, deviation } in &self.figures {
            let [tolerance, deviation] = [tolerance, deviation].map(|value| number(Some(*value), 1));
            let value = number(*value, 4);
            if value == NONE {
                writeln!(f, "  {path:<28}{value:>10}")?;
            } else {
                writeln!(f, "  {path:<28}{value:>10} ± {tolerance:<10} deviation {deviation}")?;
            }
        }
        Ok(())
    }
}

/// All scenes of a file, in its order.
pub(super) struct Snapshot(pub(super) Vec<SceneFigures>);

impl FromStr for Snapshot {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut scenes: Vec<SceneFigures> = Vec::new();
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let unreadable = || format!("`{line}` is neither a scene with its outcome nor a figure");
            let words: Vec<_> = line.split_whitespace().collect();
            if !line.starts_with(' ') {
                let (scene, outcome) = line.split_once(": ").ok_or_else(unreadable)?;
                scenes.push(SceneFigures { scene: scene.to_owned(), outcome: outcome.to_owned(), figures: Vec::new() });
                continue;
            }
            let parsed = |word: &str| word.parse::<f64>().map_err(|_| unreadable());
            let (path, value, tolerance, deviation) = match words.as_slice() {
                [path, NONE] => (path, None, 0.0, 0.0),
                [path, value, "±", tolerance, "deviation", deviation] => {
                    (path, Some(parsed(value)?), parsed(tolerance)?, parsed(deviation)?)
                }
                _ => return Err(unreadable()),
            };
            let figure = Guarded { path: (*path).to_owned(), value, tolerance, deviation };
            scenes.last_mut().ok_or_else(unreadable)?.figures.push(figure);
        }
        Ok(Self(scenes))
    }
}
