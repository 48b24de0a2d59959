//! CSV, line by line.

use vibrissa::outline::{Format, OutlineError, OutlineFault, ReadOptions, read};

/// The areas (mm²) of the polygons of a text in their order.
fn areas(text: &str) -> Result<Vec<f64>, OutlineError> {
    let options = ReadOptions { unit: Some(1e-3), ..ReadOptions::default() };
    let contours = read(text.as_bytes(), Format::Csv, &options)?;
    Ok(contours.iter().map(|contour| (contour.area() * 1e9).round() / 1e3).collect())
}

#[test]
fn a_polygon_is_read_however_its_cells_are_written() {
    for text in [
        "0,0\n10,0\n10,5\n0,5\n",
        "\u{feff}x,y\r\n0,0\r\n10,0\r\n10,5\r\n0,5\r\n0,0\r\n",
        "0,0\r10,0\r10,5\r0,5",
        "\n\n  \n0 , 0\n 10,0\n10,5 \n0,5\n\n\n",
        "x;y\n0;0\n10;0\n10;5\n0;5\n",
        "sep=;\nx;y\n0;0\n10;0\n10;5\n0;5\n",
        "0,0;0,0\n1,0e1;0\n10;5,00\n0;5.0\n",
        "x\ty\n0\t0\n10,0\t0\n10\t5\n0\t5\n",
        "0 0\n10   0\n10 5\n0 5\n",
        "\"x (mm)\",\"y (mm)\"\n\"0\",\"0\"\n\"10\", \"0\"\n10,\"5\"\n0,5\n",
        "# a rectangle\n0,0\n10,0\n  # the rest\n10,5\n0,5\n#\n",
        "0,0,\n10,0,\n10,5,,\n0,5\n,\n;;\n",
        "x,y\n\n0,0\n10,0\n10,5\n0,5\n",
        "0,0\n0,0\n10,0\n10,5\n0,5\n",
    ] {
        assert_eq!(areas(text).unwrap(), [50.0], "{text:?}");
    }
}

#[test]
fn a_blank_line_separates_polygons() {
    let both = [50.0, 25.0];
    assert_eq!(areas("0,0\n10,0\n10,5\n0,5\n\n20,0\n25,0\n25,5\n20,5\n").unwrap(), both);
    assert_eq!(areas("0,0\n10,0\n10,5\n0,5\n0,0\n,\n\n\n20,0\n25,0\n25,5\n20,5\n20,0").unwrap(), both);
    assert_eq!(areas("x,y\n0,0\n10,0\n10,5\n0,5\n \nx,y\n20,0\n25,0\n25,5\n20,5\n").unwrap(), both);
    // The gap is in a polygon, and not between two.
    let error = areas("0,0\n10,0\n10,5\n\n0,5\n").unwrap_err();
    assert_eq!((error.fault, error.line), (OutlineFault::Corners { count: 1 }, Some(5)));
}

#[test]
fn a_comment_after_a_possible_end_of_a_polygon_merges_nothing_silently() {
    for text in [
        "0,0\n10,0\n10,5\n0,5\n# second\n20,0\n25,0\n25,5\n20,5\n",
        "x,y\n0,0\n10,0\n10,5\n0,5\n  # a\n# b\n20,0\n25,0\n25,5\n",
    ] {
        let error = areas(text).unwrap_err();
        assert!(matches!(&error.fault, OutlineFault::Syntax { reason } if reason.contains("blank line")), "{error}");
        let comments = text.lines().enumerate().filter(|(_, line)| line.contains('#'));
        assert_eq!(error.line, comments.last().map(|(index, _)| index + 1));
        assert_eq!(areas(&text.replacen('#', "\n#", 1)).unwrap().len(), 2, "with a blank line they are two");
    }
    assert_eq!(areas("0,0\n10,0\n10,5\n0,5\n# the end\n").unwrap(), [50.0]);
}

#[test]
fn what_is_no_corner_is_refused_at_its_line() {
    for (text, line) in [
        ("0,0\n10,0\n10,5\n0,5,7\n", 4),
        ("0,0\n10,0\n10,5\nx,y\n0,5\n", 4),
        ("nan,nan\n0,0\n10,0\n10,5\n", 1),
        ("0,0\n10,0\n10,5\n0;5\n", 4),
        ("\"1,000\",0\n\"2,000\",0\n10,5\n", 1),
        ("1.000,5;0\n10;0\n10;5\n", 1),
        ("0,0\n10,0\n10,5\n0,5 mm\n", 4),
        ("0,0\n10,0\n10,\"5\n0,5\"\n", 3),
        ("// no comment\n0,0\n10,0\n10,5\n", 1),
        ("0\n1\n2\n", 1),
    ] {
        let error = areas(text).unwrap_err();
        assert!(matches!(error.fault, OutlineFault::Syntax { .. } | OutlineFault::FarOff), "{text:?}: {error}");
        assert_eq!(error.line, Some(line), "{text:?}: {error}");
    }
    assert_eq!(areas("x,y\n").unwrap_err().fault, OutlineFault::Corners { count: 0 });
}
