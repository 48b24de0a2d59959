//! Guards, and the modules as such.

use std::f64::consts::PI;

use vibrissa_language::{Checked, check};
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_text::diagnostic::Source;

use super::felt::{Felt, swiping};
use super::law::machine;

pub(crate) fn holds(guard: &str, whisker: usize, felt: &Felt) -> bool {
    let mut machine = machine(whisker, &format!("stop when {guard} -> Yes }} state Yes {{ stop"));
    machine.tick(&mut { *felt });
    machine.state_name() == "Yes"
}

#[test]
fn every_module_is_sound_by_itself_and_needs_nothing_that_it_does_not_use() {
    for module in ["guards", "mounting", "platform", "retrieval", "swipe", "tunnel"] {
        let text =
            std::fs::read_to_string(format!("{}/../../policies/std/{module}.fsm", env!("CARGO_MANIFEST_DIR"))).unwrap();
        let checked = check(&Source::new(module, text)).unwrap();
        let Checked::Library { name, warnings, .. } = checked else { panic!("{module}") };
        assert_eq!(name, module);
        assert!(warnings.is_empty(), "{warnings:?}");
    }
}

#[test]
fn guards_hold_when_they_say() {
    for whisker in [0, 1] {
        let (bent, back, free) = (swiping(whisker, 1.0), swiping(whisker, -1.0), Felt::at(Pose::default()));
        assert!(holds("lost(w)", whisker, &free) && !holds("lost(w)", whisker, &bent));
        assert!(holds("bent_wrong_way(w)", whisker, &back) && !holds("bent_wrong_way(w)", whisker, &bent));
        assert!(!holds("bent_wrong_way(w)", whisker, &free));
        for felt in [&bent, &back] {
            assert!(holds("at_limit(w, 299 urad)", whisker, felt) && !holds("at_limit(w, 301 urad)", whisker, felt));
        }
        assert!(!holds("same_sense(v, w)", whisker, &bent), "one of them is free");
        let mut both = bent;
        both.whiskers[1 - whisker] = swiping(1 - whisker, 0.5).whiskers[1 - whisker];
        assert!(holds("same_sense(v, w)", whisker, &both));
        both.whiskers[whisker].base_angle *= -1.0;
        assert!(!holds("same_sense(v, w)", whisker, &both));
        let turned = Felt::at(Pose { position: Point2::new(0.1, 0.0), heading: PI - 0.01 });
        assert!(holds("is_facing(-179 deg, 2 deg)", whisker, &turned));
        assert!(!holds("is_facing(-179 deg, 1 deg)", whisker, &turned));
        assert!(holds("is_near(body.position, position(0.1 m, 3 mm), 4 mm)", whisker, &turned));
        assert!(!holds("is_near(body.position, position(0.1 m, 5 mm), 4 mm)", whisker, &turned));
    }
}
