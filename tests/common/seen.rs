//! What a picture shows.
#![allow(dead_code, unreachable_pub, reason = "every test file uses a part of it")]

use svg::node::element::tag::Type;
use svg::parser::Event;

/// What a picture shows: the boxes of its texts, with them, and its frames (left, top, right, bottom in px).
#[derive(Default)]
pub struct Seen {
    pub texts: Vec<(String, [f64; 4])>,
    pub frames: Vec<[f64; 4]>,
    pub size: (f64, f64),
}

/// Reads a picture, whose tags are shown to be balanced and whose numbers to be finite.
pub fn see(picture: &str) -> Seen {
    let (mut open, mut seen, mut current) = (Vec::new(), Seen::default(), None::<(f64, f64, f64, f64, String)>);
    let mut shift = (0.0, 0.0);
    for event in svg::read(picture).unwrap() {
        match event {
            Event::Tag(name, kind, attributes) => {
                for value in attributes.values() {
                    assert!(!value.contains("NaN") && !value.contains("inf"), "{name}: {value:?}");
                }
                match kind {
                    Type::Start => open.push(name.to_owned()),
                    Type::End => assert_eq!(open.pop().as_deref(), Some(name)),
                    Type::Empty => {}
                }
                let number = |key: &str| attributes.get(key).and_then(|value| value.parse::<f64>().ok());
                match (name, kind) {
                    ("svg", Type::Start) => seen.size = (number("width").unwrap(), number("height").unwrap()),
                    ("g", Type::Start) => {
                        if let Some(transform) = attributes.get("transform") {
                            let numbers = transform.trim_matches(|c: char| !c.is_ascii_digit()).split_once(' ');
                            let (x, y) = numbers.unwrap();
                            shift = (x.parse().unwrap(), y.parse().unwrap());
                        }
                    }
                    ("rect", _) if attributes.contains_key("stroke") => {
                        let [x, y, width, height] = ["x", "y", "width", "height"].map(|key| number(key).unwrap());
                        let (x, y) = (x + shift.0, y + shift.1);
                        seen.frames.push([x, y, x + width, y + height]);
                    }
                    ("text", Type::Start) => {
                        let before = match &*attributes["text-anchor"] {
                            "start" => 0.0,
                            "middle" => 0.5,
                            _ => 1.0,
                        };
                        let [x, y, size] = ["x", "y", "font-size"].map(|key| number(key).unwrap());
                        current = Some((x + shift.0, y + shift.1, size, before, String::new()));
                    }
                    ("text", Type::End) => {
                        let (x, y, size, before, content) = current.take().unwrap();
                        let width = 0.6 * size * content.chars().count() as f64;
                        let left = x - before * width;
                        seen.texts.push((content, [left, y - 0.8 * size, left + width, y + 0.2 * size]));
                    }
                    _ => {}
                }
            }
            Event::Text(content) => {
                if let Some((.., text)) = &mut current {
                    let entities = [
                        ("&lt;", "<"),
                        ("&gt;", ">"),
                        ("&quot;", "\""),
                        ("&apos;", "'"),
                        ("&#39;", "'"),
                        ("&amp;", "&"),
                    ];
                    let plain =
                        entities.iter().fold(content.trim().to_owned(), |text, (from, to)| text.replace(from, to));
                    text.push_str(&plain);
                }
            }
            Event::Error(error) => panic!("{error}"),
            _ => {}
        }
    }
    assert!(open.is_empty(), "{open:?}");
    seen.texts.retain(|(content, _)| !content.is_empty());
    seen
}

/// Whether two boxes share nothing.
pub fn apart(a: &[f64; 4], b: &[f64; 4]) -> bool {
    a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3]
}

/// Whether a box lies in another.
pub fn within(inner: &[f64; 4], outer: &[f64; 4]) -> bool {
    inner[0] >= outer[0] && inner[1] >= outer[1] && inner[2] <= outer[2] && inner[3] <= outer[3]
}
