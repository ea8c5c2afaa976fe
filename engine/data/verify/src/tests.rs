//! A sound dataset passes; every kind of damage is found and named.

use crate::{Options, VerifyReport, files, frames, rows, tables, verify};
use cosfly_domain::{BodyInSpace, BodyKind, BodyPlan, Followed, KeyPoint, PixelBox, Shown};
use cosfly_frames::DVec3;
use cosfly_sample as sample;
use cosfly_sample::SampleFlight;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn published(flights: Vec<SampleFlight>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    sample::write_flights(folder.path(), &DatasetConfig::default(), EncodingConfig::default(), flights).unwrap();
    folder
}

fn rules_of(folder: &TempDir) -> Vec<&'static str> {
    let report = verify(folder.path(), &Options::default(), &mut |_, _| {}).unwrap();
    let mut rules: Vec<&str> = report.findings.iter().map(|finding| finding.rule).collect();
    rules.dedup();
    rules
}

fn some_file(folder: &TempDir, below: &str) -> PathBuf {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder.path().join(below)).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.remove(0)
}

fn flip(path: &Path, at: usize) {
    let mut bytes = std::fs::read(path).unwrap();
    bytes[at] ^= 0x10;
    std::fs::write(path, bytes).unwrap();
}

#[test]
fn a_sound_dataset_passes() {
    let folder = published(sample::flights());
    let mut heard = vec![];
    let report = verify(folder.path(), &Options::default(), &mut |done, total| heard.push((done, total))).unwrap();
    assert!(report.is_sound(), "{:#?}", report.findings);
    assert_eq!((report.flights, report.frames, report.boxes), (4, 20, 20));
    assert_eq!(heard.last(), Some(&(4, 4)));
}

#[test]
fn shares_by_rays_and_pixels_that_differ_are_listed_with_a_reason_and_are_no_problem() {
    let mut flights = sample::flights();
    let pixels = flights[0].record.views[2].visible_by_pixels;
    let differing = if pixels > 0.5 { pixels - 0.2 } else { pixels + 0.2 };
    flights[0].record.visible_by_dense_rays[2] = Some(differing);
    let report = verify(published(flights).path(), &Options::default(), &mut |_, _| {}).unwrap();
    assert!(report.is_sound() && (report.labels, report.gaps) == (20, 1), "{:#?}", report.findings);
    let gap = report.label_gaps[0].to_string();
    assert!(gap.contains("frame 2: ") && gap.contains(&format!("{differing:.2} visible by rays")), "{gap}");
}

#[test]
fn a_wide_body_that_is_hidden_beside_its_middle_is_judged_by_dense_rays() {
    let rules = |kind: Option<BodyKind>, dense: f64| {
        let mut flights = sample::flights();
        let record = &mut flights[0].record;
        let plan = kind.map(|kind| BodyPlan { kind, ..record.others[0].plan.clone() });
        record.followed = plan.map(|plan| Followed { traffic: "street".into(), number: 0, plan });
        record.trajectory.visibility.iter_mut().for_each(|share| *share = 1.0);
        for view in &mut record.views {
            (view.visible_by_rays, view.visible_by_pixels) = (1.0, 0.6);
            view.full_box = Some(PixelBox { u_min: 8, v_min: 8, u_max: 24, v_max: 40 });
        }
        record.visible_by_dense_rays.iter_mut().for_each(|share| *share = Some(dense));
        rules_of(&published(flights)).contains(&"verify-visibility")
    };
    assert!(rules(None, 0.6), "points of an upright person tell what is seen of it");
    assert!(!rules(Some(BodyKind::Van), 0.6));
    assert!(rules(Some(BodyKind::Van), 1.0));
}

#[test]
fn a_flight_kilometres_from_the_objects_of_its_town_is_found() {
    let mut flights = sample::flights();
    let far = cosfly_frames::DVec3::new(0.0, -5_815_132.0, 0.0);
    let trajectory = &mut flights[0].record.trajectory;
    trajectory.poses_in_world.iter_mut().for_each(|pose| pose.position_in_world += far);
    trajectory.track.states.iter_mut().for_each(|state| state.feet_in_world += far);
    assert!(rules_of(&published(flights)).contains(&"verify-town"));
}

