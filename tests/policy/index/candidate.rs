//! What can be written at a place.

use vibrissa_language::index::{Candidate, Index};

use super::policies::{USING, gathered};

/// The labels of what can be written at the `§` of a text.
pub(crate) fn labels(text: &str) -> Vec<String> {
    candidates(text).into_iter().map(|candidate| candidate.label).collect()
}

/// What can be written at the `§` of a text.
pub(crate) fn candidates(text: &str) -> Vec<Candidate> {
    let at = text.find('\u{a7}').unwrap();
    Index::new(&gathered(&text.replace('\u{a7}', "")), None).candidates(at).1
}

/// A policy with `inside` in the second of its states, and no end.
pub(crate) fn writing(inside: &str) -> String {
    format!(
        "machine m\nwhisker r0, l0\nparam speed = 50 mm/s\nlet half(x: length) = x / 2\nlaw follow(w: whisker) {{ hold }}\n\
         initial Begin\nstate Begin {{ stop }}\nstate Go(w: whisker, far: length) {{\n  var worst = 0 rad\n  let dir = w.contour\n  \
         {inside}"
    )
}

#[test]
fn a_property_offers_families_and_their_parameters() {
    let property =
        |text: &str| labels(&format!("machine m\nparam speed = 1 m/s\ninitial S\nstate S {{ stop }}\nproperty {text}"));
    assert_eq!(property("\"title\" \u{a7}"), ["over"]);
    let families = property("\"title\" over \u{a7}");
    assert!(families.len() == 10 && families.contains(&"convex-corner".to_owned()), "{families:?}");
    assert_eq!(property("\"title\" over convex-co\u{a7}"), families);
    for place in ["(\u{a7}", "(angle in 30 deg .. 60 deg, \u{a7}", "(an\u{a7}) {\n  expect run.passed\n}"] {
        let parameters = property(&format!("\"title\" over convex-corner{place}"));
        assert!(
            parameters.contains(&"angle".to_owned()) && !parameters.contains(&"width".to_owned()),
            "{parameters:?}"
        );
    }
    assert_eq!(property("\"title\" over convex-corner(angle \u{a7}"), ["in"]);
    assert_eq!(property("\"title\" over nothing(\u{a7}"), [""; 0]);
    let inside = property("\"title\" over convex-corner {\n  \u{a7}");
    assert_eq!(inside, ["set", "expect"]);
    assert!(property("\"title\" over convex-corner {\n  expect run.\u{a7}").contains(&"passed".to_owned()));
}

#[test]
fn behind_a_point_come_the_members_of_what_stands_before_it() {
    let members = [
        "base_angle",
        "base_angle_deviation",
        "touching",
        "yaw",
        "side",
        "sense",
        "length",
        "tip",
        "tip_base",
        "tip_deviation",
        "recorded_deviation",
        "base",
        "fitted",
        "tip_at",
        "loop_closed",
        "contour",
    ];
    for place in [
        "w.\u{a7}",
        "w.ti\u{a7}p",
        "when r0.\u{a7}\n  when l0.touching -> Begin\n}",
        "when |w.\u{a7}",
        "record w.\u{a7}\n}",
    ] {
        assert_eq!(labels(&writing(place)), members, "{place}");
    }
    for place in ["let x = w.contour.\u{a7}", "steer body along r0.contour.\u{a7} at speed"] {
        assert_eq!(labels(&writing(place)), ["ready", "tangent", "normal", "end", "point", "curvature"], "{place}");
    }
    assert_eq!(
        labels(&writing("let x = body.\u{a7}")),
        [
            "yaw",
            "position",
            "blocked",
            "shortfall",
            "nose",
            "tail",
            "length",
            "width",
            "nose_width",
            "tail_width",
            "flexibility",
            "decay",
            "sway"
        ]
    );
    assert_eq!(labels(&writing("let x = w.tip.\u{a7}")), ["x", "y"]);
    for place in ["let x = speed.\u{a7}", "let x = 1.\u{a7}", "let x = nobody.\u{a7}"] {
        assert_eq!(labels(&writing(place)), [""; 0], "{place}");
    }
}

#[test]
fn behind_an_arrow_come_the_states_and_the_ends() {
    for place in
        ["when true -> \u{a7}", "when true -> B\u{a7}\n}", "after 5 s ->\u{a7}", "}\nalways when true -> \u{a7}"]
    {
        assert_eq!(labels(&writing(place)), ["Begin", "Go", "Success", "Failure"], "{place}");
    }
    assert_eq!(labels(&writing("}\ninitial \u{a7}")), ["Begin"]);
    assert_eq!(labels(&writing("do \u{a7}")), ["follow"]);
    assert_eq!(labels(&writing("set \u{a7}")), ["worst"]);
}

