//! Suggestions for misspelt names.

/// Returns the most probable candidate for a misspelt name: one that differs only in case, or else the nearest by edit
/// distance. A swap of neighbours counts as one edit. `None` if more than a third of the name would change. One edit is
/// always allowed.
///
/// ```
/// use vibrissa_runtime::units::suggest;
/// assert_eq!(suggest("raduis", ["centre", "radius"]), Some("radius"));
/// assert_eq!(suggest("speed", ["centre", "radius"]), None);
/// ```
#[must_use]
pub fn suggest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (name.chars().count() / 3).max(1);
    let distance = |candidate: &str| {
        if name.to_lowercase() == candidate.to_lowercase() { 0 } else { strsim::damerau_levenshtein(name, candidate) }
    };
    candidates
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(distance, candidate)| distance <= allowed && distance < candidate.chars().count())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_wins_and_the_first_of_equals() {
        assert_eq!(suggest("heeding", ["reading", "heading"]), Some("heading"));
        assert_eq!(suggest("mx", ["mm", "ms"]), Some("mm"));
    }

    #[test]
    fn capitals_count_for_nothing() {
        assert_eq!(suggest("HEADING", ["heading"]), Some("heading"));
        assert_eq!(suggest("R0", ["l0", "r0"]), Some("r0"));
        assert_eq!(suggest("M", ["m", "s"]), Some("m"));
    }

    #[test]
    fn nothing_alike_gives_no_suggestion() {
        assert_eq!(suggest("x", ["m", "s"]), None);
        assert_eq!(suggest("", ["m"]), None);
    }
}
