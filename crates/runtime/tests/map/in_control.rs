//! A map in the control loop.

use std::sync::Arc;

use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::map::MapSettings;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

use super::world::{Object, World};

#[test]
fn a_map_changes_no_command_and_sees_the_way_of_the_body() {
    let program = Arc::new(Artifact::from_bytes(include_bytes!("../../fixtures/vibrissa.machine")).unwrap().program);
    let rig = Rig::default();
    let mut without = Control::new(&rig, Arc::clone(&program)).unwrap();
    let mut with = without.clone().with_map(&rig, MapSettings::default()).unwrap();
    let objects = vec![Object::Disk(Point2::new(0.4, -0.15), 0.15)];
    let mut world = World::new(&rig, objects, Pose::default(), 1);
    let mut command = Command::STOP;
    for _ in 0..600 {
        let samples = world.advance(command);
        command = without.tick(&samples).0;
        assert_eq!(with.tick(&samples).0, command);
    }
    assert!(without.map().is_none());
    let map = with.map().unwrap();
    assert!(map.is_free(world.pose.position) && map.free_area() > 0.03, "{} m²", map.free_area());
}

#[test]
fn settings_that_give_no_map_are_refused() {
    let program = Arc::new(Artifact::from_bytes(include_bytes!("../../fixtures/bang.machine")).unwrap().program);
    let rig = Rig::default();
    for settings in [
        MapSettings { cell: 0.0, ..MapSettings::default() },
        MapSettings { extent: f64::NAN, ..MapSettings::default() },
        MapSettings { extent: 1e6, ..MapSettings::default() },
        MapSettings { heading_bound: -1.0, ..MapSettings::default() },
    ] {
        let refused = Control::new(&rig, Arc::clone(&program)).unwrap().with_map(&rig, settings);
        assert!(matches!(refused, Err(BindError::Map(_))), "{settings:?}");
    }
}
