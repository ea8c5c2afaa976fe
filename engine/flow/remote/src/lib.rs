//! Stores in S3-compatible buckets: [`Bucket`].
//!
//! `object_store` knows the protocol (signatures, retries, conditional writes); its requests go through `ureq`, a small blocking
//! client. Every thread waits for its own requests, so the number of requests at a time is the number of threads that ask.

mod bucket;
mod http_client;

pub use bucket::Bucket;
