//! Round trips: the data read equal the published data.

use super::*;
use cosfly_frames::DVec3;
use cosfly_sample as sample;
use cosfly_schema::log::right_handed::map_from_world_point;
use cosfly_schema::tables::Windows;
use cosfly_schema::{DatasetConfig, EncodingConfig};

fn published() -> (tempfile::TempDir, PublishedDataset) {
    let folder = tempfile::tempdir().unwrap();
    sample::write_to_folder(folder.path(), &DatasetConfig::default(), EncodingConfig::default()).unwrap();
    let dataset = PublishedDataset::open(folder.path()).unwrap();
    (folder, dataset)
}

#[test]
fn flights_and_frames_come_back_as_they_were() {
    let (_folder, dataset) = published();
    assert_eq!(dataset.flights().len(), 4);
    let index = dataset.row_index("frames").unwrap();
    for given in sample::flights() {
        let record = &given.record;
        let flight = dataset.flight(&record.trajectory_id).unwrap();
        assert_eq!(flight.expert_id, record.pair.as_ref().map(|pair| pair.expert_id.clone()));
        assert_eq!((flight.frames, flight.dt_s, flight.camera.width), (record.len(), record.dt_s(), 64));
        assert_eq!((flight.weather_numbers.len(), flight.weather_numbers["cloudiness"]), (14, 5.0));
        for (read, frame) in dataset.frames(&index, flight).unwrap().iter().zip(0..) {
            let (pose, state) = (&record.trajectory.poses_in_world[frame], &record.trajectory.track.states[frame]);
            assert_eq!(
                (read.pose.position_in_world, read.target.feet_in_world),
                (pose.position_in_world, state.feet_in_world)
            );
            assert_eq!(read.visible_by_rays, record.views[frame].visible_by_rays);
        }
    }
}

#[test]
fn instructions_of_windows_are_those_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let mut config = DatasetConfig::default();
    (config.windows.size, config.windows.history, config.windows.stride) = (4, 2, 1);
    sample::write_to_folder(folder.path(), &config, EncodingConfig::default()).unwrap();
    let dataset = PublishedDataset::open(folder.path()).unwrap();
    let mut reader = InstructionReader::of(&dataset, Windows::instruction_en, 2).unwrap();
    let mut others = InstructionReader::of(&dataset, Windows::instruction_en, 3).unwrap();
    let mut seen = 0;
    for (_, path) in dataset.files("windows").unwrap() {
        read(&path, &mut |rows| {
            for row in 0..rows.len() {
                let place = dataset.place(&rows.get(Windows::trajectory_id, row)?).unwrap();
                let start = rows.get(Windows::start_frame, row)? as usize;
                let text = rows.get(Windows::instruction_en, row)?;
                assert_eq!(reader.at(&dataset, place)?.get(&start), Some(&text).filter(|text| !text.is_empty()));
                assert!(others.at(&dataset, place)?.is_empty());
                seen += usize::from(!text.is_empty());
            }
            Ok(())
        })
        .unwrap();
    }
    assert!(seen > 0);
}

#[test]
fn images_come_back_as_they_were() {
    let (_folder, dataset) = published();
    let given = sample::flight(0, cosfly_schema::Role::Expert);
    let mut log = dataset.log(dataset.flight("expert-p00000").unwrap()).unwrap();
    for (frame, images) in given.images.iter().enumerate() {
        let read = log.frame(frame).unwrap();
        assert_eq!((read.width, read.height, &read.semantic), (64, 48, &images.semantic));
        assert_eq!((read.rgb_format.as_str(), read.target.frame), ("jpeg", frame as u32));
        assert!(read.depth_m.iter().zip(&images.depth_m).all(|(a, b)| a == b || (a - b).abs() < 1e-3));
        let pose = &given.record.trajectory.poses_in_world[frame];
        assert_eq!(read.camera_in_map, map_from_world_point(pose.position_in_world));
        let ahead = read.map_from_optical * DVec3::Z;
        let expected = map_from_world_point(pose.world_from_body() * DVec3::X);
        assert!((ahead - expected).length() < 1e-12);
    }
    let scene = log.scene().unwrap();
    let wall = &sample::town().obstacles[0].shape;
    assert_eq!((scene.len(), scene[0].label.as_str()), (1, "Wall"));
    assert!(
        (scene[0].half_extents_m - wall.half_extents_m).length() < 1e-12
            && (scene[0].yaw_rad + wall.yaw_rad).abs() < 1e-9
    );
}

