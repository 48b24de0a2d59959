//! The table of the axes.

use std::path::Path;

use vibrissa_world::scene::WorldKind;

use super::case::{self, Case, RUN_TIME, RUNS};
use super::error::ScaleError;
use crate::trial::processors;

/// The axes whose costs the cost of a sweep is derived from.
pub(super) const CORES: &str = "cores";
pub(super) const RESULT_LINES: &str = "result lines";

/// An axis along which a cost is measured.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Its name.
    pub name: &'static str,
    /// What the sizes count.
    pub unit: &'static str,
    /// The work that is measured.
    pub work: String,
    /// The simulator of its runs. `None` if the work has none.
    pub simulator: Option<WorldKind>,
    /// The sizes, ascending.
    pub sizes: Vec<usize>,
    make: Make,
}

/// Makes the case of a size. Files are in the folder.
type Make = fn(usize, WorldKind, &Path) -> Result<Case, ScaleError>;

/// The simulators of an axis.
const QUASI_STATIC: &[Option<WorldKind>] = &[Some(WorldKind::QuasiStatic)];
const BOTH: &[Option<WorldKind>] = &[Some(WorldKind::Mujoco), Some(WorldKind::QuasiStatic)];
const NONE: &[Option<WorldKind>] = &[None];

/// All axes that this build can measure. Larger sizes show the exponent, because fixed costs are smaller beside them.
#[must_use]
pub fn axes() -> Vec<Axis> {
    let beside = format!("run of {RUN_TIME} s beside a disk");
    let runs = format!("runs of {RUN_TIME} s beside a disk, one after another");
    let parallel = format!("wall time of {RUNS} runs of {RUN_TIME} s beside a disk");
    let round = "run round a disk";
    let table: [(_, _, String, _, &[usize], Make); 9] = [
        (
            "run length",
            "simulated s",
            "run round a disk again and again".to_owned(),
            QUASI_STATIC,
            &[60, 600, 6000],
            case::run_length,
        ),
        ("far objects", "disks out of reach", round.to_owned(), QUASI_STATIC, &[5, 50, 500], case::far_objects),
        (
            "outline pieces",
            "lines",
            "run round a polygon".to_owned(),
            QUASI_STATIC,
            &[1000, 10_000, 100_000],
            case::outline_pieces,
        ),
        ("whiskers", "whiskers", beside.clone(), QUASI_STATIC, &[2, 4, 8], case::whiskers),
        ("links", "links of a whisker", beside, BOTH, &[8, 16, 32, 64], case::links),
        ("runs", "runs", runs, QUASI_STATIC, &[10, 100, 1000], case::runs),
        (CORES, "threads", parallel, QUASI_STATIC, &cores(), case::cores),
        (
            "states",
            "states",
            "compilation of a policy with all its analysis".to_owned(),
            NONE,
            &[10, 100, 1000],
            case::states,
        ),
        (
            RESULT_LINES,
            "lines",
            "merge of the results of a sweep".to_owned(),
            NONE,
            &[1000, 10_000, 100_000],
            case::result_lines,
        ),
    ];
    let axes = table.into_iter().flat_map(|(name, unit, work, simulators, sizes, make)| {
        let simulators =
            simulators.iter().filter(|simulator| **simulator != Some(WorldKind::Mujoco) || cfg!(feature = "sim"));
        let sizes = sizes.to_vec();
        simulators.map(move |&simulator| Axis { name, unit, work: work.clone(), simulator, sizes: sizes.clone(), make })
    });
    // Outlines with so many pieces are in files.
    axes.filter(|axis| axis.name != "outline pieces" || cfg!(feature = "outlines")).collect()
}

/// The powers of two below the number of processors, and that number.
fn cores() -> Vec<usize> {
    let processors = processors().get();
    let powers = std::iter::successors(Some(1_usize), |power| power.checked_mul(2));
    powers.take_while(|power| *power < processors).chain([processors]).collect()
}

impl Axis {
    /// The name with the simulator, if there are two.
    #[must_use]
    pub fn title(&self) -> String {
        self.simulator.map_or_else(|| self.name.to_owned(), |simulator| format!("{}, {simulator}", self.name))
    }

    /// The case of a size, with its files in a folder.
    pub(super) fn case(&self, size: usize, folder: &Path) -> Result<Case, ScaleError> {
        (self.make)(size, self.simulator.unwrap_or(WorldKind::QuasiStatic), folder)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn every_case_can_be_read_and_begins() {
        let folder = tempfile::tempdir().unwrap();
        for axis in axes() {
            assert!(axis.sizes.is_sorted_by(|size, next| size < next), "{}", axis.title());
            // Files with many results take long to write.
            for &size in axis.sizes.iter().filter(|size| axis.name != RESULT_LINES || **size < 10_000) {
                let case = axis.case(size, folder.path());
                assert!(case.is_ok(), "{} of {size}: {:?}", axis.title(), case.err());
            }
        }
    }
}
