//! Where names are given.

use vibrissa_language::check;
use vibrissa_language::index::{Index, RenameError};
use vibrissa_text::diagnostic::{Source, Span};

use super::policies::{SWIPE, USING, gathered, index, policies};

#[test]
fn every_place_of_a_name_leads_to_where_it_is_given_and_is_explained() {
    for (name, text) in policies() {
        let index = Index::new(&gathered(&text), None);
        for symbol in index.symbols() {
            let places = index.references(symbol.span.start);
            for (place, _) in places {
                assert_eq!(index.definition(place.start), Some(symbol.span), "{name}, {}", symbol.name);
                assert_eq!(index.definition(place.end), Some(symbol.span), "{name}, {}", symbol.name);
                let hover = index.hover(place.start).unwrap();
                assert_eq!((hover.span, hover.text.contains(&symbol.name)), (place, true), "{name}");
            }
        }
    }
}

#[test]
fn a_text_with_a_fault_is_known_but_for_the_fault() {
    let good = index(SWIPE);
    let broken = SWIPE.replace("let tangent = w.contour.tangent", "let tangent = w.contour.");
    let before = Index::new(&Source::new("swipe.fsm", broken.as_str()), Some(&good));
    let names = |index: &Index| index.symbols().iter().map(|symbol| symbol.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&before), names(&good));
    let at = broken.find("do swipe_tilted").unwrap() + 3;
    let given = broken.find("swipe_tilted(w: ").unwrap();
    assert_eq!(before.definition(at), Some(Span::new(given, given + "swipe_tilted".len())));
    // What the fault leaves has its types; for the rest, types of before are remembered.
    let pull = broken.find("pull) at speed").unwrap();
    assert!(index(&broken).hover(pull).unwrap().text.contains("a plain number"));
    let tangent = broken.find("tangent, unit(miss)").unwrap();
    assert!(before.hover(tangent).unwrap().text.contains("a direction"));
    assert!(!index(&broken).hover(tangent).unwrap().text.contains("a direction"));
    assert_eq!(before.rename(at, "other"), Err(RenameError::Unreadable));
    // A fault of meaning hides no place of a name.
    let wrong = SWIPE.replace("0 deg)", "0 mm)");
    assert!(check(&Source::new("a", wrong.as_str())).is_err());
    assert_eq!(
        index(&wrong).rename(wrong.find("swipe_tilted(w: ").unwrap(), "other").map(|places| places.len()),
        Ok(2)
    );
}

#[test]
fn a_state_within_another_is_found_by_its_path_and_knows_what_the_other_knows() {
    let text = "machine m\nwhisker r0\ninitial A\nstate A {\n  when r0.touching -> Outer(r0).Inner\n}\n\nstate Outer(w: whisker) {\n  var n = 0\n  \
                state Inner {\n    when w.touching -> A\n    set n = n + 1\n  }\n}\n";
    let index = index(text);
    let inner = index.symbols().iter().find(|symbol| symbol.name == "Inner").unwrap();
    assert_eq!(inner.owner.map(|owner| index.symbols()[owner].name.as_str()), Some("Outer"));
    assert_eq!(index.definition(text.find("Inner").unwrap()), Some(inner.span));
    assert_eq!(index.references(text.find("w: ").unwrap()).len(), 2);
    assert_eq!(index.references(text.find("n = 0").unwrap()).len(), 3);
}

#[test]
fn names_of_other_files_lead_there_and_are_explained() {
    let index = Index::new(&gathered(USING), None);
    let at = |part: &str| USING.find(part).unwrap();
    let source = index.source();
    for part in ["wait(r0", "wait, sharp"] {
        let place = index.definition(at(part)).unwrap();
        assert_eq!(source.part_name(source.part_at(place.start)), "laws/corner.fsm");
        assert_eq!(source.slice(place), "wait");
        let hover = index.hover(at(part)).unwrap().text;
        assert_eq!(hover, "```fsm\nlaw wait(w: whisker)\n```\n\nStops, and says nothing.\n\nfrom `laws/corner.fsm`");
        assert_eq!(index.references(at(part)).len(), 2);
    }
    let corner = source.part_at(index.definition(at("wait(r0")).unwrap().start);
    assert_eq!(
        index.definition(at("\"laws")),
        Some(Span::new(source.part_span(corner).start, source.part_span(corner).start))
    );
    assert!(index.hover(at("sharp\n")).unwrap().text.contains("an angle"));
    assert!(index.hover(at("blunt =")).unwrap().text.contains("an angle"));
    // The file that the used one uses.
    let signs = (1..source.count()).find(|&part| source.part_name(part) == "laws/signs.fsm").unwrap();
    assert_eq!(index.use_leading_to(signs).map(|way| source.slice(way).trim_matches('"')), Some("laws/corner.fsm"));
    assert_eq!(index.use_leading_to(0), None);
    // What another file gives can be renamed, and is the same there.
    let origin = index.origin(at("wait(r0")).unwrap();
    assert_eq!((origin.file.as_str(), index.rename(at("wait(r0"), "x").unwrap().len()), ("laws/corner.fsm", 2));
    let corner = Index::new(&Source::new("laws/corner.fsm", source.slice(source.part_span(corner))), None);
    assert_eq!(corner.references_to(&origin).len(), 1);
    assert_eq!(corner.origin(corner.references_to(&origin)[0].0.start), Some(origin));
    assert!(matches!(index.rename(at("blunt ="), "is_near"), Err(RenameError::Imported { .. })));
}