#[test]
fn an_unknown_flight_is_refused_with_the_nearest_names() {
    let (_folder, dataset) = published();
    let error = dataset.flight("expert-p0000").unwrap_err();
    assert_eq!(error.code, "dataset-no-flight");
    assert!(
        error.hints[0].contains("`expert-p0000") && error.hints[1].contains("perturbed-p00001"),
        "{:?}",
        error.hints
    );
}

#[test]
fn what_is_no_dataset_or_is_cut_short_is_refused() {
    let empty = tempfile::tempdir().unwrap();
    assert_eq!(PublishedDataset::open(empty.path()).unwrap_err().code, "dataset-none");
    let (folder, dataset) = published();
    let flight = dataset.flight("expert-p00000").unwrap();
    let path = folder.path().join(&flight.mcap_path);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert!(dataset.log(flight).is_err());
}

#[test]
fn all_tracks_at_once_are_those_of_the_single_flights() {
    let (_folder, dataset) = published();
    let index = dataset.row_index("frames").unwrap();
    let all = dataset.tracks(&index, &(0..4).collect()).unwrap();
    assert_eq!(dataset.tracks(&index, &[2].into()).unwrap()[&2], all[&2]);
    for (flight, track) in dataset.flights().iter().zip(all.values()) {
        let frames = dataset.frames(&index, flight).unwrap();
        assert_eq!(track.poses, frames.iter().map(|frame| frame.pose).collect::<Vec<_>>());
        assert_eq!(track.boxes, frames.iter().map(|frame| frame.visible_box_px).collect::<Vec<_>>());
        assert_eq!(track.expert_frame, (0..frames.len() as u32).collect::<Vec<_>>());
        assert_eq!((track.feet.len(), track.visible.len()), (frames.len(), frames.len()));
        assert_eq!(flight.town_geometry.len(), 64);
    }
}

#[test]
fn flights_are_walked_one_after_the_other_with_all_that_is_said_of_their_frames() {
    let (_folder, dataset) = published();
    let index = dataset.row_index("frames").unwrap();
    let mut walked = vec![];
    let mut visit = |flight: &PublishedFlight, rows: Vec<FrameRow>| {
        assert_eq!(rows, dataset.frames(&index, flight).unwrap());
        assert!(rows.iter().all(|row| row.disturbance.is_some() == flight.expert_id.is_some()));
        walked.push(flight.trajectory_id.clone());
        Ok(())
    };
    dataset.walk(&|_| true, &mut visit).unwrap();
    assert_eq!(walked.len(), 4);
    let mut twins = vec![];
    dataset
        .walk(&|flight| flight.expert_id.is_some(), &mut |flight, rows| {
            let events = rows.iter().filter(|row| row.disturbance.as_ref().is_some_and(|it| it.position)).count();
            twins.push((flight.trajectory_id.clone(), events));
            Ok(())
        })
        .unwrap();
    assert_eq!(twins, [("perturbed-p00000".to_owned(), 1), ("perturbed-p00001".to_owned(), 1)]);
    let mut captions = CaptionReader::of(&dataset).unwrap();
    for given in sample::flights() {
        let place = dataset.place(&given.record.trajectory_id).unwrap();
        assert_eq!(captions.at(&dataset, place).unwrap(), given.captions);
    }
}

