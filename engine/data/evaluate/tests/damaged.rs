//! Evaluations of damaged files of predictions: every one is scored in part or refused with its place and a way out, in little
//! time, memory and output. The run is the same every time; `COSFLY_FUZZ_ROUNDS` asks for more of it.

use cosfly_diagnose::{Diagnostic, Result};
use cosfly_evaluate::pictures::{self, PictureKind, PictureSettings};
use cosfly_evaluate::windows::Flights;
use cosfly_evaluate::{Settings, evaluate};
use cosfly_frames::{RandomStream, Seed};
use cosfly_read::{PublishedDataset, predictions};
use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use cosfly_windows::WindowShape;
use std::panic::AssertUnwindSafe;
use std::path::Path;
use std::time::{Duration, Instant};

/// Damaged copies of each file.
const ROUNDS: usize = 40;
/// Largest time of an evaluation, and sizes of its report and of its picture, bytes.
const LONGEST: Duration = Duration::from_secs(20);
const LARGEST_REPORT: usize = 4_000_000;
const LARGEST_PICTURE: usize = 200_000;
/// Largest memory of the whole run, kB.
#[cfg(target_os = "linux")]
const MOST_MEMORY_KB: u64 = 1_000_000;
/// Texts in the place of numbers and between them.
const PIECES: &[&str] = &[
    "NaN",
    "-Infinity",
    "1e23",
    "-1e24",
    "1e999",
    "1e308",
    "-0.0",
    "1e-320",
    "999999999999999999999",
    "4294967296",
    "-1",
    "0.5",
    "null",
    "true",
    "\"\"",
    "[]",
    "{}",
    "[[",
    "]",
    "}",
    ",",
    ":",
    "\"",
    "\\u0000",
    "\u{202e}",
    "<script>",
    "\n",
    "[",
    "{\"a\":",
];

struct Bench {
    _folder: tempfile::TempDir,
    dataset: PublishedDataset,
    flights: Flights,
    work: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        sample::write_to_folder(folder.path(), &DatasetConfig::default(), EncodingConfig::default()).unwrap();
        let dataset = PublishedDataset::open(folder.path()).unwrap();
        let flights = Flights::read(&dataset).unwrap();
        Self { _folder: folder, dataset, flights, work: tempfile::tempdir().unwrap() }
    }

    /// Evaluates predictions as the command does; gives the sizes of report and picture.
    fn evaluate(&self, path: &Path, kind: Option<PictureKind>) -> Result<[usize; 2]> {
        let kind = kind.map_or_else(|| pictures::recognise(path), |kind| Ok(Some(kind)))?;
        match kind {
            Some(kind) => {
                let settings = PictureSettings { resamples: 20, ..PictureSettings::new(kind) };
                let found = pictures::evaluate(&self.dataset, &self.flights, path, &settings)?;
                Ok([found.to_markdown().len() + found.to_json().len(), found.to_svg().len()])
            }
            None => {
                let window = WindowShape { history: 2, horizon: 2, stride: 1 };
                let settings = Settings { window, resamples: 20, ..Settings::default() };
                let found = evaluate(&self.flights, Some(("predictions", predictions::read(path)?)), &settings)?;
                Ok([found.to_markdown().len() + found.to_json().len(), found.to_svg().len()])
            }
        }
    }

    /// Checks one input, which is a file called `name` or, for pictures, one in a folder.
    fn check(&self, name: &str, bytes: &[u8], round: usize) {
        let is_picture = name.ends_with(".npy") || name.ends_with(".png");
        let given = self.work.path().join(if is_picture { "pictures" } else { name });
        let file = if is_picture {
            given.join("perturbed-p00000").join(format!("000001{}", &name[name.len() - 4..]))
        } else {
            given.clone()
        };
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, bytes).unwrap();
        let kind =
            is_picture.then_some(if name.starts_with("labels") { PictureKind::Semantic } else { PictureKind::Depth });
        let begun = Instant::now();
        let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| self.evaluate(&given, kind)));
        let keep = || {
            let kept = std::env::temp_dir().join(format!("evaluation-{round}-{name}"));
            std::fs::write(&kept, bytes).unwrap();
            kept.display().to_string()
        };
        let Ok(outcome) = outcome else { panic!("round {round}: the input is {}", keep()) };
        assert!(begun.elapsed() < LONGEST, "round {round}, {:?}: the input is {}", begun.elapsed(), keep());
        match outcome {
            Ok([report, picture]) => {
                assert!(
                    report < LARGEST_REPORT && picture < LARGEST_PICTURE,
                    "{report} and {picture} bytes: {}",
                    keep()
                );
            }
            Err(refusal) => assert!(has_place_and_way_out(&refusal), "{refusal:?}: {}", keep()),
        }
        if is_picture {
            std::fs::remove_dir_all(&given).unwrap();
        }
    }
}

