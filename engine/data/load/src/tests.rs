//! Flights that are the same from all layouts.

use crate::tables::NAMES;
use crate::{FlightSource, LoadedFlight, open};
use cosfly_domain::{Channel, channels};
use cosfly_images::read;
use cosfly_read::columns::Column;
use cosfly_read::{PublishedDataset, StoredImage};
use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use serde_json::Map;
use std::path::{Path, PathBuf};

/// The sample dataset, and its exports.
fn published() -> (tempfile::TempDir, [PathBuf; 3]) {
    let home = tempfile::tempdir().unwrap();
    let folders = ["sample", "v7", "lerobot"].map(|name| home.path().join(name));
    sample::write_to_folder(&folders[0], &DatasetConfig::default(), EncodingConfig::default()).unwrap();
    let dataset = PublishedDataset::open(&folders[0]).unwrap();
    for out in &folders[1..] {
        let name = out.file_name().unwrap().to_str().unwrap();
        let format = cosfly_export::prepare(name, Map::new()).unwrap();
        format.write(&dataset, &Default::default(), out, &|_, _| {}).unwrap();
    }
    (home, folders)
}

fn reals(source: &dyn FlightSource, table: &str, name: &str) -> Vec<f64> {
    match source.table(table, None).unwrap().column(name).unwrap() {
        Column::Reals(values) | Column::Lists(values, _) => values,
        Column::Integers(values) => values.into_iter().map(|value| value as f64).collect(),
        other => panic!("{name}: {other:?}"),
    }
}

fn pixels(source: &dyn FlightSource, flight: usize, channel: &Channel, frame: usize) -> Vec<u8> {
    match source.image(flight, channel, frame).unwrap() {
        StoredImage::File(file, format) => read::decoded(&file, &format).unwrap().rgb,
        // v7 says 1,000 m for the sky, and readers take 999 m and more for it.
        StoredImage::Raw { data, .. } if channel.name == "depth" => {
            let depths = data.as_chunks::<4>().0.iter().map(|depth| f32::from_le_bytes(*depth));
            depths.flat_map(|depth| if depth >= 999.0 { f32::INFINITY } else { depth }.to_le_bytes()).collect()
        }
        StoredImage::Raw { data, .. } => data.to_vec(),
    }
}

/// The flight of `source` with these values of `drone_x_m`.
fn flight_with(source: &dyn FlightSource, xs: &[f64]) -> usize {
    let all = reals(source, "frames", "drone_x_m");
    let mut rest = &all[..];
    let is_it = |flight: &LoadedFlight| {
        let (own, others) = rest.split_at(flight.frames);
        rest = others;
        own.len() == xs.len() && own.iter().zip(xs).all(|(a, b)| (a - b).abs() < 1e-3)
    };
    source.flights().iter().map(is_it).collect::<Vec<_>>().iter().position(|it| *it).expect("the flight")
}

#[test]
fn frames_and_poses_are_the_same_in_all_layouts() {
    let (_home, folders) = published();
    let [ours, v7, lerobot] = folders.each_ref().map(|folder| open(folder).unwrap());
    let xs = reals(&*ours, "frames", "drone_x_m");
    let mut first = 0;
    for (flight, known) in ours.flights().iter().enumerate() {
        for (source, tolerance) in [(&v7, 1e-6), (&lerobot, 1e-3)] {
            let other = flight_with(&**source, &xs[first..first + known.frames]);
            let (found, from) = (&source.flights()[other], source.flights()[..other].iter().map(|it| it.frames).sum());
            assert_eq!((found.frames, found.size, &found.split), (known.frames, known.size, &known.split));
            for name in ["drone_x_m", "drone_y_m", "drone_z_m", "drone_yaw_deg", "target_x_m", "target_z_m", "role"] {
                let (a, b) = (reals(&*ours, "frames", name), reals(&**source, "frames", name));
                let (a, b): (&[f64], &[f64]) = (&a[first..first + known.frames], &b[from..from + known.frames]);
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance), "{name}: {a:?} {b:?}");
            }
            for channel in source.channels(other).unwrap() {
                let channel = channels::called(channel).unwrap();
                for frame in 0..known.frames {
                    let (a, b) = (pixels(&*ours, flight, channel, frame), pixels(&**source, other, channel, frame));
                    assert!(a == b, "{}, frame {frame}", channel.name);
                }
            }
        }
        first += known.frames;
    }
    assert!(
        matches!(lerobot.table("captions", None).unwrap().column("text").unwrap(), Column::Texts(it) if it.iter().all(Option::is_some))
    );
}

