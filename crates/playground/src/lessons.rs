//! The steps that teach the language. Each has a task, which a run fulfils by its figures.

use serde::Serialize;

/// A step.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Lesson {
    title: &'static str,
    /// What is new. Code is between grave accents.
    text: &'static str,
    task: &'static str,
    /// The name of a built-in scenario.
    scene: &'static str,
    /// The policy with which the step begins.
    policy: &'static str,
    /// A policy that fulfils the task.
    solution: &'static str,
    /// The outcomes of a run that fulfils it.
    outcomes: &'static [&'static str],
    /// Bounds of figures of such a run.
    bounds: &'static [Bound],
}

/// A bound of a figure.
#[derive(Debug, Clone, Copy, Serialize)]
struct Bound {
    /// Its path in the JSON document of the run.
    figure: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    least: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    most: Option<f64>,
}

const fn least(figure: &'static str, least: f64) -> Bound {
    Bound { figure, least: Some(least), most: None }
}

const fn most(figure: &'static str, most: f64) -> Bound {
    Bound { figure, least: None, most: Some(most) }
}

/// A run that met its stop condition, also without all expectations of the scenario.
const DONE: &[&str] = &["completed", "ended"];

/// The steps, in their order.
pub(crate) const LESSONS: [Lesson; 5] = [
    Lesson {
        title: "Drive until something is there",
        text: "A policy is a machine. `whisker r0` says that it uses the robot's right whisker and calls it `r0`. The machine begins in \
               its `initial` state. Thirty times per second it takes the transitions that are due, and then executes the statements of \
               the state. A transition is `when CONDITION -> TARGET`. The targets `Success(\"why\")` and `Failure(\"why\")` end the run. \
               It is called completed if it also meets what the scene expects, such as a coverage, and ended if not. \
               Watch the run: the whisker bends at the disk, but the robot drives on, because its state has no transition.",
        task: "Add a transition to the state `Exploring`, so that the run ends in success as soon as `r0.touching` holds.",
        scene: "disk",
        policy: include_str!("../lessons/1.fsm"),
        solution: include_str!("../lessons/1-solution.fsm"),
        outcomes: DONE,
        // The whisker touches the disk after 3.8 s.
        bounds: &[least("sim_s", 3.7), most("sim_s", 5.0)],
    },
    Lesson {
        title: "Record what the whisker feels",
        text: "A whisker that touches an object is bent. `r0.base_angle` is the angle at its base. This policy drives towards the object if \
               that angle is too small, and away from it if it is too large. It does not yet measure anything: `record r0` adds the \
               estimated tip to the contour.",
        task: "Record the contour in the state `Following`, so that more than a tenth of the disk is traced.",
        scene: "disk",
        policy: include_str!("../lessons/2.fsm"),
        solution: include_str!("../lessons/2-solution.fsm"),
        outcomes: &["completed", "ended", "failed"],
        bounds: &[least("coverage", 0.1)],
    },
    Lesson {
        title: "Turn with the contour",
        text: "The platform does not rotate, so it drives past the disk. As soon as `r0.contour.ready` holds, `r0.contour.tangent` is the \
               direction of the contour at the tip. `if CONDITION { … }` executes statements only while it holds. \
               `steer r0 along DIRECTION at SPEED facing HEADING` moves the base of the whisker and turns the body. \
               `rotate(DIRECTION, ANGLE)` turns a direction, and `angle(DIRECTION)` is its heading. The law of this policy is the angle \
               `30 deg * clamp(too_much, -1, 1)`: away from the disk if the whisker is bent too much, and towards it if too little.",
        task: "While `r0.contour.ready` holds, steer `r0` along the tangent rotated by the angle of the law, facing the angle of the \
               tangent. This replaces the statement `steer body`. The run has to come round the disk: this scene ends it where the contour is closed.",
        scene: "disk",
        policy: include_str!("../lessons/3.fsm"),
        solution: include_str!("../lessons/3-solution.fsm"),
        outcomes: DONE,
        bounds: &[least("coverage", 0.95)],
    },
    Lesson {
        title: "Change parameters",
        text: "A `param` has a unit and a range. The sliders under Parameters below the editor set it for a run, and moving one runs at \
               once. A number of the text changes it for good. The score shows what a change costs.",
        task: "Come round the disk within 30 s, with a mean error of at most 10 um.",
        scene: "disk",
        policy: include_str!("../lessons/4.fsm"),
        solution: include_str!("../lessons/4-solution.fsm"),
        outcomes: DONE,
        bounds: &[least("coverage", 0.95), most("sim_s", 30.0), most("error_mm.mean", 0.01)],
    },
    Lesson {
        title: "Use the standard library",
        text: "At a corner the whisker loses the object. The behaviour `trace_object` of the standard library finds the next surface. A \
               state that `is` a behaviour has to say where each exit of it leads: `on EXIT -> TARGET`. An exit may pass values on: `w` \
               is the whisker that followed the object, and `away` the direction from its surface to the body.",
        task: "The exit `closed(w, away)` is missing. Write its line below the other exits of `Tracing`, let it end the run in success, \
               and trace the box. (This scene ends a run at a closed contour by itself. In others, only the exit does.)",
        scene: "box",
        policy: include_str!("../lessons/5.fsm"),
        solution: include_str!("../lessons/5-solution.fsm"),
        outcomes: DONE,
        bounds: &[least("coverage", 0.95)],
    },
];

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::Playground;
    use serde_json::{Value, json};
    use vibrissa_lab::built_in::SCENARIOS;

    /// The result of a policy in the scene of a lesson. An error if it does not compile.
    fn run(lesson: &Lesson, policy: &str) -> Result<Value, String> {
        let mut playground = Playground::default();
        let mut ask = |request: &Value| -> Result<Value, String> {
            let answer: Value = serde_json::from_str(&playground.answer(&request.to_string())).unwrap();
            answer.get("error").map_or(Ok(answer.clone()), |error| Err(error.to_string()))
        };
        let scene = SCENARIOS.iter().find(|file| file.name() == lesson.scene).unwrap();
        ask(&json!({ "type": "start", "scenario": scene.text, "policy": policy }))?;
        while ask(&json!({ "type": "advance", "ticks": 500, "frames": false }))?["has_ended"] != true {}
        Ok(ask(&json!({ "type": "score" }))?["result"].clone())
    }

    fn is_done(lesson: &Lesson, result: &Value) -> bool {
        let figure = |path: &str| path.split('.').fold(result, |value, key| &value[key]).as_f64();
        lesson.outcomes.iter().any(|outcome| result["outcome"] == *outcome)
            && lesson.bounds.iter().all(|bound| {
                figure(bound.figure).is_some_and(|value| {
                    bound.least.is_none_or(|least| value >= least) && bound.most.is_none_or(|most| value <= most)
                })
            })
    }

    #[test]
    fn no_step_is_done_when_it_begins_and_its_solution_does_it() {
        for lesson in &LESSONS {
            assert!(!run(lesson, lesson.policy).is_ok_and(|result| is_done(lesson, &result)), "{}", lesson.title);
            let solved = run(lesson, lesson.solution).unwrap();
            assert!(is_done(lesson, &solved), "{}: {solved}", lesson.title);
        }
    }

    #[test]
    fn the_policies_are_formatted() {
        for lesson in &LESSONS {
            for text in [lesson.policy, lesson.solution] {
                let source = vibrissa_text::diagnostic::Source::new("lesson.fsm", text);
                assert_eq!(vibrissa_language::format(&source).unwrap(), text, "{}", lesson.title);
            }
        }
    }
}
