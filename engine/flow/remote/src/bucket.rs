//! A prefix of a bucket as a remote store.

use crate::http_client::Connector;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_secrets::{Secrets, has_secret};
use cosfly_store::{Remote, RemoteObject};
use futures_util::TryStreamExt;
use object_store::aws::{AmazonS3, AmazonS3Builder};
use object_store::path::Path;
use object_store::{BackoffConfig, Error, ObjectStore, ObjectStoreExt, PutMode, PutOptions, PutPayload, RetryConfig};
use std::cell::OnceCell;
use std::future::Future;
use std::time::Duration;
use tokio::runtime::Runtime;

/// Time and number of attempts for a request that a server refuses for the moment.
const RETRY_TIME: Duration = Duration::from_secs(60);
const MOST_RETRIES: usize = 6;

/// Place that is asked for credentials where the environment has none.
const NO_KEY: &str = "169.254.169.254";

/// Objects below a prefix of a bucket.
pub struct Bucket {
    store: AmazonS3,
    prefix: String,
    place: String,
    /// Those of the environment: servers repeat them in refusals.
    secrets: Secrets,
}

impl Bucket {
    /// The prefix at `s3://BUCKET/PREFIX`, with credentials and server from the environment: `AWS_ACCESS_KEY_ID`,
    /// `AWS_SECRET_ACCESS_KEY`, `AWS_SESSION_TOKEN`, `AWS_REGION`, `AWS_ENDPOINT_URL`, `AWS_ALLOW_HTTP`.
    ///
    /// # Errors
    /// `remote-place` where it is no such place or the environment is incomplete.
    pub fn open(place: &str) -> Result<Self> {
        let secrets = Secrets::default().with_environment(std::env::vars_os());
        let wrong = |why: String| {
            let message = secrets.hidden(&format!("`{place}` cannot be a store: {why}"));
            Diagnostic::new("remote-place", Fault::Recipe, message)
                .hint("write `s3://BUCKET/PREFIX`; credentials come from AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, the server from AWS_REGION or AWS_ENDPOINT_URL")
        };
        if has_secret(place) {
            return Err(wrong("no name, password or key may be in it".to_owned()));
        }
        let rest = place.strip_prefix("s3://").ok_or_else(|| wrong("it does not begin with `s3://`".to_owned()))?;
        let (bucket, prefix) = rest.split_once('/').unwrap_or((rest, ""));
        let prefix = prefix.trim_matches('/');
        if bucket.is_empty() || prefix.is_empty() {
            return Err(wrong("it has no bucket or no prefix".to_owned()));
        }
        let backoff = BackoffConfig { max_backoff: Duration::from_secs(5), ..BackoffConfig::default() };
        let store = AmazonS3Builder::from_env()
            .with_bucket_name(bucket)
            .with_http_connector(Connector)
            .with_retry(RetryConfig { backoff, max_retries: MOST_RETRIES, retry_timeout: RETRY_TIME })
            .build()
            .map_err(|error| wrong(error.to_string()))?;
        Ok(Self { store, prefix: prefix.to_owned(), place: format!("s3://{bucket}/{prefix}"), secrets })
    }

    fn path(&self, name: &str) -> Path {
        Path::from(format!("{}/{name}", self.prefix))
    }

