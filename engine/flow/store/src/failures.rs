//! Failures of tasks, so that others can tell them: the run whose tasks ran on a cluster, where nobody reads standard error, and the viewer.

use crate::fault::PublishStep;
use crate::store::Store;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, canonical_json};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

const SCHEMA: &str = "cosfly.failure/1";

/// A failure as it is stored.
#[derive(Serialize, Deserialize)]
struct Failure {
    schema: String,
    plan: Digest,
    code: String,
    fault: String,
    message: String,
    causes: Vec<String>,
    hints: Vec<String>,
}

/// Kinds of failures and their stored names.
const FAULTS: [(Fault, &str); 7] = [
    (Fault::Recipe, "recipe"),
    (Fault::Input, "input"),
    (Fault::Machine, "machine"),
    (Fault::DiskFull, "disk-full"),
    (Fault::Lost, "lost"),
    (Fault::Stopped, "stopped"),
    (Fault::Bug, "bug"),
];

impl Store {
    /// Records why the task `plan` failed; the latest failure counts.
    pub fn put_failure(&self, plan: &Digest, diagnostic: &Diagnostic) -> Result<()> {
        let fault = FAULTS.iter().find(|(fault, _)| *fault == diagnostic.fault).map_or("bug", |(_, name)| name);
        let places = diagnostic.labels.iter().map(|label| format!("in `{}`", label.path.display()));
        let failure = Failure {
            schema: SCHEMA.to_owned(),
            plan: *plan,
            code: diagnostic.code.to_owned(),
            fault: fault.to_owned(),
            message: diagnostic.message.clone(),
            causes: diagnostic.causes.iter().cloned().chain(places).collect(),
            hints: diagnostic.hints.clone(),
        };
        let bytes = canonical_json(&failure).into_bytes();
        self.upload(&self.failure_path(plan), &bytes)?;
        self.write_file(&self.failure_path(plan), &bytes, PublishStep::WriteRun, PublishStep::RenameRun)
    }

    /// Failure of the task `plan` when it ran last; `None` where it did not fail.
    pub fn failure(&self, plan: &Digest) -> Option<Box<Diagnostic>> {
        let stored: Failure = serde_json::from_slice(&self.failure_bytes(plan)?).ok()?;
        let fault = FAULTS.iter().find(|(_, name)| *name == stored.fault)?.0;
        if stored.schema != SCHEMA || stored.plan != *plan {
            return None;
        }
        let Failure { message, causes, hints, .. } = stored;
        let code = interned(stored.code);
        Some(Box::new(Diagnostic { code, fault, message, labels: vec![], causes, hints }))
    }

    /// Forgets the failure of a task that is tried again.
    pub fn forget_failure(&self, plan: &Digest) {
        let path = self.failure_path(plan);
        let _ = fs::remove_file(&path);
        self.remote.as_ref().and_then(|remote| self.or_trouble(remote.delete(&[self.object(&path)])));
    }

    /// Bytes of a failure; those of the remote are never those of an earlier attempt.
    fn failure_bytes(&self, plan: &Digest) -> Option<Vec<u8>> {
        let path = self.failure_path(plan);
        match &self.remote {
            Some(remote) => self.or_trouble(remote.get(&self.object(&path))).flatten(),
            None => fs::read(&path).ok(),
        }
    }

    fn failure_path(&self, plan: &Digest) -> PathBuf {
        self.layout.folder("failed").join(plan.to_string())
    }
}

/// The code as one string for the whole process: there are few different ones.
fn interned(code: String) -> &'static str {
    static KNOWN: Mutex<BTreeMap<String, &'static str>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry(code.clone()).or_insert_with(|| Box::leak(code.into_boxed_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_reads_back_until_it_is_forgotten() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path()).unwrap();
        let plan = Digest::of(b"task");
        assert_eq!(store.failure(&plan), None);
        for (fault, _) in FAULTS {
            let failure = Diagnostic::new("map-empty", fault, "no roads").because("a \"cause\"").hint("next");
            store.put_failure(&plan, &failure).unwrap();
            assert_eq!(store.failure(&plan), Some(failure));
        }
        let other = Digest::of(b"other");
        fs::rename(store.failure_path(&plan), store.failure_path(&other)).unwrap();
        assert_eq!(store.failure(&other), None, "the record of another task");
        store.forget_failure(&other);
        store.forget_failure(&other);
    }
}
