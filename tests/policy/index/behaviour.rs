//! Behaviours and monitors: what their names mean, and what can be written about them.

use vibrissa_language::index::Index;

use super::candidate::{candidates, labels};
use super::policies::{gathered, index};

const TEXT: &str = "machine m
use \"laws/behaviours.fsm\" (creep)
whisker r0, l0
monitor felt(w: whisker) {
  var place = w.tip
  if w.touching { set place = w.tip }
}
monitor right is felt(r0)
behaviour follow(w: whisker) {
  exit edge(spot: position)
  exit lost
  initial Swiping
  state Swiping {
    stop
    when not w.touching for 100 ms -> exit edge(w.tip)
    after 5 s -> exit lost
  }
}
initial Creeping
state Creeping is creep(5 s, 1 mm/s) {
  on late -> Following(r0)
}
state Following(w: whisker) is follow(w) {
  on edge(place_of_it) -> Going(place_of_it)
  on lost -> Creeping
}
state Going(to: position) {
  stop
  when |to - right.place| < 1 mm -> Creeping
  after 1 s -> Failure(\"far\")
}
test \"t\" in \"a.yaml\" {
  expect run.visits(Following.Swiping) > 0
}
";

fn at(part: &str) -> usize {
    TEXT.find(part).unwrap()
}

#[test]
fn the_exit_of_a_used_behaviour_is_found_in_its_file() {
    let index = Index::new(&gathered(TEXT), None);
    let source = index.source();
    for (part, name) in [("creep(5", "creep"), ("late ->", "late")] {
        let place = index.definition(at(part)).unwrap();
        assert_eq!((source.part_name(source.part_at(place.start)), source.slice(place)), ("laws/behaviours.fsm", name));
    }
    assert_eq!(index.references(at("late ->")).len(), 1);
}

#[test]
fn a_name_in_a_behaviour_is_renamed_wherever_it_is_meant() {
    let index = Index::new(&gathered(TEXT), None);
    for (part, count) in [("edge(spot", 3), ("lost\n", 3), ("Swiping {", 3), ("follow(w: ", 2), ("place_of_it)", 2)] {
        let places = index.rename(at(part), "another").unwrap();
        assert_eq!(places.len(), count, "{part}");
        let mut text = TEXT.to_owned();
        for place in places.into_iter().rev() {
            text.replace_range(place.start..place.end, "another");
        }
        assert!(vibrissa_language::compile(&gathered(&text)).is_ok(), "{text}");
    }
    // The memory of a monitor is read by the name of its use.
    assert_eq!(index.references(at("place = w.tip\n")).len(), 3);
    assert_eq!(index.definition(at("place| < 1")).map(|place| place.start), Some(at("place = w.tip\n")));
}

#[test]
fn what_can_follow_is_offered() {
    let with = |part: &str, begin: &str| TEXT.replacen(part, begin, 1);
    assert_eq!(labels(&with("is follow(w) {", "is \u{a7} {")), ["follow", "creep"]);
    assert_eq!(labels(&with("on lost -> Creeping", "on \u{a7}")), ["edge", "lost"]);
    assert_eq!(labels(&with("-> exit lost", "-> exit \u{a7}")), ["edge", "lost"]);
    assert_eq!(labels(&with("right.place|", "right.\u{a7}|")), ["place"]);
    assert_eq!(labels(&with("is felt(r0)", "is \u{a7}")), ["felt"]);
    let targets = labels(&with("-> exit lost", "-> \u{a7}"));
    assert!(
        ["Swiping", "exit edge", "exit lost"].iter().all(|known| targets.contains(&(*known).to_owned())),
        "{targets:?}"
    );
    assert!(!targets.contains(&"Following".to_owned()), "{targets:?}");
    let outside = labels(&with("-> Failure(\"far\")", "-> \u{a7}"));
    assert!(outside.contains(&"Following".to_owned()) && !outside.contains(&"Swiping".to_owned()), "{outside:?}");
    let exit = candidates(&with("-> exit lost", "-> \u{a7}")).into_iter().find(|one| one.label == "exit edge").unwrap();
    assert_eq!(exit.snippet, "exit edge(${1:spot})");
}

#[test]
fn the_head_of_a_state_names_its_behaviour() {
    let hover = |part: &str| index(TEXT).hover(at(part)).unwrap().text;
    assert!(hover("Following(w: ").contains("state Following(w: whisker) is follow(w)"));
    assert!(hover("follow(w: ").contains("behaviour follow(w: whisker)"));
    assert!(hover("right is").contains("monitor right is felt(r0)"));
    assert!(hover("place_of_it) ->").contains("a position"));
}
