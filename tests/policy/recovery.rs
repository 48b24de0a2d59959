//! One fault of syntax does not hide the others, and gives rise to none.

use proptest::prelude::*;
use vibrissa_language::{chart, compile, format};
use vibrissa_text::diagnostic::{Colour, Diagnostic, Source, terminal};

const WHOLE: &str = include_str!("../fixtures/policies/whole/swiping.fsm");

fn faults(text: &str) -> Vec<Diagnostic> {
    compile(&Source::new("policy.fsm", text)).err().unwrap_or_default()
}

/// Lines and codes of the faults of a text.
fn told(text: &str) -> Vec<(usize, &'static str)> {
    let line = |fault: &Diagnostic| text[..fault.primary.span.start].matches('\n').count() + 1;
    faults(text).iter().map(|fault| (line(fault), fault.code)).collect()
}

/// Faults of syntax that anybody may make in a line, each by itself.
const SLIPS: [(&str, &str); 14] = [
    ("initial Exploring", "inital Exploring"),
    ("whisker r0, l0", "whisker r0 l0"),
    ("target = 300 urad", "target = = 300 urad"),
    ("param limit", "parm limit"),
    ("100 ms    in 0", "100 ms    from 0"),
    ("law swipe(w: whisker) {", "law swipe(w whisker) {"),
    ("let tangent = w.contour.tangent", "let tangent w.contour.tangent"),
    ("sign(w.base_angle))", "sign(w.base_angle)"),
    ("clamp(1.5 *", "clamp(1.5 **"),
    ("state Exploring {", "stat Exploring {"),
    ("-> Swiping(r0)", "=> Swiping(r0)"),
    ("do swipe(w)", "do swipe"),
    ("for lost ->", "for lost"),
    ("always when", "always wen"),
];

#[test]
fn every_slip_is_told_where_it_is_and_has_no_consequences() {
    for (right, wrong) in SLIPS {
        let text = WHOLE.replacen(right, wrong, 1);
        assert_ne!(text, WHOLE, "{right}");
        let line = WHOLE[..WHOLE.find(right).unwrap()].matches('\n').count() + 1;
        let told = told(&text);
        assert!(told.len() == 1 && (line..=line + 1).contains(&told[0].0), "{wrong}: {told:?} for {line}");
    }
}

#[test]
fn faults_of_meaning_are_told_beside_those_of_syntax() {
    let text = WHOLE.replacen("initial Exploring", "inital Exploring", 1).replacen("w.sense < 0", "w.sence < 0", 1);
    let codes: Vec<_> = told(&text).iter().map(|&(_, code)| code).collect();
    assert_eq!(codes, ["P0101", "P0203"]);
}

#[test]
fn everything_that_reads_a_policy_tells_the_same_faults_of_syntax() {
    let source = Source::new(
        "policy.fsm",
        WHOLE.replacen("let tangent =", "let tangent", 1).replacen("always when", "always", 1),
    );
    let syntax = compile(&source).unwrap_err();
    assert_eq!(syntax.len(), 2, "{}", terminal(&source, &syntax, Colour::Plain));
    assert_eq!(chart(&source).unwrap_err(), syntax);
    assert_eq!(format(&source).unwrap_err(), syntax);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn slips_in_different_items_are_all_told(chosen in prop::collection::btree_set(0..SLIPS.len(), 1..6)) {
        // The law and the states have several each: of those, one may hide another.
        let item = |slip: usize| match slip { 5..=8 => 5, 9..=10 => 9, 11..=12 => 11, other => other };
        let items: std::collections::BTreeSet<_> = chosen.iter().map(|&slip| item(slip)).collect();
        let text = chosen.iter().fold(WHOLE.to_owned(), |text, &slip| text.replacen(SLIPS[slip].0, SLIPS[slip].1, 1));
        let told = told(&text);
        prop_assert!(told.iter().all(|&(_, code)| code == "P0101"), "{told:?} {chosen:?}");
        prop_assert!((items.len()..=chosen.len()).contains(&told.len()), "{told:?} {chosen:?}");
    }

    #[test]
    fn a_text_with_a_fault_never_compiles_by_leaving_it_out(at in 0..WHOLE.len(), stray in "[;&%$!@}{)(\"]") {
        let text = format!("{}{stray}{}", &WHOLE[..at], &WHOLE[at..]);
        let in_comment = WHOLE[..at].rsplit('\n').next().unwrap().contains('#');
        let in_text = WHOLE[..at].rsplit('\n').next().unwrap().matches('"').count() % 2 == 1;
        prop_assert!(in_comment || in_text || !faults(&text).is_empty());
    }
}

#[test]
fn a_long_text_of_garbage_is_answered() {
    let lines = |line: &str| line.repeat((250_000 - WHOLE.len()) / line.len());
    let clean = format!("{WHOLE}{}", lines("# nothing but words\n"));
    assert_eq!(told(&clean), []);
    for line in [
        "stat A { stop }\n",
        "state A { } }\n",
        "let = 1\n",
        "a b\n",
        "{\n",
        "(\n",
        "law l( {\n",
        "\"\n",
        "state A {\n when\n",
        "; ",
    ] {
        let found = faults(&format!("{WHOLE}{}", lines(line))).len();
        assert!((1..=50).contains(&found), "{line:?}: {found}");
    }
}
