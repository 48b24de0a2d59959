//! Targets and routes, by a simple explorer that only goes where the map sends it.

use vibrissa_runtime::geometry::{Point2, Pose, turn_between};
use vibrissa_runtime::map::{Ground, Map, MapSettings, Pace, RouteStatus, Target, TargetKind};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::signal::Command;

use super::certainty::{map, perception, rigs};
use super::world::{Object, World};

/// Base angle (rad) at which the explorer stops.
const TOUCHED: f64 = 2e-5;
/// Ticks for which it turns to one side at a target.
const SWEEPS: u32 = 10;

struct Explorer {
    world: World,
    perception: Perception,
    map: Map,
    step: usize,
    waited: u32,
    retreat: u32,
    goal: Option<Pose>,
    is_following: bool,
    command: Command,
    kinds: Vec<TargetKind>,
    stopped: u32,
}

impl Explorer {
    fn new(objects: Vec<Object>, extent: f64) -> Self {
        let rig = &rigs()[0];
        let pace = Pace { near_surface: (0.02, 0.2), ..Pace::default() };
        let map = map(rig, MapSettings { extent, pace, ..MapSettings::default() });
        let world = World::new(rig, objects, Pose::default(), 4);
        Self {
            perception: perception(rig),
            world,
            map,
            step: 0,
            waited: 0,
            retreat: 0,
            goal: None,
            is_following: false,
            command: Command::STOP,
            kinds: Vec::new(),
            stopped: 0,
        }
    }

    fn tick(&mut self) {
        let before = self.world.pose;
        self.perception.update(&self.world.advance(self.command));
        let is_moving = self.command.velocity_world.norm() > 1e-6;
        self.stopped += u32::from(is_moving && before.position == self.world.pose.position);
        self.map.update(&self.perception, self.perception.pose(), self.command);
        let touches =
            (0..2).any(|whisker| self.perception.base_angle(whisker).abs() > TOUCHED) || self.perception.is_blocked();
        self.command = self.decide(touches);
        self.perception.command(self.command);
    }

    fn decide(&mut self, touches: bool) -> Command {
        let pose = self.world.pose;
        if self.retreat > 0 {
            self.retreat -= 1;
            return Command { velocity_world: self.command.velocity_world, yaw_rate: self.command.yaw_rate };
        }
        if touches {
            // Back where it came from, until nothing touches any more.
            let back = if self.is_following { -1.0 } else { 1.0 };
            if self.is_following {
                self.map.fail_target();
                self.map.seek_route(None);
            }
            (self.retreat, self.step, self.is_following) = (15, 0, false);
            let Command { velocity_world, yaw_rate } = self.command;
            return Command { velocity_world: back * velocity_world, yaw_rate: back * yaw_rate };
        }
        let Some(Target { kind, pose: goal, .. }) = self.map.next_target() else {
            self.map.seek_route(None);
            return Command::STOP;
        };
        if !self.kinds.contains(&kind) {
            self.kinds.push(kind);
        }
        if self.goal != Some(goal) {
            (self.goal, self.waited, self.step) = (Some(goal), 0, 0);
        }
        self.map.seek_route(Some(goal));
        match self.map.route_status() {
            RouteStatus::Found => {}
            RouteStatus::Failed(_) => {
                self.map.fail_target();
                return Command::STOP;
            }
            _ => {
                self.step = 0;
                return Command::STOP;
            }
        }
        let route = self.map.route();
        while let Some(next) = route.get(self.step).filter(|_| self.waited == 0) {
            let (way, turn) = (next.pose.position - pose.position, turn_between(pose.heading, next.pose.heading));
            if way.norm() < 2e-3 && turn.abs() < 0.02 {
                self.step += 1;
                continue;
            }
            assert!(next.ground != Ground::Blocked);
            self.is_following = true;
            let speed: f64 = if next.ground == Ground::Proved { 0.1 } else { 0.03 };
            let velocity_world = way / way.norm().max(1e-9) * speed.min(way.norm() * 10.0);
            return Command { velocity_world, yaw_rate: (5.0 * turn).clamp(-0.8, 0.8) };
        }
        // The whisker sweeps to both sides. Then there is nothing more to see from here.
        self.waited += 1;
        self.is_following = true;
        if self.waited > SWEEPS * 4 {
            (self.waited, self.step) = (0, 0);
            self.map.fail_target();
            return Command::STOP;
        }
        let is_right = (SWEEPS..3 * SWEEPS).contains(&self.waited);
        Command { yaw_rate: if is_right { -0.8 } else { 0.8 }, ..Command::STOP }
    }
}

#[test]
fn an_explorer_completes_an_empty_room_that_is_as_large_as_the_map() {
    let mut explorer = Explorer::new(Vec::new(), 0.5);
    let mut ticks = 0;
    while !explorer.map.is_complete() && ticks < 20_000 {
        explorer.tick();
        ticks += 1;
    }
    assert!(explorer.map.is_complete(), "{} m² are unknown after {ticks} ticks", explorer.map.unknown_area());
    assert_eq!(explorer.kinds, [TargetKind::Frontier]);
    // The tips reach the sides of the square, and the corners where the body cannot turn.
    let share = explorer.map.free_area() / (0.512 * 0.512);
    assert!(share > 0.8, "{share} of the square is free after {ticks} ticks");
}

#[test]
fn an_explorer_keeps_its_body_away_from_what_its_whiskers_touch() {
    let disk = Object::Disk(Point2::new(0.25, 0.0), 0.05);
    let mut explorer = Explorer::new(vec![disk.clone()], 0.9);
    for _ in 0..9000 {
        explorer.tick();
    }
    let area = explorer.map.free_area();
    assert!(area > 0.35, "{area} m² are free");
    let beside = explorer.map.free_cells().filter(|cell| disk.depth(*cell) > -0.03).count();
    assert!(beside > 300, "{beside} cells beside the disk");
    for cell in explorer.map.free_cells() {
        assert!(disk.depth(cell) < 1e-5, "{cell}");
    }
    // It never stands against the disk for long.
    assert!(explorer.stopped < 60, "{} ticks against the disk", explorer.stopped);
}
