//! The traversal of a drawing.

use std::collections::BTreeSet;

use vibrissa_runtime::math;
use vibrissa_runtime::units::suggest;

use super::super::assemble::{LoosePiece, assemble};
use super::super::outline_list::{Outline, OutlineList};
use super::super::text::shown;
use super::super::transform::Transform;
use super::super::{MAX_PIECES, OutlineError, OutlineFault};
use super::drawing::{Block, Drawing};
use super::entity::{EntityGeometry, geometry, is_annotation, object_transform, unsupported};
use super::record::Record;

/// The largest number of blocks in each other.
const DEEPEST: usize = 32;

/// The largest number of entities, with those that blocks repeat.
const MAX_STEPS: usize = 500_000;

/// The layer of entities that take the layer of their block, and of entities that state none.
const LAYER_OF_BLOCK: &str = "0";

/// A traversal of a drawing with its results.
pub(super) struct Walk<'d> {
    drawing: &'d Drawing<'d>,
    /// The layer to read. `None` for all visible ones.
    layer: Option<&'d str>,
    outlines: OutlineList,
    loose: Vec<LoosePiece>,
    /// The names of all layers with entities.
    layers: BTreeSet<&'d str>,
    is_found: bool,
    /// The number of entities that cannot be seen.
    unseen: usize,
    steps: usize,
    /// The names of the blocks in each other that are being drawn, in lower case.
    open: Vec<String>,
}

impl<'d> Walk<'d> {
    pub(super) fn new(drawing: &'d Drawing<'d>, layer: Option<&'d str>) -> Self {
        Self {
            drawing,
            layer,
            outlines: OutlineList::default(),
            loose: Vec::new(),
            layers: BTreeSet::new(),
            is_found: false,
            unseen: 0,
            steps: 0,
            open: Vec::new(),
        }
    }

    /// Reads all entities of the model. `transform` is that of the drawing.
    pub(super) fn read(mut self, transform: &Transform) -> Result<Vec<Outline>, OutlineError> {
        let drawing = self.drawing;
        for entity in &drawing.entities {
            if !entity.is_on_paper() {
                self.draw(entity, transform, None, 0).map_err(|error| error.or_at(entity.line))?;
            }
        }
        if let Some(layer) = self.layer
            && !self.is_found
        {
            let meant = suggest(layer, self.layers).map(str::to_owned);
            return Err(OutlineFault::NoElement { element: layer.to_owned(), meant }.into());
        }
        for (pieces, line) in assemble(&self.loose)? {
            self.outlines.add(pieces, line)?;
        }
        self.outlines.into_visible(self.unseen)
    }

    /// Draws an entity. `outer` is the layer of the block that contains it.
    fn draw(
        &mut self,
        entity: &'d Record<'d>,
        transform: &Transform,
        outer: Option<&'d str>,
        depth: usize,
    ) -> Result<(), OutlineError> {
        self.count_step()?;
        let layer = match (entity.layer(), outer) {
            (LAYER_OF_BLOCK | "", outer) => outer.unwrap_or(LAYER_OF_BLOCK),
            (own, _) => own,
        };
        if entity.kind == "INSERT" {
            let is_hidden = !entity.is_visible() || self.drawing.layers.is_frozen(layer);
            if self.layer.is_none() && is_hidden {
                self.unseen += 1;
                return Ok(());
            }
            return self.draw_block(entity, transform, layer, depth);
        }
        self.layers.insert(layer);
        let is_chosen = match self.layer {
            None => entity.is_visible() && !self.drawing.layers.is_hidden(layer),
            Some(chosen) => layer.to_lowercase() == chosen.to_lowercase(),
        };
        if !is_chosen {
            self.unseen += usize::from(self.layer.is_none() && !is_annotation(entity.kind));
            return Ok(());
        }
        self.is_found = true;
        let line = Some(entity.line);
        match geometry(entity, transform).map_err(|error| error.or_at(entity.line))? {
            EntityGeometry::Nothing => {}
            EntityGeometry::Whole(pieces) => self.outlines.add(pieces, line)?,
            EntityGeometry::Loose(pieces) => self.loose.extend(pieces.into_iter().map(|piece| (piece, line))),
        }
        if self.loose.len() > MAX_PIECES {
            return Err(OutlineFault::TooLarge { what: "lines and arcs", limit: MAX_PIECES }.at(line));
        }
        Ok(())
    }

