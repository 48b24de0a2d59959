//! Random sequences of pushes, starts, marks and losses of power, compared with a model.

use std::collections::BTreeSet;
use std::path::Path;

use proptest::prelude::*;

use crate::store::{SignedMachine, State, Store, StoreError};

use super::fixture::{MACHINES, frame, hash, keys, machine};
use super::interrupted_disk::{InterruptedDisk, Kill};
use super::simulated_disk::SimulatedDisk;

#[derive(Debug, Clone, Copy)]
enum Step {
    Push(usize),
    /// The signature belongs to another machine.
    PushForged(usize),
    /// A start. Without a mark afterwards, the run crashed.
    Start,
    UndoStart,
    MarkGood,
    Reject,
}

/// A loss of power during a step.
#[derive(Debug, Clone, Copy)]
struct Loss {
    kill: Kill,
    survivors: usize,
}

/// The rules, without hashes, files or pruning.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Model {
    good: Option<usize>,
    /// A machine, and whether it was started.
    tentative: Option<(usize, bool)>,
}

impl Model {
    fn after(mut self, step: Step) -> Self {
        match (step, self.tentative) {
            (Step::Push(number), _) => self.tentative = (self.good != Some(number)).then_some((number, false)),
            (Step::Start, Some((number, false))) => self.tentative = Some((number, true)),
            (Step::Start | Step::Reject, _) => self.tentative = None,
            (Step::MarkGood, Some((number, _))) => self = Self { good: Some(number), tentative: None },
            (Step::UndoStart, Some((number, _))) => self.tentative = Some((number, false)),
            (Step::UndoStart | Step::MarkGood | Step::PushForged(_), _) => {}
        }
        self
    }

    fn current(self) -> Option<usize> {
        self.tentative.map(|(number, _)| number).or(self.good)
    }

    fn fits(self, state: &State) -> bool {
        let tentative = state.tentative.map(|tentative| (tentative.hash, tentative.starts));
        state.good == self.good.map(hash)
            && tentative == self.tentative.map(|(number, started)| (hash(number), u32::from(started)))
    }
}

/// Does a step. Returns true if it succeeded.
fn execute(store: &Store, step: Step, model: Model) -> bool {
    let tentative = hash(model.tentative.map_or(1, |(number, _)| number));
    match step {
        Step::Push(number) => store.receive(&frame(&machine(number))[..], &keys()).is_ok(),
        Step::PushForged(number) => {
            let other = machine(number % MACHINES + 1);
            let forged = SignedMachine::new(machine(number).artifact().to_vec(), other.signature().to_owned());
            store.receive(&frame(&forged)[..], &keys()).is_ok()
        }
        Step::Start => match store.begin_run() {
            Ok(machine) => {
                assert_eq!(Some(machine.hash), model.after(step).current().map(hash));
                true
            }
            Err(_) => false,
        },
        Step::UndoStart => store.undo_start(tentative).is_ok(),
        Step::MarkGood => store.mark_good(tentative).is_ok(),
        Step::Reject => store.reject(tentative, "a reason").is_ok(),
    }
}

fn step() -> impl Strategy<Value = Step> {
    prop_oneof![
        4 => (1..=MACHINES).prop_map(Step::Push),
        1 => (1..=MACHINES).prop_map(Step::PushForged),
        4 => Just(Step::Start),
        1 => Just(Step::UndoStart),
        3 => Just(Step::MarkGood),
        1 => Just(Step::Reject),
    ]
}

fn loss() -> impl Strategy<Value = Loss> {
    (0..14_usize, 0..=4_usize, any::<usize>())
        .prop_map(|(after, quarters, survivors)| Loss { kill: Kill { after, quarters }, survivors })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// The current machine is one that was pushed with its signature. After a failed tentative machine it is the last good
    /// one. A loss of power during a step leaves the state before or after it.
    #[test]
    fn the_current_machine_is_the_tentative_or_the_last_good_one(
        steps in prop::collection::vec((step(), prop::option::weighted(0.3, loss())), 1..25),
    ) {
        let disk = SimulatedDisk::default();
        let mut model = Model::default();
        let mut pushed = BTreeSet::new();
        for (step, loss) in steps {
            let next = model.after(step);
            if let Some(Loss { kill, survivors }) = loss {
                let killed = InterruptedDisk::new(disk.clone(), kill);
                let done = execute(&Store::on(Path::new("store"), Box::new(killed)), step, model);
                disk.lose_power(survivors);
                let state = disk.store().status().unwrap();
                prop_assert!(next.fits(&state) || model.fits(&state) && !done);
                model = if next.fits(&state) { next } else { model };
            } else {
                execute(&disk.store(), step, model);
                model = next;
            }
            if let Step::Push(number) = step {
                pushed.insert(hash(number));
            }
            let store = disk.store();
            prop_assert!(model.fits(&store.status().unwrap()), "{:?}, {:?}", model, store.status());
            match (store.current(), model.current()) {
                (Ok(machine), Some(number)) => {
                    prop_assert_eq!(machine.hash, hash(number));
                    prop_assert!(pushed.contains(&machine.hash));
                }
                (Err(StoreError::NoMachine { .. }), None) => {}
                (current, expected) => prop_assert!(false, "{:?}, expected {:?}", current, expected),
            }
        }
    }
}