#[test]
fn time_stamps_that_are_shifted_everywhere_are_found_in_the_other_film_of_the_flight() {
    let films = |begins_ns: u64| {
        let mut flights = sample::flights();
        flights[0].record.camera_name = Some("front".into());
        let mut late = sample::flights().remove(0);
        late.record.camera_name = Some("late".into());
        late.record.trajectory_id += "-late";
        late.record.begins_ns = begins_ns;
        flights.push(late);
        rules_of(&published(flights))
    };
    assert_eq!(films(0), Vec::<&str>::new());
    assert_eq!(films(100_000_000), ["verify-film"]);
}

#[test]
fn a_flipped_byte_is_found_wherever_it_is() {
    for name in ["README.md", "croissant.json", "files.parquet", "SHA256SUMS", "schemas/cosfly.proto"] {
        let folder = published(sample::flights());
        flip(&folder.path().join(name), 40);
        assert!(rules_of(&folder).contains(&"verify-hash"), "{name}");
    }
    let folder = published(sample::flights());
    let log = some_file(&folder, "mcap/plain/000");
    flip(&log, std::fs::metadata(&log).unwrap().len() as usize / 2);
    let rules = rules_of(&folder);
    assert!(rules.contains(&"verify-hash") && rules.contains(&"verify-crc"), "{rules:?}");
}

#[test]
fn truncated_missing_and_extra_files_are_found() {
    let folder = published(sample::flights());
    let table = some_file(&folder, "data/frames");
    let bytes = std::fs::read(&table).unwrap();
    std::fs::write(&table, &bytes[..bytes.len() / 2]).unwrap();
    assert!(rules_of(&folder).contains(&"verify-size"));
    std::fs::remove_file(&table).unwrap();
    assert!(rules_of(&folder).contains(&"verify-missing-file"));
    std::fs::write(folder.path().join("data/frames/more.parquet"), b"x").unwrap();
    assert!(rules_of(&folder).contains(&"verify-extra-file"));
}

#[test]
fn folders_and_pipes_in_the_place_of_files_are_found_and_not_waited_for() {
    let folder = published(sample::flights());
    let log = some_file(&folder, "mcap/plain/000");
    std::fs::remove_file(&log).unwrap();
    let _pipe = std::os::unix::net::UnixListener::bind(&log).unwrap();
    std::fs::remove_file(folder.path().join("croissant.json")).unwrap();
    std::fs::create_dir(folder.path().join("croissant.json")).unwrap();
    let report = verify(folder.path(), &Options::default(), &mut |_, _| {}).unwrap();
    let found: Vec<&str> =
        report.findings.iter().filter(|it| it.rule == "verify-not-a-file").map(|it| it.file.as_str()).collect();
    assert_eq!(found.len(), 2, "{:#?}", report.findings);
    assert_eq!(found[0], "croissant.json");
}

#[test]
fn each_missing_head_of_a_dataset_is_a_finding() {
    for name in ["files.parquet", "croissant.json", "SHA256SUMS"] {
        let folder = published(sample::flights());
        std::fs::remove_file(folder.path().join(name)).unwrap();
        let report = verify(folder.path(), &Options::default(), &mut |_, _| {}).unwrap();
        assert!(report.findings.iter().any(|it| it.rule == "verify-missing-file" && it.file == name), "{name}");
    }
    let folder = published(sample::flights());
    let sums = folder.path().join("SHA256SUMS");
    let text = std::fs::read_to_string(&sums).unwrap();
    std::fs::write(&sums, format!("{text}{}  README.md\n", "0".repeat(64))).unwrap();
    assert_eq!(rules_of(&folder), ["verify-hash"]);
}

#[test]
fn a_dataset_of_perturbed_flights_alone_is_sound() {
    let flights = sample::flights().into_iter().filter(|flight| flight.record.pair.is_some()).collect();
    let report = verify(published(flights).path(), &Options::default(), &mut |_, _| {}).unwrap();
    assert!(report.is_sound() && report.flights == 2, "{:#?}", report.findings);
}

#[test]
fn images_of_the_next_frame_are_found() {
    let mut flights = sample::flights();
    flights[0].images.rotate_left(1);
    let rules = rules_of(&published(flights));
    assert!(rules.contains(&"verify-depth") || rules.contains(&"verify-log"), "{rules:?}");
}

