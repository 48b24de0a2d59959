//! One tick of a run that is recorded.

use vibrissa_runtime::signal::Sample;

use crate::run::{MarkRecord, MessageRecord, TickRecord, Trace};

/// The inputs and the results of a tick.
#[derive(Debug, Clone)]
pub struct RecordedFrame {
    /// The samples of the control period before the tick.
    pub(crate) samples: Vec<Sample>,
    /// The tick.
    pub(crate) tick: TickRecord,
    /// The marks of the policy.
    pub(crate) marks: Vec<MarkRecord>,
    /// The plots that the policy has set: index and value.
    pub(crate) plots: Vec<(usize, f64)>,
    /// The messages of the policy.
    pub(crate) messages: Vec<MessageRecord>,
}

impl RecordedFrame {
    /// The last tick of a trace. `None` if it has none.
    #[must_use]
    pub fn last(trace: &Trace, samples: Vec<Sample>) -> Option<Self> {
        let index = trace.ticks.len().checked_sub(1)?;
        let plots = trace.plots.iter().enumerate().filter_map(|(plot, record)| {
            record.values.last().filter(|&&(tick, _)| tick == index).map(|&(_, value)| (plot, value))
        });
        Some(Self {
            samples,
            tick: trace.ticks[index].clone(),
            marks: last_of(&trace.marks, |mark| mark.tick == index),
            plots: plots.collect(),
            messages: last_of(&trace.messages, |message| message.tick == index),
        })
    }
}

/// The records at the end of a list that belong to a tick.
fn last_of<T: Clone>(records: &[T], is_of_tick: impl Fn(&T) -> bool) -> Vec<T> {
    let count = records.iter().rev().take_while(|record| is_of_tick(record)).count();
    records[records.len() - count..].to_vec()
}
