//! Bags of ROS 2 have every topic at every frame, and say what the dataset says.

use crate::Choice;
use crate::laws::{export_with, files, published};
use cosfly_frames::DVec3;
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
