//! How the simulator goes from step to step.

/// How the simulator goes from step to step; what each does, MuJoCo's documentation says under "Numerical integration".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Integrator {
    /// Implicit in springs, dampers and contacts at once: stable at every step that goes into a sample.
    #[default]
    Discrete,
    /// Implicit in dampers but for what couples velocities.
    ImplicitFast,
    /// Implicit in dampers.
    Implicit,
    /// Explicit but for dampers.
    Euler,
    /// Runge and Kutta's of fourth order, explicit: four evaluations a step.
    RungeKutta,
}

impl Integrator {
    /// Every integrator.
    pub const ALL: [Self; 5] = [Self::Discrete, Self::ImplicitFast, Self::Implicit, Self::Euler, Self::RungeKutta];

    /// The name in scenarios, which is MuJoCo's.
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
