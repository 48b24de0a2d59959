//! The numerical integrator of MuJoCo.

/// The numerical integrator, as documented by MuJoCo under "Numerical integration".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Integrator {
    /// Implicit in springs, dampers and contacts. Stable for every step up to a sample period.
    #[default]
    Discrete,
    /// Implicit in dampers, without the coupling of velocities.
    ImplicitFast,
    /// Implicit in dampers.
    Implicit,
    /// Explicit except for dampers.
    Euler,
    /// Explicit fourth-order Runge-Kutta method with four evaluations per step.
    RungeKutta,
}

impl Integrator {
    /// All integrators.
    pub const ALL: [Self; 5] = [Self::Discrete, Self::ImplicitFast, Self::Implicit, Self::Euler, Self::RungeKutta];

    /// MuJoCo's name, also used in scenarios.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::ImplicitFast => "implicitfast",
            Self::Implicit => "implicit",
            Self::Euler => "Euler",
            Self::RungeKutta => "RK4",
        }
    }
}
