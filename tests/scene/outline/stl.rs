//! STL: cuts through meshes.

use vibrissa::geometry::{Contour, Point2, polygon};
use vibrissa::outline::{Format, OutlineError, OutlineFault, ReadOptions, read};

use super::{apart, folder};

fn cut(bytes: &[u8], height: f64) -> Result<Vec<Contour>, OutlineError> {
    read(bytes, Format::Stl, &ReadOptions { unit: Some(1e-3), element: None, height, ..ReadOptions::default() })
}

fn file(name: &str) -> Vec<u8> {
    std::fs::read(folder().join(name)).unwrap()
}

/// The triangles of a file of text, as three corners each.
fn triangles(text: &str) -> Vec<[[f32; 3]; 3]> {
    let vertices = text.lines().filter_map(|line| line.strip_prefix("vertex "));
    let vertices: Vec<[f32; 3]> = vertices
        .map(|line| line.split(' ').map(|number| number.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap())
        .collect();
    vertices.as_chunks().0.to_vec()
}

fn binary(triangles: &[[[f32; 3]; 3]], header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn text_and_binary_are_the_same_whatever_they_begin_with() {
    let text = String::from_utf8(file("star.stl")).unwrap();
    let [expected] = cut(text.as_bytes(), 0.01).unwrap().try_into().unwrap();
    let nameless = text.replace("solid part\n", "solid\n");
    let triangles = triangles(&text);
    for bytes in [nameless.into_bytes(), binary(&triangles, b"a header"), binary(&triangles, b"solid but binary")] {
        let [found] = cut(&bytes, 0.01).unwrap().try_into().unwrap();
        assert!(apart(&found, &expected) < 1e-12);
    }
}

#[test]
fn the_plane_may_lie_in_a_face_or_go_through_corners() {
    // What lies in the plane counts as above it: the top is cut, the bottom is not.
    assert_eq!(cut(&file("ell.stl"), 0.02).unwrap().len(), 1);
    for height in [0.0, 0.0201] {
        let missed = cut(&file("ell.stl"), height).unwrap_err();
        assert!(matches!(missed.fault, OutlineFault::Missed { .. }), "{missed}");
    }
    // Two pyramids, tip up and tip down, cut through all four corners of the square between them.
    let (tips, square) =
        ([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
    let sides = (0..4).flat_map(|k| tips.map(|tip| [square[k], square[(k + 1) % 4], tip]));
    let double = binary(&sides.collect::<Vec<_>>(), b"");
    let corners = square.map(|[x, y, _]| Point2::new(1e-3 * f64::from(x), 1e-3 * f64::from(y)));
    let [found] = cut(&double, 0.0).unwrap().try_into().unwrap();
    assert!(apart(&found, &polygon(&corners).unwrap()) < 1e-9);
    let [higher] = cut(&double, 0.0005).unwrap().try_into().unwrap();
    assert!((higher.area() - 0.25 * found.area()).abs() < 1e-15);
}

#[test]
fn a_mesh_with_a_hole_is_told_where_only_if_the_plane_goes_through_it() {
    let text = String::from_utf8(file("ell.stl")).unwrap();
    let all = triangles(&text);
    let without = |gone: usize| {
        let rest: Vec<_> = all.iter().enumerate().filter(|(index, _)| *index != gone).map(|(_, side)| *side).collect();
        cut(&binary(&rest, b""), 0.01)
    };
    for (index, triangle) in all.iter().enumerate() {
        let is_cut = triangle.iter().any(|corner| corner[2] > 10.0) && triangle.iter().any(|corner| corner[2] < 10.0);
        match without(index) {
            Ok(found) => assert!(!is_cut && found.len() == 1),
            Err(error) => assert!(is_cut && matches!(error.fault, OutlineFault::NotWatertight { .. }), "{error}"),
        }
    }
}

/// A box as a text without `solid`, from one corner (mm) to the opposite one.
fn mesh(from: [i32; 3], to: [i32; 3]) -> String {
    let corner = |index: usize| [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { from[axis] } else { to[axis] });
    let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let facet = |triangle: [&usize; 3]| {
        let vertices = triangle.map(|&index| {
            let [x, y, z] = corner(index);
            format!("vertex {x} {y} {z}\n")
        });
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", vertices.concat())
    };
    triangles.map(facet).collect()
}

/// The areas (mm²) of a cut in ascending order.
fn areas(text: &str) -> Result<Vec<f64>, OutlineError> {
    let mut areas: Vec<f64> =
        cut(text.as_bytes(), 0.01)?.iter().map(|contour| (contour.area() * 1e6).round()).collect();
    areas.sort_by(f64::total_cmp);
    Ok(areas)
}

#[test]
fn all_solids_of_a_file_are_read() {
    let [first, second, third] =
        [([0; 3], [100, 50, 20]), ([200, 0, 0], [230, 30, 20]), ([200, 100, 0], [210, 110, 20])]
            .map(|(a, b)| mesh(a, b));
    let solids = format!("solid a\n{first}endsolid a\n\nsolid\n{second}endsolid\nSolid c d\n{third}EndSolid c d\n");
    assert_eq!(areas(&solids).unwrap(), [100.0, 900.0, 5000.0]);
    // Two touch, and one is above the plane.
    let touching = format!(
        "solid a\n{}endsolid a\nsolid b\n{}endsolid b\nsolid c\n{}endsolid c\n",
        mesh([0; 3], [100, 50, 20]),
        mesh([100, 0, 0], [200, 50, 20]),
        mesh([0, 200, 15], [10, 210, 20])
    );
    assert_eq!(areas(&touching).unwrap(), [5000.0, 5000.0]);
    // One surface, of which each part is a solid, as programs of fluid dynamics write it, beside a solid that is closed.
    let parts: Vec<String> =
        first.split_inclusive("endfacet\n").map(|facet| format!("solid patch\n{facet}endsolid patch\n")).collect();
    assert_eq!(parts.len(), 12);
    assert_eq!(areas(&format!("{}solid b\n{second}endsolid b\n", parts.concat())).unwrap(), [900.0, 5000.0]);
    let leaky = parts.iter().take(11).map(String::as_str).collect::<String>();
    let error = areas(&format!("{leaky}solid b\n{second}endsolid b\n")).unwrap_err();
    assert!(matches!(error.fault, OutlineFault::NotWatertight { .. }), "{error}");
    // A solid in another is no object of its own.
    let inner = format!("solid a\n{first}endsolid a\nsolid b\n{}endsolid b\n", mesh([10, 10, 0], [20, 20, 20]));
    assert!(matches!(areas(&inner).unwrap_err().fault, OutlineFault::Hole { .. }));
}

#[test]
fn a_text_is_read_however_its_lines_and_words_are_written() {
    let facets = mesh([0; 3], [100, 50, 20]);
    let text = format!("solid part\n{facets}endsolid part\n");
    for same in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace('\n', "\r\r\n"),
        text.replace("normal 0 0 0", "normal -nan(ind) 1.#QNAN inf"),
        text.replace("normal 0 0 0\n", ""),
        text.replace("endloop", "END LOOP").replace("endfacet", "end  facet").replace("endsolid", "End Solid"),
        text.replace("\nvertex", " vertex").replace("\nouter", " outer").replace("\nendloop", "\tendloop"),
        text.replace("solid part\nfacet", "solid part facet"),
        text.replacen("solid part\n", "# written by hand\n\n  solid part, of facet 3\n// no normals\n", 1),
        text.replace(" 0 0 0", " +0.0 -0.0e+00 0E0"),
        format!("{text}\0\0\0"),
        text.replacen("solid part", "solid part\0\0", 1),
    ] {
        assert_eq!(areas(&same).unwrap(), [5000.0], "{}", &same[..90]);
    }
}

#[test]
fn a_text_that_is_not_complete_is_refused_at_its_line() {
    let facets = mesh([0; 3], [100, 50, 20]);
    let text = format!("solid part\n{facets}endsolid part\n");
    let line = |text: &str| {
        let error = areas(text).unwrap_err();
        assert!(matches!(error.fault, OutlineFault::Syntax { .. } | OutlineFault::FarOff), "{error}");
        error.line
    };
    assert_eq!(line(&text.replace("endsolid part\n", "")), Some(85));
    assert_eq!(line(&text.replacen("solid part\n", "solid part\ncolor 1 0 0\n", 1)), Some(2));
    assert_eq!(line(&text.replacen("vertex 0 0 0", "vertex 0 0", 1)), Some(5));
    assert_eq!(line(&text.replacen("vertex 0 0 0", "vertex 0 0,5 0", 1)), Some(4));
    assert_eq!(line(&text.replacen("vertex 0 0 0", "vertex 0 nan 0", 1)), Some(2));
    assert_eq!(line(&text.replacen("vertex 0 0 0", "vertex 0 \0 0", 1)), Some(4));
    assert_eq!(line(&text.replacen("endloop", "vertex 0 0 0\nendloop", 1)), Some(7));
    assert_eq!(line(&format!("{text}facet normal 0 0 0\n")), Some(87));
    assert_eq!(
        line(&text.replacen("solid part", "solid part ; vertex 0 0 0", 1).replacen("outer", "inner", 1)),
        Some(3)
    );
}

#[test]
fn a_binary_file_has_as_many_triangles_as_it_says() {
    let star = triangles(&String::from_utf8(file("star.stl")).unwrap());
    let bytes = binary(&star, b"solid but binary");
    let padded = [bytes.as_slice(), &[0; 60]].concat();
    assert_eq!(cut(&padded, 0.01).unwrap().len(), 1);
    let count = |bytes: &[u8], count: u32| [&bytes[..80], &count.to_le_bytes(), &bytes[84..]].concat();
    let all = u32::try_from(star.len()).unwrap();
    let coloured = [bytes.as_slice(), b"a further part"].concat();
    for wrong in
        [count(&bytes, 0), count(&bytes, all - 1), count(&bytes, all + 1), bytes[..bytes.len() - 1].to_vec(), coloured]
    {
        let error = cut(&wrong, 0.01).unwrap_err().to_string();
        assert!(error.contains("the number of triangles is"), "{error}");
    }
    let wide: Vec<u8> = "\u{feff}solid part\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(cut(&wide, 0.01).unwrap_err().to_string().contains("UTF-16"));
    let error = cut(b"a text of another program", 0.01).unwrap_err().to_string();
    assert!(error.contains("it is no STL"), "{error}");
}