#[test]
fn depth_of_an_export_for_lerobot_is_that_of_the_dataset_up_to_its_greatest() {
    let home = tempfile::tempdir().unwrap();
    let [dataset, out] = ["sample", "lerobot"].map(|name| home.path().join(name));
    sample::write_to_folder(&dataset, &DatasetConfig::default(), EncodingConfig::default()).unwrap();
    let options = Map::from_iter([("depth".to_owned(), true.into()), ("max_depth_m".to_owned(), 40.into())]);
    let format = cosfly_export::prepare("lerobot", options).unwrap();
    format.write(&PublishedDataset::open(&dataset).unwrap(), &Default::default(), &out, &|_, _| {}).unwrap();
    let [ours, lerobot] = [&dataset, &out].map(|folder| open(folder).unwrap());
    let xs = reals(&*ours, "frames", "drone_x_m");
    let depth = channels::called("depth").unwrap();
    let depths = |source: &dyn FlightSource, flight: usize, frame: usize| match source.image(flight, depth, frame) {
        Ok(StoredImage::Raw { data, width, height, pixel_bytes: 4 }) => {
            let depths: Vec<f32> = data.as_chunks().0.iter().map(|depth| f32::from_le_bytes(*depth)).collect();
            (depths, [width, height])
        }
        other => panic!("{other:?}"),
    };
    let (mut first, mut farther, mut nearer) = (0, 0, 0);
    for (flight, known) in ours.flights().iter().enumerate() {
        let other = flight_with(&*lerobot, &xs[first..first + known.frames]);
        assert_eq!(lerobot.channels(other).unwrap(), ["rgb", "depth"]);
        for frame in 0..known.frames {
            let ((own, size), (read, of)) = (depths(&*ours, flight, frame), depths(&*lerobot, other, frame));
            assert_eq!(size, of);
            // The floats of the log, bit for bit; what is farther, and the sky, is the greatest depth.
            assert!(own.iter().zip(&read).all(|(own, read)| own.min(40.0) == *read), "frame {frame}");
            farther += own.iter().filter(|depth| **depth > 40.0).count();
            nearer += own.iter().filter(|depth| **depth < 40.0).count();
        }
        first += known.frames;
    }
    assert!(farther > 0 && nearer > 0);
}

#[test]
fn the_doctor_reads_depth_of_an_export_for_lerobot() {
    let found = |per_metre: f32, with_depth: bool| {
        let home = tempfile::tempdir().unwrap();
        let [dataset, out] = ["sample", "lerobot"].map(|name| home.path().join(name));
        let mut flights = sample::flights();
        let images = flights.iter_mut().flat_map(|flight| &mut flight.images);
        images.flat_map(|images| &mut images.depth_m).for_each(|depth| *depth *= per_metre);
        sample::write_flights(&dataset, &DatasetConfig::default(), EncodingConfig::default(), flights).unwrap();
        let options = [("depth".to_owned(), true.into()), ("max_depth_m".to_owned(), 10_000.into())];
        let options = Map::from_iter(options.into_iter().filter(|_| with_depth));
        let format = cosfly_export::prepare("lerobot", options).unwrap();
        format.write(&PublishedDataset::open(&dataset).unwrap(), &Default::default(), &out, &|_, _| {}).unwrap();
        // The splits, each a dataset of its own, at once.
        let found = cosfly_doctor::examine(&out, &[], &mut |_, _| {}).unwrap();
        assert_eq!((found.episodes, found.frames), (4, 20));
        let mut names: Vec<&str> = found.flags.iter().map(|flag| flag.name).collect();
        names.dedup();
        (names, found.unchecked.join("; "))
    };
    let (names, notes) = found(1.0, true);
    assert!(names.is_empty() && notes.contains("depth: its files and unit are checked"), "{names:?} {notes}");
    assert!(!notes.contains("can be parsed") && !notes.contains("no splits are stated"), "{notes}");
    assert_eq!(found(100.0, true).0, ["depth-unit"]);
    let (names, notes) = found(100.0, false);
    assert!(names.is_empty() && notes.contains("no feature is marked"), "{names:?} {notes}");
}

