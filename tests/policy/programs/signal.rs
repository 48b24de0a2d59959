//! What a `previous`, a `peak`, a `settled` and a `path_length` remember.

use vibrissa_runtime::geometry::Vector2;

use super::evaluate::Value;

/// What one of them remembers since its state was entered.
#[derive(Debug, Clone, Default)]
pub(crate) struct Signal {
    /// The times at which it was computed, with the values: one entry for each time.
    past: Vec<(f64, Value)>,
    /// The largest number.
    largest: Option<f64>,
    /// The value that it stayed near, and since when.
    near: Option<(f64, f64)>,
    last: Option<Vector2>,
    length: f64,
}

impl Signal {
    /// The last value of an earlier time; at the first time, the first value of that time.
    pub(crate) fn previous(&mut self, now: f64, value: Value) -> Value {
        let earlier = self.past.iter().rev().find(|(time, _)| *time < now).map(|(_, value)| *value);
        let output = earlier.unwrap_or_else(|| self.past.first().map_or(value, |(_, first)| *first));
        // The first value of the first time is what was previous in it.
        let is_first = self.past.len() == 1 && earlier.is_none();
        match self.past.last_mut().filter(|(time, _)| *time >= now) {
            Some(last) if !is_first => last.1 = value,
            _ => self.past.push((now, value)),
        }
        output
    }

    pub(crate) fn peak(&mut self, value: f64) -> f64 {
        if !value.is_nan() {
            self.largest = Some(self.largest.map_or(value, |largest| if largest < value { value } else { largest }));
        }
        self.largest.unwrap_or(value)
    }

    pub(crate) fn settled(&mut self, now: f64, value: f64, within: f64, lasting: f64) -> bool {
        let stays = self.near.is_some_and(|(near, _)| (value - near).abs() <= within);
        if !stays {
            self.near = Some((value, now));
        }
        self.near.is_some_and(|(_, since)| lasting <= now - since + 1e-9)
    }

    pub(crate) fn path_length(&mut self, position: Vector2) -> f64 {
        // Where there is no position there is no step, and the next one counts from the last known one.
        let step = (position - self.last.unwrap_or_default()).norm();
        if !step.is_nan() {
            if self.last.is_some() {
                self.length += step;
            }
            self.last = Some(position);
        }
        self.length
    }
}
