//! A DXF drawing.

use std::collections::{HashMap, HashSet};

use super::super::text::shown;
use super::super::{OutlineError, OutlineFault};
use super::pair::{Pair, cut_off, pairs};
use super::record::Record;

/// The relevant content of a drawing. Names are in lower case, because they are case-insensitive.
#[derive(Debug, Default)]
pub(super) struct Drawing<'t> {
    /// The number of the drawing's unit, if the file states it.
    unit: Option<Pair<'t>>,
    pub(super) layers: Layers,
    pub(super) blocks: HashMap<String, Block<'t>>,
    pub(super) entities: Vec<Record<'t>>,
}

/// The layers that cannot be seen.
#[derive(Debug, Default)]
pub(super) struct Layers {
    off: HashSet<String>,
    frozen: HashSet<String>,
}

/// A group of entities that is drawn where it is inserted.
#[derive(Debug)]
pub(super) struct Block<'t> {
    pub(super) record: Record<'t>,
    pub(super) entities: Vec<Record<'t>>,
}

impl Layers {
    /// True if the entities of a layer are hidden.
    pub(super) fn is_hidden(&self, layer: &str) -> bool {
        self.off.contains(&layer.to_lowercase()) || self.is_frozen(layer)
    }

    /// True if a layer hides all of a block that is inserted there. Entities of a block have their own layers, which may be on while
    /// that of the block is off.
    pub(super) fn is_frozen(&self, layer: &str) -> bool {
        self.frozen.contains(&layer.to_lowercase())
    }
}

impl<'t> Drawing<'t> {
    pub(super) fn read(text: &'t str) -> Result<Self, OutlineError> {
        let mut drawing = Self::default();
        let mut section = "";
        // The current record, if it is relevant, and the current block.
        let (mut record, mut block): (Option<Record<'t>>, Option<Block<'t>>) = (None, None);
        let mut variable = "";
        for pair in pairs(text) {
            let pair = pair?;
            match (pair.code, pair.value) {
                (0, "EOF") => {
                    drawing.take(record, &mut block)?;
                    return Ok(drawing);
                }
                (0, kind) => {
                    drawing.take(record.take(), &mut block)?;
                    let is_wanted = matches!((section, kind), ("ENTITIES" | "BLOCKS", _) | ("TABLES", "LAYER"));
                    section = if matches!(kind, "SECTION" | "ENDSEC") { "" } else { section };
                    record = (is_wanted && !section.is_empty()).then(|| Record::new(&pair));
                }
                (2, name) if section.is_empty() => section = name,
                (9, name) if section == "HEADER" => variable = name,
                (70, _) if section == "HEADER" && variable == "$INSUNITS" => drawing.unit = Some(pair),
                _ => {
                    if let Some(record) = &mut record {
                        record.pairs.push(pair);
                    }
                }
            }
        }
        Err(cut_off().into())
    }

    /// Adds a complete record. `block` is the block whose records are being read.
    fn take(&mut self, record: Option<Record<'t>>, block: &mut Option<Block<'t>>) -> Result<(), OutlineError> {
        let Some(record) = record else { return Ok(()) };
        let entities = block.as_mut().map_or(&mut self.entities, |block| &mut block.entities);
        match (record.kind, entities.last_mut()) {
            ("LAYER", _) => {
                // A negative colour means that the layer is off. The first flag means that it is frozen.
                let name = || record.text(2).to_lowercase();
                if record.integer(62)? < 0 {
                    self.layers.off.insert(name());
                }
                if record.integer(70)? & 1 != 0 {
                    self.layers.frozen.insert(name());
                }
            }
            ("BLOCK", _) => *block = Some(Block { record, entities: Vec::new() }),
            ("ENDBLK", _) => {
                if let Some(block) = block.take() {
                    self.blocks.insert(block.record.text(2).to_lowercase(), block);
                }
            }
            ("VERTEX", Some(polyline)) if polyline.kind == "POLYLINE" => polyline.vertices.push(record),
            _ => entities.push(record),
        }
        Ok(())
    }

    /// The length of a drawing unit (m).
    pub(super) fn unit(&self) -> Result<f64, OutlineError> {
        const METRES_PER_FOOT: f64 = 0.3048;
        // That of the surveys of the United States.
        const METRES_PER_SURVEY_FOOT: f64 = 1200.0 / 3937.0;
        let Some(stated) = &self.unit else { return Err(OutlineFault::NoUnit.into()) };
        Ok(match stated.integer()? {
            0 => return Err(OutlineFault::NoUnit.at(Some(stated.line))),
            1 => METRES_PER_FOOT / 12.0,
            2 => METRES_PER_FOOT,
            3 => METRES_PER_FOOT * 5280.0,
            4 => 1e-3,
            5 => 1e-2,
            6 => 1.0,
            7 => 1e3,
            8 => 25.4e-9,
            9 => 25.4e-6,
            10 => 0.9144,
            11 => 1e-10,
            12 => 1e-9,
            13 => 1e-6,
            14 => 0.1,
            15 => 10.0,
            16 => 100.0,
            17 => 1e9,
            18 => 149_597_870_700.0,
            19 => 9_460_730_472_580_800.0,
            20 => 149_597_870_700.0 * 648_000.0 / std::f64::consts::PI,
            21 => METRES_PER_SURVEY_FOOT,
            22 => METRES_PER_SURVEY_FOOT / 12.0,
            23 => METRES_PER_SURVEY_FOOT * 3.0,
            24 => METRES_PER_SURVEY_FOOT * 5280.0,
            _ => return Err(OutlineFault::UnknownUnit { stated: shown(stated.value) }.at(Some(stated.line))),
        })
    }
}
