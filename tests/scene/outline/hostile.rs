//! Whatever bytes a file holds, they are answered.

use proptest::prelude::*;
use vibrissa::outline::{Format, OutlineFault, ReadOptions, SIZE_LIMIT, read};

use super::folder;

fn is_answered(bytes: &[u8], format: Format) {
    for element in [None, Some("star")] {
        let options = ReadOptions { unit: Some(1e-3), element, height: 0.01, ..ReadOptions::default() };
        match read(bytes, format, &options) {
            Ok(contours) => assert!(!contours.is_empty() && contours.iter().all(|contour| contour.area() > 0.0)),
            Err(error) => assert!(!error.to_string().is_empty() && !error.fault.advice().is_empty()),
        }
    }
}

/// The good files of a format.
fn good(format: Format) -> Vec<Vec<u8>> {
    let files = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files.filter(|path| path.to_str().and_then(Format::of) == Some(format)).collect();
    files.sort();
    files.into_iter().map(|path| std::fs::read(path).unwrap()).collect()
}

fn format() -> impl Strategy<Value = Format> {
    prop::sample::select(Format::ALL.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn any_bytes_are_answered(format in format(), bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        is_answered(&bytes, format);
    }

    #[test]
    fn any_path_is_answered(path in "([MmLlHhVvCcSsQqTtAaZz]| |,|-|\\.|[0-9]{1,4}|e[0-9]{1,3}|1e-200){0,40}", scale in -3..3_i8) {
        let text = format!("<svg viewBox='0 0 9 9'><path transform='scale({scale} 2)' d='M0 0{path}'/></svg>");
        is_answered(text.as_bytes(), Format::Svg);
    }

    #[test]
    fn any_cut_of_a_good_file_is_answered(format in format(), pick in any::<prop::sample::Index>(), share in 0.0..1.0_f64) {
        let files = good(format);
        let bytes = pick.get(&files);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the file")]
        let end = (share * bytes.len() as f64) as usize;
        is_answered(&bytes[..end], format);
    }

    #[test]
    fn any_mutation_of_a_good_file_is_answered(
        format in format(), pick in any::<prop::sample::Index>(), from in any::<prop::sample::Index>(), length in 0_usize..12,
        insert in prop_oneof![
            prop::collection::vec(any::<u8>(), 0..4),
            "-?[0-9]{1,3}(\\.[0-9]{1,2})?(e-?[0-9]{1,3})?|nan|inf|[-a-zA-Z0-9<>/=\"'#&;,. \n]{0,6}".prop_map(String::into_bytes),
        ],
    ) {
        let files = good(format);
        let bytes = pick.get(&files);
        let start = from.index(bytes.len());
        let end = (start + length).min(bytes.len());
        is_answered(&[&bytes[..start], &insert, &bytes[end..]].concat(), format);
    }
}

#[test]
fn a_file_that_is_too_large_is_refused_whatever_is_in_it() {
    for format in Format::ALL {
        let error = read(&vec![b' '; SIZE_LIMIT + 1], format, &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("more than"), "{error}");
    }
}

#[test]
fn elements_that_repeat_each_other_come_to_an_end() {
    let svg = |inner: &str| format!("<svg viewBox='0 0 9 9'>{inner}</svg>").into_bytes();
    is_answered(&svg("<g id='a'><use href='#a'/></g>"), Format::Svg);
    is_answered(&svg(&"<g>".repeat(20_000)), Format::Svg);
    is_answered(&svg(&("<g>".repeat(20_000) + &"</g>".repeat(20_000))), Format::Svg);
    // Each repeats the one before it ten times.
    let group = |k: u32| format!("<g id='g{}'>{}</g>", k + 1, format!("<use href='#g{k}'/>").repeat(10));
    let groups: String = (0..30).map(group).collect();
    is_answered(&svg(&format!("<g id='g0'><path/></g>{groups}")), Format::Svg);
}

#[test]
fn a_use_that_draws_itself_is_named() {
    let options = ReadOptions { unit: Some(1e-3), element: None, height: 0.0, ..ReadOptions::default() };
    for (drawing, named) in [
        ("<g id='a'><circle r='5'/><use href='#a'/></g>", "#a"),
        ("<symbol id='s'><g><use href='#s'/></g></symbol><use href='#s'/>", "#s"),
        ("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>", "#b"),
        ("<use id='u' href='#u'/>", "#u"),
    ] {
        let error = read(format!("<svg>{drawing}</svg>").as_bytes(), Format::Svg, &options).unwrap_err();
        let reason = format!("`use` of `{named}` draws itself");
        assert_eq!(error.fault, OutlineFault::Syntax { reason }, "{drawing}");
    }
}

#[test]
fn what_draws_nothing_is_bounded_too() {
    let options = ReadOptions { unit: Some(1e-3), element: None, height: 0.0, ..ReadOptions::default() };
    let read = |inner: &str| read(format!("<svg>{inner}</svg>").as_bytes(), Format::Svg, &options).unwrap_err();
    // All in one line, so that each count of its columns would go through it from the start.
    assert_eq!(read(&"<rect/>".repeat(300_000)).fault, OutlineFault::NoOutline);
    let uses = "<use href='#a'/>".repeat(10_000);
    let moves = "M0 0".repeat(250_000);
    let remarks = "<!---->".repeat(100_000);
    for repeated in [
        format!("<path id='a' d='{moves}'/>"),
        format!("<g id='a' style='{moves};display:none'><rect/></g>"),
        format!("<g id='a'>{remarks}</g>"),
    ] {
        let error = read(&format!("<defs>{repeated}</defs>{uses}"));
        assert!(matches!(error.fault, OutlineFault::TooLarge { limit: 1_000_000, .. }), "{error}");
    }
}

#[test]
fn what_would_take_the_parser_too_long_is_refused_before() {
    let read =
        |text: &str| read(text.as_bytes(), Format::Svg, &ReadOptions { unit: Some(1e-3), ..ReadOptions::default() });
    let told = |text: &str| read(text).unwrap_err().to_string();
    let attributes: String =
        (0..150_000).flat_map(|index| [" a".to_owned(), index.to_string(), "=\"\"".to_owned()]).collect();
    assert_eq!(
        told(&format!("<svg>\n<rect{attributes}/></svg>")),
        "line 2: there are more than 256 attributes of an element"
    );
    // A `>` within a value does not end the tag.
    assert!(told(&format!("<svg><rect x='>'{attributes}/></svg>")).contains("attributes of an element"));
    let nested: String =
        (0..40_000).flat_map(|index| ["<g xmlns:n".to_owned(), index.to_string(), "='u'>".to_owned()]).collect();
    assert_eq!(told(&format!("<svg>{nested}</svg>")), "there are more than 1000 declarations of namespaces");
    let document = |entity: &str, text: &str| format!("<!DOCTYPE svg [\n<!ENTITY e {entity}>]><svg>{text}</svg>");
    let references = "&e;".repeat(10_000);
    assert!(told(&document("'<g a=\"\"/>'", &references)).starts_with("line 2: an entity that holds elements"));
    assert!(told(&document("'&f;&f;'", &references)).contains("other entities"));
    let long = document(&format!("'{}'", "x".repeat(10_000)), &references);
    assert_eq!(told(&long), "there are more than 16777216 bytes that entities stand for");
    // As drawing programs have it.
    let circle = "<circle r='5' cx='&e;'/>";
    assert!(read(&document("\"7\"", circle)).is_ok());
}
