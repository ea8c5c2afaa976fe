//! Bags of ROS 2 have every topic at every frame, and say what the dataset says.

use crate::laws::{export_with, files, published};
use crate::{Choice, flown_bags};
use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose, TargetState};
use cosfly_schema::log::reading::LoggedSensor;
use cosfly_write::log::{FlownFlight, FlownStep, SensedSample, write_flown_log};
use mcap::MessageStream;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::Path;

/// Messages of a bag: topic, type, time and bytes.
type Messages = Vec<(String, String, u64, Vec<u8>)>;

fn messages(bag: &[u8]) -> Messages {
    let read = |message: mcap::Message<'_>| {
        let schema = message.channel.schema.clone().unwrap();
        assert_eq!((schema.encoding.as_str(), message.channel.message_encoding.as_str()), ("ros2msg", "cdr"));
        let stays = message.channel.metadata["offered_qos_profiles"].contains("durability: 1");
        assert_eq!(stays, ["/tf_static", "/town", "/instruction"].contains(&message.channel.topic.as_str()));
        (message.channel.topic.clone(), schema.name.clone(), message.log_time, message.data.to_vec())
    };
    MessageStream::new(bag).unwrap().map(|message| read(message.unwrap())).collect()
}

#[test]
fn every_frame_is_in_the_bag_of_its_flight_with_its_place_depths_and_labels() {
    let (home, dataset) = published();
    let out = home.path().join("ros2");
    export_with(&dataset, "ros2", serde_json::Map::new(), &Choice::default(), &out).unwrap();
    let (files, index) = (files(&out), dataset.row_index("frames").unwrap());
    for flight in dataset.flights() {
        let folder = format!("{}/000/{}", flight.split, flight.trajectory_id);
        let messages = messages(&files[Path::new(&format!("{folder}/{}_0.mcap", flight.trajectory_id))]);
        assert!(messages.is_sorted_by_key(|message| message.2));
        let of = |topic: &str| messages.iter().filter(|it| it.0 == topic).cloned().collect::<Messages>();
        let mut log = dataset.log(flight).unwrap();
        for (frame, row) in dataset.frames(&index, flight).unwrap().iter().enumerate() {
            let time_ns = 1_000_000_000 + 500_000_000 * frame as u64;
            for topic in ["/clock", "/tf", "/target/odom", "/camera/camera_info", "/detections"] {
                assert_eq!(of(topic)[frame].2, time_ns, "{topic}");
            }
            // Time, `odom`, `base_link`: 4 + 8 + 4 + 5 + 3 + 4 + 10 bytes, then the place, aligned.
            let odometry = of("/odom")[frame].3.clone();
            let place = odometry[4 + 40..4 + 64].as_chunks::<8>().0.iter().map(|it| f64::from_le_bytes(*it));
            let [x, y, z] = place.collect::<Vec<_>>().try_into().unwrap();
            assert_eq!(DVec3::new(x, -y, z), row.pose.position_in_world);
            let logged = log.frame(frame).unwrap();
            let depths: Vec<u8> = logged.depth_m.iter().flat_map(|it| it.to_le_bytes()).collect();
            assert!(of("/camera/depth/image_raw")[frame].3.ends_with(&depths));
            assert!(of("/camera/semantic/image_raw")[frame].3.ends_with(&logged.semantic));
            assert!(of("/camera/image_raw/compressed")[frame].3.ends_with(&logged.rgb_file));
        }
        let metadata = String::from_utf8(files[Path::new(&format!("{folder}/metadata.yaml"))].clone()).unwrap();
        assert!(metadata.contains(&format!("message_count: {}\n", messages.len())), "{metadata}");
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        messages.iter().for_each(|message| *counts.entry(&message.0).or_default() += 1);
        assert_eq!(counts.values().copied().collect::<Vec<_>>(), [5, 5, 5, 5, 5, 5, 5, 1, 5, 5, 5, 1, 1], "{counts:?}");
    }
}

