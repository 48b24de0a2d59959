//! `vibrissa calibrate`, from touches that were measured.

use super::program::{directory, stderr, stdout, vibrissa, vibrissa_reading};

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

/// Touches of an edge, as a text.
pub(crate) const TOUCHES: &str = "whisker,body_x_mm,body_y_mm,heading_deg,object,object_x_mm,object_y_mm,radius_mm,normal_deg,side,\
    base_angle_urad,in_air_urad,deviation_urad\nl0,0,0,0,edge,-14,110,,,left,150,0.5,0.1\n";

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
    for wanted in
        ["one_channel", "polynomial", "recursive", "sliding, moment_and_shear", "120 sets, 120 of them tip contacts"]
    {
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
    let output = vibrissa(&["inspect", "mjcf", &scenario.display().to_string()]);
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
    assert_eq!(report["held_out"].as_array().unwrap().len(), 4);
    assert!(report["field_per_moment"].is_null());
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

/// The same touches as counts of a sensor at 0.15 µT per count, with a magnet of 6 µT/µN m and a neutral value of -812.
pub(crate) fn counts() -> String {
    let lines = sets();
    let counted = lines.lines().skip(1).map(|line| {
        let (position, angle) = line.rsplit_once(',').unwrap();
        let counts = -812.0 + angle.parse::<f64>().unwrap() * 6.0 / 0.15;
        format!("{position},{counts:.0}\n")
    });
    format!("x_mm,y_mm,counts\n{}", counted.collect::<String>())
}

#[test]
fn touches_with_counts_become_a_board_and_a_calibration_for_the_robot() {
    let folder = directory("calibrate_counts");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).unwrap();
        folder.join(name).display().to_string()
    };
    let (file, config) = (write("counts.csv", &counts()), write("array.yaml", CONFIG));
    let out = folder.join("out").display().to_string();
    let calibrate = |arguments: &[&str]| vibrissa(&[&["calibrate", &file, "--config", &config], arguments].concat());
    let output = calibrate(&["--neutral", "-812", "--whisker", "l0", "--out", &out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let printed = stdout(&output);
    let board = printed.lines().find_map(|line| line.strip_prefix("board: ")).unwrap();
    let field = board.split("field_per_moment: ").nth(1).unwrap().trim_end_matches('}').parse::<f64>().unwrap();
    // The same touches with base angles have a hinge of this stiffness.
    let angles = write("angles.csv", &sets());
    let output = vibrissa(&["calibrate", &angles, "--whisker", "l0", "--out", &out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let calibration = std::fs::read_to_string(folder.join("out/calibration.yaml")).unwrap();
    let stiffness = calibration.split("hinge_stiffness: ").nth(1).unwrap().lines().next().unwrap();
    let expected = 6.0 / stiffness.parse::<f64>().unwrap();
    assert!((field / expected - 1.0).abs() < 1e-3, "{field} for {expected}");

    let robot = std::fs::read_to_string(folder.join("out/robot.yaml")).unwrap();
    assert!(robot.contains(board) && robot.contains("calibration:") && !robot.contains("hinge_stiffness"), "{robot}");

    for (arguments, reason) in [
        (&["--whisker", "l0"][..], "--neutral <COUNTS>"),
        (&["--neutral", "0", "--whisker", "r7"], "the rig has no whisker `r7`"),
        (&["--neutral", "-300000", "--whisker", "l0"], "the counts do not agree with the mechanics"),
        (&["--neutral", "0", "--rig", "a.yaml"], "cannot be used with"),
    ] {
        let output = calibrate(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(reason), "{arguments:?}: {}", stderr(&output));
    }
}

/// A robot with the reference rig, and a board at each whisker.
pub(crate) const CONFIG: &str = "name: robot
buses: [{device: /dev/i2c-1, boards: [{whisker: l0, address: 0x0C}, {whisker: r0, address: 0x0D}]}]
limits: {speed: 0.1 m/s, yaw_rate: 60 deg/s, base_angle: 1050 urad}
pose: {udp: {listen: \"0.0.0.0:9751\"}}
";

/// The parameters of the whiskers in the JSON of a calibration, and the exit status.
fn measured(arguments: &[&str]) -> (Option<i32>, Vec<serde_json::Value>) {
    let output = vibrissa(&[&["calibrate", "--json"], arguments].concat());
    let all: Vec<serde_json::Value> =
        serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
    (output.status.code(), all)
}

#[test]
fn measured_touches_have_the_fit_of_the_array_that_made_them() {
    let folder = directory("calibrate_touches");
    let mismatch = folder.join("soft.yaml").display().to_string();
    std::fs::write(&mismatch, "stiffness: -4 %\nlength: 0.4 mm\n").unwrap();
    let [out, again] = ["out", "again"].map(|name| folder.join(name).display().to_string());
    let (code, by_itself) = measured(&["--self", "--simulator", "quasistatic", "--mismatch", &mismatch, "--out", &out]);
    assert_eq!((code, by_itself.len()), (Some(0), 2), "{by_itself:?}");
    assert!(by_itself.iter().all(|whisker| whisker["within_ellipsoid"] == true), "{by_itself:?}");
    // Without noise of the poses, only that of the mechanics is left.
    let touches = format!("{out}/touches.csv");
    let (code, fitted) =
        measured(&["--touches", &touches, "--position-noise", "0.01 mm", "--heading-noise", "0 deg", "--out", &again]);
    assert_eq!(code, Some(0), "{fitted:?}");
    for (one, other) in by_itself.iter().zip(&fitted) {
        assert_eq!((&one["whisker"], &one["touches"]), (&other["whisker"], &other["touches"]));
        for (a, b) in one["parameters"].as_array().unwrap().iter().zip(other["parameters"].as_array().unwrap()) {
            let [difference, deviation] =
                ["difference", "deviation"].map(|key| [a, b].map(|of| of[key].as_f64().unwrap()));
            assert!((difference[0] - difference[1]).abs() < 0.05 * deviation[0], "{a} {b}");
        }
    }
    assert!(std::path::Path::new(&again).join("l0.yaml").exists());
}

#[test]
fn touches_that_determine_nothing_are_refused_and_write_no_calibration() {
    let folder = directory("calibrate_nothing");
    let [made, out] = ["made", "out"].map(|name| folder.join(name).display().to_string());
    assert_eq!(measured(&["--self", "--simulator", "quasistatic", "--out", &made]).0, Some(0));
    let touches = format!("{made}/touches.csv");
    let text = std::fs::read_to_string(&touches).unwrap();
    let with_deviation = |deviation: &str| {
        let line = |line: &str| format!("{},{deviation}\n", line.rsplit_once(',').unwrap().0);
        let (header, rows) = text.split_once('\n').unwrap();
        format!("{header}\n{}", rows.lines().map(line).collect::<String>())
    };
    let refused = |file: &str, arguments: &[&str]| {
        let (code, fitted) = measured(&[&["--touches", file, "--out", &out], arguments].concat());
        assert_eq!((code, fitted.len()), (Some(1), 2), "{fitted:?}");
        for whisker in &fitted {
            assert!(whisker["refusal"].as_str().unwrap().contains("hardly determine"), "{whisker}");
        }
        assert!(!std::path::Path::new(&out).join("l0.yaml").exists());
    };
    refused(&touches, &["--position-noise", "1 m"]);
    let vague = folder.join("vague.csv").display().to_string();
    for deviation in ["1000", "1e6"] {
        std::fs::write(&vague, with_deviation(deviation)).unwrap();
        refused(&vague, &[]);
    }
}

#[test]
fn touches_of_a_whisker_that_the_rig_lacks_and_too_few_touches_are_refused() {
    let folder = directory("calibrate_few_touches");
    let file = folder.join("touches.csv").display().to_string();
    std::fs::write(&file, TOUCHES).unwrap();
    let (code, fitted) = measured(&["--touches", &file]);
    assert_eq!(code, Some(1), "{fitted:?}");
    assert!(fitted[0]["refusal"].as_str().unwrap().contains("too few"), "{fitted:?}");
    std::fs::write(&file, TOUCHES.replace("l0,", "l7,")).unwrap();
    let output = vibrissa(&["calibrate", "--touches", &file]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`l7`"), "{}", stderr(&output));
}

#[test]
fn a_pluck_shows_the_first_mode_of_a_whisker() {
    use std::fmt::Write;
    let folder = directory("calibrate_pluck");
    let (frequency, decay) = (8.6_f64, 0.25_f64);
    let mut text = "time_s,base_angle_urad\n".to_owned();
    for index in 0..900_u32 {
        let time = f64::from(index) / 300.0;
        let free = (time - 0.4).max(0.0);
        let swing = ((std::f64::consts::TAU * frequency).powi(2) - decay.powi(-2)).sqrt();
        writeln!(text, "{time},{}", 5.0 + 120.0 * (-free / decay).exp() * (swing * free).cos()).unwrap();
    }
    let file = folder.join("pluck.csv");
    std::fs::write(&file, text).unwrap();
    let file = file.display().to_string();
    let output = vibrissa(&["calibrate", "--pluck", &file, "--whisker", "l0", "--json"]);
    let found: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&found["format"], &found["whisker"]), (&"pluck".into(), &"l0".into()));
    for (key, wanted) in [("first_mode_hz", frequency), ("decay_s", decay)] {
        let value = found[key].as_f64().unwrap();
        assert!((value / wanted - 1.0).abs() < 0.01, "{key}: {value}");
    }
    let output = vibrissa(&["calibrate", "--pluck", &file]);
    assert!(stdout(&output).starts_with("whiskers: {r0: {first_mode: 8.6"), "{}", stdout(&output));

    std::fs::write(folder.join("still.csv"), "time_s,base_angle_urad\n0,1\n1,1\n").unwrap();
    let output = vibrissa(&["calibrate", "--pluck", &folder.join("still.csv").display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("record at least 20"), "{}", stderr(&output));
}

#[test]
fn a_plan_takes_readings_that_can_be_used_and_goes_on_after_them() {
    let folder = directory("calibrate_plan");
    let file = folder.join("touches.csv").display().to_string();
    let plan = ["calibrate", "--plan", &file, "--heading", "-30 deg", "--pin-radius", "8 mm"];
    let continued = [&plan[..], &["--continue"]].concat();
    let first = stdout(&vibrissa(&plan));
    assert!(first.starts_with("r0, touch 1;") && first.contains("heading -30.00 deg"), "{first}");

    let output = vibrissa_reading(&continued, "nan 1\n150 2 -1\n1e9 2\n1 2 3 4\n\n");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output).lines().count(), 5, "{}", stderr(&output));
    assert_eq!(stdout(&output), first.repeat(6));
    assert!(!std::path::Path::new(&file).exists());

    // What met nothing is in the file, so a restarted plan does not say it again.
    let said = stdout(&vibrissa_reading(&continued, "missed\n"));
    let another = said.strip_prefix(&first).unwrap();
    assert!(another.starts_with("r0, touch 1;") && another != first, "{said}");
    assert_eq!(stdout(&vibrissa(&plan)), another);
    let output = vibrissa(&["calibrate", "--touches", &file]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("there are no touches"), "{}", stderr(&output));

    let said = stdout(&vibrissa_reading(&continued, "150 2\n"));
    let text = std::fs::read_to_string(&file).unwrap();
    assert_eq!(text.lines().count(), 3, "{text}");
    let second = stdout(&vibrissa(&plan));
    assert!(second.starts_with("r0, touch 2;") && said == format!("{another}{second}"), "{second}");

    let left = stdout(&vibrissa(&[&plan[..], &["--whisker", "l0"]].concat()));
    assert!(left.starts_with("l0, touch 1;"), "{left}");
}
