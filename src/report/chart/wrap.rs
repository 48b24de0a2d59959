//! Texts in lines.

/// Letters by which a line that goes on is indented.
const INDENT: usize = 2;

/// About how many letters wide a text is: those of the scripts of East Asia, and pictures, are twice as wide.
pub(super) fn letters(content: &str) -> usize {
    content.chars().map(|c| if c < '\u{1100}' { 1 } else { 2 }).sum()
}

/// Parts of a text in lines of so many letters, broken between the parts if that suffices, or else at blanks where there are any. All lines but
/// the first are indented.
pub(super) fn wrapped(parts: &[String], width: usize) -> Vec<String> {
    let mut lines = Lines { done: Vec::new(), line: String::new(), width };
    for part in parts {
        lines.add(part);
    }
    lines.done.extend((!lines.line.is_empty()).then_some(lines.line));
    lines.done
}

/// Lines in the making.
struct Lines {
    done: Vec<String>,
    line: String,
    /// Letters in a line.
    width: usize,
}

impl Lines {
    /// Adds a part, on the same line if there is room.
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
            // At least the beginning of it has room behind what is on the line.
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