#[test]
fn every_nth_frame_keeps_its_time_and_the_instruction_its_language() {
    let (home, dataset) = published();
    let out = home.path().join("ros2");
    let options = json!({"every": 3, "language": "zh"}).as_object().unwrap().clone();
    export_with(&dataset, "ros2", options, &Choice::default(), &out).unwrap();
    for (path, bytes) in files(&out).iter().filter(|(path, _)| path.extension().is_some_and(|it| it == "mcap")) {
        let messages = messages(bytes);
        let times: Vec<u64> = messages.iter().filter(|it| it.0 == "/clock").map(|it| it.2).collect();
        assert_eq!(times, [1_000_000_000, 2_500_000_000], "{}", path.display());
        let said = messages.iter().find(|it| it.0 == "/instruction").unwrap();
        assert!(String::from_utf8_lossy(&said.3).contains("跟随行人前进2米。"));
    }
}

#[test]
fn a_closed_loop_flight_becomes_a_bag_with_its_actions_and_sensors() {
    let home = tempfile::tempdir().unwrap();
    let target = TargetState { feet_in_world: DVec3::new(1.0, 2.0, 0.0), heading_rad: 0.5, speed_mps: 1.0 };
    let step = |step: u32| FlownStep {
        step,
        time_s: 0.1 * f64::from(step),
        pose: Pose::looking_at(DVec3::new(0.0, f64::from(step), 20.0), target.feet_in_world),
        velocity_in_world: DVec3::Y,
        target,
        visible: 1.0,
        in_picture: true,
        tracked: true,
        clearance_m: 3.0,
        action: if step == 1 { vec![] } else { vec![4.0, 3.0, 2.0, 30.0, 60.0] },
        reward: 1.0,
        reward_terms: vec![1.0; 6],
        others: vec![],
        attitude_xyzw: None,
        sensed: vec![SensedSample {
            time_s: 0.1 * f64::from(step) - 0.05,
            rates_rad_s: DVec3::X,
            force_mps2: DVec3::Z,
            height_m: None,
            fix: None,
        }],
        readings: vec![vec![f64::from(step)]],
        events: if step == 3 { vec![(true, "lost".to_owned())] } else { vec![] },
    };
    let flight = FlownFlight {
        about: &BTreeMap::new(),
        town: &cosfly_sample::town(),
        camera: Camera { width: 64, height: 48, horizontal_fov_rad: 1.5 },
        target_size_m: [1.7, 0.3],
        sensors: &[LoggedSensor { name: "laser".to_owned(), quantities: vec!["range_m".to_owned()] }],
        walk: &[target],
        steps: &(1..=3).map(step).collect::<Vec<_>>(),
    };
    let (result, out) = (home.path().join("result"), home.path().join("bags"));
    std::fs::create_dir(&result).unwrap();
    let log = result.join("e.mcap");
    write_flown_log(&mut std::fs::File::create(&log).unwrap(), &flight).unwrap();
    flown_bags(&[("e".to_owned(), log)], &result, &out, &|_, _| {}).unwrap();
    let messages = messages(&files(&out)[Path::new("000/e/e_0.mcap")]);
    assert!(messages.is_sorted_by_key(|message| message.2));
    let of = |topic: &str| messages.iter().filter(|it| it.0 == topic).cloned().collect::<Messages>();
    for (topic, count) in
        [("/clock", 3), ("/odom", 3), ("/imu", 3), ("/sensor/laser", 3), ("/flight/events", 1), ("/town", 1)]
    {
        assert_eq!(of(topic).len(), count, "{topic}");
    }
    let [asked, _] = &of("/cmd_vel")[..] else { panic!("two actions") };
    let numbers: Vec<f64> = asked.3[4 + 32..].as_chunks::<8>().0.iter().map(|it| f64::from_le_bytes(*it)).collect();
    let (pitch, yaw) = (30_f64.to_radians(), 60_f64.to_radians());
    assert_eq!((asked.2, &numbers[..]), (1_200_000_000, &[4.0, -3.0, 2.0, 0.0, -pitch, -yaw][..]));
    let (home, dataset) = published();
    let log = dataset.folder().join(&dataset.flights()[0].mcap_path);
    let refused = flown_bags(&[("e".to_owned(), log)], dataset.folder(), &home.path().join("bags"), &|_, _| {});
    assert_eq!(refused.unwrap_err().code, "dataset-damaged");
}
