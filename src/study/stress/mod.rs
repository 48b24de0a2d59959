//! What is hard on a world: every case ends in one of the ways in which runs end, with numbers that are finite; and the largest
//! steps that are stable.

mod case;
mod run;
mod stability;

pub use case::{CaseError, Drive, StressCase, stress_cases};
pub use run::StressRow;
pub use stability::StabilityCase;

/// A case, or a setting of which the largest stable step is sought.
#[derive(Debug, Clone)]
pub enum StressTask {
    /// A case.
    Case(Box<StressCase>),
    /// A setting.
    Step(Box<StabilityCase>),
}

impl StressTask {
    /// All of them: the list that processes agree on.
    ///
    /// # Errors
    /// [`CaseError`] when a case cannot be made.
    pub fn all() -> Result<Vec<Self>, CaseError> {
        let cases = stress_cases()?.into_iter().map(|case| Self::Case(Box::new(case)));
        Ok(cases.chain(StabilityCase::all().into_iter().map(|case| Self::Step(Box::new(case)))).collect())
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Case(case) => &case.name,
            Self::Step(case) => &case.name,
        }
    }

    /// Does it.
    #[must_use]
    pub fn run(&self) -> StressRow {
        match self {
            Self::Case(case) => case.run(),
            Self::Step(case) => case.run(),
        }
    }

    /// What is told of it if it ended its process.
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
