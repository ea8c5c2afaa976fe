//! Answers of services outside, and accounts of what was asked. Garbage collection keeps them: they cannot be computed again.

use crate::fault::PublishStep;
use crate::locks::lock_file;
use crate::records;
use crate::store::{Store, with_folder_of};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{Answers, Spent};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Folder of answers, and of accounts in it.
const FOLDER: &str = "answers";
const ACCOUNTS: &str = "accounts";

impl Store {
    fn answer_path(&self, question: &Digest) -> PathBuf {
        let hex = question.to_string();
        self.layout.folder(FOLDER).join(&hex[..2]).join(&hex)
    }

    /// Moves a complete file to `path` unless there is one; true where it was moved.
    fn place_first(&self, temporary: &Path, path: &Path) -> io::Result<bool> {
        match with_folder_of(path, || fs::hard_link(temporary, path)) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
            // Some file systems have no hard links.
            Err(_) => with_folder_of(path, || fs::rename(temporary, path)).map(|()| true),
        }
    }
}

/// Makes a file and its entry in the folder durable.
fn sync_with_folder(path: &Path) -> io::Result<()> {
    File::open(path)?.sync_all()?;
    if cfg!(unix) { path.parent().map_or(Ok(()), |folder| File::open(folder)?.sync_all()) } else { Ok(()) }
}

impl Answers for Store {
    fn answer(&self, question: &Digest) -> Option<String> {
        let bytes = self.read_file(&self.answer_path(question))?;
        records::content_for(question, &bytes).map(str::to_owned)
    }

    fn keep(&self, question: &Digest, answer: &str) -> Result<String> {
        let path = self.answer_path(question);
        let record = records::encode_answer(question, answer);
        let failed = |error: io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
        if let Some(remote) = &self.remote
            && !remote.create(&self.object(&path), record.clone())?
            && let Some(first) = remote.get(&self.object(&path))?
            && let Some(first) = records::content_for(question, &first)
        {
            return Ok(first.to_owned());
        }
        let temporary = self.write_temporary(&[&record], 0o644, PublishStep::WriteDocument)?;
        if !self.place_first(&temporary, &path).map_err(failed)? {
            if let Some(first) = self.answer(question) {
                let _ = fs::remove_file(&temporary);
                return Ok(first);
            }
            self.move_into_place(&temporary, &path, PublishStep::RenameDocument)?;
        }
        let _ = fs::remove_file(&temporary);
        sync_with_folder(&path).map_err(failed)?;
        Ok(answer.to_owned())
    }

    fn account(&self, account: &Digest, change: &mut dyn FnMut(&mut Spent) -> Result<()>) -> Result<()> {
        let lock = self.layout.root.join("locks").join(format!("account-{account}"));
        let lock = lock_file(&lock).and_then(|file| file.lock().map(|()| file));
        let _alone = lock.map_err(|error| Diagnostic::io("lock an account of the store", &error))?;
        let path = self.layout.folder(FOLDER).join(ACCOUNTS).join(account.to_string());
        let mut spent = match fs::read(&path) {
            Ok(bytes) => records::content_for(account, &bytes)
                .and_then(|json| serde_json::from_str(json).ok())
                .ok_or_else(|| damaged_account(&path))?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Spent::default(),
            Err(error) => return Err(Diagnostic::io(format!("read `{}`", path.display()), &error)),
        };
        change(&mut spent)?;
        let record = records::encode_answer(account, &canonical_json(&spent));
        self.write_file(&path, &record, PublishStep::WriteDocument, PublishStep::RenameDocument)
    }
}

fn damaged_account(path: &Path) -> Box<Diagnostic> {
    let message = format!("`{}`, which counts what was asked of a service, is damaged", path.display());
    Diagnostic::new("store-damaged-account", Fault::Input, message)
        .hint("remove the file to count from zero; kept answers are not asked for again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_answer_stays_and_a_damaged_one_is_replaced() {
        let root = tempfile::tempdir().unwrap();
        let question = Digest::of(b"question");
        let store = Store::open(root.path()).unwrap();
        assert_eq!(store.answer(&question), None);
        assert_eq!(store.keep(&question, "\"one\"").unwrap(), "\"one\"");
        assert_eq!(store.keep(&question, "\"two\"").unwrap(), "\"one\"");
        drop(store);
        let store = Store::open(root.path()).unwrap();
        assert_eq!(store.answer(&question).unwrap(), "\"one\"");
        let path = store.answer_path(&question);
        fs::write(&path, "torn").unwrap();
        assert_eq!(store.answer(&question), None);
        assert_eq!(store.keep(&question, "\"two\"").unwrap(), "\"two\"");
        fs::rename(&path, store.answer_path(&Digest::of(b"other"))).unwrap_or_default();
        assert_eq!(store.answer(&Digest::of(b"other")), None);
    }

    #[test]
    fn an_account_counts_over_all_threads_and_refuses_without_a_change() {
        let root = tempfile::tempdir().unwrap();
        let (store, account) = (Store::open(root.path()).unwrap(), Digest::of(b"account"));
        let call = |limit: u64| {
            store.account(&account, &mut |spent| {
                if spent.calls >= limit {
                    return Err(Diagnostic::stopped("account"));
                }
                spent.calls += 1;
                Ok(())
            })
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..10).for_each(|_| drop(call(25))));
            }
        });
        let mut calls = 0;
        store
            .account(&account, &mut |spent| {
                calls = spent.calls;
                Ok(())
            })
            .unwrap();
        assert_eq!(calls, 25);
        fs::write(store.layout.folder(FOLDER).join(ACCOUNTS).join(account.to_string()), "{}").unwrap();
        assert_eq!(call(25).unwrap_err().code, "store-damaged-account");
    }
}
