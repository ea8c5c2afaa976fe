//! Laws of all map formats, run over the example of each: recognition, refusals, options, determinism.

use cosfly_domain::Town;
use cosfly_frames::Seed;
use cosfly_maps::{FORMATS, MapConfig, read_town, recognise};
use cosfly_town::{Format, FormatOptions, MapError};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Far beyond what any input takes: a guard against hanging, not a measurement.
const HANGS_AFTER: Duration = Duration::from_secs(120);

fn read(bytes: &[u8], options: FormatOptions) -> Result<Town, MapError> {
    let start = Instant::now();
    let config = MapConfig { options, ..MapConfig::default() };
    let read = read_town(bytes, &config, Seed::of_item(1, "town", "town"));
    assert!(start.elapsed() < HANGS_AFTER, "{:?}", start.elapsed());
    let (town, _) = read?;
    cosfly_town::assert_well_formed(&town).expect("a town that was read is well formed");
    Ok(town)
}

fn read_plainly(bytes: &[u8]) -> Result<Town, MapError> {
    read(bytes, FormatOptions::default())
}

fn examples() -> impl Iterator<Item = (&'static Format, &'static [u8])> {
    FORMATS.iter().map(|format| (format, format.example()))
}

#[test]
fn formats_are_sorted_and_each_recognises_its_own_files_only() {
    assert!(FORMATS.is_sorted_by(|a, b| a.name().to_lowercase() < b.name().to_lowercase()));
    for (own, example) in examples() {
        for format in FORMATS {
            assert_eq!(format.recognises(example), format.name() == own.name(), "{format:?} on an example of {own:?}");
        }
        assert_eq!(recognise(&example[..example.len().min(Format::HEAD_BYTES)]).unwrap().name(), own.name());
        assert!(!own.recognises(b"") && !own.recognises(b"hello"), "{own:?}");
    }
}

#[test]
fn files_of_relatives_name_the_way_to_a_known_format() {
    for (head, expected) in [
        (&b"BZh91AY&SY"[..], "bunzip2"),
        (b"<?xml version=\"1.0\"?><core:CityModel>", "citygml-tools"),
        (b"{\"version\": 0.6, \"generator\": \"Overpass API\"}", "out:xml"),
        (b"ISO-10303-21;\nHEADER;", "IFC"),
        (b"b3dm\x01\x00\x00\x00", "3D Tiles"),
    ] {
        let error = recognise(head).unwrap_err();
        assert!(error.hints.last().is_some_and(|hint| hint.contains(expected)), "{:?}", error.hints);
    }
}

#[test]
fn houses_of_absurd_height_are_a_warning() {
    let box_of = |at: u32, height_m: f64| {
        let middle_m = 0.5 * height_m;
        format!(
            "{{\"kind\": \"building\", \"center_m\": [{}, 20, {middle_m}], \"size_m\": [9, 9, {height_m}]}}",
            20 * at
        )
    };
    for (height_m, is_odd) in [(0.12, true), (12.0, false), (1200.0, true)] {
        let boxes: Vec<String> = (0..7).map(|at| box_of(at, height_m)).collect();
        let walk = "{\"kind\": \"sidewalk\", \"outline_m\": [[0, 0, 0], [99, 0, 0], [99, 4, 0], [0, 4, 0]]}";
        let text =
            format!("{{\"format\": \"cosfly-boxes/1\", \"boxes\": [{}], \"walkable\": [{walk}]}}", boxes.join(", "));
        let (_, warnings) =
            read_town(text.as_bytes(), &MapConfig::default(), Seed::of_item(1, "town", "town")).unwrap();
        assert_eq!(
            warnings.iter().any(|warning| warning.contains("check the unit")),
            is_odd,
            "{height_m}: {warnings:?}"
        );
    }
}

#[test]
fn files_of_no_format_are_refused_with_the_names_of_all() {
    for (bytes, expected) in [(&b""[..], "the file is empty"), (b"hello", "the file is of no known map format")] {
        let error = read_plainly(bytes).unwrap_err();
        assert_eq!(error.message, expected);
        assert!(FORMATS.iter().all(|format| error.hints[0].contains(format.name())), "{:?}", error.hints);
    }
}