fn has_place_and_way_out(refusal: &Diagnostic) -> bool {
    refusal.message.contains('`') && !refusal.hints.is_empty()
}

/// Whole files of every form that is read.
fn files(bench: &Bench) -> Vec<(&'static str, Vec<u8>)> {
    let row =
        |frame: usize, more: &str| format!("{{\"trajectory_id\": \"perturbed-p00000\", \"frame\": {frame}, {more}}}");
    let deltas = "\"waypoint_deltas\": [[0.1, 0, -0.25, 0, 2, 0], {\"dx\": 1.5, \"dyaw\": -3}]";
    let said = "\"text\": \"<think>hm</think> {\\\"waypoint_deltas\\\": [[0.1, 0.2], [1]]}\"";
    let waypoints = [row(0, deltas), row(1, &format!("{deltas}, \"boxes\": [[1, 2, 30, 40], null]")), row(1, said)];
    let found = "\"category_id\": 12, \"bbox\": [10.5, 12, 20, 30], \"score\": 0.75";
    let mask =
        "\"category_id\": 12, \"score\": 0.5, \"segmentation\": {\"size\": [48, 64], \"counts\": [100, 50, 2922]}";
    let boxes = [row(0, found), row(2, found), row(9, found)];
    let masks = [row(0, mask), row(1, &mask.replace("[100, 50, 2922]", "\"T3b1jX2\""))];
    let (width, height) = (64, 48);
    let npy = |kind: &str, bytes: Vec<u8>| {
        let head = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({height}, {width}), }}\n");
        [b"\x93NUMPY\x01\x00", &(head.len() as u16).to_le_bytes()[..], head.as_bytes(), &bytes].concat()
    };
    let png = |depth: png::BitDepth, bytes: &[u8]| {
        let mut file = vec![];
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(depth);
        encoder.write_header().unwrap().write_image_data(bytes).unwrap();
        file
    };
    let pixels = (width * height) as usize;
    let mut table =
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../tests/fuzz/corpus/predictions/waypoints.parquet"))
            .unwrap();
    table.truncate(1 << 20);
    assert!(!bench.flights.rows.is_empty());
    vec![
        ("waypoints.jsonl", waypoints.join("\n").into_bytes()),
        ("waypoints.json", format!("[{}]", waypoints.join(",\n ")).into_bytes()),
        ("waypoints.parquet", table),
        ("boxes.json", format!("[{}]", boxes.join(", ")).into_bytes()),
        ("boxes.jsonl", boxes.join("\n").into_bytes()),
        ("masks.json", format!("[{}]", masks.join(",\n")).into_bytes()),
        ("depth.npy", npy("<f4", (0..pixels).flat_map(|at| (at as f32 * 0.01).to_le_bytes()).collect())),
        ("depth8.npy", npy("<f8", (0..pixels).flat_map(|at| (at as f64 * 0.01).to_le_bytes()).collect())),
        ("labels.npy", npy("|u1", (0..pixels).map(|at| (at % 29) as u8).collect())),
        ("depth.png", png(png::BitDepth::Sixteen, &vec![3; 2 * pixels])),
        ("labels.png", png(png::BitDepth::Eight, &vec![7; pixels])),
    ]
}

fn damaged(bytes: &[u8], is_text: bool, stream: &mut RandomStream) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=stream.index(4) {
        if out.is_empty() {
            return out;
        }
        let at = stream.index(out.len());
        let piece = PIECES[stream.index(PIECES.len())].as_bytes();
        match stream.index(if is_text { 9 } else { 6 }) {
            0 => out[at] = stream.index(256) as u8,
            1 => out[at] ^= 1 << stream.index(8),
            2 => drop(out.drain(at..(at + 1 + stream.index(40)).min(out.len()))),
            3 => out.truncate(at),
            4 => {
                let copied = out[at..(at + 1 + stream.index(90)).min(out.len())].to_vec();
                let to = stream.index(out.len());
                drop(out.splice(to..to, copied));
            }
            5 => drop(out.splice(at..at, [0xff, 0xff, 0xff, 0x7f])),
            6 => drop(out.splice(at..at, piece.iter().copied())),
            // A number becomes another.
            _ => {
                let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
                if let Some(first) = out[at..].iter().position(is_digit).map(|found| at + found) {
                    let length = out[first..].iter().take_while(|byte| is_digit(byte)).count();
                    drop(out.splice(first..first + length, piece.iter().copied()));
                }
            }
        }
    }
    out
}