#[test]
fn channels_on_request_are_sound_until_a_pixel_holds_no_value_or_a_frame_has_none() {
    let mut flights = sample::flights();
    flights[0].draw_on_request();
    let folder = published(flights);
    let report = verify(folder.path(), &Options::default(), &mut |_, _| {}).unwrap();
    assert!(report.is_sound(), "{:#?}", report.findings);
    let card = std::fs::read_to_string(folder.path().join("README.md")).unwrap();
    assert!(card.contains("* Channel `normals`: unit normals"), "{card}");
    let mut flights = sample::flights();
    flights[0].draw_on_request();
    let normals = flights[0].images[2].on_request.iter_mut().find(|image| image.channel.name == "normals");
    normals.unwrap().bytes[3..6].fill(255);
    let mask = flights[0].images[3].on_request.iter_mut().find(|image| image.channel.name == "mask");
    mask.unwrap().bytes[2] = 2;
    let report = verify(published(flights).path(), &Options::default(), &mut |_, _| {}).unwrap();
    let messages: Vec<&str> = report.findings.iter().map(|finding| finding.message.as_str()).collect();
    assert_eq!(messages, ["pixel 1 holds no value of `normals`", "pixel 2 holds no value of `mask`"]);
}

#[test]
fn flows_that_depth_and_poses_do_not_have_are_found() {
    type Fault = fn(&mut [f32; 2]);
    let faults: [Fault; 3] =
        [|way| *way = way.map(|it| 1.01 * it), |way| *way = way.map(|it| -it), |way| way.reverse()];
    for fault in faults {
        let mut flights = sample::flights();
        flights[0].draw_on_request();
        let flow = flights[0].images[1].on_request.iter_mut().find(|image| image.channel.name == "flow_forward");
        for pair in flow.unwrap().bytes.as_chunks_mut::<4>().0.as_chunks_mut::<2>().0 {
            let mut way = pair.map(f32::from_le_bytes);
            fault(&mut way);
            *pair = way.map(f32::to_le_bytes);
        }
        assert_eq!(rules_of(&published(flights)), ["verify-flow"]);
    }
    let mut flights = sample::flights();
    flights[0].draw_on_request();
    let mask = flights[0].images[0].on_request.iter_mut().find(|image| image.channel.name == "flow_back_valid");
    mask.unwrap().bytes[7] = 1;
    assert_eq!(rules_of(&published(flights)), ["verify-flow"]);
}

#[test]
fn disparities_that_depth_and_base_line_do_not_have_are_found() {
    let faults: [fn(f32) -> f32; 2] = [|px| 1.01 * px, |px| px + 0.5];
    for fault in faults {
        let mut flights = sample::flights();
        flights[0].draw_on_request();
        let image = flights[0].images[1].on_request.iter_mut().find(|image| image.channel.name == "disparity");
        for four in image.unwrap().bytes.as_chunks_mut::<4>().0 {
            *four = fault(f32::from_le_bytes(*four)).to_le_bytes();
        }
        assert_eq!(rules_of(&published(flights)), ["verify-disparity"]);
    }
}

#[test]
fn matched_depths_of_another_base_line_are_found() {
    let measured = |share: f32| {
        let mut flights = sample::flights();
        flights[0].draw_on_request();
        // Of a pair with a base line of 0.3 m.
        let scale = 0.3 * flights[0].record.camera.focal_px() as f32;
        let images = &mut flights[0].images[1];
        let image = images.on_request.iter_mut().find(|image| image.channel.name == "depth_stereo");
        let pixels = image.unwrap().bytes.as_chunks_mut::<4>().0.iter_mut();
        let matched = |depth_m: f32| 16.0 * scale / (16.0 * scale / (share * depth_m)).round();
        pixels.zip(&images.depth_m).for_each(|(four, depth_m)| *four = matched(*depth_m).to_le_bytes());
        rules_of(&published(flights))
    };
    assert_eq!((measured(1.0), measured(0.2)), (vec![], vec!["verify-disparity"]));
}

