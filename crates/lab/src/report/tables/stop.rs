//! Tables of guards: of a run that stopped at a breakpoint, and of two policies that differ.

use crate::inspect::{GuardRecord, PolicyDifference, PolicyTick, StopRecord};

use super::super::table::{NONE, Table};

/// The tables of a stop: the transitions of its tick, where each guard stands, and memory.
#[must_use]
pub fn stop_tables(stop: &StopRecord) -> Vec<Table> {
    let (place, breakpoint) = (stop.states.join("."), &stop.breakpoint);
    let caption =
        format!("{}: tick {}, {:.3} s, in {place}, breakpoint `{breakpoint}`", stop.scenario, stop.tick, stop.time_s);
    let mut tables = Vec::new();
    if !stop.taken.is_empty() {
        tables.push(taken(&stop.taken).under("transitions of this tick"));
    }
    tables.push(standing(&stop.guards).under(caption));
    if !stop.variables.is_empty() {
        let rows = stop.variables.iter().map(|variable| {
            let state = variable.state.clone().unwrap_or_else(|| "machine".to_owned());
            vec![state, variable.name.clone(), variable.value.clone()]
        });
        tables.push(Table::new(3, ["memory of", "name", "value"], rows));
    }
    tables
}

/// The tables of two policies in one scenario: the first tick in which they differ, and where the guards of both stand.
#[must_use]
pub fn difference_tables(difference: &PolicyDifference) -> Vec<Table> {
    let scenario = &difference.scenario;
    let Some(first) = &difference.first else {
        let caption = format!("{scenario}: equal in all {} ticks", difference.equal_ticks);
        return vec![Table::new(1, ["difference"], [vec![NONE.to_owned()]]).under(caption)];
    };
    let row = |policy: &PolicyTick| {
        let [x, y] = policy.velocity_m_s.map(|part| format!("{:.3}", part * 1e3));
        let states = if policy.states.is_empty() { NONE.to_owned() } else { policy.states.join(".") };
        vec![policy.policy.clone(), states, x, y, format!("{:.3}", policy.yaw_rate_rad_s.to_degrees())]
    };
    let caption = format!("{scenario}: the first difference is in tick {}, at {:.3} s", first.tick, first.time_s);
    let headings = ["policy", "state", "x mm/s", "y mm/s", "yaw rate deg/s"];
    let mut tables = vec![Table::new(2, headings, [row(&first.first), row(&first.second)]).under(caption)];
    for policy in [&first.first, &first.second] {
        if let Some(last) = &policy.last {
            let caption = format!("last transition of `{}`, from {} at {:.3} s", policy.policy, last.left, last.time_s);
            tables.push(taken(std::slice::from_ref(&last.taken)).under(caption));
        }
        tables.push(standing(&policy.guards).under(format!("guards of `{}`", policy.policy)));
    }
    tables
}

fn taken(guards: &[GuardRecord]) -> Table {
    let rows = guards.iter().map(|guard| named(guard, guard.guard.clone()));
    Table::new(4, ["state", "line", "target", "guard"], rows)
}

fn standing(guards: &[GuardRecord]) -> Table {
    let rows = guards.iter().map(|guard| {
        let missing = guard.missing();
        named(guard, if missing.is_empty() { NONE.to_owned() } else { missing })
    });
    Table::new(4, ["state", "line", "target", "missing"], rows)
}

fn named(guard: &GuardRecord, last: String) -> Vec<String> {
    let state = guard.state.clone().unwrap_or_else(|| "any state".to_owned());
    let line = guard.file.as_ref().map_or(guard.line.to_string(), |file| format!("{file}:{}", guard.line));
    vec![state, line, guard.target.clone(), last]
}
