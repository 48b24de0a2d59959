//! The properties of elements: style sheets, `style`, and presentation attributes.

use std::collections::HashMap;

use roxmltree::{Node, NodeId};

use super::super::OutlineFault;

/// The largest number of comparisons of an element with a selector. A comparison counts once for each class of the selector, and for this
/// share of the bytes of the element's classes.
const MAX_COMPARISONS: usize = 5_000_000;
const BYTES_PER_COMPARISON: usize = 16;

/// The largest number of selectors in all style sheets. Drawings have a few dozen.
const MAX_SELECTORS: usize = 10_000;

/// The style sheets of a document.
#[derive(Debug, Default)]
pub(super) struct Styles {
    /// The declarations between brackets.
    blocks: Vec<String>,
    /// In ascending precedence.
    rules: Vec<Rule>,
    /// The blocks that hold for an element, in ascending precedence.
    blocks_of: HashMap<NodeId, Vec<usize>>,
}

/// A selector with the index of its block.
#[derive(Debug)]
struct Rule {
    selector: Selector,
    block: usize,
}

/// A selector of elements by their name, id and classes.
#[derive(Debug, Default, PartialEq)]
struct Selector {
    element: Option<String>,
    id: Option<String>,
    classes: Vec<String>,
}

impl Selector {
    /// Reads a selector, such as `path.a`. `None` for one that depends on other elements, attributes or states.
    fn parse(text: &str) -> Option<Self> {
        let is_name = |name: &str| {
            !name.is_empty() && name.chars().all(|letter| letter.is_alphanumeric() || matches!(letter, '-' | '_'))
        };
        let marks = |letter: char| matches!(letter, '.' | '#');
        let (element, mut rest) = text.split_at(text.find(marks).unwrap_or(text.len()));
        let mut selector = Self::default();
        match element {
            "*" => {}
            "" if !rest.is_empty() => {}
            name if is_name(name) => selector.element = Some(name.to_owned()),
            _ => return None,
        }
        while !rest.is_empty() {
            let (mark, behind) = rest.split_at(1);
            let (name, next) = behind.split_at(behind.find(marks).unwrap_or(behind.len()));
            if !is_name(name) || (mark == "#" && selector.id.is_some()) {
                return None;
            }
            match mark {
                "#" => selector.id = Some(name.to_owned()),
                _ => selector.classes.push(name.to_owned()),
            }
            rest = next;
        }
        Some(selector)
    }

    fn matches(&self, node: Node<'_, '_>) -> bool {
        let has_class = |class: &String| {
            node.attribute("class").is_some_and(|classes| classes.split_whitespace().any(|found| found == class))
        };
        self.element.as_deref().is_none_or(|element| node.tag_name().name() == element)
            && self.id.as_deref().is_none_or(|id| node.attribute("id") == Some(id))
            && self.classes.iter().all(has_class)
    }

    /// The precedence by the standard.
    fn specificity(&self) -> (bool, usize, bool) {
        (self.id.is_some(), self.classes.len(), self.element.is_some())
    }
}

