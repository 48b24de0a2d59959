//! `vibrissa calibrate`, from touches that were measured.

use super::program::{directory, stderr, stdout, vibrissa};

/// Touches on a line of places that a whisker might have, as a text.
pub(crate) fn sets() -> String {
    use std::fmt::Write;
    let mut text = "x_mm,y_mm,base_angle_urad\n".to_owned();
    for index in 0..120 {
        let (row, column) = (f64::from(index / 12), f64::from(index % 12));
        let (y, x) = (15.0 + 3.0 * row, 99.0 - 0.02 * row.powi(2) - 1.5 * column);
        // About what a whisker of the reference rig does.
        let angle = 4.0 * y + 0.04 * y * y + 1.5 * column;
        writeln!(text, "{x},{y},{angle}").unwrap();
    }
    text
}

#[test]
fn touches_from_a_file_become_a_calibration_a_picture_and_a_table() {
    let folder = directory("calibrate");
    let file = folder.join("measured.csv");
    std::fs::write(&file, sets()).unwrap();
    let out = folder.join("out");
    let (file, out_text) = (file.display().to_string(), out.display().to_string());
    let output = vibrissa(&["calibrate", &file, "--whisker", "l0", "--out", &out_text]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let printed = stdout(&output);
    for wanted in ["one_channel", "recursive", "sliding, moment_and_shear", "120 sets, 120 of them tip contacts"] {
        assert!(printed.contains(wanted), "{printed}");
    }
    let calibration = std::fs::read_to_string(out.join("calibration.yaml")).unwrap();
    assert!(calibration.contains("vibrissa_calibration: 2") && calibration.contains("l0, measured"), "{calibration}");
    let picture = std::fs::read_to_string(out.join("profile.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.matches("<circle").count() == 120);
    assert_eq!(std::fs::read_to_string(out.join("sets.csv")).unwrap().lines().count(), 121);

    // A rig takes what was written.
    let scenario = folder.join("scenario.yaml");
    std::fs::write(
        &scenario,
        "name: calibrated\nrig: {whiskers: {l0: {calibration: out/calibration.yaml}}}\n\
         objects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
         start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 1 s}\n",
    )
    .unwrap();
    let output = vibrissa(&["mjcf", &scenario.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn what_was_measured_is_not_written_over() {
    let folder = directory("calibrate_onto");
    let file = folder.join("sets.csv");
    std::fs::write(&file, sets()).unwrap();
    let output = vibrissa(&["calibrate", &file.display().to_string(), "--out", &folder.display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("this command reads it as"), "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), sets());
    assert!(!folder.join("calibration.yaml").exists());
}

#[test]
fn json_alone_is_printed_if_asked_for() {
    let file = directory("calibrate_json").join("measured.csv");
    std::fs::write(&file, sets()).unwrap();
    let output = vibrissa(&["calibrate", &file.display().to_string(), "--json"]);
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&report["whisker"], &report["sets"]), (&"r0".into(), &120.into()));
    assert_eq!(report["held_out"].as_array().unwrap().len(), 3);
}

#[test]
fn what_cannot_be_calibrated_says_why() {
    let folder = directory("calibrate_bad");
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        std::fs::write(&file, text).unwrap();
        file.display().to_string()
    };
    let few = write("few.csv", "x_mm,y_mm,base_angle_urad\n82,51,300\n");
    let wrong = write("wrong.csv", "x_mm,y_mm\n82,51\n");
    for (arguments, reason) in [
        (&["calibrate", &wrong][..], "line 1: the column `base_angle_urad` is missing"),
        (&["calibrate", &few], "1 tip contacts are too few, or at too few positions; give at least 50 positions"),
        (&["calibrate", "none.csv"], "cannot read none.csv"),
        (&["calibrate", &few, "--whisker", "r7"], "the rig has no whisker `r7`; it has"),
    ] {
        let output = vibrissa(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
}