#[test]
fn a_contour_is_declared_and_recorded_by_its_words() {
    assert_eq!(labels(&writing("}\ncontour middle of 7 \u{a7}")), ["points"]);
    assert_eq!(labels(&writing("}\ncontour middle of \u{a7}")), [""; 0]);
    let has = |place: &str, word: &str| labels(&writing(place)).contains(&word.to_owned());
    assert!(has("}\n\u{a7}", "contour") && has("}\ncontour middle \u{a7}", "of"));
    assert!(has("}\ncontour middle of 7 points 5 mm \u{a7}", "apart") && has("record w.tip \u{a7}", "in"));
    assert_eq!(labels(&writing("record w.tip in \u{a7}\n}\ncontour middle\ncontour other")), ["middle", "other"]);
    assert_eq!(
        labels(&writing("let x = middle.\u{a7}\n}\ncontour middle")),
        ["ready", "tangent", "normal", "end", "point", "curvature"]
    );
}

#[test]
fn a_statement_a_transition_and_an_item_begin_with_their_words() {
    let has = |place: &str, word: &str| labels(&writing(place)).contains(&word.to_owned());
    for (place, yes, no) in [
        ("\u{a7}", "when", "param"),
        ("hold\n  \u{a7}", "steer", "law"),
        ("hold\n  st\u{a7}", "steer", "param"),
        ("hold\n  st\u{a7}", "state", "law"),
        ("hold\n  \u{a7}", "never", "use"),
        ("never w.touching \u{a7}", "for", "->"),
        ("always w.touching \u{a7}", "within", "->"),
        ("}\n\n\u{a7}", "assume", "when"),
        ("hold\n  \u{a7}", "failsafe", "use"),
        ("if true {\n \u{a7}", "record", "when"),
        ("entry {\n \u{a7}", "set", "when"),
        ("}\n\n\u{a7}", "param", "when"),
        ("}\n\nlaw other() {\n  \u{a7}", "steer", "when"),
        ("}\n\npa\u{a7}", "param", "steer"),
        ("steer body \u{a7}", "along", "at"),
        ("steer body along w.tip \u{a7}", "at", "along"),
        ("steer body along w.tip at speed \u{a7}", "facing", "at"),
        ("when w.touching \u{a7}", "->", "along"),
        ("when w.touching for 1 s \u{a7}", "->", "for"),
        ("if true { hold } \u{a7}", "else", "facing"),
        ("}\nparam x = 3 mm \u{a7}", "in", "when"),
        ("}\nneeds \u{a7}", "sample_age", "when"),
        ("}\nneeds sample_rate \u{a7}", "in", "when"),
        ("}\nalways \u{a7}", "when", "param"),
    ] {
        assert!(has(place, yes), "{place}: {:?}", labels(&writing(place)));
        assert!(!has(place, no), "{place}: {:?}", labels(&writing(place)));
    }
    assert_eq!(labels("\u{a7}"), ["machine", "library", "tests"]);
    assert_eq!(labels("library l\n\u{a7}"), ["use", "type", "let", "law", "behaviour", "monitor"]);
}

#[test]
fn a_value_is_one_that_is_known_at_the_place() {
    let has = |place: &str, word: &str| labels(&writing(place)).contains(&word.to_owned());
    for value in ["w", "far", "worst", "dir", "speed", "half", "r0", "l0", "time", "body", "not", "clamp", "pid"] {
        assert!(has("let x = \u{a7}", value), "{value}");
        assert!(has("let x = clamp(1, \u{a7}", value), "{value}");
    }
    // Transitions are tried before the statements, and other items do not know what a state does.
    assert!(!has("when \u{a7}", "dir") && has("when \u{a7}", "worst"));
    assert!(!has("}\nlet x = \u{a7}", "w") && !has("}\nlet x = \u{a7}", "worst") && has("}\nlet x = \u{a7}", "speed"));
    assert!(!has("let x = \u{a7}", "x") && !has("let x = \u{a7}", "Go"));
    assert!(!has("if true { let inner = 1 }\n let x = \u{a7}", "inner"));
    assert!(has("if true { let inner = 1\n let x = \u{a7}", "inner"));
}

#[test]
fn the_machines_memory_is_known_to_all_but_laws_and_derived_values() {
    let has = |place: &str, word: &str| {
        let text = format!("machine m\nvar met = 1\nparam p = 1 m\n{place}\n\nvar later = met\n");
        labels(&text).contains(&word.to_owned())
    };
    for place in ["state S { set \u{a7} = 1 }", "set \u{a7}", "if true {\n  set \u{a7}\n}"] {
        assert!(has(place, "met") && has(place, "later"), "{place}");
    }
    for place in
        ["always when \u{a7}", "state S {\n  when \u{a7}", "state S {\n  state T { var x = \u{a7}", "var x = \u{a7}"]
    {
        assert!(has(place, "met") && has(place, "p"), "{place}");
        // A `var` of the machine knows what stands above it, all others what stands below them, too.
        assert_eq!(has(place, "later"), !place.starts_with("var"), "{place}");
    }
    for place in [
        "let x = \u{a7}",
        "let x(a: length) = a + \u{a7}",
        "law l() {\n  if \u{a7}",
        "law l() {\n  if true {\n    let x = \u{a7}",
    ] {
        assert!(!has(place, "met") && has(place, "p"), "{place}");
    }
    assert!(!has("test \"t\" in \"s\" {\n  expect \u{a7}", "met"));
    for (place, word) in [("\u{a7}", "var"), ("se\u{a7}", "set"), ("var n = p\n\u{a7}", "if")] {
        assert!(has(place, word) && !has(place, "steer"), "{place}");
    }
}

