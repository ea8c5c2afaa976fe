//! Leaves as JSON lines, for any engine.

use crate::leaves::{Command, Leaf};
use serde_json::json;

/// One line for each leaf: number, name, numbers of the leaves that must end first, command, resources. Memory in MiB, time
/// in seconds; 0 where none is asked for.
pub fn json_lines(leaves: &[Leaf], command: &Command) -> String {
    let line = |leaf: &Leaf| {
        let value = json!({
            "id": leaf.id, "name": leaf.name, "deps": leaf.deps, "command": command.of(leaf), "cpus": leaf.request.cpus,
            "memory_mib": leaf.request.memory_mib, "gpus": leaf.request.gpus, "time_s": leaf.request.seconds,
        });
        format!("{value}\n")
    };
    leaves.iter().map(line).collect()
}
