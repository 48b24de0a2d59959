//! The numerical integrator of MuJoCo.

vibrissa_runtime::kinds! {
    /// The numerical integrator, as documented by MuJoCo under "Numerical integration".
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Integrator,
    /// MuJoCo's name, also used in scenarios.
    fn name {
        /// Implicit in springs, dampers and contacts. Stable for every step up to a sample period.
        #[default]
        Discrete = "discrete",
        /// Implicit in dampers, without the coupling of velocities.
        ImplicitFast = "implicitfast",
        /// Implicit in dampers.
        Implicit = "implicit",
        /// Explicit except for dampers.
        Euler = "Euler",
        /// Explicit fourth-order Runge-Kutta method with four evaluations per step.
        RungeKutta = "RK4",
    }
}