impl Styles {
    /// Reads all style sheets of a document. An error has the element.
    pub(super) fn read<'d>(document: Node<'d, 'd>) -> Result<Self, (Node<'d, 'd>, OutlineFault)> {
        let mut styles = Self::default();
        for node in document.descendants() {
            if node.pi().is_some_and(|instruction| instruction.target == "xml-stylesheet") {
                return Err((node, unsupported("a style sheet in another file")));
            }
            if node.tag_name().name() == "style" {
                styles.add_sheet(node).map_err(|fault| (node, fault))?;
            }
        }
        styles.rules.sort_by_key(|rule| rule.selector.specificity());
        if styles.rules.is_empty() {
            return Ok(styles);
        }
        let weight: usize = styles.rules.iter().map(|rule| 1 + rule.selector.classes.len()).sum();
        let mut comparisons = 0_usize;
        for node in document.descendants().filter(Node::is_element) {
            let bytes = node.attribute("class").map_or(0, str::len);
            comparisons = comparisons.saturating_add(weight.saturating_mul(1 + bytes / BYTES_PER_COMPARISON));
            if comparisons > MAX_COMPARISONS {
                let what = "comparisons of elements with rules of style sheets";
                return Err((node, OutlineFault::TooLarge { what, limit: MAX_COMPARISONS }));
            }
            let found = styles.rules.iter().filter(|rule| rule.selector.matches(node)).map(|rule| rule.block);
            let found: Vec<usize> = found.collect();
            if !found.is_empty() {
                styles.blocks_of.insert(node.id(), found);
            }
        }
        Ok(styles)
    }

    /// Adds the rules of a sheet. A rule that this reader does not understand could hide, move or change any element.
    fn add_sheet(&mut self, node: Node<'_, '_>) -> Result<(), OutlineFault> {
        let text: String = node.descendants().filter(Node::is_text).filter_map(|part| part.text()).collect();
        let text = without_comments(&text).ok_or_else(|| unsupported("a style sheet with an open comment"))?;
        if text.trim().is_empty() {
            return Ok(());
        }
        let is_one_of = |name, values: &[&str]| {
            node.attribute(name).is_none_or(|value| values.iter().any(|known| value.eq_ignore_ascii_case(known)))
        };
        if !is_one_of("type", &["text/css", ""]) || !is_one_of("media", &["all", "screen", ""]) {
            return Err(unsupported("a style sheet of another type or for another medium"));
        }
        if let Some(mark) = text.chars().find(|letter| matches!(letter, '@' | '\\')) {
            return Err(unsupported(&format!("a style sheet with `{mark}`")));
        }
        let mut rest = text.as_str();
        while let Some((selectors, behind)) = rest.split_once('{') {
            let (declarations, next) =
                behind.split_once('}').ok_or_else(|| unsupported("a style sheet with an open bracket"))?;
            if declarations.contains('{') {
                return Err(unsupported("a style sheet with rules in each other"));
            }
            for selector in selectors.split(',').map(str::trim) {
                let shown: String = selector.chars().take(40).collect();
                let selector = Selector::parse(selector)
                    .ok_or_else(|| unsupported(&format!("a style sheet with the selector `{shown}`")))?;
                self.rules.push(Rule { selector, block: self.blocks.len() });
                if self.rules.len() > MAX_SELECTORS {
                    return Err(OutlineFault::TooLarge { what: "selectors in style sheets", limit: MAX_SELECTORS });
                }
            }
            self.blocks.push(declarations.to_owned());
            rest = next;
        }
        if rest.trim().is_empty() { Ok(()) } else { Err(unsupported("a style sheet with an incomplete rule")) }
    }

    /// The value of a property. Style sheets have precedence over the attribute, and the element's own style over both. Of several values, the
    /// last one or the last important one holds.
    pub(super) fn property<'s>(&'s self, node: Node<'s, 's>, name: &str) -> Option<&'s str> {
        let values =
            || self.declarations(node).filter(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, value)| value);
        let important = |value: &'s str| value.split_once('!').map(|(value, _)| value);
        let styled = values().filter_map(important).last().or_else(|| values().last());
        styled.or_else(|| node.attribute(name)).map(str::trim)
    }

    /// The names and values of the properties in style sheets and in the element's own style, in ascending precedence.
    pub(super) fn declarations<'s>(&'s self, node: Node<'s, 's>) -> impl Iterator<Item = (&'s str, &'s str)> {
        let texts = self.blocks_of(node).chain(node.attribute("style"));
        let pairs = texts.flat_map(|text| text.split(';')).filter_map(|declaration| declaration.split_once(':'));
        pairs.map(|(name, value)| (name.trim(), value.trim()))
    }

    /// The number of bytes that style sheets state for an element.
    pub(super) fn size(&self, node: Node<'_, '_>) -> usize {
        self.blocks_of(node).map(str::len).sum()
    }

    fn blocks_of<'s>(&'s self, node: Node<'_, '_>) -> impl Iterator<Item = &'s str> + use<'s> {
        let indices = self.blocks_of.get(&node.id()).map(Vec::as_slice).unwrap_or_default();
        indices.iter().filter_map(|&index| self.blocks.get(index)).map(String::as_str)
    }
}

/// A sheet without its comments. `None` if one has no end.
fn without_comments(text: &str) -> Option<String> {
    let mut parts = text.split("/*");
    let mut rest = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        rest.push(' ');
        rest.push_str(part.split_once("*/")?.1);
    }
    Some(rest)
}

fn unsupported(what: &str) -> OutlineFault {
    let advice = "save it with the properties as attributes of the elements, and take the sheet out";
    OutlineFault::Unsupported { what: what.to_owned(), advice }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn a_selector_has_a_name_an_id_and_classes_and_nothing_else() {
        let selector = Selector::parse("path.a.b-2#c").unwrap();
        assert_eq!((selector.element.as_deref(), selector.id.as_deref()), (Some("path"), Some("c")));
        assert_eq!(selector.classes, ["a", "b-2"]);
        assert_eq!(Selector::parse("*"), Some(Selector::default()));
        for other in ["", "a b", "a>b", "a:hover", "[x]", "a.", ".#", "#a#b", "a*", ".a:not(.b)"] {
            assert_eq!(Selector::parse(other), None, "{other}");
        }
    }
}
