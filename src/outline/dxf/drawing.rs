//! A DXF drawing.

use std::collections::HashSet;

use super::super::OutlineError;
use super::pair::{Pair, cut_off, pairs};
use super::record::Record;

/// The relevant content of a drawing.
#[derive(Debug, Default)]
pub(super) struct Drawing<'t> {
    /// The length of a drawing unit (m), if the file states it.
    pub(super) unit: Option<f64>,
    /// The names of hidden layers, in lower case.
    pub(super) hidden: HashSet<String>,
    pub(super) entities: Vec<Record<'t>>,
}

impl<'t> Drawing<'t> {
    pub(super) fn read(text: &'t str) -> Result<Self, OutlineError> {
        let mut drawing = Self::default();
        let mut section = "";
        // The current record, if it is relevant.
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

    /// Adds a complete record.
    fn take(&mut self, record: Option<Record<'t>>) -> Result<(), OutlineError> {
        let Some(record) = record else { return Ok(()) };
        match (record.kind, self.entities.last_mut()) {
            ("LAYER", _) => {
                // A negative colour means that the layer is off. The first flag means that it is frozen.
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

/// The length of a unit (m) by its number. `None` if there is no unit.
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
