//! The declaration of a figure of a run.

use vibrissa_runtime::units::Dimension;

/// What the number of a figure is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A length (m).
    Length,
    /// An area (m²).
    Area,
    /// A time (s).
    Time,
    /// An angle (rad).
    Angle,
    /// A share, 0 to 1.
    Share,
    /// A ratio of two quantities of one dimension.
    Ratio,
    /// A number of things.
    Count,
    /// 1 if a statement holds, else 0.
    Truth,
}

/// The direction in which a figure is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Smaller values are better. A scenario bounds the figure from above.
    Smaller,
    /// Larger values are better. A scenario bounds the figure from below.
    Larger,
}

/// The bounds of a figure that a scenario can expect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// The range of bounds (SI).
    pub range: (f64, f64),
    /// A bound, as an example for messages.
    pub example: &'static str,
}

/// The form of a figure in a cell of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// With this number of decimals. A length in mm has as many as are significant.
    Decimals(usize),
    /// Like [`Cell::Decimals`], but empty for zero.
    Positive(usize),
    /// A mean in mm with its standard deviation.
    Spread,
}

/// The column of a figure in the table of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its place: columns are in ascending order. A narrow table omits the last ones.
    pub rank: u16,
    /// Its heading, with the unit.
    pub heading: &'static str,
    /// The form of its cells.
    pub cell: Cell,
    /// True if the table has the column even if no run has the figure.
    pub is_always: bool,
}

/// A figure in comparisons of policies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// Its place: figures are in ascending order.
    pub rank: u16,
    /// Its name, with the unit.
    pub name: &'static str,
}

/// All that is declared of a figure of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Its place in the JSON document of a run, with a dot before each nested key. The key names the unit. `None` if the document
    /// does not have it.
    pub key: Option<&'static str>,
    /// What its number is.
    pub kind: Kind,
    /// The meaning, for texts of editors, schemas and pages: lower-case, without a full stop.
    pub meaning: &'static str,
    /// The direction in which it is better. `None` if it is not judged.
    pub better: Option<Better>,
    /// Its name in `expect` of a scenario, in tests of policies (`run.name`) and in the objective of `tune`.
    pub name: Option<&'static str>,
    /// The bounds that `expect` accepts. `None` if `expect` does not have it.
    pub bound: Option<Bound>,
    /// True if tests of policies can read it.
    pub is_in_tests: bool,
    /// True if every run has it, or every run that has the [group](super::Group) of its key.
    pub is_always_known: bool,
    /// Its column in the table of results.
    pub column: Option<Column>,
    /// Its entry in comparisons of policies.
    pub compared: Option<Compared>,
}

impl Figure {
    pub(super) const fn new(kind: Kind, key: &'static str, meaning: &'static str) -> Self {
        Self {
            key: Some(key),
            kind,
            meaning,
            better: None,
            name: None,
            bound: None,
            is_in_tests: false,
            is_always_known: false,
            column: None,
            compared: None,
        }
    }

    pub(super) const fn without_key(kind: Kind, meaning: &'static str) -> Self {
        Self { key: None, ..Self::new(kind, "", meaning) }
    }

    pub(super) const fn smaller(self) -> Self {
        Self { better: Some(Better::Smaller), ..self }
    }

    pub(super) const fn larger(self) -> Self {
        Self { better: Some(Better::Larger), ..self }
    }

    pub(super) const fn named(self, name: &'static str) -> Self {
        Self { name: Some(name), ..self }
    }

    pub(super) const fn bound(self, range: (f64, f64), example: &'static str) -> Self {
        Self { bound: Some(Bound { range, example }), ..self }
    }

    pub(super) const fn in_tests(self) -> Self {
        Self { is_in_tests: true, ..self }
    }

    pub(super) const fn always(self) -> Self {
        Self { is_always_known: true, ..self }
    }

    /// A column of tables in which every table has it.
    pub(super) const fn column(self, rank: u16, heading: &'static str, cell: Cell) -> Self {
        Self { column: Some(Column { rank, heading, cell, is_always: true }), ..self }
    }

    /// A column of tables in which a run has the figure.
    pub(super) const fn column_if_known(self, rank: u16, heading: &'static str, cell: Cell) -> Self {
        Self { column: Some(Column { rank, heading, cell, is_always: false }), ..self }
    }

    pub(super) const fn compared(self, rank: u16, name: &'static str) -> Self {
        Self { compared: Some(Compared { rank, name }), ..self }
    }

    /// The physical dimension.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        match self.kind {
            Kind::Length => Dimension::LENGTH,
            Kind::Area => Dimension::AREA,
            Kind::Time => Dimension::TIME,
            Kind::Angle => Dimension::ANGLE,
            Kind::Share | Kind::Ratio | Kind::Count | Kind::Truth => Dimension::NUMBER,
        }
    }

    /// The unit in the document of a run. Empty for a number.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        let has = |unit: &str| self.key.is_some_and(|key| key.split('.').any(|part| part.ends_with(unit)));
        match self.kind {
            Kind::Length if has("_mm") => "mm",
            Kind::Length => "m",
            Kind::Area => "m\u{b2}",
            Kind::Time if has("_us") => "\u{b5}s",
            Kind::Time => "s",
            Kind::Angle => "rad",
            Kind::Share | Kind::Ratio | Kind::Count | Kind::Truth => "",
        }
    }

    /// The number of these units in the SI unit.
    #[must_use]
    pub fn units(&self) -> f64 {
        match self.unit() {
            "mm" => 1e3,
            "\u{b5}s" => 1e6,
            _ => 1.0,
        }
    }

    /// True if larger values are better, so that a bound is the smallest allowed value.
    #[must_use]
    pub fn larger_is_better(&self) -> bool {
        self.better == Some(Better::Larger)
    }

    /// The meaning as a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        sentence(self.meaning)
    }
}

/// A meaning with a capital letter and a full stop.
pub(super) fn sentence(meaning: &str) -> String {
    let mut letters = meaning.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}