    fn refused(&self, action: &str, name: &str, error: &Error) -> Box<Diagnostic> {
        let text = error.to_string();
        let says = |words: &[&str]| words.iter().any(|word| text.contains(word));
        let message = format!("could not {action} `{}/{name}`", self.place);
        let diagnostic = if says(&["RequestTimeTooSkewed"]) {
            Diagnostic::new("remote-clock", Fault::Machine, message)
                .hint("the clock of this machine differs from the server's: set it, for instance with an NTP service")
        } else if says(&[
            "InvalidAccessKeyId",
            "SignatureDoesNotMatch",
            "AccessDenied",
            "ExpiredToken",
            "InvalidToken",
            NO_KEY,
        ]) || matches!(error, Error::PermissionDenied { .. } | Error::Unauthenticated { .. })
        {
            Diagnostic::new("remote-credentials", Fault::Machine, message)
                .hint("check AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, AWS_SESSION_TOKEN and the rights of that user")
        } else if says(&["NoSuchBucket"]) {
            Diagnostic::new("remote-bucket", Fault::Recipe, message)
                .hint("create the bucket, or name another one with `--store`")
        } else if says(&["QuotaExceeded", "StorageFull", "InsufficientStorage", "EntityTooLarge", "507 "]) {
            Diagnostic::new("remote-full", Fault::DiskFull, message)
                .hint("free some space there, for instance with `cosfly gc`, and run the same command again: finished items are kept")
        } else {
            Diagnostic::new("remote-refused", Fault::Machine, message)
                .hint("check the server and the network, and run the same command again: finished items are kept")
        };
        let cause: String =
            self.secrets.hidden(&text).split_whitespace().collect::<Vec<_>>().join(" ").chars().take(400).collect();
        diagnostic.because(cause)
    }
}

impl Remote for Bucket {
    fn place(&self) -> &str {
        &self.place
    }

    fn get(&self, name: &str) -> Result<Option<Vec<u8>>> {
        let read = wait(async { self.store.get(&self.path(name)).await?.bytes().await });
        match read {
            Ok(bytes) => Ok(Some(bytes.into())),
            Err(Error::NotFound { source, .. }) if !source.to_string().contains("NoSuchBucket") => Ok(None),
            Err(error) => Err(self.refused("read", name, &error)),
        }
    }

    fn size(&self, name: &str) -> Result<Option<u64>> {
        match wait(self.store.head(&self.path(name))) {
            Ok(object) => Ok(Some(object.size)),
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.refused("find", name, &error)),
        }
    }

    fn put(&self, name: &str, bytes: Vec<u8>) -> Result<()> {
        let written = wait(self.store.put(&self.path(name), PutPayload::from(bytes)));
        written.map(drop).map_err(|error| self.refused("write", name, &error))
    }

    fn create(&self, name: &str, bytes: Vec<u8>) -> Result<bool> {
        let options = PutOptions { mode: PutMode::Create, ..PutOptions::default() };
        match wait(self.store.put_opts(&self.path(name), PutPayload::from(bytes), options)) {
            Ok(_) => Ok(true),
            Err(Error::AlreadyExists { .. } | Error::Precondition { .. }) => Ok(false),
            Err(error) => Err(self.refused("create", name, &error)),
        }
    }

    fn list(&self, folder: &str) -> Result<Vec<RemoteObject>> {
        let listed: std::result::Result<Vec<_>, Error> = wait(self.store.list(Some(&self.path(folder))).try_collect());
        let start = format!("{}/", self.prefix);
        let object = |object: object_store::ObjectMeta| {
            let name = object.location.as_ref().strip_prefix(&start)?.to_owned();
            Some(RemoteObject { name, bytes: object.size, written: object.last_modified.into() })
        };
        let listed = listed.map_err(|error| self.refused("list", folder, &error))?;
        Ok(listed.into_iter().filter_map(object).collect())
    }

    fn delete(&self, names: &[String]) -> Result<()> {
        for name in names {
            match wait(self.store.delete(&self.path(name))) {
                Ok(()) | Err(Error::NotFound { .. }) => {}
                Err(error) => return Err(self.refused("remove", name, &error)),
            }
        }
        Ok(())
    }
}

/// Result of a request, which this thread waits for.
fn wait<T>(request: impl Future<Output = T>) -> T {
    thread_local! {
        static RUNTIME: OnceCell<Runtime> = const { OnceCell::new() };
    }
    RUNTIME.with(|runtime| {
        let start = || tokio::runtime::Builder::new_current_thread().enable_time().build();
        runtime.get_or_init(|| start().expect("a runtime without threads and files starts")).block_on(request)
    })
}
