//! Damaged compressed points give an error of ours, and nothing else on the standard error stream.

use cosfly_scans::cloud::CloudOptions;
use cosfly_scans::las::Las;
use cosfly_town::MapFormat;
use std::process::Command;

/// Set in the process that reads the damaged files.
const READER: &str = "COSFLY_READS_HOSTILE_LAZ";

/// A file of the fuzzer's collection with its bytes changed, each by several patterns.
fn read_damaged_files() {
    let (mut refused, mut contained) = (0, 0);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../tests/fuzz/corpus/las/example.laz");
    let whole = std::fs::read(path).unwrap();
    let start = u32::from_le_bytes(*whole[96..].first_chunk().unwrap()) as usize;
    for at in (start..whole.len()).step_by(1 + (whole.len() - start) / 300) {
        for change in [0xff, 0x80, 0x55, 0x01] {
            // A run of damage, as a bad sector makes it.
            for length in [1, 16] {
                let mut file = whole.clone();
                file[at..].iter_mut().take(length).for_each(|byte| *byte ^= change);
                let Err(error) = Las::read(&file, &CloudOptions::default()) else { continue };
                refused += 1;
                contained += usize::from(error.message.contains("what no encoder writes"));
            }
        }
    }
    assert!(contained > 0, "no damage makes the decoder panic");
    println!("refused: {refused}, of them by a panic of the decoder: {contained}");
}

#[test]
fn hostile_points_are_refused_in_silence() {
    if std::env::var_os(READER).is_some() {
        return read_damaged_files();
    }
    let name = "hostile_points_are_refused_in_silence";
    let program = std::env::current_exe().unwrap();
    let run = Command::new(program).args(["--exact", name, "--nocapture"]).env(READER, "1").output().unwrap();
    let (said, complained) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    assert!(run.status.success(), "{said}\n{complained}");
    println!("{}", said.lines().find(|line| line.starts_with("refused")).unwrap_or_default());
    assert_eq!(complained, "");
}