#[test]
fn instance_ids_come_back_when_asked_for() {
    let (_folder, dataset) = published();
    let given = sample::flight(0, cosfly_schema::Role::Expert);
    let mut log = dataset.log(dataset.flight("expert-p00000").unwrap()).unwrap();
    assert!(log.frame(2).unwrap().instance.is_empty());
    assert_eq!(log.frame_with_instances(2).unwrap().instance, given.images[2].instance);
}

#[test]
fn a_folder_that_was_made_anew_is_refused_and_one_with_the_same_bytes_is_not() {
    let (folder, dataset) = published();
    let write = |config: &DatasetConfig| {
        sample::write_to_folder(folder.path(), config, EncodingConfig::default()).unwrap();
    };
    write(&DatasetConfig::default());
    assert!(dataset.log(&dataset.flights()[0]).is_ok() && dataset.files("frames").is_ok());
    write(&DatasetConfig { title: "another one".into(), ..DatasetConfig::default() });
    let now = PublishedDataset::open(folder.path()).unwrap();
    assert_ne!(now.identity().digest(), dataset.identity().digest());
    let flight = &dataset.flights()[0];
    for refusal in [dataset.log(flight).err(), dataset.image_log(flight).err(), dataset.files("frames").err()] {
        let refusal = refusal.unwrap();
        assert_eq!(refusal.code, "dataset-changed");
        for named in [dataset.identity(), now.identity()] {
            assert!(refusal.message.contains(&named.digest()[..12]), "{refusal}");
        }
        assert!(refusal.hints[0].contains("open the folder again"), "{refusal}");
    }
    // Without its sums a dataset is known by its tables.
    std::fs::remove_file(folder.path().join("SHA256SUMS")).unwrap();
    let bare = PublishedDataset::open(folder.path()).unwrap();
    assert!(bare.files("frames").is_ok());
    let table = bare.files("trajectories").unwrap().remove(0).1;
    std::fs::remove_file(table).unwrap();
    assert_eq!(bare.files("frames").unwrap_err().code, "dataset-changed");
}

/// A log again, with what `encoding` says of the messages of a topic: their encoding, or that they are left out.
fn written_again(log: &std::path::Path, encoding: &dyn Fn(&str) -> Option<&'static str>) {
    let bytes = std::fs::read(log).unwrap();
    let mut again = std::io::Cursor::new(vec![]);
    let mut writer = ::mcap::Writer::new(&mut again).unwrap();
    for message in ::mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let Some(encoding) = encoding(&message.channel.topic) else { continue };
        let channel = ::mcap::Channel { message_encoding: encoding.to_owned(), ..(*message.channel).clone() };
        writer.write(&::mcap::Message { channel: std::sync::Arc::new(channel), ..message }).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    std::fs::write(log, again.into_inner()).unwrap();
}

#[test]
fn foreign_encodings_and_missing_topics_of_a_log_are_named() {
    const DEPTH: &str = "/camera/depth/image";
    let told = |encoding: &dyn Fn(&str) -> Option<&'static str>| {
        let (_folder, dataset) = published();
        let flight = dataset.flight("expert-p00000").unwrap();
        written_again(&dataset.folder().join(&flight.mcap_path), encoding);
        let mut log = dataset.log(flight).unwrap();
        [log.frame(1).err(), log.scene().err()].map(|it| it.map_or(String::new(), |it| it.to_string()))
    };
    assert_eq!(told(&|_| Some("protobuf")), ["", ""]);
    let [frame, scene] = told(&|topic| Some(if topic == DEPTH { "json" } else { "protobuf" }));
    assert!(frame.contains("messages on `/camera/depth/image` have the encoding `json`, not `protobuf`"), "{frame}");
    assert_eq!(scene, "");
    let [frame, scene] = told(&|topic| Some("protobuf").filter(|_| topic != DEPTH));
    assert!(frame.contains("frame 1 has no message on `/camera/depth/image`"), "{frame}");
    assert_eq!(scene, "");
    let [frame, scene] = told(&|topic| Some("protobuf").filter(|_| topic != "/scene"));
    assert!(scene.contains("it has no message on `/scene`"), "{scene}");
    assert_eq!(frame, "");
}