#[test]
fn damaged_predictions_are_scored_in_part_or_refused_with_place_and_way_out() {
    let rounds = std::env::var("COSFLY_FUZZ_ROUNDS").map_or(ROUNDS, |text| text.parse().unwrap());
    let bench = Bench::new();
    for (name, bytes) in files(&bench) {
        let is_text = name.contains(".json");
        let begun = Instant::now();
        let mut stream = Seed::of_item(1, "evaluation", name).stream("damage");
        bench.check(name, &bytes, 0);
        for round in 1..=rounds {
            bench.check(name, &damaged(&bytes, is_text, &mut stream), round);
        }
        println!("{name}: {rounds} rounds in {:.1} s", begun.elapsed().as_secs_f64());
    }
    #[cfg(target_os = "linux")]
    {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        let most =
            status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB")?.trim().parse().ok());
        let most: u64 = most.unwrap();
        println!("memory: {most} kB");
        assert!(most < MOST_MEMORY_KB, "{most} kB");
    }
}

#[test]
fn huge_sizes_in_small_files_take_no_memory() {
    let bench = Bench::new();
    let shape = |shape: &str| {
        let head = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        [b"\x93NUMPY\x01\x00", &(head.len() as u16).to_le_bytes()[..], head.as_bytes()].concat()
    };
    for text in ["(32768, 32768)", "(99999999999, 99999999999)", "(0, 0)", "(18446744073709551615, 1)", "(-1, 5)"] {
        bench.check("depth.npy", &shape(text), 0);
        bench.check("labels.npy", &shape(text), 0);
    }
    let runs = "{\"size\": [65535, 65535], \"counts\": [4294967295]}";
    let row = format!(
        "[{{\"trajectory_id\": \"a\", \"frame\": 0, \"category_id\": 1, \"score\": 1, \"segmentation\": {runs}}}]"
    );
    bench.check("masks.json", row.as_bytes(), 0);
    bench.check("deep.json", "[".repeat(1 << 20).as_bytes(), 0);
    bench.check("deep.jsonl", "{\"a\":".repeat(1 << 20).as_bytes(), 0);
}

/// Text of predictions that fit both windows of a flight, but for the first number.
fn with_number(number: &str) -> String {
    let row = |id: usize, frame: usize, number: &str| {
        format!(
            "{{\"trajectory_id\": \"perturbed-p0000{id}\", \"frame\": {frame}, \"waypoint_deltas\": [[{number}], [0.1]]}}\n"
        )
    };
    [row(0, 0, number), row(0, 1, "0"), row(1, 0, "0"), row(1, 1, "0")].concat()
}

#[test]
fn numbers_that_no_flight_has_are_malformed_rows_and_the_others_are_scored() {
    let bench = Bench::new();
    let window = WindowShape { history: 2, horizon: 2, stride: 1 };
    let settings = Settings { window, resamples: 20, ..Settings::default() };
    let path = bench.work.path().join("predictions.jsonl");
    for number in ["1e15", "1e23", "-1e24", "1e300", "NaN", "-Infinity", "1e999"] {
        std::fs::write(&path, with_number(number)).unwrap();
        let given = predictions::read(&path).unwrap();
        let found = evaluate(&bench.flights, Some(("predictions", given)), &settings).unwrap();
        let rows = found.rows.as_ref().unwrap();
        assert_eq!((rows.malformed, rows.problems[0].line, found.has_problems()), (1, 1, true), "{number}");
        assert!(found.methods[0].scores["fde_m"].value < 100.0, "{number}");
        assert!(found.to_svg().len() < LARGEST_PICTURE, "{number}");
    }
    // What is plausible is scored, however wrong it is, and drawn in little room.
    std::fs::write(&path, with_number("9e8")).unwrap();
    let found = evaluate(&bench.flights, Some(("predictions", predictions::read(&path).unwrap())), &settings).unwrap();
    assert!(found.methods[0].scores["fde_m"].value > 1e8 && found.to_svg().len() < LARGEST_PICTURE);
}

#[test]
fn scores_of_a_part_say_so_first() {
    let bench = Bench::new();
    let window = WindowShape { history: 2, horizon: 2, stride: 1 };
    let settings = Settings { window, resamples: 20, ..Settings::default() };
    let path = bench.work.path().join("predictions.jsonl");
    let whole = with_number("0");
    std::fs::write(&path, whole.lines().next().unwrap()).unwrap();
    let of = |settings: &Settings| {
        evaluate(&bench.flights, Some(("predictions", predictions::read(&path).unwrap())), settings).unwrap()
    };
    let found = of(&settings);
    assert!(found.is_partial && found.has_problems() && found.windows.without_prediction > 0);
    let report = found.to_markdown();
    assert!(report.lines().nth(2).unwrap().starts_with("**Partial: "), "{report}");
    let filled = of(&Settings { missing_as_zero: true, ..settings });
    assert!(!filled.is_partial && !filled.has_problems() && !filled.to_markdown().contains("Partial"));
}

