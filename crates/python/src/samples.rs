//! Samples of sensors as arrays.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

use crate::arrays::{Numbers, list, numbers, table};

/// The samples of a run as arrays with a row for each. `width` is the number of whiskers of the rig.
pub(crate) fn dictionary<'py>(py: Python<'py>, ticks: &[Vec<Sample>], width: usize) -> PyResult<Bound<'py, PyDict>> {
    let all = || ticks.iter().flatten();
    let each = |value: fn(&Sample) -> f64| list(py, all().map(value).collect());
    let readings = |value: fn(&Reading) -> f64| {
        table(py, all().flat_map(|sample| sample.whiskers[..width].iter().map(value)).collect(), width)
    };
    let samples = PyDict::new(py);
    let indices = (0_i64..).zip(ticks).flat_map(|(index, samples)| samples.iter().map(move |_| index));
    samples.set_item("tick", list(py, indices.collect::<Vec<i64>>()))?;
    samples.set_item("time_s", each(|sample| sample.time))?;
    let positions = all().flat_map(|sample| [sample.body.position.x, sample.body.position.y]);
    samples.set_item("position_m", table(py, positions.collect(), 2)?)?;
    samples.set_item("heading_rad", each(|sample| sample.body.heading))?;
    samples.set_item("base_angle_rad", readings(|reading| reading.base_angle)?)?;
    samples.set_item("shear_n", readings(|reading| reading.shear.unwrap_or(f64::NAN))?)?;
    samples.set_item("axial_n", readings(|reading| reading.axial.unwrap_or(f64::NAN))?)?;
    Ok(samples)
}

/// Arrays of samples that Python gives.
pub(crate) struct GivenSamples<'py> {
    pub(crate) time: Numbers<'py>,
    pub(crate) position: Numbers<'py>,
    pub(crate) heading: Numbers<'py>,
    pub(crate) base_angle: Numbers<'py>,
    pub(crate) shear: Option<Numbers<'py>>,
    pub(crate) axial: Option<Numbers<'py>>,
}

impl GivenSamples<'_> {
    /// The samples of a rig with this many whiskers.
    ///
    /// # Errors
    /// An array does not have as many rows as there are times.
    pub(crate) fn samples(&self, width: usize) -> PyResult<Vec<Sample>> {
        let width = width.min(MAX_WHISKERS);
        let time = numbers("time_s", &self.time, self.time.as_array().len())?;
        let count = time.len();
        let position = numbers("position_m", &self.position, 2 * count)?;
        let heading = numbers("heading_rad", &self.heading, count)?;
        let base_angle = numbers("base_angle_rad", &self.base_angle, width * count)?;
        let forces = |name, given: &Option<Numbers<'_>>| {
            given.as_ref().map(|given| numbers(name, given, width * count)).transpose()
        };
        let (shear, axial) = (forces("shear_n", &self.shear)?, forces("axial_n", &self.axial)?);
        let sample = |row: usize| {
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            for (whisker, reading) in whiskers[..width].iter_mut().enumerate() {
                let place = row * width + whisker;
                let force = |forces: &Option<Vec<f64>>| forces.as_ref().map(|forces| forces[place]);
                *reading = Reading {
                    base_angle: base_angle[place],
                    shear: force(&shear),
                    axial: force(&axial),
                    true_tip: None,
                };
            }
            let position = Point2::new(position[2 * row], position[2 * row + 1]);
            Sample { time: time[row], body: Pose { position, heading: heading[row] }, whiskers }
        };
        Ok((0..count).map(sample).collect())
    }
}
