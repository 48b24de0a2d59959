//! A search for a route takes many ticks. The time of a tick is printed, because a limit on it would depend on the computer.

use std::time::Instant;

use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::map::{MapSettings, Pace, RouteStatus};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

use super::certainty::{map, perception};
use super::world::{Object, Random, World};

const TICKS: u32 = 1500;
/// Equal runs. The least time of each tick is that without interruptions by other programs.
const RUNS: usize = 3;

#[test]
fn a_long_search_takes_many_ticks() {
    for (name, mut rig) in [("reference", Rig::default()), ("thesis", Rig::thesis_array())] {
        rig.sensing.make_real();
        let mut least = vec![f64::INFINITY; TICKS as usize];
        let mut searching = 0;
        for _ in 0..RUNS {
            let mut perception = perception(&rig);
            let pace = Pace { near_surface: (0.02, 0.2), ..Pace::default() };
            let mut map = map(&rig, MapSettings { pace, ..MapSettings::default() });
            let mut random = Random::new(9);
            let objects = (0..12).map(|_| {
                let centre = Point2::new(random.within(-1.5, 1.5), random.within(1.2, 2.0));
                Object::random(&mut random, centre)
            });
            let mut world = World::new(&rig, objects.collect(), Pose::default(), 2);
            searching = 0;
            for tick in 0..TICKS {
                // A circle with rotations, and goals so far through unknown ground that the search lasts.
                let angle = f64::from(tick) / 400.0;
                let going = Command { velocity_world: Vector2::new(angle.cos(), angle.sin()) * 0.05, yaw_rate: 0.5 };
                perception.update(&world.advance(going));
                if tick % 500 == 10 {
                    let goal = Point2::new(2.2 * angle.cos(), 2.2);
                    map.seek_route(Some(Pose { position: goal, heading: 3.0 + angle }));
                }
                let start = Instant::now();
                map.update(&perception, perception.pose(), going);
                let time = &mut least[tick as usize];
                *time = time.min(start.elapsed().as_secs_f64());
                searching += usize::from(map.route_status() == RouteStatus::Searching);
                perception.command(going);
            }
        }
        least.sort_by(f64::total_cmp);
        let [median, late, most] = [least.len() / 2, least.len() * 99 / 100, least.len() - 1].map(|at| least[at] * 1e6);
        println!("{name}: median {median:.0} µs, 99 % {late:.0} µs, most {most:.0} µs, {searching} ticks of search");
        assert!(searching > 100, "{searching} ticks of search");
    }
}
