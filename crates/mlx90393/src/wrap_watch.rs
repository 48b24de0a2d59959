//! The wrap of counts beyond the range of 16 bits.

/// Follows the counts of an axis over successive measurements.
///
/// With RES 0 and 1 the output is the lower 16 bits of a converter that has more. A field beyond their range gives counts
/// of the other sign. They differ from the counts before by more than half the range, which a field within the range does
/// not do between two measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct WrapWatch {
    /// The newest counts, continued beyond the range.
    last: Option<i32>,
}

/// The range of counts without a wrap.
const RANGE: core::ops::RangeInclusive<i32> = -0x8000..=0x7FFF;

impl WrapWatch {
    /// A watch before the first measurement. Its counts are taken to be within the range.
    pub(crate) const fn new() -> Self {
        Self { last: None }
    }

    /// True if these counts have wrapped. Counts at the end of the range, `is_at_end`, say nothing about those that follow.
    pub(crate) fn has_wrapped(&mut self, counts: i32, is_at_end: bool) -> bool {
        if is_at_end {
            return false;
        }
        let last = self.last.unwrap_or(counts);
        #[expect(clippy::cast_possible_truncation, reason = "a difference is known up to multiples of the range")]
        let step = counts.wrapping_sub(last) as i16;
        let continued = last.saturating_add(i32::from(step));
        self.last = Some(continued);
        !RANGE.contains(&continued)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn exactly_the_counts_beyond_the_range_have_wrapped(
            steps in prop::collection::vec(-30_000_i32..30_000, 1..50), start in -0x7FFF..0x7FFF_i32,
        ) {
            let (mut watch, mut converter) = (WrapWatch::new(), start);
            for step in core::iter::once(0).chain(steps) {
                converter = (converter + step).clamp(-88_000, 88_000);
                #[expect(clippy::cast_possible_truncation, reason = "as the sensor does")]
                let output = i32::from(converter as i16);
                prop_assert_eq!(watch.has_wrapped(output, false), !RANGE.contains(&converter));
            }
        }
    }

    #[test]
    fn counts_at_the_end_of_the_range_are_not_followed() {
        let mut watch = WrapWatch::new();
        assert!(!watch.has_wrapped(-6000, false));
        assert!(!watch.has_wrapped(0x7FFF, true));
        assert!(!watch.has_wrapped(-6000, false));
    }
}
