//! Text from elsewhere that is shown on a terminal or stored.

/// The text as one line of at most `limit` characters. Control characters become spaces. Long texts lose their middle.
pub(super) fn one_line(text: &str, limit: usize) -> String {
    let words: Vec<_> =
        text.split(|c: char| c.is_control() || c.is_whitespace()).filter(|word| !word.is_empty()).collect();
    let line = words.join(" ");
    let length = line.chars().count();
    if length <= limit {
        return line;
    }
    let half = limit.saturating_sub(3) / 2;
    let start: String = line.chars().take(half).collect();
    let end: String = line.chars().skip(length - half).collect();
    format!("{start} … {end}")
}
