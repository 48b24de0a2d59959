//! The admission of a machine on simulated devices.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use proptest::option;
use proptest::prelude::*;
use vibrissa_runtime::machine::{Artifact, Needs, RateRange};
use vibrissa_runtime::rig::Rig;

use super::{Admission, Device, Refusal, admit};
use crate::config::{Config, MAX_ROUNDS};
use crate::sensor::{BusClock, Sensor};

/// The policy `bang` with other needs.
fn machine(needs: Needs) -> Artifact {
    let bytes = include_bytes!("../../../runtime/fixtures/bang.machine");
    let mut artifact = Artifact::from_bytes(bytes).unwrap();
    artifact.program.needs = needs;
    artifact
}

fn configured(control_rate: f64, rounds: u32) -> Config {
    let mut rig = Rig::default();
    (rig.sensing.control_rate, rig.sensing.sample_rate) = (control_rate, control_rate * f64::from(rounds));
    Config::emulated(rig, 1.5)
}

/// A simulated device.
#[derive(Debug, Clone, Copy)]
struct Speed {
    frequency_hz: u32,
    lateness: f64,
    operation: f64,
    /// Time of a tick without samples, and of each sample in it (s).
    tick: f64,
    sample: f64,
}

/// A device that needs next to no time, with buses as the configuration demands.
const FAST: Speed = Speed { frequency_hz: 400_000, lateness: 1e-5, operation: 1e-9, tick: 1e-4, sample: 1e-5 };

impl Speed {
    fn clock(self) -> BusClock {
        BusClock { frequency_hz: self.frequency_hz, overhead_ns: 30_000 }
    }

    fn tick(self, rounds: u32) -> f64 {
        self.tick + f64::from(rounds) * self.sample
    }

    fn admit(self, machine: &Artifact, config: &Config) -> Result<Admission, Refusal> {
        let mut device = Device {
            clocks: vec![self.clock(); config.buses.len()],
            lateness: self.lateness,
            operation: self.operation,
            tick: Box::new(move |rounds| self.tick(rounds)),
        };
        admit(machine, config, &mut device)
    }

    /// True if the device can run the loop at this rate, by the rules of the documentation.
    fn holds(self, machine: &Artifact, config: &Config, control_rate: f64, rounds: u32) -> bool {
        let needs = &machine.program.needs;
        let sample_rate = control_rate * f64::from(rounds);
        let sensing = &config.rig.sensing;
        let allows = |range: Option<RateRange>, configured: f64, rate: f64| {
            let (low, high) = range.map_or((configured, configured), |range| (range.low, range.high));
            rate > low * (1.0 - 1e-7) && rate < high.min(configured) * (1.0 + 1e-7)
        };
        let conversion = f64::from(config.sensor().unwrap().conversion_us()) * 1e-6;
        let age = conversion + self.lateness + 1.0 / sample_rate;
        let tick = self.tick(rounds) + machine.most_operations as f64 * self.operation;
        let round = |boards: usize| {
            f64::from(config.sensor().unwrap().round_us(u32::try_from(boards).unwrap(), self.clock())) * 1e-6
        };
        allows(needs.control_rate, sensing.control_rate, control_rate)
            && allows(needs.sample_rate, sensing.sample_rate, sample_rate)
            && needs.sample_age.is_none_or(|most| age < most * (1.0 + 1e-7))
            && config.buses.iter().all(|bus| round(bus.boards.len()) * sample_rate < 0.4 * (1.0 + 1e-7))
            && tick * control_rate < 0.5 * (1.0 + 1e-7)
            && (1.0 / control_rate + tick + self.lateness) < config.timeouts.control * (1.0 + 1e-7)
    }

