//! A chart's picture: all of it can be seen.

use std::collections::BTreeSet;

use proptest::prelude::*;
use vibrissa::policy::chart::{Target, Transition};
use vibrissa::report::{chart_dot, chart_svg};

use super::charts::{HARD, NESTED, THESIS, chart_of, charts};
use crate::seen::{apart, see, within};

/// Texts lie in the picture, apart from each other, and each in a frame or apart from it.
fn stands_clear(picture: &str) {
    let seen = see(picture);
    let all = [0.0, 0.0, seen.size.0, seen.size.1];
    for (index, (a, place)) in seen.texts.iter().enumerate() {
        assert!(within(place, &all), "{a} is cut off");
        for (b, other) in &seen.texts[..index] {
            assert!(apart(place, other), "`{a}` and `{b}` overlap");
        }
        for frame in &seen.frames {
            assert!(apart(place, frame) || within(place, frame), "`{a}` overlaps a frame");
        }
    }
    for (index, a) in seen.frames.iter().enumerate() {
        assert!(within(a, &all));
        for b in &seen.frames[..index] {
            assert!(apart(a, b) || within(a, b) || within(b, a), "frames overlap");
        }
    }
}

/// The numbers of the data of a path.
fn numbers(data: &str) -> Vec<f64> {
    data.split(|letter: char| letter.is_alphabetic() || letter == ' ').filter_map(|part| part.parse().ok()).collect()
}

/// The head of an arrow is at the end of its line, and the line comes from behind it.
fn heads_follow_their_lines(picture: &str) {
    let paths: Vec<&str> = picture.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut heads = 0;
    for pair in paths.windows(2).filter(|pair| pair[1].ends_with('Z')) {
        let (line, head) = (numbers(pair[0]), numbers(pair[1]));
        // The head of a vertical arrow: both ends of its back have one height. The heads of loops are horizontal.
        let [_, back, x, tip, _, other] = head[..] else { continue };
        if (back - other).abs() > 0.01 {
            continue;
        }
        heads += 1;
        assert_eq!(line[line.len() - 2..], [x, tip], "{}", pair[0]);
        let mut heights = line.iter().skip(1).step_by(2).rev();
        let before = heights.find(|height| (*height - tip).abs() > 0.5).unwrap();
        assert!((back - tip).signum() == (before - tip).signum(), "{} has the head {}", pair[0], pair[1]);
    }
    assert!(heads > 0);
}

#[test]
fn in_a_picture_nothing_hides_anything() {
    for text in [THESIS, HARD, NESTED] {
        stands_clear(&chart_svg(&chart_of(text)).unwrap());
        heads_follow_their_lines(&chart_svg(&chart_of(text)).unwrap());
    }
}

#[test]
fn a_picture_stands_by_itself_and_is_always_the_same() {
    let picture = chart_svg(&chart_of(HARD)).unwrap();
    assert_eq!(picture.matches("http").count(), 1, "the namespace alone");
    assert!(picture == chart_svg(&chart_of(HARD)).unwrap());
}

#[test]
fn a_chart_that_nobody_could_make_out_has_no_picture() {
    let states: Vec<_> = (0..101).map(|k| format!("state S{k} {{ after 1 s -> S{} }}", (k + 1) % 101)).collect();
    let chart = chart_of(&format!("machine m initial S0 {}", states.join("\n")));
    assert!(chart_svg(&chart).unwrap_err().to_string().contains("101 states"));
    assert_eq!(chart_dot(&chart).matches("after").count(), 101);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn in_the_picture_of_any_chart_nothing_hides_anything(chart in charts()) {
        let picture = chart_svg(&chart).unwrap();
        heads_follow_their_lines(&picture);
        stands_clear(&picture);
        // One arrow for all transitions between two states, and one to each initial state.
        let ends = |transition: &Transition| match &transition.target {
            Target::State { state, .. } => (format!("{:?}", transition.origin), Ok(*state)),
            Target::Failure(_) => (format!("{:?}", transition.origin), Err("failure".to_owned())),
            Target::Success(_) => (format!("{:?}", transition.origin), Err("success".to_owned())),
            Target::Exit { name, .. } => (format!("{:?}", transition.origin), Err(format!("exit {name}"))),
        };
        let arrows: BTreeSet<_> = chart.transitions.iter().map(ends).collect();
        let initial = chart.states.iter().filter(|state| state.initial).count();
        prop_assert_eq!(picture.matches("stroke-width=\"1.3\"").count(), arrows.len() + initial);
    }
}
