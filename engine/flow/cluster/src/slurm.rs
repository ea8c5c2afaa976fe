//! A script for Slurm that starts HyperQueue inside one allocation and runs a recipe there, for sites that warn against
//! automatic allocation or do not let a server live on a login node.

use std::fmt::Write;

/// An allocation and the run in it.
#[derive(Clone, Debug)]
pub struct Allocation {
    /// Name of the job.
    pub name: String,
    /// Nodes, each with one worker.
    pub nodes: u32,
    /// Time limit as Slurm reads it, such as `08:00:00`.
    pub time: String,
    /// More options of `sbatch`, such as `--partition=cpu`.
    pub options: Vec<String>,
    /// Command of the run, such as `cosfly run recipe.toml --on hq`.
    pub command: Vec<String>,
}

/// The script.
pub fn slurm_script(allocation: &Allocation) -> String {
    let mut text = format!(
        "#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --nodes={}\n#SBATCH --ntasks-per-node=1\n#SBATCH --exclusive\n\
         #SBATCH --time={}\n#SBATCH --output=%x-%j.log\n#SBATCH --signal=B:TERM@120\n",
        allocation.name, allocation.nodes, allocation.time
    );
    for option in &allocation.options {
        let _ = writeln!(text, "#SBATCH {option}");
    }
    let command: Vec<String> = allocation.command.iter().map(|word| shell_word(word)).collect();
    let _ = write!(
        text,
        r#"
# The server of HyperQueue on the first node, a worker on every node, and the run. When the time is over, submit the same
# script again: finished items are in the store.
set -euo pipefail
hq="${{COSFLY_HQ:-hq}}"
export HQ_SERVER_DIR="$PWD/.hq-${{SLURM_JOB_ID:-here}}"
mkdir -p "$HQ_SERVER_DIR"
"$hq" server start --journal "$HQ_SERVER_DIR/journal" &
server=$!
trap '"$hq" server stop || true; wait "$server" || true' EXIT
trap 'kill "$run"; wait "$run" || true; exit 130' TERM
for _ in $(seq 100); do "$hq" server info >/dev/null 2>&1 && break; sleep 0.2; done
srun "$hq" worker start --on-server-lost=finish-running &
{} &
run=$!
wait "$run"
"#,
        command.join(" ")
    );
    text
}

/// A word of a shell's command line.
pub fn shell_word(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,@%+".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_split_or_expand_them() {
        assert_eq!(shell_word("stages.walkers.count=20"), "stages.walkers.count=20");
        assert_eq!(shell_word("it's $HOME"), r"'it'\''s $HOME'");
        assert_eq!(shell_word(""), "''");
    }
}
