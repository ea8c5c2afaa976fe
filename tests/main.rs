//! End-to-end tests through the real binary: runs, resume, determinism, diagnostics, snapshots, repository rules.

mod repository;
mod support;
