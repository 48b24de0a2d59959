//! What a run has done until now, for viewers and counterfactuals.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use vibrissa_runtime::signal::Sample;

use vibrissa_lab::recording::RecordedFrame;
use vibrissa_lab::run::Trace;
use vibrissa_lab::stream::message::{Frame, Hello, MapFrame};
use vibrissa_lab::stream::{Changeable, GuardNumbers, PastRun, RunFacts, RunSetup, SampleStore, Shadow, TickResult};
use vibrissa_text::diagnostic::Source;
use vibrissa_world::scene::Scene;

/// Number of ticks between copies of the control loop. A counterfactual executes at most as many ticks before its own.
const CHECKPOINT_TICKS: usize = 256;
/// The largest number of frames that are kept. The page has its own limit, `LIMIT` in `web/src/live/history.ts`. With more, every second one of the older ones is dropped.
const FRAME_LIMIT: usize = 36_000;
/// The number of the newest frames that are all kept.
const NEWEST: usize = 4096;
/// The number of ticks that are kept for viewers of Foxglove's protocol.
const RAW_LIMIT: usize = 128;

/// A run and its past.
pub(super) struct RunLog {
    /// What does not change.
    pub(super) facts: RunFacts,
    /// The scene, if it is known.
    pub(super) scene: Option<Scene>,
    /// The text of the policy, if there is one.
    pub(super) policy: Option<Source>,
    /// A trace of the run without ticks, as soon as it has had one.
    pub(super) names: OnceLock<Trace>,
    past: Mutex<Past>,
}

/// The past of a run.
pub(super) struct Past {
    frames: Vec<Arc<Frame>>,
    /// Frames with an index that is a multiple of this are kept.
    kept_every: usize,
    /// The results of all ticks.
    ticks: Vec<TickResult>,
    samples: SampleStore,
    /// Copies of the control loop, with the number of ticks that they have executed.
    checkpoints: Vec<(usize, Box<Shadow>)>,
    /// The newest ticks for viewers of Foxglove's protocol.
    raw: VecDeque<(usize, Arc<RecordedFrame>)>,
}

/// A tick that a run has executed.
pub(super) struct Executed<'t> {
    /// The frame for pages.
    pub(super) frame: Frame,
    /// The result.
    pub(super) result: TickResult,
    /// The samples before it.
    pub(super) samples: &'t [Sample],
    /// The control loop after it.
    pub(super) shadow: &'t Shadow,
    /// The tick for viewers of Foxglove's protocol, if there are any.
    pub(super) raw: Option<RecordedFrame>,
}

impl RunLog {
    /// The log of a run before its first tick. `shadow` is the control loop at the start.
    pub(super) fn new(
        (hello, numbers, changeable): (Hello, GuardNumbers, Changeable),
        setup: &RunSetup,
        shadow: &Shadow,
    ) -> Self {
        let past = Past {
            frames: Vec::new(),
            kept_every: 1,
            ticks: Vec::new(),
            samples: SampleStore::new(setup.rig.whiskers.len()),
            checkpoints: vec![(0, Box::new(shadow.clone()))],
            raw: VecDeque::new(),
        };
        Self {
            facts: RunFacts {
                hello: Arc::new(hello),
                numbers,
                changeable,
                rig: setup.rig.clone(),
                trial: setup.trial.clone(),
            },
            scene: setup.scene.clone(),
            policy: setup.policy.clone(),
            names: OnceLock::new(),
            past: Mutex::new(past),
        }
    }

