//! How the simulator finds the forces of contacts.

/// How the simulator finds the forces of contacts; what each does, MuJoCo's documentation says under "Algorithms".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Solver {
    /// Conjugate gradients: the same forces as Newton's method to a millionth, without factoring a matrix of all joints.
    ConjugateGradients,
    /// Newton's method.
    Newton,
    /// Projected Gauss and Seidel's, in the dual problem, which is small where contacts are few. It delays the servos by a step.
    #[default]
    ProjectedGaussSeidel,
}

impl Solver {
    /// Every solver.
    pub const ALL: [Self; 3] = [Self::ConjugateGradients, Self::Newton, Self::ProjectedGaussSeidel];

    /// The name in scenarios, which is MuJoCo's.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ConjugateGradients => "CG",
            Self::Newton => "Newton",
            Self::ProjectedGaussSeidel => "PGS",
        }
    }
}
