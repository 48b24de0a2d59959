//! A spring with a damper.

/// An angle that follows another as a spring with a damper follows a moment, by a first-order lag.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lag {
    /// Time constant (s).
    time: f64,
    value: f64,
    aim: f64,
}

/// An angle (rad) below this is nothing.
const FADED: f64 = 1e-290;

impl Lag {
    /// At rest at 0, with a time constant (s): damping over stiffness.
    pub(super) fn new(time: f64) -> Self {
        Self { time, value: 0.0, aim: 0.0 }
    }

    pub(super) fn value(&self) -> f64 {
        self.value
    }

    /// Lets a time `period` (s) pass in which what is followed goes evenly to `aim`.
    pub(super) fn follow(&mut self, aim: f64, period: f64) {
        // Behind an even change it is late by the time constant, once what was else has faded.
        let late = (aim - self.aim) / period * self.time;
        let fading = if self.time > 0.0 { (-period / self.time).exp() } else { 0.0 };
        let value = aim - late + (self.value - self.aim + late) * fading;
        // A hundred times as slow would be what fades beyond the normal numbers, where rounding holds it for ever.
        self.value = if value.abs() < FADED { 0.0 } else { value };
        self.aim = aim;
    }
}

#[cfg(test)]
mod tests {
    use super::Lag;

    #[test]
    fn a_lag_is_late_by_its_time_constant_and_comes_to_rest_where_it_should() {
        let mut lag = Lag::new(0.01);
        for step in 1..=100 {
            lag.follow(0.03 * f64::from(step), 0.003);
        }
        assert!((lag.value() - (3.0 - 0.1)).abs() < 1e-9);
        for _ in 0..100 {
            lag.follow(3.0, 0.003);
        }
        assert!((lag.value() - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_lag_in_two_halves_is_the_same() {
        let (mut once, mut twice) = (Lag::new(0.01), Lag::new(0.01));
        once.follow(1.0, 0.004);
        twice.follow(0.5, 0.002);
        twice.follow(1.0, 0.002);
        assert!((once.value() - twice.value()).abs() < 1e-15);
    }

    #[test]
    fn what_fades_is_gone_at_last() {
        let mut lag = Lag::new(0.01);
        lag.follow(1e-3, 0.003);
        for _ in 0..2500 {
            lag.follow(0.0, 0.003);
        }
        assert!(lag.value() == 0.0);
    }

    #[test]
    fn no_damper_is_no_lag() {
        let mut lag = Lag::new(0.0);
        lag.follow(0.7, 0.003);
        assert!((lag.value() - 0.7).abs() < f64::EPSILON);
    }
}