    /// The past. It is locked for the time of a copy.
    pub(super) fn past(&self) -> MutexGuard<'_, Past> {
        // A thread that panicked has not left it half changed: it only pushes.
        self.past.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl PastRun for RunLog {
    fn facts(&self) -> &RunFacts {
        &self.facts
    }

    fn sampled(&self) -> usize {
        self.past().samples.ticks()
    }

    fn samples(&self, tick: usize) -> Vec<Sample> {
        self.past().samples.get(tick)
    }

    fn result(&self, tick: usize) -> Option<TickResult> {
        self.past().ticks.get(tick).copied()
    }

    fn checkpoint(&self, ticks: usize) -> Option<(usize, Box<Shadow>)> {
        self.past().checkpoint(ticks)
    }
}

impl Past {
    /// Adds a tick.
    pub(super) fn push(&mut self, executed: Executed<'_>) {
        let Executed { frame, result, samples, shadow, raw } = executed;
        let tick = self.ticks.len();
        self.samples.push(samples);
        self.ticks.push(result);
        self.frames.push(Arc::new(frame));
        if let Some(raw) = raw {
            self.raw.push_back((tick, Arc::new(raw)));
            self.raw.drain(..self.raw.len().saturating_sub(RAW_LIMIT));
        }
        if self.ticks.len().is_multiple_of(CHECKPOINT_TICKS) {
            self.checkpoints.push((self.ticks.len(), Box::new(shadow.clone())));
        }
        if self.frames.len() > FRAME_LIMIT {
            self.kept_every *= 2;
            let newest = self.frames.split_off(self.frames.len().saturating_sub(NEWEST));
            self.frames = thinned(&self.frames, self.kept_every);
            self.frames.extend(newest);
        }
    }

    /// The number of ticks.
    pub(super) fn len(&self) -> usize {
        self.ticks.len()
    }

    /// The program keeps every tick whose index is a multiple of this.
    pub(super) fn kept_every(&self) -> usize {
        self.kept_every
    }

    /// The frames from a tick on, at most `most` of the newest ones.
    pub(super) fn newest(&self, from: usize, most: usize) -> Vec<Arc<Frame>> {
        let first = self.frames.partition_point(|frame| frame.tick < from);
        let first = first.max(self.frames.len().saturating_sub(most));
        self.frames.get(first..).unwrap_or_default().to_vec()
    }

    /// The ticks from one on for viewers of Foxglove's protocol.
    pub(super) fn raw(&self, from: usize) -> Vec<(usize, Arc<RecordedFrame>, Option<Arc<Frame>>)> {
        let frame = |tick: usize| {
            let place = self.frames.binary_search_by_key(&tick, |frame| frame.tick).ok()?;
            self.frames.get(place).cloned()
        };
        let from = self.raw.iter().filter(|(tick, _)| *tick >= from);
        from.map(|(tick, raw)| (*tick, Arc::clone(raw), frame(*tick))).collect()
    }

    /// The frames of a range of ticks, at most `most`.
    pub(super) fn range(&self, from: usize, to: usize, most: usize) -> Vec<Arc<Frame>> {
        let [first, last] = [from, to].map(|tick| self.frames.partition_point(|frame| frame.tick < tick));
        let frames = self.frames.get(first..last).unwrap_or_default();
        if frames.len() <= most {
            return frames.to_vec();
        }
        thinned(frames, to.saturating_sub(from).div_ceil(most.max(1)))
    }

    /// The last copy of the control loop that has executed at most this number of ticks.
    fn checkpoint(&self, ticks: usize) -> Option<(usize, Box<Shadow>)> {
        let place = self.checkpoints.partition_point(|(executed, _)| *executed <= ticks).checked_sub(1)?;
        self.checkpoints.get(place).cloned()
    }

