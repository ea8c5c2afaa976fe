//! Calls of the real binary, and scratch folders for it.

use parquet::file::reader::{FileReader, SerializedFileReader};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Root folder of the repository.
pub fn repository_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..").canonicalize().expect("the repository is there")
}

/// One call of the binary.
pub struct Call {
    command: Command,
    input: Option<Vec<u8>>,
}

/// Output of a call.
pub struct Printed {
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
    /// Exit code; `None` when the process was killed.
    pub code: Option<i32>,
}

/// Creates a call of `cosfly` with `arguments`, run in the repository root.
pub fn cosfly<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Call {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cosfly"));
    command.args(arguments).current_dir(repository_root()).env_remove("COSFLY_STORE").env("NO_COLOR", "1");
    Call { command, input: None }
}

impl Call {
    /// Runs in `dir` instead of the repository root.
    pub fn within(mut self, dir: &Path) -> Self {
        self.command.current_dir(dir);
        self
    }

    /// Sets an environment variable.
    pub fn with(mut self, name: &str, value: &str) -> Self {
        self.command.env(name, value);
        self
    }

    /// Sets standard input to `text`, which need not be UTF-8; empty by default.
    pub fn fed(mut self, text: impl Into<Vec<u8>>) -> Self {
        self.input = Some(text.into());
        self
    }

    /// Runs to the end.
    pub fn run(mut self) -> Printed {
        let stdin = if self.input.is_some() { Stdio::piped() } else { Stdio::null() };
        let command = self.command.stdin(stdin).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("cosfly starts");
        if let (Some(text), Some(mut pipe)) = (self.input, child.stdin.take()) {
            // A call that fails early does not read standard input to the end.
            let _ = pipe.write_all(&text);
        }
        let Output { status, stdout, stderr } = child.wait_with_output().expect("cosfly runs");
        Printed {
            stdout: String::from_utf8(stdout).expect("UTF-8"),
            stderr: String::from_utf8(stderr).expect("UTF-8"),
            code: status.code(),
        }
    }

    /// Runs to the end and expects success.
    pub fn run_ok(self) -> Printed {
        let printed = self.run();
        assert_eq!(printed.code, Some(0), "stdout:\n{}\nstderr:\n{}", printed.stdout, printed.stderr);
        printed
    }

    /// Runs with standard output on a full disk; returns exit code and standard error.
    #[cfg(target_os = "linux")]
    pub fn run_on_a_full_disk(mut self) -> (Option<i32>, String) {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
        let stdin = if self.input.is_some() { Stdio::piped() } else { Stdio::null() };
        let mut child = self.command.stdin(stdin).stdout(full).stderr(Stdio::piped()).spawn().expect("cosfly starts");
        if let (Some(text), Some(mut pipe)) = (self.input, child.stdin.take()) {
            let _ = pipe.write_all(&text);
        }
        let Output { status, stderr, .. } = child.wait_with_output().expect("cosfly runs");
        (status.code(), String::from_utf8(stderr).expect("UTF-8"))
    }

    /// Runs with standard error on a full disk; returns the exit code.
    #[cfg(target_os = "linux")]
    pub fn run_untold(mut self) -> Option<i32> {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
        self.command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(full).status().expect("cosfly runs").code()
    }

    /// Starts the process without waiting.
    pub fn spawn(mut self) -> std::process::Child {
        self.command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("cosfly starts")
    }
}

/// All files below `dir` with the digests of their bytes, sorted.
pub fn tree_digests(dir: &Path) -> Vec<(String, String)> {
    fn walk(root: &Path, dir: &Path, found: &mut Vec<(String, String)>) {
        for entry in std::fs::read_dir(dir).expect("readable").map(|entry| entry.expect("entry").path()) {
            if entry.is_dir() {
                walk(root, &entry, found);
            } else {
                let name = entry.strip_prefix(root).expect("below").display().to_string();
                found.push((
                    name,
                    cosfly_fingerprint::Digest::of(&std::fs::read(&entry).expect("readable")).to_string(),
                ));
            }
        }
    }
    let mut found = vec![];
    walk(dir, dir, &mut found);
    found.sort();
    found
}

/// A column of a table as text, row by row.
pub fn column(dataset: &Path, table: &str, column: &str) -> Vec<String> {
    let mut rows = vec![];
    for file in std::fs::read_dir(dataset.join("data").join(table)).expect("a table") {
        let file = std::fs::File::open(file.expect("an entry").path()).expect("readable");
        let reader = SerializedFileReader::new(file).expect("Parquet");
        for row in reader.get_row_iter(None).expect("rows").map(|row| row.expect("readable")) {
            let cell = row.get_column_iter().find(|(name, _)| *name == column);
            rows.push(cell.expect("the column is there").1.to_string());
        }
    }
    rows
}
