//! A square of bits, in which rows are written and read by spans.

/// Number of bits in a word.
pub(super) const WORD: usize = 64;

/// One bit for each cell of a square. Rows begin at whole words, so that a span of a row is written and tested by words.
#[derive(Debug, Clone)]
pub(super) struct Bits {
    words: Vec<u64>,
    /// Words in a row.
    per_row: usize,
}

/// The words of a span: the index in the row, and the bits that belong to the span.
struct SpanWords {
    row: usize,
    word: usize,
    last_word: usize,
    first_bit: usize,
    last_bit: usize,
    is_done: bool,
}

impl Iterator for SpanWords {
    type Item = (usize, u64);

    #[inline]
    fn next(&mut self) -> Option<(usize, u64)> {
        if self.is_done {
            return None;
        }
        let mut mask = u64::MAX << self.first_bit;
        if self.word == self.last_word {
            mask &= u64::MAX >> (WORD - 1 - self.last_bit);
            self.is_done = true;
        }
        let index = self.row + self.word;
        (self.word, self.first_bit) = (self.word + 1, 0);
        Some((index, mask))
    }
}

impl Bits {
    /// Creates a square with this number of cells a side, a multiple of [`WORD`], without a set bit.
    pub(super) fn new(side: usize) -> Self {
        let per_row = side / WORD;
        Self { words: vec![0; per_row * side], per_row }
    }

    /// Cells of a side.
    fn side(&self) -> usize {
        self.per_row * WORD
    }

    /// The bit of a cell. `false` outside of the square.
    pub(super) fn get(&self, column: i32, row: i32) -> bool {
        let (Ok(column), Ok(row)) = (usize::try_from(column), usize::try_from(row)) else { return false };
        let is_inside = column < self.side() && row < self.side();
        is_inside && self.words[row * self.per_row + column / WORD] >> (column % WORD) & 1 == 1
    }

    /// Sets the bits of a row from one column to another one, both included, as far as they are in the square. Returns
    /// the number of bits that were not set before.
    pub(super) fn fill(&mut self, row: i32, from: i32, to: i32) -> u32 {
        let mut new = 0;
        for (index, mask) in self.span(row, from, to) {
            let word = &mut self.words[index];
            new += (mask & !*word).count_ones();
            *word |= mask;
        }
        new
    }

    /// True if the whole span is in the square and all its bits are set.
    pub(super) fn are_set(&self, row: i32, from: i32, to: i32) -> bool {
        self.contains(row, from, to) && self.span(row, from, to).all(|(index, mask)| !self.words[index] & mask == 0)
    }

    /// True if the whole span is in the square.
    pub(super) fn contains(&self, row: i32, from: i32, to: i32) -> bool {
        let is_inside = |at: i32| usize::try_from(at).is_ok_and(|at| at < self.side());
        is_inside(row) && is_inside(from) && is_inside(to)
    }

    /// The words of the part of a span that is in the square: the index of each, and the mask of the bits of the span.
    pub(super) fn words(&self, row: i32, from: i32, to: i32) -> impl Iterator<Item = (usize, u64)> + use<> {
        self.span(row, from, to)
    }

    /// The word with an index of [`words`](Self::words).
    pub(super) fn word(&self, index: usize) -> u64 {
        self.words[index]
    }

