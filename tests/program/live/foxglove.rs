//! The stream for viewers of Foxglove's protocol.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};
use tungstenite::Message;

use super::session::{SCENE, Session};
use crate::command::program::directory;

#[test]
fn a_viewer_subscribes_and_decodes_messages() {
    let folder = directory("live-foxglove");
    std::fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    let session = Session::start(&folder, &["run", "scene.yaml", "--live", "--live-speed", "5"]);
    let mut viewer = session.connect("foxglove.sdk.v1");
    let info = viewer.next();
    assert_eq!(info["op"], "serverInfo", "{info}");
    let mut channels = BTreeMap::new();
    let advertised = viewer.next();
    assert_eq!(advertised["op"], "advertise");
    for channel in advertised["channels"].as_array().unwrap() {
        channels.insert(channel["topic"].as_str().unwrap().to_owned(), channel.clone());
    }
    shows_these(&channels);
    let [ticks, scene] = ["ticks", "scene"].map(|topic| channels[topic].clone());
    assert_eq!((&ticks["encoding"], &ticks["schemaEncoding"]), (&"json".into(), &"jsonschema".into()));
    assert_eq!((&scene["encoding"], &scene["schemaName"]), (&"protobuf".into(), &"foxglove.SceneUpdate".into()));
    let schema: Value = serde_json::from_str(ticks["schema"].as_str().unwrap()).unwrap();
    viewer.send(&json!({"op": "subscribe", "subscriptions": [{"id": 7, "channelId": ticks["id"]}, {"id": 8, "channelId": scene["id"]}]}));
    let (mut shown, mut times) = (0, Vec::new());
    while times.len() < 10 || shown == 0 {
        let Message::Binary(data) = viewer.receive() else { continue };
        assert_eq!(data[0], 1);
        let subscription = u32::from_le_bytes(data[1..5].try_into().unwrap());
        let time = u64::from_le_bytes(data[5..13].try_into().unwrap());
        if subscription == 8 {
            shown += 1;
            continue;
        }
        assert_eq!(subscription, 7);
        let tick: Value = serde_json::from_slice(&data[13..]).unwrap();
        assert!(jsonschema::is_valid(&schema, &tick), "{tick}");
        assert!((tick["time_s"].as_f64().unwrap() * 1e9 - time as f64).abs() < 1.0);
        times.push(time);
    }
    assert!(times.is_sorted_by(|a, b| a < b), "{times:?}");
}

/// The layout for viewers has topics and keys of the channels.
fn shows_these(channels: &BTreeMap<String, Value>) {
    let layout: Value = serde_json::from_str(include_str!("../../../deploy/viewers/foxglove.json")).unwrap();
    let panels = layout["configById"].as_object().unwrap();
    let mut paths: Vec<String> = panels["3D!scene"]["topics"].as_object().unwrap().keys().cloned().collect();
    paths.push(panels["RawMessages!guards"]["topicPath"].as_str().unwrap().to_owned());
    for panel in ["StateTransitions!states", "Plot!angles"] {
        let shown = panels[panel]["paths"].as_array().unwrap();
        paths.extend(shown.iter().map(|path| path["value"].as_str().unwrap().replace("[:]", "")));
    }
    for path in &paths {
        let mut keys = path.split('.');
        let channel = &channels[keys.next().unwrap()];
        let mut keys = keys.peekable();
        if keys.peek().is_none() {
            continue;
        }
        let root: Value = serde_json::from_str(channel["schema"].as_str().unwrap()).unwrap();
        let found = keys.try_fold(&root, |schema, key| {
            let inner = schema["properties"].get(key)?;
            let items = inner.get("items").unwrap_or(inner);
            let name = items["$ref"].as_str().and_then(|place| place.strip_prefix("#/$defs/"));
            Some(name.map_or(items, |name| &root["$defs"][name]))
        });
        assert!(found.is_some(), "{path}");
    }
    let placed: BTreeSet<_> = panels_of(&layout["layout"]).collect();
    assert_eq!(placed, panels.keys().cloned().collect());
}

/// The panels in a part of a layout.
fn panels_of(part: &Value) -> Box<dyn Iterator<Item = String> + '_> {
    match part.as_str() {
        Some(panel) => Box::new(std::iter::once(panel.to_owned())),
        None => Box::new(["first", "second"].into_iter().flat_map(|key| panels_of(&part[key]))),
    }
}
