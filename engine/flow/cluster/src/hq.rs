//! HyperQueue through its command `hq`, with JSON as output. Nothing else of HyperQueue is relied on.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use serde_json::Value;
use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The oldest version whose job files and JSON have the form used here.
const OLDEST: [u32; 2] = [0, 19];
/// Time after which a call of `hq` counts as hanging.
const LONGEST_CALL: Duration = Duration::from_secs(120);

/// The command `hq` of a running server.
pub struct Hq {
    program: PathBuf,
}

/// A job on the server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// Number on the server.
    pub id: u64,
    /// Name from the job file.
    pub name: String,
    /// Number of tasks that ended, in whatever way.
    pub ended: u64,
    /// Number of tasks.
    pub tasks: u64,
}

impl Job {
    /// Whether no task will start any more.
    pub fn is_over(&self) -> bool {
        self.ended >= self.tasks
    }
}

impl Hq {
    /// The command at `COSFLY_HQ`, else `hq` on the `PATH`, with a server that answers.
    ///
    /// # Errors
    /// `cluster-hq-missing`, `cluster-hq-version`, `cluster-hq-refused`.
    pub fn connect() -> Result<Self> {
        let named = std::env::var_os("COSFLY_HQ").filter(|place| !place.is_empty());
        let hq = Self { program: PathBuf::from(named.unwrap_or_else(|| OsString::from("hq"))) };
        let info = hq.call(&["server", "info"]).map_err(|refusal| match refusal.code {
            "cluster-hq-refused" => {
                refusal.hint("start a server with `hq server start` and workers with `hq worker start`")
            }
            _ => refusal,
        })?;
        let version = info["version"].as_str().unwrap_or_default();
        let mut numbers =
            version.trim_start_matches('v').split(['.', '-']).map(|part| part.parse::<u32>().unwrap_or(0));
        let found = [numbers.next().unwrap_or(0), numbers.next().unwrap_or(0)];
        if found < OLDEST {
            let message = format!("HyperQueue's server has version `{version}`");
            return Err(Diagnostic::new("cluster-hq-version", Fault::Machine, message)
                .hint(format!("cosfly works with version {}.{} and later", OLDEST[0], OLDEST[1])));
        }
        Ok(hq)
    }

    /// Number of connected workers.
    pub fn workers(&self) -> Result<usize> {
        Ok(self.call(&["worker", "list"])?.as_array().map_or(0, Vec::len))
    }

    /// Submits a job file; gives the number of the job.
    pub fn submit(&self, job_file: &Path) -> Result<u64> {
        let path = job_file.to_string_lossy();
        let answer = self.call(&["job", "submit-file", &path])?;
        answer["id"].as_u64().ok_or_else(|| strange("job submit-file", &answer))
    }

    /// All jobs that the server knows.
    pub fn jobs(&self) -> Result<Vec<Job>> {
        let answer = self.call(&["job", "list", "--all"])?;
        let job = |value: &Value| {
            let stats = &value["task_stats"];
            let ended = ["finished", "failed", "canceled", "aborted"].map(|state| stats[state].as_u64().unwrap_or(0));
            Some(Job {
                id: value["id"].as_u64()?,
                name: value["name"].as_str()?.to_owned(),
                ended: ended.iter().sum(),
                tasks: value["task_count"].as_u64()?,
            })
        };
        let jobs: Option<Vec<Job>> = answer.as_array().and_then(|jobs| jobs.iter().map(job).collect());
        jobs.ok_or_else(|| strange("job list", &answer))
    }

    /// Numbers of the finished tasks of a job.
    pub fn finished(&self, job: u64) -> Result<Vec<u32>> {
        let id = job.to_string();
        let answer = self.call(&["job", "task-ids", &id, "--filter", "finished"])?;
        let number = |value: &Value| u32::try_from(value.as_u64()?).ok();
        let ids: Option<Vec<u32>> = of_job(&answer, &id).and_then(|ids| ids.iter().map(number).collect());
        ids.ok_or_else(|| strange("job task-ids", &answer))
    }