    /// Draws a block where it is inserted, once for each row and column.
    fn draw_block(
        &mut self,
        insert: &'d Record<'d>,
        transform: &Transform,
        layer: &'d str,
        depth: usize,
    ) -> Result<(), OutlineError> {
        let at = |fault: OutlineFault| fault.at(Some(insert.line));
        if depth >= DEEPEST {
            return Err(at(OutlineFault::TooLarge { what: "blocks in each other", limit: DEEPEST }));
        }
        let name = insert.text(2);
        let key = name.to_lowercase();
        if self.open.contains(&key) {
            let reason = format!("the block `{}` contains itself", shown(name));
            return Err(at(OutlineFault::Syntax { reason }));
        }
        let Some(block) = self.drawing.blocks.get(&key) else {
            let reason = format!("an INSERT refers to the block `{}`, which is not there", shown(name));
            return Err(at(OutlineFault::Syntax { reason }));
        };
        if block.is_external()? {
            let what = format!("the block `{}` of another file", shown(name));
            return Err(at(unsupported(&what, "bind it into this file, or take it out")));
        }
        self.open.push(key);
        let count = |code| Ok::<_, OutlineError>(insert.integer(code)?.max(1));
        let (columns, rows) = (count(70)?, count(71)?);
        for row in 0..rows {
            for column in 0..columns {
                self.count_step().map_err(|error| error.or_at(insert.line))?;
                let place = [f64::from(column), f64::from(row)];
                let inner =
                    block_transform(insert, block, place, transform).map_err(|error| error.or_at(insert.line))?;
                for entity in &block.entities {
                    self.draw(entity, &inner, Some(layer), depth + 1)?;
                }
            }
        }
        self.open.pop();
        Ok(())
    }

    fn count_step(&mut self) -> Result<(), OutlineError> {
        self.steps += 1;
        if self.steps <= MAX_STEPS {
            return Ok(());
        }
        let what = "entities, with those that blocks repeat";
        Err(OutlineFault::TooLarge { what, limit: MAX_STEPS }.into())
    }
}

impl Block<'_> {
    /// True if the entities are in another file.
    fn is_external(&self) -> Result<bool, OutlineError> {
        const REFERENCE: i32 = 4 | 8;
        Ok(self.record.integer(70)? & REFERENCE != 0)
    }
}

/// The transform of the entities of a block in a column and a row of an INSERT.
fn block_transform(
    insert: &Record<'_>,
    block: &Block<'_>,
    [column, row]: [f64; 2],
    transform: &Transform,
) -> Result<Transform, OutlineError> {
    let (sin, cos) = math::sin_cos(insert.number(50, 0.0)?.to_radians());
    let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    let scale = [insert.number(41, 1.0)?, insert.number(42, 1.0)?];
    if scale.contains(&0.0) {
        let reason = "an INSERT has the scale 0".to_owned();
        return Err(OutlineFault::Syntax { reason }.into());
    }
    let [base, place] = [block.record.place(10)?, insert.place(10)?];
    // The distances of rows and columns are not scaled, but turned.
    let grid = [column * insert.number(44, 0.0)?, row * insert.number(45, 0.0)?];
    let moved = turn([grid[0] - scale[0] * base[0], grid[1] - scale[1] * base[1]]);
    let own = object_transform(insert, transform)?;
    Ok(own.inner(turn([scale[0], 0.0]), turn([0.0, scale[1]]), [place[0] + moved[0], place[1] + moved[1]]))
}
