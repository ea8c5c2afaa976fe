//! Leaves as a job file of HyperQueue: one TOML document, a `[[task]]` for each leaf.

use crate::leaves::{Command, Leaf};
use std::fmt::Write;

/// Crashes of workers that a task survives; a task that brings its workers down is not tried for ever.
const CRASH_LIMIT: u32 = 8;

/// Job file with the name `name`.
pub fn job_file(name: &str, leaves: &[Leaf], command: &Command) -> String {
    let mut text = format!("name = {}\n", quoted(name));
    for leaf in leaves {
        let arguments: Vec<String> = command.of(leaf).iter().map(|argument| quoted(argument)).collect();
        let _ = write!(text, "\n[[task]]\nid = {}\ncommand = [{}]\n", leaf.id, arguments.join(", "));
        if !leaf.deps.is_empty() {
            let deps: Vec<String> = leaf.deps.iter().map(u32::to_string).collect();
            let _ = writeln!(text, "deps = [{}]", deps.join(", "));
        }
        // Leaves record their failures in the store; thousands of empty files of output would load the file system.
        let _ = writeln!(text, "stdout = \"none\"\nstderr = \"none\"\ncrash_limit = {CRASH_LIMIT}");
        let request = leaf.request;
        let mut resources = format!("cpus = {}", request.cpus);
        for (name, amount) in [("mem", request.memory_mib), ("\"gpus/nvidia\"", u64::from(request.gpus))] {
            if amount > 0 {
                let _ = write!(resources, ", {name} = {amount}");
            }
        }
        let _ = writeln!(text, "[[task.request]]\nresources = {{ {resources} }}");
        if request.seconds > 0 {
            let _ = writeln!(text, "time_request = \"{}s\"", request.seconds);
        }
    }
    text
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            control if control.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(control));
            }
            plain => quoted.push(plain),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_quoted_as_toml_wants_them() {
        assert_eq!(quoted("a \"b\"\\\n\u{85}é"), "\"a \\\"b\\\"\\\\\\u000A\\u0085é\"");
    }
}
