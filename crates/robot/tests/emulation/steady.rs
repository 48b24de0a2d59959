//! The loop without faults.

use vibrissa_robot::emulation::{Settings, Stopped};
use vibrissa_robot::vitals::Phase;

use super::robot::{MS, robot};

#[test]
fn a_robot_without_faults_misses_no_period_and_reports_no_fault() {
    let mut robot = robot(&Settings::default());
    let mut ticks = 0;
    let stopped = robot.run(10_000 * MS, |_, _, _, _| {
        ticks += 1;
        true
    });
    assert_eq!(stopped.unwrap(), Stopped::Time);
    assert!(robot.take_events().is_empty());
    assert_eq!(Phase::ALL.map(|phase| robot.vitals().missed(phase)), [0; Phase::ALL.len()]);
    // The first second goes to the neutral values.
    assert!((265..=270).contains(&ticks), "{ticks}");
    // A value is 2.6 ms old when it is read, and the tick begins 1.5 ms after the round.
    let age_ns = robot.vitals().sample_age.largest_ns();
    assert!((4 * MS..5 * MS).contains(&age_ns), "{age_ns} ns");
}