#[test]
fn a_flight_whose_boxes_are_all_missing_is_found() {
    let mut flights = sample::flights();
    flights[0].record.bodies_3d = vec![in_space(&flights[0], 0)];
    let (with, without) = (published(flights), published(sample::flights()));
    for file in std::fs::read_dir(with.path().join("data/bodies_3d")).unwrap().map(|file| file.unwrap().path()) {
        std::fs::copy(without.path().join(file.strip_prefix(with.path()).unwrap()), file).unwrap();
    }
    let report = verify(with.path(), &Options::default(), &mut |_, _| {}).unwrap();
    let found = report.findings.iter().find(|it| it.rule == "verify-3d").expect("it is found");
    assert!(found.file.ends_with(".mcap") && found.message.contains("it had 1 row in"), "{found}");
}

/// The boxes of a body beside the target, which has no key points.
fn others_in_space(flight: &SampleFlight) -> impl Iterator<Item = BodyInSpace> {
    flight.record.sightings.iter().map(|sighting| {
        let size_m = flight.record.others[sighting.other as usize].plan.size_m;
        BodyInSpace {
            frame: sighting.frame,
            instance: sighting.view.instance,
            centre_in_world: sighting.state.feet_in_world + DVec3::Z * (0.5 * size_m.z),
            size_m,
            heading_rad: sighting.state.heading_rad,
            key_points: vec![],
        }
    })
}

/// The target's box, with all key points in its middle.
fn in_space(flight: &SampleFlight, frame: usize) -> BodyInSpace {
    let (record, state) = (&flight.record, &flight.record.trajectory.track.states[frame]);
    let track = &record.trajectory.track;
    let size_m = DVec3::new(2.0 * track.radius_m, 2.0 * track.radius_m, track.height_m);
    let centre_in_world = state.feet_in_world + DVec3::Z * (0.5 * size_m.z);
    let (u, v, depth_m) = record.camera.project(&record.camera_pose(frame), centre_in_world).unwrap();
    let point = KeyPoint { point_in_world: centre_in_world, pixel: [u, v], depth_m, shown: Shown::Visible };
    BodyInSpace {
        frame: frame as u32,
        instance: 1,
        centre_in_world,
        size_m,
        heading_rad: state.heading_rad,
        key_points: vec![point; 17],
    }
}

#[test]
fn boxes_and_key_points_that_poses_and_pictures_do_not_have_are_found() {
    type Fault = fn(&mut Vec<BodyInSpace>);
    let faults: [Fault; 14] = [
        |bodies| bodies[2].centre_in_world.y = -bodies[2].centre_in_world.y,
        |bodies| bodies[2].frame += 1,
        |bodies| bodies[2].instance = 900,
        |bodies| bodies[2].heading_rad += 0.01,
        |bodies| bodies[2].size_m.x *= 1.1,
        |bodies| bodies[2].key_points.truncate(16),
        |bodies| bodies[2].key_points[3].pixel.reverse(),
        |bodies| bodies[2].key_points[3].depth_m += 0.1,
        |bodies| bodies[2].key_points[16].shown = Shown::Outside,
        |bodies| bodies[2].key_points[0].point_in_world.z += 3.0,
        |bodies| bodies.last_mut().unwrap().size_m.y *= 1.1,
        |bodies| bodies.truncate(bodies.len() - 1),
        |bodies| drop(bodies.remove(2)),
        |bodies| bodies.push(bodies[2].clone()),
    ];
    let marked = |fault: Fault| {
        let mut flights = sample::flights();
        let views = &flights[0].record.views;
        let shown = (0..views.len()).filter(|frame| views[*frame].pixels > 0);
        let mut bodies: Vec<BodyInSpace> = shown.map(|frame| in_space(&flights[0], frame)).collect();
        bodies.extend(others_in_space(&flights[0]));
        fault(&mut bodies);
        flights[0].record.bodies_3d = bodies;
        rules_of(&published(flights))
    };
    assert!(marked(|_| ()).is_empty());
    for (number, fault) in faults.into_iter().enumerate() {
        assert_eq!(marked(fault), ["verify-3d"], "fault {number}");
    }
}

#[test]
fn depths_outside_of_the_target_s_body_are_found() {
    let mut flights = sample::flights();
    let images = &mut flights[0].images[1];
    let at = images.instance.iter().position(|id| *id == 1).unwrap();
    images.depth_m[at] += 3.0;
    assert_eq!(rules_of(&published(flights)), ["verify-depth"]);
}

