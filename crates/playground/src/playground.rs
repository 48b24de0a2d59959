//! The answers to the page.

use serde::Serialize;
use serde_json::{Value, json};
use vibrissa_declare::catalogue::ENTRIES;
use vibrissa_lab::built_in::{NAMED_SCENARIOS, POLICIES, ROOM_POLICY, TextFile};
use vibrissa_lab::family::Family;
use vibrissa_lab::stream::Question;
use vibrissa_language::server::Session;

use crate::lessons::LESSONS;
use crate::request::Request;
use crate::shapes::{changed, shapes};
use crate::simulation::Simulation;

/// The error of a policy that uses a file.
const NO_FILES: &str = "a policy of the playground is one text, with the standard library beside it";

/// The seed of drawn scenes, which is the one that `vibrissa families` takes by default.
const SEED: u64 = 1;

/// Compiler, language server and simulator behind one function.
pub struct Playground {
    session: Session,
    /// The run that the page shows.
    simulation: Option<Simulation>,
    /// A run of another policy, with which it is compared.
    beside: Option<Simulation>,
}

impl Default for Playground {
    fn default() -> Self {
        Self { session: Session::new(&|_| Err(NO_FILES.to_owned())), simulation: None, beside: None }
    }
}

impl Playground {
    /// Answers a request. Both are JSON texts. A request that cannot be carried out has an answer with the key `error`, which says what is
    /// wrong.
    pub fn answer(&mut self, request: &str) -> String {
        let answer = serde_json::from_str(request).map_err(|fault| fault.to_string());
        let answer = answer.and_then(|request| self.carry_out(request));
        answer.unwrap_or_else(|error| json!({ "error": error }).to_string())
    }

    fn carry_out(&mut self, request: Request) -> Result<String, String> {
        match request {
            Request::Catalog => text(&json!({
                "version": env!("CARGO_PKG_VERSION"),
                "scenarios": texts(NAMED_SCENARIOS),
                "families": ENTRIES.map(|family| json!({ "name": family.name, "about": family.about })),
                "policies": texts(POLICIES),
                "templates": texts(&[POLICIES, &[ROOM_POLICY]].concat()),
                "lessons": LESSONS,
                "words": vibrissa_language::scopes(),
            })),
            Request::Language { message } => {
                let answers = self.session.handle(&message.to_string());
                let answers: Result<Vec<Value>, _> =
                    answers.iter().map(|answer| serde_json::from_str(answer)).collect();
                text(&answers.map_err(|fault| fault.to_string())?)
            }
            Request::Start { scenario, policy, set, breakpoints, beside } => {
                let place = self.place(beside);
                *place = None;
                let (simulation, hello) = Simulation::start(scenario, policy, &set, &breakpoints)?;
                *place = Some(simulation);
                text(&hello)
            }
            Request::Break { texts, new } => text(&self.simulation(false)?.set_breakpoints(&texts, new.as_ref())?),
            Request::Counterfactual { id, tick, kind, set } => {
                self.simulation(false)?.ask(Question { id, tick, kind, values: set })?;
                text(&())
            }
            Request::Answer { ticks } => text(&self.simulation(false)?.answer(ticks)?),
            Request::Draw { family, number } => {
                let family = Family::named(&family).ok_or_else(|| format!("there is no family `{family}`"))?;
                let draw = family.draw(SEED, number).map_err(|error| error.to_string())?;
                text(&json!({ "scenario": draw.text, "speed": draw.speed }))
            }
            Request::Shapes { scenario } => text(&shapes(&scenario)?),
            Request::Reshape { scenario, change } => text(&json!({ "scenario": changed(&scenario, &change)? })),
            Request::Advance { ticks, frames, beside } => text(&self.simulation(beside)?.advance(ticks, frames)?),
            Request::Frames => text(&self.simulation(false)?.take_frames()),
            Request::Ticks => text(&json!({ "lines": self.simulation(false)?.ticks()? })),
            Request::Score { beside } => text(&self.simulation(beside)?.score()?),
        }
    }

