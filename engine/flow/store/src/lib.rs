//! Content-addressed artifacts on disk: finished results are kept, damaged ones are detected and never used.
//!
//! ```text
//! STORE/format                     `cosfly-store 1`
//! STORE/cas/ab/<digest>            blobs, read-only, named by their BLAKE3 digest
//! STORE/ac/ab/<action digest>      output of an action: blob names and digests, notes, warnings, its key, a check line
//! STORE/done/ab/<plan digest>      action digest of a finished task, its key, a check line
//! STORE/answers/ab/<digest>        answers of services outside, by their questions; never removed
//! STORE/answers/accounts/<digest>  what was asked of a service
//! STORE/plan/ab/<digest>           plan documents (canonical JSON, named by their own digest)
//! STORE/build/ab/<digest>          parameters and paths to build the stage of a plan definition again
//! STORE/runs/<recipe>/<n>          plan digests of the tasks of a recipe; the last ten runs
//! STORE/index/<recipe>             a cache of `done` and `ac` for quick starts; may be deleted
//! STORE/costs/<stage>            measured time of tasks, for predictions; may be deleted
//! STORE/out/<path digest>          sizes and times of the files of a delivered folder; may be deleted
//! STORE/spare/<path digest>/     the version before of a delivered folder, as links; may be deleted
//! STORE/packs/<area>               small files of an area in one file, made by garbage collection
//! STORE/pins/<name>                a copy of a run that garbage collection keeps
//! STORE/failed/<plan digest>       reason why a task failed that ran apart from its run
//! STORE/divergence/<action>-<n>    two executions of one action with different bytes
//! STORE/tmp/<pid>-<n>/             files that a living process is writing
//! STORE/locks/                     advisory locks; the system frees them when their process dies
//! ```
//!
//! A task is published in the order blobs, action, (one `syncfs` for a group of tasks), done. Readers check the
//! size and digest of every blob once per process; a blob that does not fit counts as absent and is computed again.
//!
//! * [`Store`]: opening, reading ([`cosfly_stage::BlobSource`]), records, syncing.
//! * [`TaskSink`]: sink for the blobs of a running task ([`cosfly_blobs::OutputSink`]).
//! * [`materialise`]: writes an artifact as an ordinary folder; [`check_out_folder`]: checks the place of that folder.
//! * [`collect_garbage`]: removes everything that no recent run needs.

mod answers;
mod blobs;
mod costs;
mod decoded;
mod delivered;
mod digesting;
mod durability;
mod failures;
mod fault;
mod folder;
mod garbage;
mod hex;
mod history;
mod index;
mod index_format;
mod layout;
mod link;
mod locks;
mod materialise;
mod mutex;
mod names;
mod pack;
mod packed;
mod packs;
mod places;
mod present;
mod records;
mod remote;
mod remote_garbage;
mod scratch;
mod side_by_side;
mod sink;
mod spare;
mod store;
mod turn;
mod write_through;

pub use blobs::digest_of_file;
pub use costs::Costs;
pub use fault::{FaultPoints, PublishStep};
pub use folder::VERSION_FILE;
pub use garbage::{GarbageOptions, GarbageReport, collect_garbage, pin};
pub use history::{PastRun, PastStage};
pub use index::{FinishedTask, IndexedTask, KnownTasks};
pub use index_format::FolderTimes;
pub use locks::TaskLock;
pub use materialise::{Materialised, content_of, materialise};
pub use places::check_out_folder;
pub use records::{ActionRecord, Finished};
pub use remote::{Remote, RemoteObject};
pub use remote_garbage::collect_remote_garbage;
pub use sink::{Settled, TaskSink};
pub use store::Store;
