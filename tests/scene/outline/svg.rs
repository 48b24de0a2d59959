//! SVG, element by element.

use std::f64::consts::PI;

use vibrissa::geometry::{Contour, Point2, circle};
use vibrissa::outline::{Format, Holes, OutlineError, OutlineFault, ReadOptions, read};

use super::apart;

fn all(inner: &str, request: &ReadOptions<'_>) -> Result<Vec<Contour>, OutlineError> {
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\n{inner}\n</svg>");
    read(text.as_bytes(), Format::Svg, request)
}

const MILLIMETRES: ReadOptions<'_> = ReadOptions { unit: Some(1e-3), element: None, height: 0.0, holes: Holes::Refuse };

fn one(inner: &str) -> Contour {
    let [contour] = all(inner, &MILLIMETRES).unwrap().try_into().unwrap();
    contour
}

/// The disk of 30 mm about (40 mm, 50 mm) in the file.
fn disk() -> Contour {
    circle(Point2::new(0.04, -0.05), 0.03).unwrap()
}

#[test]
fn a_circle_is_a_circle_however_it_is_drawn() {
    let drawings = [
        "<circle cx='40' cy='50' r='30'/>",
        "<ellipse cx='40' cy='50' rx='30' ry='30'/>",
        "<path d='M 70 50 A 30 30 0 0 1 10 50 A 30 30 0 0 1 70 50 Z'/>",
        "<path d='M 70 50 a 30 30 0 1 0 -30 30 30 30 0 0 0 30 -30'/>",
        "<rect x='10' y='20' width='60' height='60' rx='30'/>",
        "<g transform='translate(40 50) rotate(33)'><circle r='3' transform='scale(-10 10)'/></g>",
        "<ellipse cx='4' cy='25' rx='3' ry='15' transform='scale(10 2)'/>",
        "<circle cx='4cm' r='3cm' cy='5cm' transform='scale(0.26458333333333334)'/>",
        "<defs><circle id='c' r='30'/></defs><use href='#c' x='40' y='50'/>",
        "<symbol id='s'><circle r='30'/></symbol><use href='#s' transform='translate(40,50)'/>",
    ];
    for drawing in drawings {
        let found = one(drawing);
        assert!(apart(&found, &disk()) < 1e-9, "{drawing}: {} m", apart(&found, &disk()));
        assert!(found.pieces().iter().all(|piece| (piece.curvature() - 1.0 / 0.03).abs() < 1e-6), "{drawing}");
    }
}

#[test]
fn curves_are_followed_to_a_micrometre() {
    // A parabola over a chord: two thirds of the triangle of its control points.
    let parabola = one("<path d='M 0 0 Q 50 80 100 0 Z'/>");
    assert!((parabola.area() - 2.0 / 3.0 * 0.5 * 0.1 * 0.08).abs() < 1e-7);
    for k in 0..=100 {
        let x = f64::from(k) / 100.0;
        let place = Point2::new(0.1 * x, -0.16 * x * (1.0 - x));
        assert!(parabola.nearest(place).distance < 1.1e-6);
    }
    // The same in two, the second smooth behind the first.
    let halves = one("<path d='M 0 0 Q 25 40 50 40 T 100 0 Z'/>");
    assert!(apart(&halves, &parabola) < 2.2e-6);
    let raised = one(
        "<path d='M 0 0 C 16.6666666667 26.6666666667 33.3333333333 40 50 40 S 83.3333333333 26.6666666667 100 0 Z'/>",
    );
    assert!(apart(&raised, &parabola) < 2.2e-6);
    let ellipse = one("<ellipse cx='50' cy='50' rx='40' ry='15' transform='rotate(20)'/>");
    assert!((ellipse.area() - PI * 0.04 * 0.015).abs() < 1e-7 && ellipse.corners().is_empty());
}

#[test]
fn what_is_not_to_be_seen_is_left_out_unless_it_is_asked_for() {
    let drawing =
        "<circle r='5'/><g id='more' style='display: none'><circle cx='20' r='5'/><circle cx='40' r='5'/></g>";
    assert_eq!(all(drawing, &MILLIMETRES).unwrap().len(), 1);
    assert_eq!(all(drawing, &ReadOptions { element: Some("more"), ..MILLIMETRES }).unwrap().len(), 2);
}