#[test]
fn bodies_below_drawn_ground_are_found() {
    let camera = cosfly_domain::Camera { width: 320, height: 240, horizontal_fov_rad: 1.2 };
    let flight = || sample::flight_filmed_by(camera, 0, cosfly_schema::Role::Expert);
    let report = verify(published(vec![flight()]).path(), &Options::default(), &mut |_, _| {}).unwrap();
    assert!(report.findings.iter().all(|it| it.rule != "verify-ground"), "{:#?}", report.findings);
    let mut flights = vec![flight()];
    sample::raise_drawn_ground(&mut flights[0], 0.3);
    let report = verify(published(flights).path(), &Options::default(), &mut |_, _| {}).unwrap();
    let found: Vec<String> =
        report.findings.iter().filter(|it| it.rule == "verify-ground").map(ToString::to_string).collect();
    assert!(found.iter().any(|it| it.contains("stands below drawn ground")), "{:#?}", report.findings);
    assert!(found.iter().all(|it| it.contains("expert-p00000")), "{found:#?}");
}

#[test]
fn a_flipped_yaw_is_found() {
    let mut flights = sample::flights();
    flights[1].record.trajectory.poses_in_world[3].yaw_rad *= -1.0;
    let report = verify(published(flights).path(), &Options::default(), &mut |_, _| {}).unwrap();
    let found = report.findings.iter().find(|finding| finding.rule == "verify-reprojection").expect("it is found");
    assert!(found.place.contains("`perturbed-p00000` frame 3") && found.file.starts_with("data/frames/"), "{found}");
    assert!(report.findings.iter().any(|finding| finding.rule == "verify-pair"));
}

#[test]
fn boxes_of_the_next_frame_are_found() {
    let mut flights = sample::flights();
    flights[0].record.views.rotate_left(2);
    let rules = rules_of(&published(flights));
    assert!(rules.contains(&"verify-log"), "{rules:?}");
}

#[test]
fn bodies_that_are_not_where_their_pixels_are_are_found() {
    type Spoil = (&'static str, fn(&mut SampleFlight));
    let spoils: [Spoil; 5] = [
        ("verify-log", |it| it.record.sightings[2].view.pixels += 1),
        ("verify-log", |it| it.record.sightings.truncate(2)),
        ("verify-reprojection", |it| it.record.sightings[1].state.feet_in_world.x += 4.0),
        ("verify-reference", |it| {
            it.record.others[0].instance = 6;
            it.record.sightings.iter_mut().for_each(|sighting| sighting.view.instance = 6);
        }),
        ("verify-reference", |it| it.record.views[0].occluder_instance = 8),
    ];
    for (rule, spoil) in spoils {
        let mut flights = sample::flights();
        spoil(&mut flights[0]);
        let rules = rules_of(&published(flights));
        assert!(rules.contains(&rule), "{rule}: {rules:?}");
    }
}

#[test]
fn a_twin_that_is_not_its_expert_plus_its_displacement_is_found() {
    let mut flights = sample::flights();
    let perturbation = flights[1].record.trajectory.perturbation.as_mut().unwrap();
    perturbation.frames[3].expert_frame = 2;
    assert_eq!(rules_of(&published(flights)), ["verify-pair"]);
    let mut flights = sample::flights();
    flights[1].record.pair.as_mut().unwrap().expert_id = "expert-p00009".into();
    assert!(rules_of(&published(flights)).contains(&"verify-pair"));
}

#[test]
fn figures_that_do_not_follow_from_the_frames_are_found() {
    let spoils: [fn(&mut cosfly_domain::Certificate); 7] = [
        |it| it.max_yaw_rate_deg_s += 0.01,
        |it| it.max_pitch_rate_deg_s += 0.01,
        |it| it.mean_visibility += 1e-6,
        |it| it.frames_half_visible = 0.9,
        |it| it.mean_distance_m += 0.1,
        |it| it.length_m *= 1.01,
        |it| it.min_clearance_m = 3.1,
    ];
    for spoil in spoils {
        let mut flights = sample::flights();
        spoil(&mut flights[0].record.trajectory.certificate);
        assert_eq!(rules_of(&published(flights)), ["verify-figures"]);
    }
}

#[test]
fn a_certificate_that_holds_against_its_own_limits_is_found() {
    let mut flights = sample::flights();
    flights[0].record.trajectory.certificate.limits.speed_mps = 1.0;
    assert_eq!(rules_of(&published(flights)), ["verify-certificate"]);
}

#[test]
fn a_missing_language_is_found() {
    let mut flights = sample::flights();
    flights[2].captions.pop();
    assert_eq!(rules_of(&published(flights)), ["verify-caption"]);
}

#[test]
fn an_action_that_does_not_lead_to_the_next_pose_is_found() {
    let folder = published(sample::flights());
    let mut report = VerifyReport::default();
    let files = files::check(folder.path(), &Default::default(), &mut report).unwrap();
    let tables = tables::read(folder.path(), &files, &mut report);
    let file = files.sound_below("data/frames/").next().unwrap();
    let mut groups = vec![];
    rows::frames(&folder.path().join(file), &mut |frames| groups.push(frames)).unwrap();
    let frames = &mut groups[0];
    frames[1].stored.action_in_world.as_mut().unwrap()[4] += 0.01;
    frames::check_frames(file, tables.flights.get(&frames[0].trajectory_id).unwrap(), frames, &mut report);
    assert_eq!(report.findings.iter().map(|finding| finding.rule).collect::<Vec<_>>(), ["verify-action"]);
}

#[test]
fn a_folder_without_a_dataset_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert!(
        verify(folder.path(), &Options::default(), &mut |_, _| {})
            .unwrap_err()
            .message
            .contains("is not a finished dataset")
    );
    let absent = folder.path().join("absent");
    assert!(verify(&absent, &Options::default(), &mut |_, _| {}).unwrap_err().message.contains("does not exist"));
}

