//! What is said of a word.

use vibrissa_language::index::{CandidateKind, Index};

use super::candidate::candidates;
use super::policies::{SWIPE, THESIS, gathered, index, policies};

#[test]
fn every_word_of_a_policy_that_compiles_is_explained() {
    for (name, text) in policies() {
        let index = Index::new(&gathered(&text), None);
        let mut at = 0;
        // Comments and texts have no meaning.
        let code: String = text.lines().map(|line| line.split('#').next().unwrap().to_owned() + "\n").collect();
        assert!(code.len() <= text.len() + 1);
        for line in text.split_inclusive('\n') {
            let mut in_text = false;
            for (offset, letter) in line.char_indices() {
                in_text ^= letter == '"';
                if letter == '#' && !in_text {
                    break;
                }
                let begins = !line[..offset].ends_with(|before: char| before.is_ascii_alphanumeric() || before == '_');
                if letter.is_ascii_alphabetic() && begins && !in_text && !line[..offset].ends_with(['/', '^']) {
                    assert!(index.hover(at + offset).is_some(), "{name}: {}", &line[offset..]);
                }
            }
            at += line.len();
        }
    }
}

#[test]
fn the_names_in_a_property_are_those_of_the_family_and_not_of_the_policy() {
    let text = "machine m  param speed = 50 mm/s  initial S  state S { stop }
        property \"p\" over convex-corner(angle in 30 deg .. 60 deg, speed = 5 cm/s) { expect run.passed and speed > 0 m/s }";
    let index = index(text);
    let of = |part: &str| index.hover(text.find(part).unwrap()).unwrap().text;
    assert!(of("over convex").contains("The family of the scenes"), "{}", of("over convex"));
    assert!(of("convex-corner").contains("Its parameters are `start_x`"), "{}", of("convex-corner"));
    assert!(of("angle in").contains("an angle, in deg") && of("angle in").contains("From 10 deg to 180 deg"));
    assert!(of("speed = 5 cm").contains("value of the policy's parameter `speed`"));
    // A change of the policy's own parameter leaves the family's alone.
    assert_eq!(index.references(text.find("speed").unwrap()).len(), 2);
}

#[test]
fn a_hover_says_type_unit_range_and_description() {
    let of = |text: &str, part: &str| index(text).hover(text.find(part).unwrap()).unwrap().text;
    assert_eq!(
        of(THESIS, "target, speed"),
        "```fsm\nparam target = 300 urad in 50 .. 800 urad\n```\n\nan angle, in deg, rad, mrad, urad\n\nbase angle at which the tip \
         is known best"
    );
    assert_eq!(of(SWIPE, "tangent = w"), "```fsm\nlet tangent = w.contour.tangent\n```\n\na direction");
    let law = "```fsm\nlaw swipe(w: whisker, target: angle, speed: speed)\n```\n\nAlgorithm 3.";
    assert!(of(SWIPE, "swipe(w: ").starts_with(law));
    assert!(of(THESIS, "swipe(w, ").starts_with(law) && of(THESIS, "swipe(w, ").ends_with("from `std.swipe`"));
    assert!(
        of(THESIS, "std.swipe").contains("algorithms 1 to 3") && of(THESIS, "std.swipe").contains("law swipe_tilted(")
    );
    assert_eq!(of(SWIPE, "w.contour"), "```fsm\nw: whisker\n```\n\na whisker");
    assert_eq!(
        of(SWIPE, "clamp("),
        "```fsm\nclamp(x, low, high)\n```\n\n`min(max(x, low), high)`\n\nIt takes three numbers of one dimension: the value, the \
         minimum, the maximum."
    );
    assert!(of(SWIPE, "contour.ready").starts_with("```fsm\nwhisker.contour\n```\n\na contour\n\nthe local contour"));
    assert!(of(SWIPE, "tip_at(").starts_with("```fsm\nwhisker.tip_at(base angle)\n```"));
    assert!(
        of(SWIPE, "tangent\n").starts_with("```fsm\ncontour.tangent\ncontour.tangent(distance behind the end)\n```")
    );
    assert!(of(THESIS, "visits(").starts_with("```fsm\nrun.visits(State)\n```"));
    assert_eq!(of(THESIS, "mm/s "), "```fsm\nmm/s\n```\n\na unit of a speed: 0.001 m/s");
    assert!(of(SWIPE, "hold\n").starts_with("```fsm\nhold\n```"));
    let products = "library l\nlet x(a: angular_speed / length, b: vector of length / time) = a * |b|";
    assert!(of(products, "a: ").starts_with("```fsm\na: angular_speed / length\n```\n\n"));
    assert!(of(products, "time)").ends_with("a time, in s, ms, us"), "{}", of(products, "time)"));
}

#[test]
fn every_built_in_is_explained_by_the_words_of_the_reference_page() {
    let page = include_str!("../../../docs/reference.md").replace('`', "");
    let inside = candidates("library l\nlaw l(w: whisker) { let x = \u{a7}");
    let members = candidates("library l\nlaw l(w: whisker) { let x = w.\u{a7}");
    let functions = inside.into_iter().filter(|candidate| candidate.kind == CandidateKind::Function);
    let mut explained = 0;
    for candidate in members.into_iter().chain(functions) {
        assert!(page.contains(&candidate.meaning.replace('`', "")), "{candidate:?}");
        assert!(!candidate.meaning.is_empty());
        explained += 1;
    }
    assert_eq!(explained, 16 + 30);
}

#[test]
fn the_examples_of_the_editors_page_are_described_as_it_says() {
    let page = include_str!("../../../docs/editor.md");
    let example = page.split("```fsm\n").nth(1).unwrap().split("```").next().unwrap();
    let index = index(example);
    let described: Vec<String> = index.symbols().iter().map(|symbol| index.description(symbol)).collect();
    assert_eq!(
        described,
        ["How fast the body moves, in every state.", "time without touch after which the contour is lost"]
    );
}
