//! A policy that is a function in Python, in a process of its own.

use super::answer::Answer;
use super::question::Question;
use super::{Failure, Manners, Pilot};
use crate::wire;
use cosfly_diagnose::visible_text;
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment};
use std::io::{Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

const BRIDGE: &str = include_str!("bridge.py");
/// Time for imports.
const STARTS: Duration = Duration::from_secs(120);
/// Characters of a traceback's end that are kept.
const KEPT: usize = 300;

/// A message of the process.
enum Told {
    Bytes(Vec<u8>),
    Text(String),
    TooLong,
}

/// A function in Python. Its process serves all episodes of a thread; a policy that answers too late gets a new one.
pub struct PythonPilot {
    module: String,
    function: String,
    manners: Manners,
    process: Option<Process>,
    question: Question,
    answer: Option<Answer>,
}

struct Process {
    child: Child,
    questions: ChildStdin,
    answers: Receiver<Told>,
}

impl Drop for Process {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

impl PythonPilot {
    /// The function of a module, not yet started.
    pub fn new(module: &str, function: &str, manners: Manners) -> Self {
        let (module, function) = (module.to_owned(), function.to_owned());
        let question = Question::new(&manners);
        Self { module, function, manners, process: None, question, answer: None }
    }

    fn start(&mut self) -> Result<(), Failure> {
        let python = &self.manners.python;
        let mut command = Command::new(python);
        command.args(["-c", BRIDGE, &self.module, &self.function]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let started = command.spawn();
        let mut child = started.map_err(|error| Failure::Gone(format!("`{}`: {error}", python.display())))?;
        let (Some(questions), Some(mut output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Failure::Gone("the process has no pipes".to_owned()));
        };
        let (sender, answers) = sync_channel(1);
        std::thread::spawn(move || {
            while let Some(told) = read_message(&mut output) {
                let is_last = matches!(told, Told::TooLong);
                if sender.send(told).is_err() || is_last {
                    break;
                }
            }
        });
        self.process = Some(Process { child, questions, answers });
        let metadata = self.receive(STARTS)?;
        wire::decode(&metadata).map_err(Failure::Answer)?;
        Ok(())
    }

    fn receive(&mut self, within: Duration) -> Result<Vec<u8>, Failure> {
        let process = self.process.as_ref().ok_or_else(|| Failure::Gone("there is no process".to_owned()))?;
        let failure = match process.answers.recv_timeout(within) {
            Ok(Told::Bytes(bytes)) => return Ok(bytes),
            // The process goes on.
            Ok(Told::Text(text)) => {
                let end: Vec<char> = visible_text(text.trim()).chars().rev().take(KEPT).collect();
                let end: String = end.into_iter().rev().collect();
                return Err(Failure::Answer(format!("the policy failed: {end}")));
            }
            Ok(Told::TooLong) => {
                Failure::Answer(format!("the answer is longer than {} MiB", wire::LARGEST_BYTES >> 20))
            }
            Err(RecvTimeoutError::Timeout) => Failure::Answer(format!("no answer within {} s", within.as_secs_f64())),
            Err(RecvTimeoutError::Disconnected) => Failure::Gone("the process of the policy ended".to_owned()),
        };
        self.process = None;
        Err(failure)
    }
}

fn read_message(output: &mut impl Read) -> Option<Told> {
    let mut head = [0; 5];
    output.read_exact(&mut head).ok()?;
    let size = u32::from_le_bytes([head[1], head[2], head[3], head[4]]);
    if size as usize > wire::LARGEST_BYTES {
        return Some(Told::TooLong);
    }
    let mut bytes = vec![0; size as usize];
    output.read_exact(&mut bytes).ok()?;
    let is_text = head[0] == b't';
    Some(if is_text { Told::Text(String::from_utf8_lossy(&bytes).into_owned()) } else { Told::Bytes(bytes) })
}

impl Pilot for PythonPilot {
    fn begin(&mut self, _: &Environment, _: &Knowledge) -> Result<(), Failure> {
        self.answer = None;
        if self.process.is_some() { Ok(()) } else { self.start() }
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, Failure> {
        let every = self.manners.every;
        if let Some(action) = self.answer.as_ref().and_then(|answer| answer.action(environment, every)) {
            return Ok(action);
        }
        let question = self.question.bytes(environment);
        let process = self.process.as_mut().ok_or_else(|| Failure::Gone("there is no process".to_owned()))?;
        let size = (question.len() as u32).to_le_bytes();
        let sent = process.questions.write_all(&size).and_then(|()| process.questions.write_all(&question));
        if sent.and_then(|()| process.questions.flush()).is_err() {
            self.process = None;
            return Err(Failure::Gone("the process of the policy ended".to_owned()));
        }
        let message = self.receive(self.manners.timeout)?;
        let message = wire::decode(&message).map_err(Failure::Answer)?;
        let answer = Answer::read(&message, environment, self.manners.actions).map_err(Failure::Answer)?;
        let action = answer.action(environment, every);
        self.answer = Some(answer);
        action.ok_or_else(|| Failure::Answer("the answer is too short for one step".to_owned()))
    }
}