#[test]
fn the_report_is_the_same_for_any_number_of_threads() {
    let mut flights = sample::flights();
    flights[0].images.rotate_left(1);
    flights[1].record.trajectory.poses_in_world[3].yaw_rad *= -1.0;
    flights[2].captions.pop();
    let folder = published(flights);
    let found = [1, 2, 5].map(|jobs| {
        verify(folder.path(), &Options { jobs: Some(jobs), ..Options::default() }, &mut |_, _| {}).unwrap()
    });
    assert!(found[0].found > 3 && found[0] == found[1] && found[0] == found[2]);
}

#[test]
fn a_sample_is_checked_in_full_and_says_what_it_is() {
    let mut flights = sample::flights();
    flights.iter_mut().for_each(|flight| flight.images.rotate_left(1));
    let folder = published(flights);
    let options = Options { sample: Some(1), ..Options::default() };
    let report = verify(folder.path(), &options, &mut |_, all| assert_eq!(all, 1)).unwrap();
    assert_eq!((report.sample, report.flights, report.flights_of_dataset, report.frames), (Some(1), 1, 4, 5));
    let files: std::collections::BTreeSet<&str> = report.findings.iter().map(|it| it.file.as_str()).collect();
    assert_eq!(files.iter().filter(|file| file.starts_with("mcap/")).count(), 1, "{:#?}", report.findings);
    let log = some_file(&folder, "mcap/plain/000");
    std::fs::write(&log, b"short").unwrap();
    let again = verify(folder.path(), &options, &mut |_, _| {}).unwrap();
    assert!(again.findings.iter().any(|it| it.rule == "verify-size"));
    let all = verify(folder.path(), &Options { sample: Some(9), ..Options::default() }, &mut |_, _| {}).unwrap();
    assert_eq!((all.sample, all.flights), (None, 4));
}