#[test]
fn what_is_hidden_is_left_out_however_that_is_said() {
    let hidden = [
        "<circle cx='20' r='5' display='none'/>",
        "<circle cx='20' r='5' style='Display : NONE !important; fill: red'/>",
        "<circle cx='20' r='5' style='display: none ! important; display: inline'/>",
        "<circle cx='20' r='5' display='inline' style='display:none'/>",
        "<circle cx='20' r='5' visibility='hidden'/>",
        "<circle cx='20' r='5' style='visibility: collapse'/>",
        "<g visibility='hidden'><g><circle cx='20' r='5'/></g></g>",
        "<defs><circle id='c' r='5'/></defs><use href='#c' x='20' visibility='hidden'/>",
        "<symbol id='s' visibility='hidden'><circle r='5'/></symbol><use href='#s' x='20'/>",
    ];
    for drawing in hidden {
        let found = all(&format!("<circle r='5'/>{drawing}"), &MILLIMETRES).unwrap();
        assert_eq!(found.len(), 1, "{drawing}");
    }
    let shown = [
        "<circle cx='20' r='5' display='none' style='display:inline'/>",
        "<circle cx='20' r='5' style='display:none; display:inline'/>",
        "<g visibility='hidden'><circle cx='20' r='5' visibility='visible'/></g>",
        "<circle cx='20' r='5' clip-path='none' style='mask: none'/>",
    ];
    for drawing in shown {
        let found = all(&format!("<circle r='5'/>{drawing}"), &MILLIMETRES).unwrap();
        assert_eq!(found.len(), 2, "{drawing}");
    }
    // What is asked for is taken, be it visible or not.
    let asked = ReadOptions { element: Some("c"), ..MILLIMETRES };
    assert_eq!(all("<g visibility='hidden'><circle id='c' r='5' visibility='hidden'/></g>", &asked).unwrap().len(), 1);
}

#[test]
fn an_element_lies_where_its_ancestors_put_it() {
    let drawing =
        "<circle r='500'/><g transform='scale(10)'><g transform='translate(4 5)'><circle id='c' r='3'/></g></g>";
    let [found] = all(drawing, &ReadOptions { element: Some("c"), ..MILLIMETRES }).unwrap().try_into().unwrap();
    assert!(apart(&found, &disk()) < 1e-12);
}

#[test]
fn paper_and_view_box_say_what_a_unit_is_and_the_scenario_overrules_them() {
    let width = |paper: &str, unit| {
        let text = format!("<svg {paper} viewBox='0 0 200 100'><rect width='10' height='10'/></svg>");
        let outlines = read(text.as_bytes(), Format::Svg, &ReadOptions { unit, ..ReadOptions::default() });
        outlines.map(|outlines| outlines[0].bounding_box().max.x)
    };
    assert!((width("width='100mm' height='5cm'", None).unwrap() - 0.005).abs() < 1e-15);
    assert!((width("width='2in' height='1in'", None).unwrap() - 0.00254).abs() < 1e-15);
    assert!((width("width='100mm' height='5cm'", Some(1e-3)).unwrap() - 0.01).abs() < 1e-15);
    for (unknown, words) in [
        ("", "`width` is missing"),
        ("width='100' height='50'", "`width` is `100`, which is no physical length"),
        ("width='100mm'", "`height` is missing"),
        ("width='100%' height='100%'", "`width` is `100%`"),
        ("width='200mm' height='100px'", "`height` is `100px`, which is no physical length"),
        ("width='2dm' height='1dm'", "`width` is `2dm`"),
        ("width='-2mm' height='1mm'", "`width` is `-2mm`"),
    ] {
        let fault = width(unknown, None).unwrap_err().fault;
        let OutlineFault::NoLength { .. } = fault else { panic!("{unknown}: {fault:?}") };
        assert!(fault.to_string().contains("does not state its unit") && fault.to_string().contains(words), "{fault}");
    }
    let boxless = b"<svg width='20mm' height='10mm'><rect width='10' height='10'/></svg>";
    assert_eq!(read(boxless, Format::Svg, &ReadOptions::default()).unwrap_err().fault, OutlineFault::NoViewBox);
}

#[test]
fn a_drawing_is_fitted_into_its_frame_and_a_unit_has_any_case() {
    let bounds = |frame: &str| {
        let text = format!("<svg {frame} viewBox='0 0 200 100'><rect width='10' height='10'/></svg>");
        let outlines = read(text.as_bytes(), Format::Svg, &ReadOptions::default()).unwrap();
        let size = outlines[0].bounding_box();
        let lengths = [size.max.x - size.min.x, size.max.y - size.min.y];
        lengths.iter().map(|length| (length * 1e9).round() / 1e6).collect::<Vec<f64>>()
    };
    assert_eq!(bounds("width='100mm' height='60mm'"), [5.0, 5.0]);
    assert_eq!(bounds("width='200mm' height='60mm' preserveAspectRatio='xMinYMax meet'"), [6.0, 6.0]);
    assert_eq!(bounds("width='100mm' height='60mm' preserveAspectRatio='xMidYMid slice'"), [6.0, 6.0]);
    assert_eq!(bounds("width='100mm' height='60mm' preserveAspectRatio='none'"), [5.0, 6.0]);
    for same in [
        "width='100MM' height='5Cm'",
        "width=' 100 mm ' height='50mm'",
        "width='400Q' height='200q'",
        "style='width: 100mm; height: 50mm'",
        "width='7' height='8' style='width:100mm;height:50mm'",
    ] {
        assert_eq!(bounds(same), [5.0, 5.0], "{same}");
    }
}

