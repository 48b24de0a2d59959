//! Pages for a browser: self-contained HTML files with tables and figures.
//!
//! A page is complete without its script. The script sorts, exports and zooms.

mod bench;
mod changes;
mod comparison;
mod document;
mod families;
mod figure;
mod pareto;
mod provenance;
mod run;
mod runs;
mod sweep;
mod table;

pub use bench::bench_page;
pub use comparison::comparison_page;
pub use families::families_page;
pub use pareto::pareto_page;
pub use run::RunFigures;
pub use runs::runs_page;
pub use sweep::sweep_page;
