//! The process of a policy in Python: messages to it and from it, and the end of what it writes to its standard error.

use crate::wire;
use cosfly_diagnose::visible_text;
use cosfly_secrets::Secrets;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

const BRIDGE: &str = include_str!("bridge.py");
/// Bytes of the end of its standard error that are kept.
const KEPT: usize = 4096;
/// Bytes of its standard error that are passed on; a flood of it fills no log.
const PASSED_ON: usize = 64 << 10;
/// Time for its last words once it ended: a child of its own may hold the pipe open for ever.
const LAST_WORDS: Duration = Duration::from_millis(500);

/// Messages of a process, and its end.
pub enum Told {
    /// A message.
    Bytes(Vec<u8>),
    /// A text: what went wrong.
    Text(String),
    /// A message that is too long to be read; no further one comes.
    TooLong,
}

/// Why nothing came.
pub enum Silence {
    /// Not within the time.
    Late,
    /// The process ended.
    Ended,
}

/// A running process. Dropped, it is ended with all processes that it started.
pub struct Process {
    child: Child,
    questions: SyncSender<Vec<u8>>,
    answers: Receiver<Told>,
    errors: Arc<Errors>,
}

impl Process {
    /// Starts Python on a function of a module.
    ///
    /// # Errors
    /// A command that cannot be started, in words.
    pub fn start(python: &Path, module: &str, function: &str) -> Result<Self, String> {
        let mut command = Command::new(python);
        command.args(["-c", BRIDGE, module, function]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        in_group(&mut command);
        let started = command.spawn();
        let mut child = started.map_err(|error| format!("`{}` cannot be started: {error}", python.display()))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(mut input), Some(mut output), Some(stderr)) = pipes else {
            return Err("the process has no pipes".to_owned());
        };
        // Threads of their own write and read: a policy that takes no observation, or answers unasked, holds nobody up.
        let (questions, asked) = sync_channel::<Vec<u8>>(1);
        std::thread::spawn(move || {
            while let Ok(question) = asked.recv() {
                let size = (question.len() as u32).to_le_bytes();
                let sent = input.write_all(&size).and_then(|()| input.write_all(&question));
                if sent.and_then(|()| input.flush()).is_err() {
                    break;
                }
            }
        });
        let (sender, answers) = sync_channel(1);
        std::thread::spawn(move || {
            while let Some(told) = read_message(&mut output) {
                let is_last = matches!(told, Told::TooLong);
                if sender.send(told).is_err() || is_last {
                    break;
                }
            }
        });
        let errors = Arc::new(Errors::default());
        let kept = Arc::clone(&errors);
        std::thread::spawn(move || kept.read(stderr));
        Ok(Self { child, questions, answers, errors })
    }

    /// Whether it has told something that nobody asked for.
    pub fn has_told(&self) -> bool {
        self.answers.try_recv().is_ok()
    }

    /// Sends a question. Where the process does not take it, nothing is received.
    pub fn ask(&self, question: Vec<u8>) {
        _ = self.questions.try_send(question);
    }

    /// Next message of the process.
    ///
    /// # Errors
    /// [`Silence`].
    pub fn receive(&self, within: Duration) -> Result<Told, Silence> {
        self.answers.recv_timeout(within).map_err(|error| match error {
            RecvTimeoutError::Timeout => Silence::Late,
            RecvTimeoutError::Disconnected => Silence::Ended,
        })
    }

    /// How it ended, in words, with the end of its standard error.
    pub fn last_words(&mut self) -> String {
        let until = Instant::now() + LAST_WORDS;
        let mut status = None;
        while Instant::now() < until && (status.is_none() || !self.errors.is_over.load(Ordering::Acquire)) {
            status = status.or_else(|| self.child.try_wait().ok().flatten());
            std::thread::sleep(Duration::from_millis(5));
        }
        let how = status.map_or_else(|| "ended".to_owned(), |status| format!("ended ({})", words(status)));
        let said = self.errors.end();
        if said.is_empty() { how } else { format!("{how}; the end of its standard error: {said}") }
    }

    /// The end of its standard error.
    pub fn end_of_errors(&self) -> String {
        self.errors.end()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        end(&mut self.child);
    }
}

/// Gives a process a group of its own: processes that it starts end with it.
pub fn in_group(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(not(unix))]
    let _ = command;
}

/// Ends a process of a group of its own, and all processes that it started.
pub fn end(child: &mut Child) {
    // The number of the group is not given away before `wait`.
    #[cfg(unix)]
    {
        let kill = format!("kill -s KILL -- -{}", child.id());
        let mut shell = Command::new("sh");
        shell.args(["-c", &kill]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        _ = shell.status();
    }
    _ = child.kill();
    _ = child.wait();
}

/// How a process ended, in words.
fn words(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return format!("by signal {signal}");
    }
    status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"))
}

fn read_message(output: &mut impl Read) -> Option<Told> {
    let mut head = [0; 5];
    output.read_exact(&mut head).ok()?;
    let size = u32::from_le_bytes([head[1], head[2], head[3], head[4]]);
    if size as usize > wire::LARGEST_BYTES {
        return Some(Told::TooLong);
    }
    let mut bytes = Vec::new();
    output.take(u64::from(size)).read_to_end(&mut bytes).ok().filter(|read| *read == size as usize)?;
    let is_text = head[0] == b't';
    Some(if is_text { Told::Text(String::from_utf8_lossy(&bytes).into_owned()) } else { Told::Bytes(bytes) })
}

/// Standard error of a process: its beginning is passed on, its end is kept.
#[derive(Default)]
struct Errors {
    end: Mutex<Vec<u8>>,
    is_over: AtomicBool,
}

impl Errors {
    fn read(&self, mut stderr: impl Read) {
        let (mut buffer, mut passed_on) = ([0; 8192], 0);
        let secrets = Secrets::default().with_environment(std::env::vars_os());
        while let Ok(count @ 1..) = stderr.read(&mut buffer) {
            let bytes = &buffer[..count];
            let mut end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
            end.extend(bytes);
            let surplus = end.len().saturating_sub(KEPT);
            end.drain(..surplus);
            drop(end);
            if passed_on < PASSED_ON {
                passed_on += count;
                let text = String::from_utf8_lossy(bytes).replace('\r', "\n");
                let more = if passed_on < PASSED_ON { "" } else { "\n(the policy's further output is not shown)\n" };
                _ = std::io::stderr().write_all((visible_text(&secrets.hidden(&text)) + more).as_bytes());
            }
        }
        self.is_over.store(true, Ordering::Release);
    }

    fn end(&self) -> String {
        let end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
        String::from_utf8_lossy(&end).into_owned()
    }
}
