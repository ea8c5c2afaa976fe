//! Content-addressed artifacts on disk: what is finished stays finished, and nothing broken is ever trusted.
//!
//! ```text
//! STORE/format                     `cosfly-store 1`
//! STORE/cas/ab/<digest>            blobs, read-only, named by their BLAKE3 digest
//! STORE/ac/ab/<action digest>      what an action made: blob names and digests, notes, warnings, its key, a check line
//! STORE/done/ab/<plan digest>      the action digest that a planned task came to, its key, a check line
//! STORE/plan/ab/<digest>           plan documents (canonical JSON, named by their own digest)
//! STORE/build/ab/<digest>          how to build the stage of a plan definition again (paths, raw parameters)
//! STORE/runs/<recipe>/<n>          which task of a recipe had which plan digest; the last ten runs
//! STORE/index/<recipe>             a cache of `done` and `ac` for quick starts; may be deleted
//! STORE/out/<path digest>          what the files of a delivered folder looked like; may be deleted
//! STORE/pins/<name>                a copy of a run that garbage collection keeps
//! STORE/divergence/<action>-<n>    two executions of one action that gave different bytes
//! STORE/tmp/<pid>-<n>/             what a living process is writing
//! STORE/locks/                     advisory locks; the system frees them when their process dies
//! ```
//!
//! A task is published in the order blobs, action, (one `syncfs` for a group of tasks), done. Readers check the
//! size and digest of every blob once per process; whatever does not fit counts as absent and is computed again.
//!
//! * [`Store`]: opening, reading ([`cosfly_stage::BlobSource`]), records, syncing.
//! * [`TaskSink`]: where a running task puts its blobs ([`cosfly_stage::OutputSink`]).
//! * [`materialise`]: an artifact as an ordinary folder; [`check_out_folder`]: where that may lie.
//! * [`collect_garbage`]: what no recent run needs.

mod blobs;
mod decoded;
mod delivered;
mod durability;
mod fault;
mod garbage;
mod history;
mod index;
mod layout;
mod locks;
mod materialise;
mod places;
mod records;
mod scratch;
mod sink;
mod store;

pub use blobs::digest_of_file;
pub use fault::{FaultPoints, NoFaults, Step};
pub use garbage::{GarbageOptions, GarbageReport, collect_garbage, pin, unpin};
pub use history::{PastRun, PastStage};
pub use index::KnownTasks;
pub use locks::TaskLock;
pub use materialise::{Materialised, VERSION_FILE, content_of, materialise};
pub use places::check_out_folder;
pub use records::{ActionRecord, Finished};
pub use sink::{Settled, TaskSink};
pub use store::{BLOB_LOST, Store};