    fn place(&mut self, beside: bool) -> &mut Option<Simulation> {
        if beside { &mut self.beside } else { &mut self.simulation }
    }

    fn simulation(&mut self, beside: bool) -> Result<&mut Simulation, String> {
        self.place(beside).as_mut().ok_or_else(|| "there is no run; start one first".to_owned())
    }
}

fn texts(files: &[TextFile]) -> Vec<Value> {
    files.iter().map(|file| json!({ "name": file.name(), "text": file.text })).collect()
}

/// The JSON text of an answer. It is written at once, because a tree of the values of many frames takes longer than the run.
fn text(answer: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(answer).map_err(|fault| fault.to_string())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;
    use vibrissa_lab::built_in::{DEFAULT_POLICY, SCENARIOS};
    use vibrissa_lab::request::{Input, PolicyInput, TrialRequest};
    use vibrissa_lab::results::Document;
    use vibrissa_world::scene::WorldKind;

    fn ask(playground: &mut Playground, request: &Value) -> Value {
        serde_json::from_str(&playground.answer(&request.to_string())).unwrap()
    }

    proptest! {
        #[test]
        fn whatever_is_no_request_is_refused_in_words(text in "\\PC{0,40}") {
            let answer: Value = serde_json::from_str(&Playground::default().answer(&text)).unwrap();
            prop_assert!(answer["error"].is_string());
        }

        #[test]
        fn texts_that_are_no_scenario_or_policy_are_refused(scenario in "\\PC{0,40}", policy in "\\PC{0,40}") {
            let request = json!({ "type": "start", "scenario": scenario, "policy": policy });
            prop_assert!(ask(&mut Playground::default(), &request)["error"].is_string());
        }
    }

    #[test]
    fn a_run_in_steps_has_the_figures_of_a_whole_one() {
        let (scenario, policy) = (SCENARIOS[0], POLICIES[0]);
        let mut playground = Playground::default();
        let start = json!({ "type": "start", "scenario": scenario.text, "policy": policy.text });
        assert_eq!(ask(&mut playground, &start)["type"], "hello");
        let mut frames = 0;
        let ticks = loop {
            let advanced = ask(&mut playground, &json!({ "type": "advance", "ticks": 7 }));
            frames += ask(&mut playground, &json!({ "type": "frames" })).as_array().unwrap().len();
            if advanced["has_ended"] == true {
                break advanced["ticks"].clone();
            }
        };
        assert_eq!(ticks, frames);
        let stepped = ask(&mut playground, &json!({ "type": "score" }))["result"].clone();
        assert!(ask(&mut playground, &json!({ "type": "score" }))["error"].is_string());
        let mut request = TrialRequest::new(Input::BuiltIn(&SCENARIOS[0]));
        request.policy = Some(PolicyInput::BuiltIn(&POLICIES[0]));
        request.world = Some(WorldKind::QuasiStatic);
        let trial = request.prepare().unwrap().trial;
        let document = trial.document(&trial.run().unwrap());
        let whole: Value = serde_json::to_value(document.versioned(None)).unwrap();
        for key in ["outcome", "reason", "error_mm", "coverage", "sim_s", "states", "corners"] {
            assert_eq!(stepped[key], whole[key], "{key}");
        }
    }

    #[test]
    fn every_scene_of_the_page_begins() {
        let mut playground = Playground::default();
        let catalog = ask(&mut playground, &json!({ "type": "catalog" }));
        let scenarios = catalog["scenarios"].as_array().unwrap().iter().map(|scenario| scenario["text"].clone());
        let mut scenarios: Vec<Value> = scenarios.collect();
        for family in catalog["families"].as_array().unwrap() {
            let request = json!({ "type": "draw", "family": family["name"], "number": 3 });
            scenarios.push(ask(&mut playground, &request)["scenario"].clone());
        }
        for scenario in scenarios {
            let start = json!({ "type": "start", "scenario": scenario, "policy": DEFAULT_POLICY.text });
            let hello = ask(&mut playground, &start);
            assert_eq!(hello["type"], "hello", "{scenario}: {hello}");
            assert_eq!(ask(&mut playground, &json!({ "type": "advance", "ticks": 2 }))["ticks"], 2);
        }
    }

    #[test]
    fn a_run_stops_at_its_breakpoints_and_a_new_one_sees_all_ticks_before() {
        let mut playground = Playground::default();
        let start = json!({ "type": "start", "scenario": SCENARIOS[0].text, "policy": POLICIES[0].text, "breakpoints": ["Following", "no such"] });
        let hello = ask(&mut playground, &start);
        assert_eq!(hello["breakpoints"].as_array().unwrap().len(), 1, "{}", hello["breakpoints"]);
        let advance = json!({ "type": "advance", "ticks": 1000 });
        let stopped = ask(&mut playground, &advance);
        assert_eq!(stopped["breakpoint"], "Following");
        // What has held before is no hit.
        let texts = ["time > 1 s", "time > 10 s"];
        let set = ask(&mut playground, &json!({ "type": "break", "texts": texts, "new": texts[0] }));
        assert_eq!(set.as_array().unwrap().len(), 2, "{set}");
        let wrong = ask(&mut playground, &json!({ "type": "break", "texts": ["r0.tuching"], "new": "r0.tuching" }));
        assert!(wrong["error"].is_string());
        let stopped = ask(&mut playground, &advance);
        assert_eq!(stopped["breakpoint"], texts[1]);
        assert!((stopped["time"].as_f64().unwrap() - 10.0).abs() < 0.1, "{}", stopped["time"]);
    }

    #[test]
    fn a_counterfactual_without_a_change_differs_nowhere_and_one_with_a_change_does() {
        let mut playground = Playground::default();
        let start = json!({ "type": "start", "scenario": SCENARIOS[0].text, "policy": POLICIES[0].text });
        let hello = ask(&mut playground, &start);
        let speed = hello["parameters"].as_array().unwrap().iter().find(|parameter| parameter["name"] == "speed");
        let speed = speed.unwrap()["value"].as_f64().unwrap();
        ask(&mut playground, &json!({ "type": "advance", "ticks": 200 }));
        for kind in ["recorded", "closed_loop"] {
            for (value, differs) in [(speed, false), (0.5 * speed, true)] {
                let question =
                    json!({ "type": "counterfactual", "id": 1, "tick": 20, "kind": kind, "set": { "speed": value } });
                assert_eq!(ask(&mut playground, &question), Value::Null);
                let mut ticks = Vec::new();
                let last = loop {
                    let piece = ask(&mut playground, &json!({ "type": "answer", "ticks": 50 }));
                    ticks.extend(
                        piece["frames"].as_array().into_iter().flatten().map(|frame| frame["tick"].as_u64().unwrap()),
                    );
                    if piece["done"] == true {
                        break piece;
                    }
                };
                assert_eq!(
                    last["first_difference"].is_null(),
                    !differs,
                    "{kind} {value}: {}",
                    last["first_difference"]
                );
                let end = if kind == "recorded" { 200 } else { 20 + ticks.len() as u64 };
                assert_eq!(ticks, (20..end).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn a_parameter_is_set_within_its_range() {
        let start = |set: Value| {
            let request =
                json!({ "type": "start", "scenario": SCENARIOS[0].text, "policy": POLICIES[0].text, "set": set });
            ask(&mut Playground::default(), &request)
        };
        let hello = start(json!({ "speed": 0.06 }));
        let speed = hello["parameters"].as_array().unwrap().iter().find(|parameter| parameter["name"] == "speed");
        assert_eq!(speed.unwrap()["value"], 0.06);
        for wrong in [json!({ "speed": 5.0 }), json!({ "nothing": 1.0 })] {
            assert!(start(wrong)["error"].is_string());
        }
    }
}
