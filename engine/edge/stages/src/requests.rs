//! Resources of the built-in stages, for engines on other machines; measured, see "Costs of a task" in the book's benchmarks.

use cosfly_cluster::Request;

/// Resources of one task of a kind. Cheap tasks share a command: starting one costs about as much as 20 of them.
pub fn request(kind: &str) -> Request {
    let of = |memory_mib, batch| Request { memory_mib, batch, ..Request::default() };
    match kind {
        "caption" => of(256, 64),
        "perturb" => of(256, 16),
        "pedestrians" => of(512, 16),
        "muco" => of(512, 4),
        "traffic" => of(1024, 1),
        "map" => of(1024, 1),
        "render" => of(1024, 1),
        "dataset" => of(2048, 1),
        _ => of(1024, 1),
    }
}