    /// Numbers of the failed tasks of a job, with HyperQueue's own words on them.
    pub fn failed(&self, job: u64) -> Result<Vec<(u32, String)>> {
        let id = job.to_string();
        let answer = self.call(&["task", "list", &id, "--task-status", "failed"])?;
        let failed = |task: &Value| {
            let words = task["error"].as_str().unwrap_or("no reason is given").trim().to_owned();
            Some((u32::try_from(task["id"].as_u64()?).ok()?, words))
        };
        let tasks: Option<Vec<_>> = of_job(&answer, &id).and_then(|tasks| tasks.iter().map(failed).collect());
        tasks.ok_or_else(|| strange("task list", &answer))
    }

    /// Cancels a job.
    pub fn cancel(&self, job: u64) -> Result<()> {
        self.call(&["job", "cancel", &job.to_string()]).map(drop)
    }

    fn call(&self, arguments: &[&str]) -> Result<Value> {
        let mut command = Command::new(&self.program);
        command.args(["--output-mode", "json"]).args(arguments);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().map_err(|error| {
            let message = format!("could not start `{}`, the command of HyperQueue", self.program.display());
            Diagnostic::new("cluster-hq-missing", Fault::Machine, message)
                .because(error)
                .hint("install HyperQueue and put `hq` on the PATH, or set COSFLY_HQ to its place")
        })?;
        let what = arguments[..2].join(" ");
        let (stdout, stderr, succeeded) = finish(child).ok_or_else(|| refused(&what, "it gave no answer in time"))?;
        let answer: Option<Value> = serde_json::from_str(&stdout).ok();
        match answer {
            Some(answer) if succeeded && answer.get("error").is_none() => Ok(answer),
            Some(answer) if answer["error"].is_string() => Err(refused(&what, answer["error"].as_str().unwrap_or(""))),
            _ if !succeeded => Err(refused(&what, stderr.trim())),
            _ => Err(strange(&what, &Value::from(stdout))),
        }
    }
}

/// The list of a job in an answer by job; a job without an entry has none.
fn of_job<'a>(answer: &'a Value, id: &str) -> Option<&'a [Value]> {
    answer.as_object()?.get(id).map_or(Some(&[]), |list| list.as_array().map(Vec::as_slice))
}

/// Output, messages and success of a process; `None` where it hangs, and is ended.
fn finish(mut child: Child) -> Option<(String, String, bool)> {
    let reader = |pipe: Option<Box<dyn Read + Send>>| {
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            // What was read before an error is enough for a message.
            let _ = pipe.map(|mut pipe| pipe.read_to_end(&mut bytes));
            String::from_utf8_lossy(&bytes).into_owned()
        })
    };
    let stdout = reader(child.stdout.take().map(|pipe| Box::new(pipe) as Box<dyn Read + Send>));
    let stderr = reader(child.stderr.take().map(|pipe| Box::new(pipe) as Box<dyn Read + Send>));
    let began = Instant::now();
    let mut pause = Duration::from_millis(1);
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if began.elapsed() < LONGEST_CALL => std::thread::sleep(pause),
            _ => {
                let _ = child.kill();
                let _ = child.wait();
                return None;
            }
        }
        pause = (pause * 2).min(Duration::from_millis(20));
    };
    Some((stdout.join().unwrap_or_default(), stderr.join().unwrap_or_default(), status.success()))
}

fn refused(what: &str, why: &str) -> Box<Diagnostic> {
    Diagnostic::new("cluster-hq-refused", Fault::Machine, format!("`hq {what}` failed"))
        .because(why.lines().next().unwrap_or_default())
}

fn strange(what: &str, answer: &Value) -> Box<Diagnostic> {
    let shown: String = answer.to_string().chars().take(200).collect();
    Diagnostic::new("cluster-hq-answer", Fault::Machine, format!("`hq {what}` gave an unexpected answer"))
        .because(shown)
        .hint("use a released version of HyperQueue, and the same one for `hq`, the server and the workers")
}
