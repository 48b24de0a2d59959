//! STL: cuts through meshes.

use vibrissa::geometry::{Contour, Point2, polygon};
use vibrissa::outline::{Format, OutlineError, OutlineFault, ReadOptions, read};

use super::{apart, folder};

fn cut(bytes: &[u8], height: f64) -> Result<Vec<Contour>, OutlineError> {
    read(bytes, Format::Stl, &ReadOptions { unit: Some(1e-3), element: None, height })
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