#[test]
fn an_interrupted_check_goes_on_and_reads_changed_logs_again() {
    let folder = published(sample::flights());
    let notes = tempfile::tempdir().unwrap();
    let path = notes.path().join("notes.jsonl");
    let options = Options { resume: Some(path.clone()), ..Options::default() };
    let first = verify(folder.path(), &options, &mut |_, _| {}).unwrap();
    assert_eq!(first, verify(folder.path(), &Options::default(), &mut |_, _| {}).unwrap());
    // Two flights were noted, the line of a third was cut short.
    let text = std::fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 5);
    std::fs::write(&path, format!("{}\n{}", lines[..3].join("\n"), &lines[3][..20])).unwrap();
    let second = verify(folder.path(), &options, &mut |_, _| {}).unwrap();
    assert_eq!(second, VerifyReport { resumed: 2, ..first.clone() });
    assert_eq!(verify(folder.path(), &options, &mut |_, _| {}).unwrap().resumed, 4);
    let log = some_file(&folder, "mcap/plain/000");
    flip(&log, std::fs::metadata(&log).unwrap().len() as usize / 2);
    std::fs::File::options().append(true).open(&log).unwrap().set_modified(std::time::UNIX_EPOCH).unwrap();
    let third = verify(folder.path(), &options, &mut |_, _| {}).unwrap();
    assert!(third.resumed == 3 && third.findings.iter().any(|it| it.rule == "verify-hash"));
    let other = published(sample::flights().into_iter().take(2).collect());
    assert_eq!(verify(other.path(), &options, &mut |_, _| {}).unwrap_err().code, "verify-resume");
}

#[test]
fn kinds_that_sizes_deny_and_films_of_another_target_are_found() {
    type Spoil = (&'static str, fn(&mut [SampleFlight]));
    let spoils: [Spoil; 4] = [
        // Nobody of that height is a child, nobody so narrow has a wheelchair.
        ("verify-kind", |all| all[0].record.others[0].plan.kind = BodyKind::Child),
        ("verify-kind", |all| all[0].record.others[0].plan.kind = BodyKind::Wheelchair),
        ("verify-flight", |all| all[0].record.flight_id = all[2].record.flight_id.clone()),
        ("verify-flight", |all| all[2].record.flight_id = all[0].record.flight_id.clone()),
    ];
    for (rule, spoil) in spoils {
        let mut flights = sample::flights();
        spoil(&mut flights);
        let rules = rules_of(&published(flights));
        assert!(rules.contains(&rule), "{rule}: {rules:?}");
    }
}

#[test]
fn files_of_another_version_are_found_in_logs_and_in_tables() {
    let other = {
        let mut flights = sample::flights();
        for flight in &mut flights {
            flight.record.trajectory.poses_in_world.iter_mut().for_each(|pose| pose.position_in_world.y += 0.4);
        }
        published(flights)
    };
    for below in ["mcap/plain/000", "data/waypoints", "data/frames"] {
        let folder = published(sample::flights());
        let mut mixed = 0;
        for entry in std::fs::read_dir(other.path().join(below)).unwrap() {
            let entry = entry.unwrap();
            let to = folder.path().join(below).join(entry.file_name());
            mixed += usize::from(std::fs::read(entry.path()).unwrap() != std::fs::read(&to).unwrap());
            std::fs::copy(entry.path(), &to).unwrap();
        }
        assert!(mixed > 0, "{below}");
        let report = verify(folder.path(), &Options::default(), &mut |_, _| {}).unwrap();
        let of_files = report.findings.iter().filter(|it| it.file.starts_with(below));
        let rules: Vec<&str> = of_files.map(|finding| finding.rule).collect();
        let hashes = rules.iter().filter(|rule| ["verify-hash", "verify-size"].contains(*rule)).count();
        assert_eq!(hashes, mixed, "{below}: {:#?}", report.findings);
    }
    // Everything of the other version but for the logs: their messages are held against the tables, whatever the hashes.
    let folder = published(sample::flights());
    for entry in std::fs::read_dir(folder.path().join("mcap/plain/000")).unwrap() {
        let entry = entry.unwrap();
        std::fs::copy(entry.path(), other.path().join("mcap/plain/000").join(entry.file_name())).unwrap();
    }
    let report = verify(other.path(), &Options::default(), &mut |_, _| {}).unwrap();
    assert!(
        report.findings.iter().any(|it| it.file.ends_with(".mcap") && it.rule == "verify-log"),
        "{:#?}",
        report.findings
    );
}

#[test]
fn a_check_that_is_stopped_says_so() {
    let folder = published(sample::flights());
    let stop = cosfly_diagnose::Stop::of(std::sync::Arc::new(true.into()));
    let stopped = Options { stop, ..Options::default() };
    let refusal = verify(folder.path(), &stopped, &mut |_, _| {}).unwrap_err();
    assert_eq!(refusal.fault, cosfly_diagnose::Fault::Stopped);
}
