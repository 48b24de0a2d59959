//! What a control loop knows by touch, as arrays.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibrissa_runtime::map::{CellSpan, Map};

use crate::arrays::{list, table};

/// The map as a dictionary. `names` has the whiskers of the machine.
pub(crate) fn of_map<'py>(py: Python<'py>, map: &Map, names: &[String]) -> PyResult<Bound<'py, PyDict>> {
    let points: Vec<_> = map.contours().collect();
    let whiskers: Vec<_> = points.iter().map(|point| names.get(point.whisker).map_or("", String::as_str)).collect();
    let spans = |spans: &mut dyn Iterator<Item = CellSpan>| {
        table(py, spans.flat_map(|CellSpan { low, high }| [low.x, low.y, high.x, high.y]).collect::<Vec<_>>(), 4)
    };
    let known = PyDict::new(py);
    known.set_item(
        "contour_m",
        table(py, points.iter().flat_map(|point| [point.place.x, point.place.y]).collect(), 2)?,
    )?;
    known.set_item("spread_m", list(py, points.iter().map(|point| point.deviation).collect::<Vec<_>>()))?;
    known.set_item(
        "normal",
        table(py, points.iter().flat_map(|point| [point.normal.x, point.normal.y]).collect(), 2)?,
    )?;
    known.set_item("piece", list(py, points.iter().map(|point| point.piece).collect::<Vec<_>>()))?;
    known.set_item("whisker", whiskers)?;
    known.set_item("free_m", spans(&mut map.free_spans())?)?;
    known.set_item("blocked_m", spans(&mut map.blocked_spans())?)?;
    known.set_item("contour_length_m", map.contour_length())?;
    known.set_item("free_area_m2", map.free_area())?;
    known.set_item("unknown_area_m2", map.unknown_area())?;
    known.set_item("is_complete", map.is_complete())?;
    Ok(known)
}
