//! The contact solver of MuJoCo.

vibrissa_runtime::kinds! {
    /// The solver for contact forces, as documented by MuJoCo under "Algorithms".
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Solver,
    /// MuJoCo's name, also used in scenarios.
    fn name {
        /// Conjugate gradients. The forces agree with Newton's method to a millionth, without a factorisation.
        ConjugateGradients = "CG",
        /// Newton's method.
        Newton = "Newton",
        /// Projected Gauss-Seidel for the dual problem, which is small if there are few contacts. It delays the servos by a
        /// step.
        #[default]
        ProjectedGaussSeidel = "PGS",
    }
}