#[test]
fn units_follow_numbers_and_types_follow_colons() {
    for place in ["let x = 50 \u{a7}", "let x = 50 m\u{a7}", "after 5 \u{a7}", "}\nparam x = 1 \u{a7}"] {
        let labels = labels(&writing(place));
        assert!(
            ["mm", "m", "urad", "ms", "mm/s", "deg/s", "N*m"].iter().all(|unit| labels.contains(&(*unit).to_owned()))
        );
    }
    let types = labels(&writing("}\nlaw other(a: \u{a7}"));
    assert!(types.contains(&"whisker".to_owned()) && types.contains(&"angular_speed".to_owned()));
    assert_eq!(labels(&writing("}\nlaw other(a: vector \u{a7}")), ["of"]);
    assert!(!labels(&writing("}\nlaw other(a: vector of \u{a7}")).contains(&"whisker".to_owned()));
}

#[test]
fn where_anything_may_be_written_nothing_is_offered() {
    for place in [
        "# w.\u{a7}",
        "when true -> Failure(\"w.\u{a7}\")",
        "let \u{a7}",
        "var x\u{a7}",
        "}\nlaw \u{a7}",
        "}\nlaw l(\u{a7}",
        "}\nparam x = \u{a7}",
        "let x = 50\u{a7}",
    ] {
        assert_eq!(labels(&writing(place)), [""; 0], "{place}");
    }
}

#[test]
fn a_use_is_completed_by_modules_and_by_the_names_of_the_file() {
    let modules = [
        "contact",
        "convexity",
        "corridor",
        "explore",
        "feelers",
        "first_contact",
        "following",
        "guards",
        "mounting",
        "object",
        "obstacle",
        "platform",
        "posture",
        "retrieval",
        "search",
        "senses",
        "shaft",
        "sweep",
        "swipe",
        "tracing",
        "tunnel",
    ];
    assert_eq!(labels("machine m\nuse \u{a7}"), modules.map(|module| format!("std.{module}")));
    assert_eq!(labels("machine m\nuse std.\u{a7}"), modules);
    assert_eq!(labels("machine m\nuse std.sw\u{a7}\nwhisker r0"), modules);
    let laws = ["strongest", "swipe", "swipe_tilted", "follow", "keep_bent", "slow_turn", "keenness", "nimble"];
    for list in ["(\u{a7}", "(\u{a7})", "(swipe, \u{a7})\nwhisker r0\n", "(sw\u{a7}"] {
        assert_eq!(labels(&format!("machine m\nuse std.swipe {list}")), laws, "{list}");
        assert_eq!(labels(&format!("machine m\nuse \"laws/corner.fsm\" {list}")), ["sharp", "wait"], "{list}");
    }
    let has = |text: &str, name: &str| labels(text).contains(&name.to_owned());
    let using = |inside: &str| USING.replace("  do wait(r0)\n", inside);
    assert!(has(&using("do \u{a7}"), "wait") && !has(&using("do \u{a7}"), "sharp"));
    assert!(has(&using("let x = \u{a7}\n"), "sharp") && has(&using("let x = \u{a7}\n"), "is_near"));
    // What the used file uses itself is not known.
    assert!(!has(&using("let x = \u{a7}\n"), "bent"));
}

#[test]
fn records_and_lists_offer_their_parts_and_are_types_and_values() {
    let with = |inside: &str| {
        let text = format!(
            "machine m\nwhisker w\ntype Spot(place: position, heading: angle)\ntype Spots = list of 4 Spot\ninitial S\n\
             var spot = Spot(w.tip, body.yaw)\nvar spots = Spots()\nstate S {{\n  {inside}\n}}\n"
        );
        labels(&text)
    };
    assert_eq!(with("set spot = Spot(spot.\u{a7}"), ["place", "heading"]);
    assert_eq!(with("let a = spots.\u{a7}"), ["count", "newest", "oldest", "element", "nearest", "with"]);
    assert_eq!(with("let a = spots.newest.\u{a7}"), ["place", "heading"]);
    assert_eq!(with("let a = spots.element(1).place.\u{a7}"), ["x", "y"]);
    assert!(with("let a = \u{a7}").contains(&"Spot".to_owned()));
    let types = labels("machine m\ntype Spot(place: position)\nlaw l(a: \u{a7}");
    assert!(["Spot", "position", "direction"].iter().all(|name| types.contains(&(*name).to_owned())), "{types:?}");
    assert_eq!(labels("machine m\ntype Spots = \u{a7}"), ["list"]);
    assert!(labels("machine m\ntype Spots = list of 4 \u{a7}").contains(&"position".to_owned()));
}
