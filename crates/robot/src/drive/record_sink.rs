//! Receivers of the loop's records.

use super::loop_record::LoopRecord;
use crate::vitals::Vitals;

/// A receiver of the loop's records, such as a log, a broker or a file. It runs on a thread with ordinary priority, so it
/// may allocate memory and write files. While it waits, the queue of records fills, and records are lost.
pub trait RecordSink: Send {
    /// Takes the next record.
    fn take(&mut self, record: &LoopRecord);

    /// All records until now have been taken. `now_ns` is the time since the start of the program.
    fn pause(&mut self, now_ns: u64, vitals: &Vitals) {
        let _ = (now_ns, vitals);
    }

    /// No further records follow.
    fn finish(&mut self) {}
}