    /// The columns and rows of the set bits, row by row.
    pub(super) fn set(&self) -> impl Iterator<Item = (i32, i32)> + '_ {
        let words = self.words.iter().enumerate().filter(|(_, word)| **word != 0);
        words.flat_map(|(index, &word)| {
            let (row, first) = (index / self.per_row, index % self.per_row * WORD);
            let bits = (0..WORD).filter(move |bit| word >> bit & 1 == 1);
            bits.filter_map(move |bit| Some((i32::try_from(first + bit).ok()?, i32::try_from(row).ok()?)))
        })
    }

    /// The spans of set bits: the row, and the first and the last column of each, row by row.
    pub(super) fn spans(&self) -> impl Iterator<Item = (i32, i32, i32)> + '_ {
        let mut from = 0;
        std::iter::from_fn(move || {
            let side = self.side();
            let start = self.first(from, side * side, true)?;
            // A span ends with its row.
            let end = self.first(start, (start / side + 1) * side, false).unwrap_or((start / side + 1) * side);
            from = end;
            let cell = |index: usize| i32::try_from(index).ok();
            Some((cell(start / side)?, cell(start % side)?, cell((end - 1) % side)?))
        })
    }

    /// The first cell from one index to before another one, counted row by row, whose bit is set, or is not.
    fn first(&self, from: usize, before: usize, is_set: bool) -> Option<usize> {
        let mut index = from;
        while index < before {
            let word = self.words[index / WORD];
            let wanted = if is_set { word } else { !word };
            let rest = wanted & u64::MAX << (index % WORD);
            index -= index % WORD;
            if rest != 0 {
                return Some(index + rest.trailing_zeros() as usize).filter(|index| *index < before);
            }
            index += WORD;
        }
        None
    }

    /// The words of the part of a span that is in the square.
    fn span(&self, row: i32, from: i32, to: i32) -> SpanWords {
        let last = i32::try_from(self.side()).unwrap_or(i32::MAX) - 1;
        let (from, to) = (from.max(0), to.min(last));
        let empty = SpanWords { row: 0, word: 0, last_word: 0, first_bit: 0, last_bit: 0, is_done: true };
        let (Ok(row), Ok(from), Ok(to)) = (usize::try_from(row), usize::try_from(from), usize::try_from(to)) else {
            return empty;
        };
        if row >= self.side() || from > to {
            return empty;
        }
        SpanWords {
            row: row * self.per_row,
            word: from / WORD,
            last_word: to / WORD,
            first_bit: from % WORD,
            last_bit: to % WORD,
            is_done: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn spans_set_and_test_the_bits_that_single_cells_have(
            spans in prop::collection::vec((-5..200_i32, -70..300_i32, -70..300_i32), 0..12),
            asked in (-5..200_i32, -10..200_i32, -10..200_i32),
        ) {
            let mut bits = Bits::new(192);
            let mut expected = vec![vec![false; 192]; 192];
            let mut count = 0;
            for (row, from, to) in spans {
                count += bits.fill(row, from, to);
                for column in from.max(0)..=to.min(191) {
                    if let Some(line) = usize::try_from(row).ok().and_then(|row| expected.get_mut(row)) {
                        line[usize::try_from(column).unwrap_or(0)] = true;
                    }
                }
            }
            let at = |column: i32, row: i32| {
                let cell = usize::try_from(row).ok().zip(usize::try_from(column).ok());
                cell.and_then(|(row, column)| expected.get(row)?.get(column)).copied().unwrap_or(false)
            };
            for row in -2..194 {
                for column in -2..194 {
                    prop_assert_eq!(bits.get(column, row), at(column, row));
                }
            }
            let mut listed = vec![vec![false; 192]; 192];
            for (row, from, to) in bits.spans() {
                prop_assert!(from <= to && !at(from - 1, row) && !at(to + 1, row), "a span is as long as possible");
                let (Ok(row), Ok(from), Ok(to)) = (usize::try_from(row), usize::try_from(from), usize::try_from(to)) else {
                    return Err(TestCaseError::fail("outside"));
                };
                listed[row][from..=to].fill(true);
            }
            prop_assert_eq!(&listed, &expected);
            let (row, from, to) = asked;
            if from <= to {
                prop_assert_eq!(bits.are_set(row, from, to), (from..=to).all(|column| at(column, row)));
            }
            let set = expected.iter().flatten().filter(|is_set| **is_set).count();
            prop_assert_eq!(usize::try_from(count).ok(), Some(set));
        }
    }
}