#[test]
fn what_is_not_painted_is_no_object() {
    let unseen = [
        "<circle cx='20' r='5' fill='none'/>",
        "<circle cx='20' r='5' fill='transparent'/>",
        "<circle cx='20' r='5' style='FILL: None'/>",
        "<circle cx='20' r='5' fill='red' style='fill:none'/>",
        "<circle cx='20' r='5' fill='#f000'/>",
        "<circle cx='20' r='5' fill='rgba(1, 2, 3, 0)'/>",
        "<circle cx='20' r='5' fill-opacity='0'/>",
        "<circle cx='20' r='5' style='fill-opacity:0%'/>",
        "<circle cx='20' r='5' fill='url(#gone)'/>",
        "<circle cx='20' r='5' fill='none' stroke='none'/>",
        "<circle cx='20' r='5' fill='none' stroke='red' stroke-width='0'/>",
        "<circle cx='20' r='5' fill='none' stroke='red' stroke-width='0px'/>",
        "<circle cx='20' r='5' fill='none' stroke='red' stroke-opacity='0.0'/>",
        "<circle cx='20' r='5' opacity='0'/>",
        "<g opacity='0'><circle cx='20' r='5' opacity='1' fill='red'/></g>",
        "<g fill='none'><g stroke-width='1'><circle cx='20' r='5'/></g></g>",
        "<g fill='none'><circle cx='20' r='5' fill='inherit'/></g>",
        "<g fill='none' stroke='red'><circle cx='20' r='5' stroke='none'/></g>",
        "<line x1='20' x2='30' y2='5'/>",
        "<defs><circle id='c' r='5'/></defs><use href='#c' x='20' fill='none'/>",
        "<defs><g fill='red'><circle id='c' r='5'/></g></defs><g fill='none'><use href='#c' x='20'/></g>",
        "<symbol id='s' opacity='0'><circle r='5'/></symbol><use href='#s' x='20'/>",
        "<symbol id='s' fill='none'><circle r='5'/></symbol><use href='#s' x='20'/>",
    ];
    for drawing in unseen {
        let found = all(&format!("<circle r='5'/>{drawing}"), &MILLIMETRES).unwrap();
        assert_eq!(found.len(), 1, "{drawing}");
    }
    let seen = [
        "<circle cx='20' r='5' fill='none' stroke='red'/>",
        "<circle cx='20' r='5' fill='none' stroke='#000' stroke-width='0.01'/>",
        "<circle cx='20' r='5' fill='none' style='stroke: currentColor'/>",
        "<circle cx='20' r='5' fill='white'/>",
        "<circle cx='20' r='5' fill='#FFF8'/>",
        "<circle cx='20' r='5' fill='url(#gone) blue'/>",
        "<pattern id='p'/><circle cx='20' r='5' fill='url(#p)'/>",
        "<circle cx='20' r='5' fill='no colour'/>",
        "<circle cx='20' r='5' fill='none' style='fill:red'/>",
        "<g fill='none'><circle cx='20' r='5' fill='initial'/></g>",
        "<g fill='none' stroke='red'><g><circle cx='20' r='5'/></g></g>",
        "<g fill-opacity='0'><circle cx='20' r='5' fill-opacity='0.1'/></g>",
        "<circle cx='20' r='5' opacity='1%'/>",
        "<defs><circle id='c' r='5' fill='red'/></defs><use href='#c' x='20' fill='none'/>",
        "<defs><g fill='none'><circle id='c' r='5'/></g></defs><use href='#c' x='20'/>",
    ];
    for drawing in seen {
        let found = all(&format!("<circle r='5'/>{drawing}"), &MILLIMETRES).unwrap();
        assert_eq!(found.len(), 2, "{drawing}");
    }
}