#[test]
fn an_empty_list_of_detections_has_missed_everything() {
    let bench = Bench::new();
    let path = bench.work.path().join("results.json");
    std::fs::write(&path, "[]\n").unwrap();
    assert_eq!(pictures::recognise(&path).unwrap(), Some(PictureKind::Boxes));
    let settings = PictureSettings { resamples: 20, ..PictureSettings::new(PictureKind::Boxes) };
    let found = pictures::evaluate(&bench.dataset, &bench.flights, &path, &settings).unwrap();
    assert_eq!((found.scores["ap"].value, found.scores["ap50"].value), (0.0, 0.0));
    assert!(found.is_partial && found.has_problems() && found.frames.scored > 0);
    assert!(found.to_markdown().contains("**Empty: there is no detection."), "{}", found.to_markdown());
    std::fs::write(&path, "").unwrap();
    let refusal = pictures::evaluate(&bench.dataset, &bench.flights, &path, &settings).unwrap_err();
    assert!(has_place_and_way_out(&refusal) && refusal.message.ends_with("is empty"), "{refusal:?}");
}

#[test]
fn depths_that_are_no_number_are_counted_and_said() {
    let bench = Bench::new();
    let folder = bench.work.path().join("depth");
    std::fs::create_dir_all(folder.join("expert-p00000")).unwrap();
    let depth = |odd: f32| -> Vec<u8> {
        (0..64 * 48).flat_map(|at| if at % 4 == 0 { odd } else { 5.0_f32 }.to_le_bytes()).collect()
    };
    let head = "{'descr': '<f4', 'fortran_order': False, 'shape': (48, 64), }\n";
    let head = [b"\x93NUMPY\x01\x00", &(head.len() as u16).to_le_bytes()[..], head.as_bytes()].concat();
    for (frame, odd) in [f32::NAN, -1.0, 1e23, 5.0, f32::INFINITY].into_iter().enumerate() {
        std::fs::write(folder.join(format!("expert-p00000/{frame}.npy")), [&head[..], &depth(odd)].concat()).unwrap();
    }
    let settings = PictureSettings { resamples: 20, ..PictureSettings::new(PictureKind::Depth) };
    let found = pictures::evaluate(&bench.dataset, &bench.flights, &folder, &settings).unwrap();
    let nonsense = &found.frames.nonsense;
    assert_eq!((nonsense.frames, nonsense.first.as_deref()), (3, Some("expert-p00000/0.npy")));
    assert!(nonsense.pixels > 0);
    assert!(
        found.to_markdown().contains("scored pixels in 3 frames: a depth that is not a number"),
        "{}",
        found.to_markdown()
    );
}

#[test]
fn names_with_markup_are_text_in_reports() {
    let bench = Bench::new();
    let path = bench.work.path().join("predictions.jsonl");
    let hostile = [
        "<script>alert(1)</script>",
        "a`b|c",
        "# x\\n\\n- y",
        "\\u001b[31mred",
        "\\u202egnp",
        "![i](http://example.org)",
    ];
    let row = |id: &str| format!("{{\"trajectory_id\": \"{id}\", \"frame\": 0, \"waypoint_deltas\": [[1], [1]]}}\n");
    let text: String = hostile.iter().map(|id| row(id)).collect();
    std::fs::write(&path, text + &with_number("0")).unwrap();
    let window = WindowShape { history: 2, horizon: 2, stride: 1 };
    let settings = Settings { window, resamples: 20, ..Settings::default() };
    let given = predictions::read(&path).unwrap();
    let found = evaluate(&bench.flights, Some(("<b>|`x`", given)), &settings).unwrap();
    let report = found.to_markdown();
    for foreign in ["\n# x", "\n- y", "\u{1b}", "\u{202e}"] {
        assert!(!report.contains(foreign), "{foreign:?} in {report}");
    }
    // Outside of code nothing is markup.
    let outside: String = report.lines().map(outside_of_code).collect();
    assert!(!outside.contains('<') && !outside.contains("!["), "{outside}");
    assert!(!found.to_svg().contains("<script"));
}

/// A line of Markdown without its code.
fn outside_of_code(line: &str) -> String {
    let (mut shown, mut rest) = (String::new(), line);
    while let Some(start) = rest.find('`').filter(|at| !rest[..*at].ends_with('\\')) {
        let fence = rest[start..].len() - rest[start..].trim_start_matches('`').len();
        shown.push_str(&rest[..start]);
        let inner = &rest[start + fence..];
        let end = inner.find(&"`".repeat(fence)).map_or(inner.len(), |at| at + fence);
        rest = &inner[end.min(inner.len())..];
    }
    shown + rest
}
