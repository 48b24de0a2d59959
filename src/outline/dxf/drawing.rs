//! A drawing as a whole.

use std::collections::HashSet;

use super::super::OutlineError;
use super::pair::{Pair, cut_off, pairs};
use super::record::Record;

/// What is read of a drawing.
#[derive(Debug, Default)]
pub(super) struct Drawing<'t> {
    /// What 1 in it is (m), if it says so.
    pub(super) unit: Option<f64>,
    /// The names of layers that are not shown, in small letters.
    pub(super) hidden: HashSet<String>,
    pub(super) entities: Vec<Record<'t>>,
}

impl<'t> Drawing<'t> {
    pub(super) fn read(text: &'t str) -> Result<Self, OutlineError> {
        let mut drawing = Self::default();
        let mut section = "";
        // What is read at the moment, if it is of use.
        let mut record: Option<Record<'t>> = None;
        let mut variable = "";
        for pair in pairs(text) {
            let pair = pair?;
            match (pair.code, pair.value) {
                (0, "EOF") => {
                    drawing.take(record)?;
                    return Ok(drawing);
                }
                (0, kind) => {
                    drawing.take(record.take())?;
                    let is_wanted = matches!((section, kind), ("ENTITIES", _) | ("TABLES", "LAYER"));
                    section = if matches!(kind, "SECTION" | "ENDSEC") { "" } else { section };
                    record = (is_wanted && !section.is_empty()).then(|| Record::new(&pair));
                }
                (2, name) if section.is_empty() => section = name,
                (9, name) if section == "HEADER" => variable = name,
                (70, _) if section == "HEADER" && variable == "$INSUNITS" => drawing.unit = metres(&pair)?,
                _ => {
                    if let Some(record) = &mut record {
                        record.pairs.push(pair);
                    }
                }
            }
        }
        Err(cut_off().into())
    }

    /// Takes a record that is complete.
    fn take(&mut self, record: Option<Record<'t>>) -> Result<(), OutlineError> {
        let Some(record) = record else { return Ok(()) };
        match (record.kind, self.entities.last_mut()) {
            ("LAYER", _) => {
                // A colour below 0 is that of a layer that is off; the first flag is set of one that is frozen.
                if record.integer(62)? < 0 || record.integer(70)? & 1 != 0 {
                    self.hidden.insert(record.text(2).to_lowercase());
                }
            }
            ("VERTEX", Some(polyline)) if polyline.kind == "POLYLINE" => polyline.vertices.push(record),
            _ => self.entities.push(record),
        }
        Ok(())
    }
}

/// What 1 is (m), by the number of a unit; `None` if there is none.
fn metres(unit: &Pair<'_>) -> Result<Option<f64>, OutlineError> {
    Ok(Some(match unit.integer()? {
        1 => 0.0254,
        2 => 0.3048,
        4 => 1e-3,
        5 => 1e-2,
        6 => 1.0,
        9 => 25.4e-6,
        10 => 0.9144,
        13 => 1e-6,
        14 => 0.1,
        _ => return Ok(None),
    }))
}
