//! The contact solver of MuJoCo.

/// The solver for contact forces, as documented by MuJoCo under "Algorithms".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Solver {
    /// Conjugate gradients. The forces agree with Newton's method to a millionth, without a factorisation.
    ConjugateGradients,
    /// Newton's method.
    Newton,
    /// Projected Gauss-Seidel for the dual problem, which is small if there are few contacts. It delays the servos by a
    /// step.
    #[default]
    ProjectedGaussSeidel,
}

impl Solver {
    /// All solvers.
    pub const ALL: [Self; 3] = [Self::ConjugateGradients, Self::Newton, Self::ProjectedGaussSeidel];

    /// MuJoCo's name, also used in scenarios.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ConjugateGradients => "CG",
            Self::Newton => "Newton",
            Self::ProjectedGaussSeidel => "PGS",
        }
    }
}
