//! A policy that is a function in Python, in a process of its own.

use super::answer::PolicyAnswer;
use super::manners::Manners;
use super::process::{Process, Silence, Told};
use super::question::Question;
use super::seam::{Pilot, PilotFailure, late};
use crate::wire;
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment};
use std::time::Duration;

/// Characters of a traceback's end that are kept.
const KEPT: usize = 300;
/// Characters that are kept where the policy cannot be loaded: nothing else tells why.
const KEPT_OF_LOADING: usize = 800;

/// A function in Python. Its process serves all episodes of a thread; a policy that answers too late gets a new one.
pub struct PythonPilot {
    module: String,
    function: String,
    manners: Manners,
    process: Option<Process>,
    question: Question,
    answer: Option<PolicyAnswer>,
}

impl PythonPilot {
    /// The function of a module, not yet started.
    pub fn new(module: &str, function: &str, manners: Manners) -> Self {
        let (module, function) = (module.to_owned(), function.to_owned());
        let question = Question::new(&manners);
        Self { module, function, manners, process: None, question, answer: None }
    }

    /// Starts the process and waits until the function is loaded.
    fn start(&mut self) -> Result<(), String> {
        let cannot = |why: &str| format!("`{}:{}` cannot be loaded: {why}", self.module, self.function);
        let mut process = Process::start(&self.manners.python, &self.module, &self.function)?;
        let told = process.receive(self.manners.wait);
        let why = match told {
            Ok(Told::Bytes(metadata)) => match wire::decode(&metadata) {
                Ok(_) => {
                    self.process = Some(process);
                    return Ok(());
                }
                Err(what) => what,
            },
            Ok(Told::Text(text)) => text,
            Ok(Told::TooLong) => "it answers before it is asked".to_owned(),
            Err(Silence::Late) => {
                let wait = self.manners.wait.as_secs_f64();
                let errors = process.end_of_errors();
                format!("it takes more than {wait} s (`--wait-s` gives it more); {errors}")
            }
            Err(Silence::Ended) => format!("its process {}", process.last_words()),
        };
        Err(cannot(&self.manners.end_of(&why, KEPT_OF_LOADING)))
    }

    fn receive(&mut self, within: Duration) -> Result<Vec<u8>, PilotFailure> {
        let process = self.process.as_mut().ok_or_else(|| PilotFailure::Gone("there is no process".to_owned()))?;
        let failure = match process.receive(within) {
            Ok(Told::Bytes(bytes)) => return Ok(bytes),
            // The process goes on.
            Ok(Told::Text(text)) => {
                return Err(PilotFailure::Answer(format!("the policy failed: {}", self.manners.end_of(&text, KEPT))));
            }
            Ok(Told::TooLong) => PilotFailure::Answer(wire::too_long()),
            Err(Silence::Late) => PilotFailure::Answer(late(within)),
            Err(Silence::Ended) => {
                let words = process.last_words();
                PilotFailure::Gone(format!(
                    "the process of the policy {}",
                    self.manners.end_of(&words, KEPT_OF_LOADING)
                ))
            }
        };
        self.process = None;
        Err(failure)
    }
}

impl Pilot for PythonPilot {
    fn begin(&mut self, _: &Environment, _: &Knowledge) -> Result<(), String> {
        self.answer = None;
        if self.process.is_some() { Ok(()) } else { self.start() }
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, PilotFailure> {
        let every = self.manners.every;
        if let Some(action) = self.answer.as_ref().and_then(|answer| answer.action(environment, every)) {
            return Ok(action);
        }
        let question = self.question.bytes(environment);
        let process = self.process.as_ref().ok_or_else(|| PilotFailure::Gone("there is no process".to_owned()))?;
        if process.has_told() {
            self.process = None;
            return Err(PilotFailure::Answer("the policy answers more often than it is asked".to_owned()));
        }
        process.ask(question);
        let message = self.receive(self.manners.timeout)?;
        let message = wire::decode(&message).map_err(PilotFailure::Answer)?;
        let answer = PolicyAnswer::read(&message, environment, self.manners.actions).map_err(PilotFailure::Answer)?;
        let action = answer.action(environment, every);
        self.answer = Some(answer);
        action.ok_or_else(|| PilotFailure::Answer("the answer is too short for one step".to_owned()))
    }
}
