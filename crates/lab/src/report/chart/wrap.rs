//! Wrapped texts.

/// Indentation of continued lines in letters.
const INDENT: usize = 2;

/// Approximate width of a text in letters. East Asian letters and pictograms have double width.
pub(super) fn letters(content: &str) -> usize {
    content.chars().map(|c| if c < '\u{1100}' { 1 } else { 2 }).sum()
}

/// Parts of a text in lines of `width` letters. Lines are broken between the parts if that suffices, else at blanks.
/// All lines except the first are indented.
pub(super) fn wrapped(parts: &[String], width: usize) -> Vec<String> {
    let mut lines = Lines { done: Vec::new(), line: String::new(), width };
    for part in parts {
        lines.add(part);
    }
    lines.done.extend((!lines.line.is_empty()).then_some(lines.line));
    lines.done
}

/// Lines in construction.
struct Lines {
    done: Vec<String>,
    line: String,
    /// Letters in a line.
    width: usize,
}

impl Lines {
    /// Adds a part, on the same line if it fits.
    fn add(&mut self, part: &str) {
        let fits_alone = INDENT + letters(part) <= self.width;
        if self.fits(part) {
            self.append(part);
        } else if fits_alone {
            self.turn();
            self.append(part);
        } else if part.contains(char::is_whitespace) {
            part.split_whitespace().for_each(|word| self.add(word));
        } else {
            // The beginning of the part fits behind the text of the line.
            if letters(&self.line) + 2 < self.width && !self.line.trim().is_empty() {
                self.line.push(' ');
            }
            for letter in part.chars() {
                if letters(&self.line) >= self.width {
                    self.turn();
                }
                self.line.push(letter);
            }
        }
    }

    fn fits(&self, part: &str) -> bool {
        letters(&self.line) + usize::from(!self.line.trim().is_empty()) + letters(part) <= self.width
    }

    fn append(&mut self, part: &str) {
        if !self.line.trim().is_empty() {
            self.line.push(' ');
        }
        self.line.push_str(part);
    }

    /// Begins a new line.
    fn turn(&mut self) {
        let indent = " ".repeat(INDENT);
        if self.line.trim().is_empty() {
            self.line = indent;
        } else {
            self.done.push(std::mem::replace(&mut self.line, indent));
        }
    }
}