#[test]
fn examples_give_the_same_town_twice() {
    for (format, example) in examples() {
        let town = read_plainly(example).unwrap_or_else(|error| panic!("{format:?}: {error}"));
        assert!(!town.obstacles.is_empty() && !town.walkable.is_empty() && !town.surfaces.is_empty(), "{format:?}");
        assert_eq!(read_plainly(example).unwrap(), town, "{format:?}");
    }
}

#[test]
fn formats_that_have_an_option_of_the_same_name_describe_it_alike() {
    let mut known = BTreeMap::new();
    for format in FORMATS {
        let schema = format.schema();
        for (name, option) in schema["properties"].as_object().into_iter().flatten() {
            let first = known.entry(name.clone()).or_insert_with(|| option.clone());
            assert_eq!(first, option, "`{name}` of {format:?}");
        }
    }
}

#[test]
fn defaults_may_be_given_and_options_of_other_formats_are_refused() {
    for (own, example) in examples() {
        let plain = read_plainly(example).unwrap();
        for format in FORMATS {
            let defaults = format.filled(&FormatOptions::default()).unwrap();
            let read = read(example, defaults.clone());
            // Options that say nothing by default are not given.
            let given = serde_json::to_value(&defaults).unwrap();
            if given.as_object().unwrap().keys().all(|name| own.option_names().contains(name)) {
                assert_eq!(read.unwrap(), plain, "{own:?}");
            } else {
                let error = read.unwrap_err();
                assert!(error.message.contains(own.name()), "{error}");
            }
        }
    }
}

#[test]
fn every_truncation_is_refused() {
    for (format, example) in examples() {
        for end in (0..example.len()).step_by(1 + example.len() / 200) {
            let refused = read_plainly(&example[..end]);
            assert!(refused.is_err() || example[end..].trim_ascii().is_empty(), "{format:?} cut at {end}");
        }
    }
}

/// A change of a file at a place, which is a share of its length.
#[derive(Clone, Debug)]
enum Damage {
    Byte(u8),
    Insert(&'static str),
    Cut(usize),
    /// The next digit becomes another character of numbers, so that files stay well formed and their numbers turn wild.
    Digit(u8),
}

const PIECES: &[&str] = &[
    "", "-", "1e9", "nan", "inf", "\"", "<", ">", "/>", "0", "999999", "-1", "s=\"", "<road>", "\u{0}", "e308", " ",
    "[", "]", "{", "}", ",", "null", "[[[[",
];

fn damage() -> impl Strategy<Value = (f64, Damage)> {
    let kind = prop_oneof![
        any::<u8>().prop_map(Damage::Byte),
        prop::sample::select(PIECES).prop_map(Damage::Insert),
        (1..40_usize).prop_map(Damage::Cut),
        prop::sample::select(&b"0123456789.e-"[..]).prop_map(Damage::Digit),
    ];
    (0.0..1.0, kind)
}

fn damaged(bytes: &[u8], damages: &[(f64, Damage)]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for (share, damage) in damages {
        let at = (share * out.len() as f64) as usize;
        match damage {
            _ if out.is_empty() => break,
            Damage::Byte(byte) => out[at] = *byte,
            Damage::Insert(piece) => drop(out.splice(at..at, piece.bytes())),
            Damage::Cut(length) => drop(out.drain(at..(at + length).min(out.len()))),
            Damage::Digit(digit) => {
                if let Some(found) = out[at..].iter().position(u8::is_ascii_digit) {
                    out[at + found] = *digit;
                }
            }
        }
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_give_an_error_or_a_well_formed_town(damages in prop::collection::vec(damage(), 1..5)) {
        for (_, example) in examples() {
            let _ = read_plainly(&damaged(example, &damages));
        }
    }

    #[test]
    fn garbage_behind_a_good_beginning_is_refused(garbage in prop::collection::vec(any::<u8>(), 0..400)) {
        for (_, example) in examples() {
            let head = &example[..example.len() / 3];
            prop_assert!(read_plainly(&[head, &garbage].concat()).is_err());
        }
    }
}
