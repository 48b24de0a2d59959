//! The page that documents the topics.

use std::collections::BTreeSet;

use serde::Serialize;
use serde::de::DeserializeOwned;
use vibrissa_robot::services::Inputs;
use vibrissa_robot::telemetry::{
    CommandLog, Dropped, FaultNote, Health, Latency, Numbered, Perception, Samples, State, Topic,
};

const PAGE: &str = include_str!("../../../../docs/telemetry.md");

#[test]
fn the_page_lists_every_topic_and_no_other() {
    let rows = PAGE.lines().filter_map(|line| line.strip_prefix("| `"));
    let listed: BTreeSet<&str> = rows.filter_map(|row| row.split_once('`')).map(|(word, _)| word).collect();
    let words: BTreeSet<&str> = Topic::ALL.into_iter().map(Topic::word).collect();
    assert!(words.is_subset(&listed), "{words:?} {listed:?}");
    for topic in Topic::ALL {
        let row = PAGE.lines().find(|line| line.starts_with(&format!("| `{}`", topic.word()))).unwrap();
        assert_eq!(row.contains("| yes |"), topic.is_retained(), "{row}");
    }
}

/// The example below the heading of a topic.
fn example(topic: Topic) -> &'static str {
    let heading = format!("### `{}`", topic.word());
    let (_, section) = PAGE.split_once(&heading).unwrap_or_else(|| panic!("the page has no `{heading}`"));
    let (_, rest) = section.split_once("```json").unwrap();
    rest.split_once("```").unwrap().0
}

/// Reads an example, and compares it with what the program writes.
fn check<T: DeserializeOwned + Serialize>(topic: Topic) {
    let text = example(topic);
    let payload: T = serde_json::from_str(text).unwrap_or_else(|error| panic!("{topic:?}: {error}"));
    let value: serde_json::Value = serde_json::from_str(text).unwrap();
    assert_eq!(serde_json::to_value(&payload).unwrap(), value, "{topic:?}");
}

#[test]
fn the_examples_of_the_page_have_exactly_the_keys_of_the_payloads() {
    check::<Numbered<State>>(Topic::State);
    check::<Numbered<Health>>(Topic::Health);
    check::<Numbered<Samples>>(Topic::Samples);
    check::<Numbered<Perception>>(Topic::Perception);
    check::<Numbered<CommandLog>>(Topic::CommandLog);
    check::<Numbered<FaultNote>>(Topic::Events);
    check::<Numbered<Latency>>(Topic::Latency);
    check::<Dropped>(Topic::Dropped);
    check::<Inputs>(Topic::Inputs);
}