    /// The highest rate of those that are whole, or at an end of a range, or at the limit of a demand.
    fn highest(self, machine: &Artifact, config: &Config) -> Option<f64> {
        let needs = &machine.program.needs;
        let ends = |range: Option<RateRange>, configured: f64| {
            range.map_or(vec![configured], |range| vec![range.low, range.high, configured])
        };
        let conversion = f64::from(config.sensor().unwrap().conversion_us()) * 1e-6;
        let mut rates = Vec::new();
        for rounds in 1..=MAX_ROUNDS {
            let tick = self.tick(rounds) + machine.most_operations as f64 * self.operation;
            let mut candidates: Vec<f64> = (1..=60).map(f64::from).collect();
            candidates.extend(ends(needs.control_rate, config.rig.sensing.control_rate));
            let mut samples = ends(needs.sample_rate, config.rig.sensing.sample_rate);
            samples.extend(needs.sample_age.map(|age| 1.0 / (age - conversion - self.lateness)));
            candidates.extend(samples.into_iter().map(|rate| rate / f64::from(rounds)));
            candidates.push(1.0 / (config.timeouts.control - self.lateness - tick));
            rates.extend(candidates.into_iter().filter(|&rate| self.holds(machine, config, rate, rounds)));
        }
        rates.into_iter().max_by(f64::total_cmp)
    }
}

fn range(low: std::ops::Range<u32>, width: u32) -> impl Strategy<Value = Option<RateRange>> {
    let range = (low, 0..=width).prop_map(|(low, width)| RateRange { low: low.into(), high: (low + width).into() });
    option::weighted(0.7, range)
}

prop_compose! {
    fn needs()(
        control_rate in range(5..30, 30), sample_rate in range(40..220, 250),
        sample_age in option::weighted(0.4, 0.004..0.03),
    ) -> Needs {
        Needs { control_rate, sample_rate, sample_age }
    }
}