#[test]
fn what_a_layout_does_not_hold_is_refused_with_what_it_holds() {
    let (_home, [ours, v7, lerobot]) = published();
    let refused = |folder: &Path, name: &str| {
        let refusal = open(folder).unwrap().image(0, channels::called(name).unwrap(), 0).unwrap_err();
        (refusal.code, refusal.hints.join(" "))
    };
    let (code, hints) = refused(&lerobot, "depth");
    assert!(code == "dataset-channel" && hints.contains("rgb"), "{hints}");
    assert_eq!(refused(&v7, "normals").0, "dataset-channel");
    let (code, hints) = refused(&ours, "disparity");
    assert!(code == "dataset-channel" && hints.contains("semantic"), "{hints}");
    let missing = open(&v7).unwrap().table("objects", None).unwrap_err();
    assert!(missing.code == "dataset-none" && missing.hints[0].contains("frames"), "{missing:?}");
    assert_eq!(open(Path::new("/nowhere")).err().unwrap().code, "dataset-none");
}

#[test]
fn damaged_folders_are_refused() {
    let (_home, [_, v7, lerobot]) = published();
    let mut below = vec![v7.clone(), lerobot.clone()];
    while let Some(path) = below.pop() {
        if path.is_dir() {
            below.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|it| ["json", "parquet", "npy", "png"].iter().any(|end| it == *end)) {
            let bytes = std::fs::read(&path).unwrap();
            std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        }
    }
    assert_eq!(open(&v7).err().unwrap().code, "dataset-damaged");
    assert_eq!(open(&lerobot).err().unwrap().code, "dataset-damaged");
}

#[test]
fn datasets_of_all_layouts_are_told_apart_and_known_again_in_a_copy() {
    let (_home, folders) = published();
    let (_home_of_copy, copies) = published();
    let identities = folders.each_ref().map(|folder| open(folder).unwrap().identity().to_owned());
    let again = copies.each_ref().map(|folder| open(folder).unwrap().identity().to_owned());
    assert_eq!(identities, again);
    assert!(identities[0] != identities[1] && identities[1] != identities[2]);
    // Another dataset in the folder of the open one.
    let ours = open(&folders[0]).unwrap();
    let other = DatasetConfig { title: "another one".into(), ..DatasetConfig::default() };
    sample::write_to_folder(&folders[0], &other, EncodingConfig::default()).unwrap();
    let refusals =
        [ours.check().err(), ours.table("frames", None).err(), ours.image(0, &channels::rgb::CHANNEL, 0).err()];
    assert!(refusals.iter().all(|it| it.as_ref().is_some_and(|it| it.code == "dataset-changed")), "{refusals:?}");
}

#[test]
fn columns_of_other_layouts_are_columns_of_cosfly() {
    let (_home, [ours, v7, lerobot]) = published();
    let columns = |folder: &Path, table: &str| open(folder).unwrap().table(table, None).unwrap().columns().unwrap();
    for (folder, table) in [&v7, &lerobot].into_iter().flat_map(|folder| NAMES.iter().map(move |table| (folder, table)))
    {
        let own = columns(&ours, table);
        let strange: Vec<_> = columns(folder, table).into_iter().filter(|name| !own.contains(name)).collect();
        assert!(strange.is_empty(), "table `{table}` of cosfly has no {strange:?}");
    }
}

#[test]
fn splits_and_tables_without_rows_have_their_columns_and_types() {
    let experts = sample::flights().into_iter().filter(|flight| flight.record.pair.is_none()).collect();
    let home = tempfile::tempdir().unwrap();
    sample::write_flights(home.path(), &DatasetConfig::default(), EncodingConfig::default(), experts).unwrap();
    let source = open(home.path()).unwrap();
    // No flight is perturbed.
    let pairs = source.table("pairs", None).unwrap();
    assert_eq!(pairs.rows().unwrap(), 0);
    assert!(matches!(pairs.column("expert_id").unwrap(), Column::Texts(texts) if texts.is_empty()));
    let used: Vec<&str> = source.flights().iter().map(|flight| flight.split.as_str()).collect();
    let unused = ["train", "val", "test"].into_iter().find(|split| !used.contains(split)).expect("two flights");
    let (none, all) = (source.table("frames", Some(unused)).unwrap(), source.table("frames", None).unwrap());
    assert_eq!((none.rows().unwrap(), none.columns().unwrap()), (0, all.columns().unwrap()));
    assert!(matches!(none.column("trajectory_id").unwrap(), Column::Texts(texts) if texts.is_empty()));
}
