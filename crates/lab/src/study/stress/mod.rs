//! Stress tests of a world. Every case must end with a regular outcome and finite numbers. Other tasks search the
//! largest stable step.

mod case;
mod run;
mod stability;

pub use case::{CaseError, Drive, StressCase, stress_cases};
pub use run::StressRow;
pub use stability::StabilityCase;

/// A stress test, or the search for the largest stable step of a setting.
#[derive(Debug, Clone)]
pub enum StressTask {
    /// A case.
    Case(Box<StressCase>),
    /// A setting.
    Step(Box<StabilityCase>),
}

impl StressTask {
    /// All tasks. Processes identify a task by its index in this list.
    ///
    /// # Errors
    /// [`CaseError`] if a case cannot be made.
    pub fn all() -> Result<Vec<Self>, CaseError> {
        let cases = stress_cases()?.into_iter().map(|case| Self::Case(Box::new(case)));
        Ok(cases.chain(StabilityCase::all().into_iter().map(|case| Self::Step(Box::new(case)))).collect())
    }

    /// The name of the task.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Case(case) => &case.name,
            Self::Step(case) => &case.name,
        }
    }

    /// Executes the task.
    #[must_use]
    pub fn run(&self) -> StressRow {
        match self {
            Self::Case(case) => case.run(),
            Self::Step(case) => case.run(),
        }
    }

    /// The row of a task whose process crashed.
    #[must_use]
    pub fn crashed(&self, reason: String) -> StressRow {
        match self {
            Self::Case(case) => case.crashed(reason),
            Self::Step(case) => {
                let (name, world) = (case.name.clone(), case.world.to_string());
                StressRow::Step { name, world, largest_ms: None, reason: Some(reason) }
            }
        }
    }
}
