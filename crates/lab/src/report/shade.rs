//! Appearances of states. The states in one outermost state have one hue, and differ by lightness and hatching.

use svg::Document;
use svg::node::element::{Definitions, Path, Pattern, Rectangle};

use super::style::px;

/// One light colour for each outermost state, readable under text.
const HUES: [[u8; 3]; 12] = [
    [0xd9, 0xe2, 0xec],
    [0xb8, 0xdc, 0xf0],
    [0xfd, 0xe3, 0xa7],
    [0xd6, 0xc9, 0xec],
    [0xc7, 0xe8, 0xc9],
    [0xf6, 0xcf, 0xd8],
    [0xe6, 0xd5, 0xb8],
    [0xbf, 0xe3, 0xdf],
    [0xfb, 0xcf, 0xb1],
    [0xdf, 0xeb, 0xa8],
    [0xe8, 0xbf, 0xe6],
    [0xbd, 0xc8, 0xf5],
];

/// Shares of ink in a colour, from the lightest appearance of a hue to the darkest.
const INKS: [f64; 3] = [0.0, 0.11, 0.22];

/// Additional share of ink in the colour of a hatch.
const HATCH_INK: f64 = 0.22;

/// The ink.
const INK: [u8; 3] = [0x1f, 0x29, 0x33];

/// Side of the square of a hatch (px).
const TILE: f64 = 7.0;

/// Lines in that square. Empty for a plain area.
const HATCHES: [&str; 8] = [
    "",
    "M-1 1L1 -1M0 7L7 0M6 8L8 6",
    "M-1 6L1 8M0 0L7 7M6 -1L8 1",
    "M3.5 0V7",
    "M0 3.5H7",
    "M0 7L7 0M0 0L7 7",
    "M3.5 0V7M0 3.5H7",
    "M2 3.5a1.5 1.5 0 1 0 3 0a1.5 1.5 0 1 0 -3 0",
];

/// The appearance of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shade {
    hue: usize,
    ink: usize,
    hatch: usize,
}

/// The appearances of a machine's states, given by the parent of each state. An outer state comes before its inner
/// states. All are different for up to 12 outermost states with up to 23 inner states each.
pub(super) fn shades(parents: &[Option<usize>]) -> Vec<Shade> {
    let mut hues = Vec::with_capacity(parents.len());
    let mut outermost = 0;
    // Number of states of each hue.
    let mut counts = [0; HUES.len()];
    let mut shades = Vec::with_capacity(parents.len());
    for parent in parents {
        let hue = parent.and_then(|parent| hues.get(parent).copied()).unwrap_or_else(|| {
            outermost += 1;
            (outermost - 1) % HUES.len()
        });
        hues.push(hue);
        let rank: usize = counts[hue];
        counts[hue] += 1;
        shades.push(Shade { hue, ink: rank % INKS.len(), hatch: rank / INKS.len() % HATCHES.len() });
    }
    shades
}

impl Shade {
    /// The fill of an area of this appearance. A hatched one needs its [pattern](define).
    pub(super) fn fill(self) -> String {
        if self.hatch == 0 { self.ground() } else { format!("url(#{})", self.id()) }
    }

    fn ground(self) -> String {
        mixed(HUES[self.hue], INKS[self.ink])
    }

    fn id(self) -> String {
        format!("shade-{}-{}-{}", self.hue, self.ink, self.hatch)
    }

    fn pattern(self) -> Pattern {
        let ground = Rectangle::new().set("width", px(TILE)).set("height", px(TILE)).set("fill", self.ground());
        let colour = mixed(HUES[self.hue], INKS[self.ink] + HATCH_INK);
        let lines = Path::new().set("d", HATCHES[self.hatch]).set("fill", "none").set("stroke", colour);
        let pattern = Pattern::new().set("id", self.id()).set("patternUnits", "userSpaceOnUse");
        pattern.set("width", px(TILE)).set("height", px(TILE)).add(ground).add(lines.set("stroke-width", "1.2"))
    }
}

/// Adds the patterns of the hatched appearances to the document, each once.
pub(super) fn define(document: Document, shades: impl IntoIterator<Item = Shade>) -> Document {
    let mut hatched: Vec<Shade> = Vec::new();
    for shade in shades {
        if shade.hatch > 0 && !hatched.contains(&shade) {
            hatched.push(shade);
        }
    }
    if hatched.is_empty() {
        return document;
    }
    document.add(hatched.into_iter().fold(Definitions::new(), |all, shade| all.add(shade.pattern())))
}

/// A colour with a share of ink.
fn mixed(colour: [u8; 3], share: f64) -> String {
    let part = |index: usize| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
        let part = (f64::from(colour[index]) * (1.0 - share) + f64::from(INK[index]) * share).round() as u8;
        part
    };
    format!("#{:02x}{:02x}{:02x}", part(0), part(1), part(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_of_a_large_machine_all_look_different_and_those_of_one_outermost_state_have_its_hue() {
        // Twelve outermost states. The third has 23 inner states, some of them nested.
        let mut parents: Vec<Option<usize>> = vec![None, None, None];
        parents.extend((0..23).map(|k| Some(if k < 10 { 2 } else { 3 + k % 10 })));
        parents.extend([None; 9]);
        parents.extend([Some(26), Some(26), Some(27)]);
        let all = shades(&parents);
        for (index, shade) in all.iter().enumerate() {
            assert!(!all[..index].contains(shade), "{index}: {shade:?}");
            if let Some(parent) = parents[index] {
                assert_eq!(shade.hue, all[parent].hue);
            }
        }
    }

    #[test]
    fn outermost_states_that_share_a_hue_look_different() {
        let all = shades(&[None; 40]);
        assert!(all.iter().enumerate().all(|(index, shade)| !all[..index].contains(shade)));
    }
}
