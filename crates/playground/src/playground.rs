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
