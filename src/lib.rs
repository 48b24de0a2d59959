//! Scenarios, simulators, scores and a policy language for robots that feel with whiskers.
//!
//! This crate compiles control policies and reads scenes from YAML. It simulates a robot with whiskers under a policy,
//! and scores the estimated contour against the exact one. The crate [`vibrissa_runtime`] has the control loop that also
//! runs on the robot.
//!
//! For contributors: only commands, the live page, videos and files of services are in this crate. An option is in
//! `command/NAME.rs` and its parser in `command/values.rs`. Everything else is exported from `crates`.
//!
//! # From a scenario to a result
//!
//! 1. [`scenario::read`] reads a scenario from a text. The result is a [`scene::Scene`] in SI units.
//! 2. [`policy::compile`] compiles a policy. The result is a [`Program`](vibrissa_runtime::machine::Program).
//! 3. [`trial::Trial`] combines both with a world and a seed. [`Trial::run`](trial::Trial::run) simulates and scores.
//! 4. [`trial::TrialResult`] has the [`run::Trace`] of the run, the [`score::Score`] and the expectations that fail.
//! 5. [`report`] makes tables and pictures of it, and [`results`] makes JSON.
//!
//! This example runs the disk in the quasi-static simulator, which needs no library:
//!
//! ```
//! use std::sync::Arc;
//! use vibrissa::diagnostic::Source;
//! use vibrissa::scene::{Outcome, WorldKind};
//! use vibrissa::{built_in, policy, scenario, trial::Trial};
//!
//! let disk = built_in::SCENARIOS[0];
//! let scene = scenario::read(&Source::new(disk.path, disk.text)).expect("the disk is a valid scenario");
//! let source = Source::new("bang.fsm", "
//!     machine bang
//!     whisker r0
//!     initial Exploring
//!     state Exploring {
//!       steer body along direction(body.yaw) at 50 mm/s turning 0 deg/s
//!       when r0.touching -> Following
//!     }
//!     state Following {
//!       record r0
//!       if |r0.base_angle| < 150 urad {
//!         steer body along direction(body.yaw - 15 deg) at 50 mm/s turning -10 deg/s
//!       } else {
//!         steer body along direction(body.yaw + 25 deg) at 50 mm/s turning 3 deg/s
//!       }
//!     }
//! ");
//! let program = policy::compile(&source).expect("the policy has no error");
//!
//! let mut trial = Trial::new(scene, Arc::new(program));
//! trial.world = WorldKind::QuasiStatic.into();
//! let result = trial.run().expect("the rig has the whisker r0");
//!
//! let error = result.score.error.expect("the policy recorded tips");
//! println!("mean error {:.3} mm, coverage {:.1} %", 1e3 * error.mean, 100.0 * result.score.coverage);
//! assert_eq!(result.run.outcome, Outcome::Completed);
//! assert!(error.mean < 0.8e-3);
//! ```
//!
//! The folder `examples` has longer programs:
//!
//! | example | shows |
//! |---|---|
//! | `run_scenario` | a scenario and a policy from files, the figures and the picture of the run |
//! | `write_world` | an own simulator: an implementation of [`world::World`] |
//! | `contact_estimator` | an own contact estimator, evaluated on recorded samples |
//! | `add_metric` | an own metric, computed from the trace of a run |
//!
//! # Modules
//!
//! | purpose | modules |
//! |---|---|
//! | input texts and their errors | [`scenario`], [`policy`], [`outline`], [`diagnostic`], [`built_in`] |
//! | scenes and exact geometry | [`scene`], [`solid`], [`geometry`], [`physics`] |
//! | simulators | [`world`], [`mujoco`], [`quasi_static`] |
//! | runs and their evaluation | [`request`], [`trial`], [`run`], [`figures`], [`score`], [`results`], [`inspect`], `recording`, `video` |
//! | many runs | [`study`], [`family`], [`sweep`], [`tune`] |
//! | tables, pages and pictures | [`report`] |
//! | measured whiskers | [`calibration`] |
//!
//! Lengths are in metres, angles in radians, times in seconds and forces in newtons. Only input texts and reports have
//! other units.
//!
//! # Features
//!
//! | feature | default | adds |
//! |---|---|---|
//! | `sim` | yes | the MuJoCo simulator. It needs MuJoCo's library, which `cargo x setup` installs into a checkout |
//! | `recording` | yes | recordings of runs as MCAP files, and their replay |
//! | `live` | yes | a page that shows a run while it happens |
//! | `render` | yes | `run --video`, videos of runs. A video needs EGL and a driver |
//! | `lsp` | yes | the command `vibrissa lsp`, a language server for editors |
//! | `viewer` | no | `run --view`, MuJoCo's window during a run |
//! | `outlines` | yes | outlines from SVG, DXF, CSV and STL files |
//! | `standard-library` | no | the standard library of policies, which only the command has by itself |
//!
//! Without `sim`, everything except the MuJoCo simulator works. No library is necessary then.
//!
//! # Pages of the book
//!
//! The book is in the folder `docs` of the repository. `cargo x book` builds it.
//!
//! | page | content |
//! |---|---|
//! | `docs/language.md` | tour of the policy language |
//! | `docs/language-semantics.md`, `docs/reference.md` | its semantics, and its words, types, members and functions |
//! | `docs/scenarios.md` | reference of the scenario format |
//! | `docs/metrics.md` | definitions of all figures |
//! | `docs/worlds.md` | the simulators and their differences |
//! | `docs/rig.md` | platform, whiskers and sensors, with frames and signs |
//! | `docs/glossary.md` | terms of the field |
//! | `docs/howto/extend.md` | how to add a contact estimator, a metric, a scene family or a construct of the language |
//! | `ARCHITECTURE.md` | the structure of the code, for contributors |

mod command;
#[cfg(feature = "live")]
pub mod live;
pub mod services;
#[cfg(unix)]
mod stage;
#[cfg(any(feature = "render", feature = "viewer"))]
pub mod video;

pub use vibrissa_declare::{catalogue, figures, rig};
#[cfg(feature = "recording")]
pub use vibrissa_lab::recording;
pub use vibrissa_lab::{
    built_in, calibration, emulated, family, inspect, report, request, results, run, score, study, sweep, trial, tune,
};
pub use vibrissa_language as policy;
pub use vibrissa_mujoco as mujoco;
pub use vibrissa_text::diagnostic;
pub use vibrissa_world::{geometry, mismatch, outline, physics, quasi_static, scenario, scene, solid, world};

#[doc(hidden)]
pub use command::main as command_line;
