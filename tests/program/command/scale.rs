//! `vibrissa study scale`.

use std::path::Path;

use vibrissa::report::scale_tables;
use vibrissa::study::scale::{axes, measure, steps};

/// All sizes take minutes.
#[test]
fn the_smallest_size_of_every_axis_has_a_time_and_a_sweep_has_a_cost_in_each_simulator() {
    let mut axes = axes();
    for axis in &mut axes {
        axis.sizes.truncate(1);
    }
    let mut done = 0;
    let scale = measure(&axes, Path::new(env!("CARGO_BIN_EXE_vibrissa")), 1, |_| done += 1).unwrap();
    assert_eq!(done, steps(&axes, 1));
    assert_eq!(scale.axes.len(), axes.len());
    for (row, axis) in scale.axes.iter().zip(&axes) {
        assert_eq!((row.axis.as_str(), row.exponent), (axis.name, None));
        assert!(matches!(&row.times[..], [time] if time.size == axis.sizes[0] && time.time_s > 0.0), "{row:?}");
    }
    let simulators: &[&str] = if cfg!(feature = "sim") { &["mujoco", "quasistatic"] } else { &["quasistatic"] };
    assert_eq!(scale.sweeps.iter().map(|cost| cost.simulator.as_str()).collect::<Vec<_>>(), simulators);
    for cost in &scale.sweeps {
        assert!(cost.run_ms > 0.0 && cost.line_bytes > 500 && cost.job_start_s > 0.0, "{cost:?}");
        assert!(cost.processor_hours > 0.0 && cost.array_minutes > 0.0 && cost.merge_minutes > 0.0, "{cost:?}");
    }
    let [exponents, times, costs] = scale_tables(&scale);
    assert!(exponents.wide().contains("far objects") && times.wide().contains("simulated s"));
    assert_eq!(costs.rows.len(), simulators.len());
}
