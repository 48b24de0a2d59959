//! `vibrissa calibrate --plan --stage`: planned touches that a 3-D printer makes.

use std::process::Output;

use super::printer::{Fault, Printer};
use super::program::{directory, stderr, stdout, vibrissa_reading};

/// The planned touches of the whisker r0 by a printer, with these lines of standard input.
fn planned(name: &str, printer: &Printer, more: &[&str], lines: &str) -> (Output, String) {
    let file = directory(name).join("touches.csv").display().to_string();
    let stage = format!("gcode:{}", printer.device);
    let plan = ["calibrate", "--plan", &file, "--heading", "90 deg", "--whisker", "r0", "--continue"];
    let moved = ["--stage", &stage, "--stage-zero", "150,80"];
    let output = vibrissa_reading(&[&plan[..], &moved, more].concat(), lines);
    (output, std::fs::read_to_string(file).unwrap_or_default())
}

/// The numbers behind X, Y and Z of the executed motions (mm).
fn motions(printer: &Printer) -> Vec<[f64; 3]> {
    let executed = printer.executed();
    let place = |line: &String| {
        let numbers: Vec<f64> =
            line.split_whitespace().skip(1).take(3).map(|word| word[1..].parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    executed.iter().filter(|line| line.starts_with("G1 ")).map(place).collect()
}

/// The poses x, y (mm) that the program said, each that in the air before that in the touch.
fn said(text: &str) -> Vec<[f64; 2]> {
    let number = |text: &str| text.trim().split(' ').nth(1).unwrap().parse().unwrap();
    let place = |line: &str| {
        let mut parts = line.split_once(": ").unwrap().1.split(',');
        [number(parts.next().unwrap()), number(parts.next().unwrap())]
    };
    text.lines().filter(|line| line.contains(" mm, y ")).map(place).collect()
}

#[test]
fn a_printer_makes_the_touches_that_are_planned() {
    let printer = Printer::start([10.0, 20.0, 5.0], Fault::Starting);
    let (output, file) = planned("stage", &printer, &["--stage-start", "G28 X Y"], "2\n150\n2\n150 0.2\n");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert_eq!(text.matches("at rest in the touch").count(), 2, "{text}");

    let (motions, poses) = (motions(&printer), said(&text));
    assert_eq!(printer.executed()[..3], ["G28 X Y", "G21", "G90"]);
    // For each touch: up, above the pose in the air, down, to the touch, back, up. The third one ends in the air with the input.
    assert_eq!(motions.len(), 2 * 6 + 5, "{motions:?}");
    assert!(printer.executed().contains(&"G1 X10.000 Y20.000 Z25.000 F600".to_owned()), "it rises where it is");
    for (motions, poses) in motions.chunks_exact(6).zip(poses.chunks_exact(2)) {
        let at = |[x, y]: [f64; 2], z: f64| [150.0 + x, 80.0 + y, z];
        let expected =
            [at(poses[0], 25.0), at(poses[0], 5.0), at(poses[1], 5.0), at(poses[0], 5.0), at(poses[0], 25.0)];
        for (motion, expected) in motions[1..].iter().zip(expected) {
            let near = motion.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 0.011);
            assert!(near, "{motion:?} {expected:?}");
        }
    }
    // Base angle, that in the air, deviation.
    let rows = file.lines().skip(1).map(|line| line.split(',').skip(10).map(|value| value.parse().unwrap()).collect());
    let found: Vec<Vec<f64>> = rows.collect();
    let expected = [[150.0, 2.0, 0.1], [150.0, 2.0, 0.2]];
    assert_eq!(found.len(), expected.len(), "{file}");
    let mut values = found.iter().flatten().zip(expected.iter().flatten());
    assert!(values.all(|(found, expected): (&f64, &f64)| (found - expected).abs() < 1e-9), "{file}");
}

#[test]
fn a_pin_that_a_printer_carries_moves_the_other_way() {
    let printer = Printer::start([10.0, 20.0, 5.0], Fault::None);
    let (output, _) = planned("stage_pin", &printer, &["--stage-carries", "pin", "--stage-volume", "300,300,300"], "");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let [x, y] = said(&stdout(&output))[0];
    let [found_x, found_y, _] = motions(&printer)[1];
    assert!((found_x - (150.0 - x)).abs() < 0.011 && (found_y - (80.0 - y)).abs() < 0.011, "{found_x} {found_y}");
}

#[test]
fn lost_and_wrong_lines_are_sent_again() {
    for (name, fault) in [("stage_lost", Fault::LostOk), ("stage_noise", Fault::Noise)] {
        let printer = Printer::start([10.0, 20.0, 5.0], fault);
        let (output, file) = planned(name, &printer, &[], "2\n150\n");
        assert_eq!(output.status.code(), Some(0), "{fault:?}: {}", stderr(&output));
        assert_eq!(file.lines().count(), 2, "{fault:?}");
        // Nothing is executed twice.
        let executed = printer.executed();
        assert_eq!(executed.iter().filter(|line| line.starts_with("G1 ")).count(), 6 + 5, "{fault:?}: {executed:?}");
    }
}

#[test]
fn a_printer_that_does_not_obey_ends_the_command_and_says_what_to_do() {
    let cases = [
        (Fault::Halt, "Error:Printer halted. kill() called!; correct the cause, home it"),
        (Fault::Restart, "the printer has started again, so its position is unknown"),
        (Fault::Clamp, "the printer is at X20.000"),
        (Fault::Dead, "the printer does not answer `M110 N0` within 10 s; check its power"),
    ];
    for (fault, expected) in cases {
        let printer = Printer::start([10.0, 20.0, 5.0], fault);
        let (output, file) = planned("stage_fault", &printer, &[], "2\n150\n");
        assert_eq!(output.status.code(), Some(2), "{fault:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(expected), "{fault:?}: {}", stderr(&output));
        assert!(file.is_empty(), "{fault:?}: {file}");
    }
}

#[test]
fn nothing_moves_if_a_pose_is_outside_of_the_volume() {
    for (option, value, axis) in [("--stage-volume", "180,10,180", "Y "), ("--stage-lift", "200 mm", "Z 205.00 mm")] {
        let printer = Printer::start([10.0, 20.0, 5.0], Fault::None);
        let (output, _) = planned("stage_outside", &printer, &[option, value], "2\n150\n");
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        let text = stderr(&output);
        assert!(text.contains("would leave the volume of the printer") && text.contains(axis), "{text}");
        assert!(motions(&printer).is_empty(), "{:?}", printer.executed());
    }
}

#[test]
fn a_device_that_is_no_printer_is_refused() {
    let plan = ["calibrate", "--plan", "touches.csv", "--continue", "--stage-zero", "0,0", "--stage"];
    for (device, expected) in
        [("gcode:/dev/null", "cannot open the printer at /dev/null"), ("/dev/ttyUSB0", "write `gcode:`")]
    {
        let output = vibrissa_reading(&[&plan[..], &[device]].concat(), "");
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}