prop_compose! {
    fn speed()(
        frequency_hz in prop_oneof![Just(400_000_u32), 15_000..400_000_u32],
        (lateness, operation) in (0.0..0.002, prop_oneof![Just(1e-9), 1e-9..1e-5]),
        (tick, sample) in (prop_oneof![Just(1e-4), 1e-4..0.06], prop_oneof![Just(1e-5), 1e-5..0.003]),
    ) -> Speed {
        Speed { frequency_hz, lateness, operation, tick, sample }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn a_machine_is_admitted_exactly_if_the_device_holds_an_allowed_rate_and_runs_at_the_highest(
        needs in needs(), speed in speed(), control_rate in 16_u32..40, rounds in 1_u32..=8, patience in 0.03..0.2,
    ) {
        let machine = machine(needs);
        let mut config = configured(control_rate.into(), rounds);
        config.timeouts.control = patience;
        config.buses.iter_mut().for_each(|bus| bus.clock = 0.0);
        let is_held = speed.holds(&machine, &config, control_rate.into(), rounds);
        match speed.admit(&machine, &config) {
            Ok(Admission { config: admitted, slower }) => {
                let sensing = &admitted.rig.sensing;
                prop_assert_eq!(slower.is_none(), is_held);
                prop_assert_eq!(is_held, sensing == &config.rig.sensing);
                let ratio = sensing.sample_rate / sensing.control_rate;
                prop_assert!((ratio - ratio.round()).abs() < 1e-6);
                let rounds = u32::try_from(admitted.rounds_per_tick()).unwrap();
                prop_assert!(speed.holds(&machine, &config, sensing.control_rate, rounds), "{sensing:?}");
                let highest = speed.highest(&machine, &config).unwrap();
                prop_assert!(sensing.control_rate >= highest.floor() * (1.0 - 1e-6), "{highest} {sensing:?}");
            }
            Err(refusal) => prop_assert_eq!(speed.highest(&machine, &config), None, "{}", refusal),
        }
    }

    #[test]
    fn silence_that_makes_a_sample_too_old_is_a_fault(age in 0.008..0.2) {
        let config = configured(30.0, 10);
        let machine = machine(Needs { sample_age: Some(age), ..Needs::default() });
        let timeouts = FAST.admit(&machine, &config).unwrap().config.timeouts;
        let conversion = f64::from(config.sensor().unwrap().conversion_us()) * 1e-6;
        for (timeout, configured) in
            [(timeouts.sensor, config.timeouts.sensor), (timeouts.bus, config.timeouts.bus)]
        {
            prop_assert!((timeout - configured.min(age - conversion)).abs() < 1e-12);
            // A new value comes in every sample period.
            prop_assert!(timeout > 1.0 / 300.0);
        }
    }
}

/// The message about a device: of the refusal, or of the slower loop. The page must explain it.
fn message(speed: Speed, machine: &Artifact, config: &Config) -> String {
    let message = match speed.admit(machine, config) {
        Ok(Admission { slower, .. }) => format!("warning: {}", slower.unwrap()),
        Err(refusal) => refusal.to_string(),
    };
    let words: Vec<_> = message.split(' ').take(3).collect();
    let page = include_str!("../../../../docs/raspberry-pi.md");
    assert!(page.contains(&format!("\n| `{}", words.join(" "))), "Troubleshooting lacks: {message}");
    message
}

#[test]
fn every_refusal_names_the_need_the_measured_value_and_the_remedy() {
    let config = configured(30.0, 10);
    let range = |low, high| Some(RateRange { low, high });
    let refused = |speed: Speed, needs: Needs| message(speed, &machine(needs), &config);
    let slow_tick = Speed { tick: 0.030, ..FAST };
    assert_eq!(
        refused(slow_tick, Needs::default()),
        "a tick takes up to 30.1 ms on this device, more than half of the control period of 33.3 ms; lower the control rate \
         as far as the policy allows, allow lower rates in it by `needs`, or simplify it"
    );
    assert_eq!(
        refused(slow_tick, Needs { control_rate: range(20.0, 60.0), ..Needs::default() }),
        "a tick takes up to 30.2 ms on this device, more than half of the control period of 50.0 ms; lower the control rate \
         as far as the policy allows, allow lower rates in it by `needs`, or simplify it"
    );
    assert_eq!(
        refused(FAST, Needs { control_rate: range(40.0, 60.0), ..Needs::default() }),
        "the policy needs a control rate of 40 Hz to 60 Hz, but the rig has 30 Hz; change the rate in the section `sensing` \
         of the configuration"
    );
    assert_eq!(
        refused(FAST, Needs { sample_age: Some(0.005), ..Needs::default() }),
        "a sample is up to 6.0 ms old on this device, and the machine needs at most 5.0 ms; raise the sample rate, or choose \
         a weaker filter of the sensors"
    );
    assert_eq!(
        refused(Speed { frequency_hz: 100_000, ..FAST }, Needs::default()),
        "the clock of bus 0 is 100 kHz, less than the 360 kHz of the configuration; set its baud rate in config.txt, and \
         update a kernel from before December 2023"
    );
    let mut patient = config.clone();
    patient.buses.iter_mut().for_each(|bus| bus.clock = 0.0);
    assert_eq!(
        message(Speed { frequency_hz: 30_000, ..FAST }, &machine(Needs::default()), &patient),
        "a round on bus 0 takes 1930 µs at its clock of 30 kHz, more than 40 % of the sample period of 3333 µs; set its baud \
         rate to 400000 in config.txt, move boards to another bus, or allow lower sample rates in the policy by `needs`"
    );
    assert_eq!(
        message(FAST, &machine(Needs::default()), &configured(10.0, 10)),
        "a tick of 0.2 ms in a control period of 100.0 ms exceeds the timeout of `control`; raise that timeout, or the \
         control rate"
    );
    let mut other = machine(Needs::default());
    other.program.whiskers[0] = "r9".to_owned();
    assert_eq!(
        message(FAST, &other, &config),
        "the machine needs the whisker `r9`, which the array does not have; add a board, or compile another policy"
    );
}

#[test]
fn a_slower_loop_says_why() {
    let slower = |speed: Speed, low, high| {
        let needs = Needs { control_rate: Some(RateRange { low, high }), ..Needs::default() };
        message(speed, &machine(needs), &configured(30.0, 10))
    };
    assert_eq!(
        slower(Speed { tick: 0.020, ..FAST }, 20.0, 60.0),
        "warning: the loop runs at 23.1 Hz with samples at 300 Hz, instead of 30 Hz and 300 Hz, as the policy allows: a tick \
         takes up to 20.1 ms on this device, more than half of the control period of 33.3 ms"
    );
    assert_eq!(
        slower(FAST, 20.0, 25.0),
        "warning: the loop runs at 25 Hz with samples at 300 Hz, instead of 30 Hz and 300 Hz, as the policy allows: the policy \
         needs a control rate of 20 Hz to 25 Hz, but the rig has 30 Hz"
    );
}
