//! Every fuzz target over damaged files of its corpus: a bounded run that is the same every time.

use crate::support::repository_root;
use cosfly_frames::{RandomStream, Seed};
use std::panic::AssertUnwindSafe;
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[path = "fuzz/src/lib.rs"]
mod targets;

/// Damaged copies of each file; `COSFLY_FUZZ_ROUNDS` asks for more.
const ROUNDS: u64 = 30;
/// Far beyond what any input takes: a guard against hanging, not a measurement.
const HANGS_AFTER: Duration = Duration::from_secs(60);
/// Pieces of the formats that are put in.
const PIECES: &[&[u8]] = &[
    b"",
    b"-",
    b"1e9",
    b"1e308",
    b"nan",
    b"\"",
    b"<",
    b">",
    b"/>",
    b"0",
    b"999999",
    b"\0\0\0\0",
    b"\xff\xff\xff\xff",
    b"\0\0\0\x01",
    b"\xff\xff\xff\x7f",
    b"\x80",
    b"[",
    b"]",
    b"{",
    b"}",
    b",",
    b"null",
    b"\n",
    b"[[[[",
    b" = ",
    b"o",
];

/// The files of a corpus, sorted by name.
fn corpus(name: &str) -> Vec<(String, Vec<u8>)> {
    let folder = repository_root().join("tests/fuzz/corpus").join(name);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    let read = |path: PathBuf| {
        let file = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
        (file, std::fs::read(path).expect("readable"))
    };
    paths.into_iter().map(read).collect()
}

/// A copy with a few damages.
pub fn damaged(bytes: &[u8], stream: &mut RandomStream) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=stream.index(6) {
        if out.is_empty() {
            return out;
        }
        let at = stream.index(out.len());
        match stream.index(7) {
            0 => out[at] = stream.index(256) as u8,
            1 => out[at] ^= 1 << stream.index(8),
            2 => drop(out.splice(at..at, PIECES[stream.index(PIECES.len())].iter().copied())),
            3 => drop(out.drain(at..(at + 1 + stream.index(40)).min(out.len()))),
            4 => out.truncate(at),
            5 => {
                let piece = out[at..(at + 1 + stream.index(60)).min(out.len())].to_vec();
                let to = stream.index(out.len());
                drop(out.splice(to..to, piece));
            }
            _ => {
                // A digit becomes another, so that texts stay well formed and their numbers turn wild.
                if let Some(found) = out[at..].iter().position(u8::is_ascii_digit) {
                    out[at + found] = b"0123456789.e-"[stream.index(13)];
                }
            }
        }
    }
    out
}

/// Runs one input; one that panics or hangs is kept in the system's folder for temporary files.
fn check(name: &str, file: &str, round: u64, target: targets::Target, input: &[u8]) {
    let begun = Instant::now();
    let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| target(input)));
    if outcome.is_err() || begun.elapsed() > HANGS_AFTER {
        let kept = std::env::temp_dir().join(format!("fuzz-{name}-{file}-{round}"));
        std::fs::write(&kept, input).expect("the temporary folder is writable");
        panic!("target `{name}`, round {round} of `{file}`, {:?}: the input is {}", begun.elapsed(), kept.display());
    }
}

/// Runs the target over its corpus as it is, and over `rounds` damaged copies of each file.
fn run(name: &str, target: targets::Target, rounds: u64) {
    let begun = Instant::now();
    let files = corpus(name);
    assert!(!files.is_empty(), "`tests/fuzz/corpus/{name}` has a file");
    for (file, bytes) in &files {
        let mut stream = Seed::of_item(1, name, file).stream("damage");
        check(name, file, 0, target, bytes);
        for round in 1..=rounds {
            check(name, file, round, target, &damaged(bytes, &mut stream));
        }
    }
    println!("{name}: {} files, {rounds} rounds in {:.1} s", files.len(), begun.elapsed().as_secs_f64());
}

#[test]
fn damaged_files_of_every_corpus_are_read_or_refused() {
    let rounds = std::env::var("COSFLY_FUZZ_ROUNDS").map_or(ROUNDS, |text| text.parse().expect("a number of rounds"));
    for (name, target) in targets::TARGETS {
        run(name, *target, rounds);
    }
}

#[test]
fn every_target_has_a_file_for_libfuzzer_and_a_corpus() {
    let root = repository_root().join("tests/fuzz");
    let manifest = std::fs::read_to_string(root.join("Cargo.toml")).expect("readable");
    for (name, _) in targets::TARGETS {
        assert!(targets::target(name) as usize != 0 && !corpus(name).is_empty());
        assert!(root.join(format!("fuzz_targets/{name}.rs")).is_file(), "{name}");
        assert!(manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")), "{name}");
    }
    assert_eq!(std::fs::read_dir(root.join("fuzz_targets")).expect("readable").count(), targets::TARGETS.len());
}
