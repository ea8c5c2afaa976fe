//! Logs say what the record says, are the same twice, and have checks in every place.

use super::*;
use crate::frame_pack::FramePackReader;
use cosfly_domain::ChannelSet;
use cosfly_sample as sample;
use cosfly_schema::log::{Frequency, TargetStateMessage, right_handed, topic, topics};
use cosfly_schema::{EncodingConfig, LogRecord, RenderedTrajectory, Role};
use prost::Message;
use std::io::Cursor;

fn log(record: &RenderedTrajectory) -> (Vec<u8>, LogRecord) {
    let flight = sample::flight(0, record.role);
    let pack = flight.pack(EncodingConfig::default());
    let mut bytes = vec![];
    let mut reader = FramePackReader::new(Cursor::new(pack)).unwrap();
    let log = write_log(&mut bytes, record, &mut reader, &flight.captions, &[], &sample::town(), &|| Ok(())).unwrap();
    for (part, frame) in log.previews.iter().zip(0..) {
        let at = part.offset as usize..part.offset as usize + part.bytes as usize;
        assert_eq!(bytes[at], reader.preview_strip().unwrap().jpegs[frame]);
    }
    assert_eq!(log.previews.len(), record.len());
    (bytes, log.record)
}

fn messages_of(bytes: &[u8], topic: &str) -> Vec<(u64, Vec<u8>)> {
    ::mcap::MessageStream::new(bytes)
        .unwrap()
        .map(Result::unwrap)
        .filter(|message| message.channel.topic == topic)
        .map(|message| (message.log_time, message.data.to_vec()))
        .collect()
}

#[test]
fn the_same_record_gives_the_same_bytes_and_their_hash() {
    let record = sample::flight(0, Role::Expert).record;
    let (first, log_record) = log(&record);
    let (second, _) = log(&record);
    assert!(first == second);
    assert_eq!(
        (log_record.bytes, &log_record.sha256),
        (first.len() as u64, &cosfly_fingerprint::sha256::sha256_of(&first))
    );
}

#[test]
fn every_frame_has_every_channel_at_its_time() {
    let record = sample::flight(0, Role::Perturbed).record;
    let (bytes, log_record) = log(&record);
    let times: Vec<u64> = (0..5).map(|i| i * 500_000_000).collect();
    for topic in topics(&ChannelSet::default()) {
        let found: Vec<u64> = messages_of(&bytes, &topic.name).iter().map(|message| message.0).collect();
        match topic.frequency {
            Frequency::EveryFrame | Frequency::Previews => assert_eq!(found, times, "{}", topic.name),
            Frequency::Once => assert_eq!(found, [0], "{}", topic.name),
            Frequency::Captions => assert_eq!(found, [0, 0], "{}", topic.name),
            Frequency::Readings => unreachable!("a flight without sensors"),
        }
    }
    assert_eq!(log_record.messages, 13 * 5 + 5);
}

#[test]
fn poses_and_states_say_what_the_record_says() {
    let record = sample::flight(0, Role::Perturbed).record;
    let (bytes, _) = log(&record);
    for (frame, (_, data)) in messages_of(&bytes, topic::DRONE_POSE).iter().enumerate() {
        let message = foxglove::messages::PoseInFrame::decode(&data[..]).unwrap();
        let pose = message.pose.unwrap();
        let (p, q) = (pose.position.unwrap(), pose.orientation.unwrap());
        let back = right_handed::world_pose_from_map(
            cosfly_frames::DVec3::new(p.x, p.y, p.z),
            cosfly_frames::DQuat::from_xyzw(q.x, q.y, q.z, q.w),
        );
        let given = record.trajectory.poses_in_world[frame];
        assert!((back.position_in_world - given.position_in_world).length() < 1e-9);
        assert!((back.yaw_rad - given.yaw_rad).abs() < 1e-9 && (back.pitch_rad - given.pitch_rad).abs() < 1e-9);
    }
    let (_, data) = &messages_of(&bytes, topic::TARGET_STATE)[2];
    let state = TargetStateMessage::decode(&data[..]).unwrap();
    assert!(state.position_event && !state.rotation_event && state.frame == 2);
    assert_eq!(state.feet_y_m, -record.trajectory.track.states[2].feet_in_world.y);
    assert_eq!(state.visible_pixels, record.views[2].pixels);
}

#[test]
fn a_pack_of_another_flight_is_refused() {
    let mut record = sample::flight(0, Role::Expert).record;
    record.camera.width = 65;
    let pack = sample::flight(0, Role::Expert).pack(EncodingConfig::default());
    let mut reader = FramePackReader::new(Cursor::new(pack)).unwrap();
    let error = write_log(&mut vec![], &record, &mut reader, &[], &[], &sample::town(), &|| Ok(())).unwrap_err();
    assert!(error.message.contains("5 frames of 65 x 48"), "{error}");
}

/// A disk with room for so many bytes.
struct Disk(usize);

impl std::io::Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if bytes.len() > self.0 {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        self.0 -= bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_disk_that_fills_up_anywhere_is_an_error_and_no_log() {
    let flight = sample::flight(0, Role::Expert);
    let pack = flight.pack(EncodingConfig::default());
    let whole = log(&flight.record).1.bytes as usize;
    for room in [0, 7, 100, whole / 3, whole - 1] {
        let mut reader = FramePackReader::new(Cursor::new(&pack)).unwrap();
        let mut disk = Disk(room);
        let outcome =
            write_log(&mut disk, &flight.record, &mut reader, &flight.captions, &[], &sample::town(), &|| Ok(()));
        let error = outcome.expect_err("there is not enough room");
        assert_eq!(error.fault, cosfly_diagnose::Fault::DiskFull, "{room}: {error}");
    }
}