    /// Replaces the copies of the control loop by those of a loop with other breakpoints. It executes all ticks again, and is then at
    /// the same tick.
    pub(super) fn repeat(&mut self, shadow: &mut Shadow) {
        self.checkpoints = vec![(0, Box::new(shadow.clone()))];
        for tick in 0..self.samples.ticks() {
            let _ = shadow.tick(&self.samples.get(tick));
            if (tick + 1).is_multiple_of(CHECKPOINT_TICKS) {
                self.checkpoints.push((tick + 1, Box::new(shadow.clone())));
            }
        }
    }
}

/// The frames whose index is a multiple of `every`, and the last one. Events of the dropped frames are in the next kept one, and so are
/// plots and the map that it has not set itself.
fn thinned(frames: &[Arc<Frame>], every: usize) -> Vec<Arc<Frame>> {
    let mut kept = Vec::with_capacity(frames.len() / every.max(1) + 1);
    let (mut contour, mut taken, mut messages) = (Vec::new(), Vec::new(), Vec::new());
    let mut plots: Vec<Option<f64>> = Vec::new();
    let mut map: Option<Box<MapFrame>> = None;
    for (place, frame) in frames.iter().enumerate() {
        if !frame.tick.is_multiple_of(every.max(1)) && place + 1 < frames.len() {
            contour.extend_from_slice(&frame.contour);
            taken.extend_from_slice(&frame.taken);
            messages.extend_from_slice(&frame.messages);
            plots.resize(frame.plots.len(), None);
            plots.iter_mut().zip(&frame.plots).for_each(|(kept, value)| *kept = value.or(*kept));
            map = joined(map, frame.map.clone());
            continue;
        }
        let has_plots = frame.plots.iter().zip(&plots).any(|(own, before)| own.is_none() && before.is_some());
        if contour.is_empty() && taken.is_empty() && messages.is_empty() && !has_plots && map.is_none() {
            plots.clear();
            kept.push(Arc::clone(frame));
            continue;
        }
        let mut frame = frame.as_ref().clone();
        frame.contour.splice(0..0, contour.drain(..));
        frame.taken.splice(0..0, taken.drain(..));
        frame.messages.splice(0..0, messages.drain(..));
        frame.plots.iter_mut().zip(plots.drain(..)).for_each(|(own, before)| *own = own.or(before));
        frame.map = joined(map.take(), frame.map);
        kept.push(Arc::new(frame));
    }
    kept
}

/// Two frames of the map as one.
fn joined(before: Option<Box<MapFrame>>, now: Option<Box<MapFrame>>) -> Option<Box<MapFrame>> {
    let Some(mut now) = now else { return before };
    if let Some(before) = before {
        now.prepend(*before);
    }
    Some(now)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vibrissa_lab::stream::message::{ContourFrame, Metrics};

    #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "a small count")]
    fn frame(tick: usize, tips: usize, plot: Option<f64>) -> Arc<Frame> {
        let tip =
            |number: usize| ContourFrame { whisker: number, point: [tick as f64, 0.0], spread: None, error: None };
        Arc::new(Frame {
            tick,
            time: 0.0,
            states: Vec::new(),
            pose: [0.0; 3],
            whiskers: Vec::new(),
            guards: Vec::new(),
            taken: Vec::new(),
            command: [0.0; 3],
            contour: (0..tips).map(tip).collect(),
            metrics: Metrics::default(),
            timing: None,
            messages: Vec::new(),
            plots: vec![plot],
            map: (tips > 1).then(|| Box::new(MapFrame { free: vec![[tick as i32, 0, 0]], ..MapFrame::default() })),
        })
    }

    proptest! {
        #[test]
        fn thinned_ticks_have_all_recorded_tips_and_cells_in_their_order(
            tips in prop::collection::vec(0..4_usize, 0..60), every in 1..9_usize,
        ) {
            let frames: Vec<_> = tips.iter().enumerate().map(|(tick, &tips)| frame(tick, tips, None)).collect();
            let kept = thinned(&frames, every);
            let all = |frames: &[Arc<Frame>]| frames.iter().flat_map(|frame| frame.contour.clone()).collect::<Vec<_>>();
            prop_assert_eq!(all(&kept), all(&frames));
            let maps = |frames: &[Arc<Frame>]| frames.iter().filter_map(|frame| frame.map.clone()).collect::<Vec<_>>();
            let cells = |frames: &[Arc<Frame>]| maps(frames).into_iter().flat_map(|map| map.free).collect::<Vec<_>>();
            prop_assert_eq!(cells(&kept), cells(&frames));
            prop_assert_eq!(kept.last().map(|frame| frame.tick), frames.last().map(|frame| frame.tick));
            prop_assert!(kept.len() <= frames.len().div_ceil(every) + 1);
            let mut earlier = kept.iter().rev().skip(1);
            prop_assert!(earlier.all(|frame| frame.tick % every == 0));
        }

        #[test]
        fn a_thinned_tick_has_the_last_value_of_a_plot_since_the_kept_tick_before(
            values in prop::collection::vec(prop::option::of(0.0..1.0_f64), 0..60), every in 1..9_usize,
        ) {
            let frames: Vec<_> = values.iter().enumerate().map(|(tick, &value)| frame(tick, 0, value)).collect();
            let mut from = 0;
            for kept in thinned(&frames, every) {
                let last = values[from..=kept.tick].iter().flatten().last().copied();
                prop_assert_eq!(&kept.plots, &[last]);
                from = kept.tick + 1;
            }
        }
    }
}