#[test]
fn a_style_sheet_holds_for_the_elements_that_it_names() {
    let count = |sheet: &str, shape: &str| {
        let drawing = format!("<style type='text/css'>{sheet}</style><circle id='c' r='5'/>{shape}");
        all(&drawing, &MILLIMETRES).unwrap().len()
    };
    let other = "<g class='a b'><path class='cls-1 frame' d='M20 0h9v9z'/></g>";
    for sheet in [
        ".cls-1 { fill: none; }",
        ".x,.cls-1,.y{fill:none}",
        "path { display: none }",
        ".b { opacity: 0 }",
        "/* a frame */ path.frame { fill : NONE }\n.cls-2 {fill: red}",
        ".cls-1 { fill: red } .cls-1.frame { fill: none } path { fill: blue }",
        ".cls-1 { fill: none !important } .frame { fill: red }",
        "* { visibility: hidden } #c { visibility: visible }",
        "<![CDATA[ .frame { fill: red; fill: none; } ]]>",
    ] {
        assert_eq!(count(sheet, other), 1, "{sheet}");
    }
    for sheet in [
        "",
        " /* nothing */ ",
        ".cls { fill: none }",
        "rect { fill: none }",
        ".cls-1 { fill: none; stroke: red }",
        ".cls-1 { fill: none } .frame { fill: red }",
        ".cls-1 { fill: red } * { fill: none } circle { fill: red }",
    ] {
        assert_eq!(count(sheet, other), 2, "{sheet}");
    }
    assert_eq!(count(".f { fill: none }", "<rect class='f' width='9' height='9' style='fill:red' x='20'/>"), 2);
    assert_eq!(count(".f { fill: red }", "<rect class='f' width='9' height='9' fill='none' x='20'/>"), 2);
    for sheet in [
        "@import 'a.css';",
        "@media print { .a { fill: none } }",
        "g path { fill: none }",
        "path:hover { fill: none }",
        "[id] { fill: none }",
        ".a { fill: none",
        ".a { fill: none } /* open",
        ".\\61 { fill: none }",
        ".a { fill: none } b",
    ] {
        let error = all(&format!("<style>{sheet}</style><circle r='5'/>"), &MILLIMETRES).unwrap_err();
        assert!(matches!(error.fault, OutlineFault::Unsupported { .. }) && error.line == Some(2), "{sheet}: {error}");
    }
    let moved = "<style>.a { transform: scale(2) }</style><circle class='a' r='5'/>";
    let wide = "<style>.a { width: 20px }</style><rect class='a' width='5' height='5'/>";
    for drawing in [moved, wide] {
        let error = all(drawing, &MILLIMETRES).unwrap_err();
        assert!(matches!(error.fault, OutlineFault::Unsupported { .. }), "{drawing}: {error}");
    }
    let (rules, long) = (".a { fill: none } ".repeat(1000), "fill: red; ".repeat(10_000));
    for crowd in [
        format!("<style>{rules}</style>{}", "<g/>".repeat(10_000)),
        format!("<style>{}a {{ fill: none }}</style><g class='{}'/>", ".a,".repeat(1000), "b ".repeat(100_000)),
        format!("<style>.a {{ {long} }}</style>{}", "<g class='a'/>".repeat(1000)),
        format!("<style>{}a {{ fill: none }}</style>", "a,".repeat(10_000)),
    ] {
        assert!(matches!(all(&crowd, &MILLIMETRES).unwrap_err().fault, OutlineFault::TooLarge { .. }));
    }
}

#[test]
fn what_is_asked_for_is_read_without_paint_only_if_nothing_in_it_has_any() {
    let frame = "<g id='icon' fill='none'><rect id='frame' width='24' height='24'/>";
    let asked = |drawing: &str, element| all(drawing, &ReadOptions { element: Some(element), ..MILLIMETRES });
    assert_eq!(asked(&format!("{frame}<circle fill='red' r='5'/></g>"), "icon").unwrap().len(), 1);
    assert_eq!(asked(&format!("{frame}</g>"), "icon").unwrap().len(), 1);
    assert_eq!(asked(&format!("{frame}</g>"), "frame").unwrap().len(), 1);
    let error = all(&format!("{frame}</g>"), &MILLIMETRES).unwrap_err();
    assert_eq!(error.fault, OutlineFault::Invisible { unseen: 1 });
}

#[test]
fn a_fault_has_its_line() {
    let line = |inner: &str| all(inner, &MILLIMETRES).unwrap_err().line;
    assert_eq!(line("<circle r='5'/>\n<g>\n<path d='M 0 0 L 9 9'/></g>"), Some(4));
    assert_eq!(line("<circle r='5'/>\n<circle r='2'/>"), Some(3));
    assert_eq!(line("<g transform='turn(3)'>\n<circle r='5'/></g>"), Some(2));
    assert_eq!(line("<circle r='5'>"), Some(3));
}
