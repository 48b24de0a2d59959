//! Written schemas of all JSON outputs, compared with the output of the program.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may panic and open files")]
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

use vibrissa_lab::family::FamilyRun;
use vibrissa_lab::inspect::{NearMiss, PolicyDifference, StopRecord, TransitionLine, ViolationLine};
use vibrissa_lab::results::{Document, DriveResult, ReplayResult, RunResult, TickLine, Versioned};
use vibrissa_lab::study::bench::BenchRow;
use vibrissa_lab::study::compare::Comparison;
use vibrissa_lab::study::estimators::EstimatorRow;
use vibrissa_lab::study::pareto::Pareto;
use vibrissa_lab::study::scale::Scale;
use vibrissa_lab::study::stress::StressRow;
use vibrissa_lab::study::timing::TimingRow;
use vibrissa_lab::study::worlds::WorldsRow;
use vibrissa_lab::sweep::{Header, SweepLine, SweepSummary};
use vibrissa_lab::tune::{Tuning, TuningLine};
use vibrissa_world::world::Pruning;

use super::calibrate::Printed;
use super::calibrate_array::MeasuredDocument;
use super::calibrate_pluck::PluckDocument;
use super::check::Checked;
use super::push::Pushed;
use super::test::Tested;

/// A format, its version, and its schema.
fn schema<D: Document + JsonSchema + 'static>() -> (&'static str, u32, Schema) {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    (D::FORMAT, D::VERSION, generator.into_root_schema_for::<Versioned<'static, D>>())
}

#[test]
fn every_json_output_is_as_its_schema_says() {
    let schemas = [
        schema::<RunResult>(),
        schema::<DriveResult>(),
        schema::<ReplayResult>(),
        schema::<TickLine<'static>>(),
        schema::<TransitionLine>(),
        schema::<ViolationLine>(),
        schema::<StopRecord>(),
        schema::<PolicyDifference>(),
        schema::<NearMiss>(),
        schema::<BenchRow>(),
        schema::<TimingRow>(),
        schema::<WorldsRow>(),
        schema::<EstimatorRow>(),
        schema::<FamilyRun>(),
        schema::<Comparison>(),
        schema::<Pareto>(),
        schema::<Scale>(),
        schema::<StressRow>(),
        schema::<Header>(),
        schema::<SweepLine>(),
        schema::<SweepSummary>(),
        schema::<TuningLine>(),
        schema::<Tuning>(),
        schema::<Checked>(),
        schema::<Tested>(),
        schema::<Printed<'static>>(),
        schema::<MeasuredDocument>(),
        schema::<PluckDocument>(),
        schema::<Pruning>(),
        schema::<Pushed>(),
    ];
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/schema");
    for (format, version, mut schema) in schemas {
        schema.insert("title".to_owned(), format!("Vibrissa: {format}, version {version}").into());
        for (key, value) in [("format", serde_json::json!(format)), ("version", serde_json::json!(version))] {
            if let Some(property) = schema.pointer_mut(&format!("/properties/{key}")) {
                *property = serde_json::json!({ "const": value });
            }
        }
        let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        let path = format!("{folder}/{format}.schema.json");
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            std::fs::create_dir_all(folder).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        let written = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            written == text,
            "{path} is stale; run `INSTA_UPDATE=always cargo test --lib schema`. Raise the version if a key went or changed"
        );
    }
}
