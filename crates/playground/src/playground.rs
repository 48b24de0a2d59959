//! The answers to the page.

use serde::Serialize;
use serde_json::{Value, json};
use vibrissa_lab::built_in::{POLICIES, SCENARIOS, TextFile};
use vibrissa_language::server::Session;

use crate::lessons::LESSONS;
use crate::request::Request;
use crate::simulation::Simulation;

/// The error of a policy that uses a file.
const NO_FILES: &str = "a policy of the playground is one text, with the standard library beside it";

/// Compiler, language server and simulator behind one function.
pub struct Playground {
    session: Session,
    simulation: Option<Simulation>,
}

impl Default for Playground {
    fn default() -> Self {
        Self { session: Session::new(&|_| Err(NO_FILES.to_owned())), simulation: None }
    }
}

impl Playground {
    /// Answers a request. Both are JSON texts. A request that cannot be carried out has an answer with the key `error`, which says what is
    /// wrong.
    pub fn answer(&mut self, request: &str) -> String {
        let answer = serde_json::from_str(request).map_err(|fault| fault.to_string());
        let answer = answer.and_then(|request| self.carry_out(request));
        answer.unwrap_or_else(|error| json!({ "error": error })).to_string()
    }

    fn carry_out(&mut self, request: Request) -> Result<Value, String> {
        match request {
            Request::Catalog => Ok(json!({
                "version": env!("CARGO_PKG_VERSION"),
                "scenarios": texts(SCENARIOS),
                "policies": texts(POLICIES),
                "lessons": LESSONS,
                "words": vibrissa_language::scopes(),
            })),
            Request::Language { message } => {
                let answers = self.session.handle(&message.to_string());
                let answers: Result<Vec<Value>, _> =
                    answers.iter().map(|answer| serde_json::from_str(answer)).collect();
                value(&answers.map_err(|fault| fault.to_string())?)
            }
            Request::Start { scenario, policy, set } => {
                self.simulation = None;
                let (simulation, hello) = Simulation::start(scenario, policy, &set)?;
                self.simulation = Some(simulation);
                value(&hello)
            }
            Request::Advance { ticks, frames } => value(&self.simulation()?.advance(ticks, frames)?),
            Request::Score => value(&self.simulation()?.score()?),
        }
    }

    fn simulation(&mut self) -> Result<&mut Simulation, String> {
        self.simulation.as_mut().ok_or_else(|| "there is no run; start one first".to_owned())
    }
}

fn texts(files: &[TextFile]) -> Vec<Value> {
    files.iter().map(|file| json!({ "name": file.name(), "text": file.text })).collect()
}

fn value(answer: &impl Serialize) -> Result<Value, String> {
    serde_json::to_value(answer).map_err(|fault| fault.to_string())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;
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
            frames += advanced["frames"].as_array().unwrap().len();
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
