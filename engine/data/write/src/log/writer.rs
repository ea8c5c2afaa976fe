//! Writes the log of one trajectory, frame by frame.

use super::channels::ChannelWriter;
use super::readings::Readings;
use super::{metadata, scene};
use crate::frame_pack::{FramePackReader, PackHeader, PackedFrame};
use cosfly_blobs::BlobPart;
use cosfly_channel_pictures::previews;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::Town;
use cosfly_domain::channels::rgb;
use cosfly_fingerprint::Digest;
use cosfly_fingerprint::sha256::HashingWriter;
use cosfly_schema::extras::Extra;
use cosfly_schema::log::{Frequency, messages, topic, topics};
use cosfly_schema::{CaptionRecord, LogRecord, RenderedTrajectory, RgbEncoding};
use std::io::{Read, Seek, Write};

/// A log that was written.
#[derive(Clone, Debug)]
pub struct WrittenLog {
    /// Its row among all logs.
    pub record: LogRecord,
    /// Places of the colour previews, by frame; none where previews are off.
    pub previews: Vec<BlobPart>,
}

/// Writes the log of `record` with the images of `pack` and the readings of sensors among `extras` to `output`, which is only appended to.
/// Holds one frame in memory. `keep_going` is asked before every frame and its error ends the work.
pub fn write_log<R: Read + Seek>(
    output: &mut dyn Write,
    record: &RenderedTrajectory,
    pack: &mut FramePackReader<R>,
    captions: &[CaptionRecord],
    extras: &[Extra],
    town: &Town,
    keep_going: &dyn Fn() -> Result<()>,
) -> Result<WrittenLog> {
    record.check()?;
    check_pack(record, pack)?;
    let mut hashing = HashingWriter::new(output);
    let with_previews = pack.header().encoding.previews;
    let mut topics = topics(&pack.header().channels);
    topics.retain(|topic| with_previews || topic.frequency != Frequency::Previews);
    let mut readings = Readings::of(extras);
    topics.extend(readings.topics());
    let mut log = ChannelWriter::new(&mut hashing, &topics)?;
    for (name, entries) in metadata::records(record, pack.header(), town) {
        log.metadata(name, &entries)?;
    }
    write_once(&mut log, record, captions, town)?;
    let mut previews = vec![];
    for frame in 0..record.len() {
        keep_going()?;
        let images = pack.frame(frame)?;
        // A reading that rounding puts behind the last frame is one of that frame.
        let is_last = frame + 1 == record.len();
        readings.write(&mut log, if is_last { u64::MAX } else { record.times().ns(frame) })?;
        previews.extend(write_frame(&mut log, record, frame, images, pack.header())?);
    }
    let messages = log.finish()?;
    let (bytes, sha256) = hashing.finish();
    let record = LogRecord {
        trajectory_id: record.trajectory_id.clone(),
        role: record.role,
        pedestrian_id: record.pedestrian_id.clone(),
        town: record.town.name.clone(),
        frames: record.len() as u64,
        messages,
        bytes,
        sha256,
    };
    Ok(WrittenLog { record, previews })
}

fn check_pack<R: Read + Seek>(record: &RenderedTrajectory, pack: &FramePackReader<R>) -> Result<()> {
    let (header, camera) = (pack.header(), &record.camera);
    let same_size = (header.width, header.height) == (camera.width, camera.height);
    if pack.len() != record.len() || !same_size || header.times() != record.times() {
        return Err(Diagnostic::new(
            "mcap-pack",
            Fault::Bug,
            format!(
                "trajectory `{}` has {} of {} x {}, {} s apart; its frame pack has {} of {} x {}, {} s apart",
                record.trajectory_id,
                counted(record.len(), "frame"),
                camera.width,
                camera.height,
                record.dt_s(),
                pack.len(),
                header.width,
                header.height,
                header.dt_s
            ),
        ));
    }
    Ok(())
}

/// Parts of messages that are the same in every frame.
fn write_once<W: Write>(
    log: &mut ChannelWriter<W>,
    record: &RenderedTrajectory,
    captions: &[CaptionRecord],
    town: &Town,
) -> Result<()> {
    let track = &record.trajectory.track;
    log.write(topic::SCENE, 0, &scene::scene(town, &record.trajectory.poses_in_world, track.height_m, track.radius_m))?;
    let poses = record.trajectory.poses_in_world.iter().copied();
    log.write(topic::DRONE_PATH, 0, &messages::path_in_map(poses))?;
    let targets = (0..record.len()).map(|frame| messages::target_pose(record, frame));
    log.write(topic::TARGET_PATH, 0, &messages::path_in_map(targets))?;
    captions.iter().try_for_each(|caption| log.write(topic::CAPTIONS, 0, &scene::caption(caption)))?;
    log.end_compressed_chunk()
}

fn write_frame<W: Write>(
    log: &mut ChannelWriter<W>,
    record: &RenderedTrajectory,
    frame: usize,
    images: PackedFrame,
    header: &PackHeader,
) -> Result<Option<BlobPart>> {
    let time = record.times().ns(frame);
    let camera = &record.camera;
    let pose = &record.trajectory.poses_in_world[frame];
    let target = messages::target_pose(record, frame);
    log.write(topic::TF, time, &messages::transforms(time, pose, &record.mount, &target))?;
    log.write(topic::DRONE_POSE, time, &messages::pose_in_map(time, pose))?;
    log.write(topic::TARGET_POSE, time, &messages::pose_in_map(time, &target))?;
    log.write(topic::TARGET_STATE, time, &messages::target_state(record, frame))?;
    log.write(topic::CAMERA, time, &messages::calibration(time, camera, &record.lens, &record.mount))?;
    log.write(topic::ANNOTATIONS, time, &messages::annotations(time, record, frame))?;
    let format = match header.encoding.rgb {
        RgbEncoding::Jpeg => "jpeg",
        RgbEncoding::Png => "png",
    };
    for (channel, file) in images.files {
        log.write(&topic::images(channel), time, &messages::compressed_image(time, format, file))?;
    }
    let mut colour = None;
    for (channel, file) in images.previews {
        let message = messages::compressed_image(time, previews::format(channel), file.clone());
        log.write(&topic::previews(channel), time, &message)?;
        if *channel == rgb::CHANNEL {
            colour = Some(part_of(log, &file)?);
        }
    }
    // A chunk for the files and one for each kind of raw images: who reads one of them decodes nothing of the others.
    log.end_plain_chunk()?;
    images.chunks.iter().try_for_each(|chunk| log.packed_chunk(time, chunk))?;
    Ok(colour)
}

/// Place of a file of the last message in the log.
fn part_of<W: Write>(log: &ChannelWriter<W>, file: &[u8]) -> Result<BlobPart> {
    let place = log.offset_of(file).zip(u32::try_from(file.len()).ok());
    let (offset, bytes) =
        place.ok_or_else(|| Diagnostic::new("mcap-preview", Fault::Bug, "a message does not have its preview"))?;
    Ok(BlobPart { offset, bytes, digest: Digest::of(file) })
}
