//! Frame packs survive a round trip; damaged ones are refused.

use super::*;
use cosfly_diagnose::Result;
use cosfly_domain::channels::{ALL, depth, instance, semantic};
use cosfly_domain::{ChannelImage, ChannelSet, FrameImages};
use cosfly_images::depth::GRID_M;
use cosfly_schema::EncodingConfig;
use std::io::Cursor;

fn images(seed: u32) -> FrameImages {
    let (width, height) = (64, 48);
    let pixels = width * height;
    FrameImages {
        width,
        height,
        rgb: (0..3 * pixels).map(|i| (i * 7 + seed) as u8).collect(),
        depth_m: (0..pixels).map(|i| if i < 64 { f32::INFINITY } else { 3.0 + i as f32 * 0.013 }).collect(),
        semantic: (0..pixels).map(|i| (i % 29) as u8).collect(),
        instance: (0..pixels).map(|i| i % 500).collect(),
        on_request: vec![],
    }
}

fn pack(encoding: EncodingConfig) -> Vec<u8> {
    let mut writer = FramePackWriter::new(vec![], &PackHeader::new(64, 48, 500, encoding, 0.5)).unwrap();
    for frame in 0..3 {
        writer.frame(&images(frame)).unwrap();
    }
    writer.finish().unwrap()
}

#[test]
fn a_pack_gives_back_what_was_put_in() {
    let bytes = pack(EncodingConfig::default());
    let mut reader = FramePackReader::new(Cursor::new(&bytes)).unwrap();
    assert_eq!(reader.len(), 3);
    let frame = reader.frame(2).unwrap();
    let mut pixels = |channel| reader.raw_pixels(channel, 2).unwrap();
    let given = images(2);
    assert_eq!(pixels(&semantic::CHANNEL), given.semantic);
    for (stored, depth) in pixels(&depth::CHANNEL).chunks_exact(4).zip(&given.depth_m) {
        let stored = f32::from_le_bytes(stored.try_into().unwrap());
        assert!(stored == *depth || (stored - depth).abs() <= 0.5 * GRID_M, "{stored} {depth}");
    }
    for (stored, id) in pixels(&instance::CHANNEL).chunks_exact(2).zip(&given.instance) {
        assert_eq!(u32::from(u16::from_le_bytes(stored.try_into().unwrap())), *id);
    }
    assert_eq!(frame.files[0].1[..2], [0xff, 0xd8]);
    assert_eq!(reader.preview_strip().unwrap().jpegs.len(), 3);
    let previews: Vec<&str> = frame.previews.iter().map(|(channel, _)| channel.name).collect();
    assert_eq!(previews, ["rgb", "depth", "semantic"]);
    assert_eq!(frame.previews[2].1[1..4], *b"PNG");
}

#[test]
fn lossless_packs_keep_every_bit_and_previews_can_be_left_out() {
    let encoding = EncodingConfig {
        rgb: cosfly_schema::RgbEncoding::Png,
        depth: cosfly_schema::DepthEncoding::Lossless,
        previews: false,
        ..EncodingConfig::default()
    };
    let bytes = pack(encoding);
    let mut reader = FramePackReader::new(Cursor::new(&bytes)).unwrap();
    let frame = reader.frame(0).unwrap();
    let given = images(0);
    assert_eq!(
        reader.raw_pixels(&depth::CHANNEL, 0).unwrap(),
        given.depth_m.iter().flat_map(|d| d.to_le_bytes()).collect::<Vec<_>>()
    );
    let mut decoder = png::Decoder::new(Cursor::new(&frame.files[0].1)).read_info().unwrap();
    let mut pixels = vec![0; decoder.output_buffer_size().unwrap()];
    decoder.next_frame(&mut pixels).unwrap();
    assert_eq!(pixels, given.rgb);
    assert!(frame.previews.is_empty() && reader.preview_strip().unwrap().jpegs.is_empty());
}

#[test]
fn every_channel_on_request_comes_back_as_drawn_and_has_a_preview_and_its_own_chunk() {
    let channels = ChannelSet::of(|_| true);
    let header =
        PackHeader { channels: channels.clone(), ..PackHeader::new(64, 48, 500, EncodingConfig::default(), 0.5) };
    let mut given = images(1);
    let on_request = channels.iter().filter(|channel| channel.is_on_request());
    given.on_request = on_request.map(|channel| ChannelImage::new(channel, 64 * 48)).collect();
    for image in &mut given.on_request {
        image.bytes.iter_mut().enumerate().for_each(|(at, byte)| *byte = (at % 100) as u8);
    }
    let mut writer = FramePackWriter::new(vec![], &header).unwrap();
    writer.frame(&given).unwrap();
    let mut reader = FramePackReader::new(Cursor::new(writer.finish().unwrap())).unwrap();
    assert_eq!(reader.header(), &header);
    let frame = reader.frame(0).unwrap();
    assert_eq!(frame.chunks.len(), 2 + given.on_request.len());
    assert_eq!(frame.previews.len(), ALL.iter().filter(|channel| channel.has_previews()).count());
    assert!(frame.previews.iter().all(|(_, file)| !file.is_empty()));
    for image in &given.on_request {
        assert_eq!(reader.raw_pixels(image.channel, 0).unwrap(), image.bytes, "{}", image.channel.name);
    }
    let mut writer = FramePackWriter::new(vec![], &header).unwrap();
    let error = writer.frame(&images(1)).unwrap_err();
    assert!(error.message.contains("does not hold 3072 pixels"), "{error}");
}

#[test]
fn the_same_images_give_the_same_bytes() {
    assert_eq!(pack(EncodingConfig::default()), pack(EncodingConfig::default()));
}

#[test]
fn every_truncation_and_every_flipped_byte_is_refused() {
    let whole = pack(EncodingConfig::default());
    let readable = |bytes: &[u8]| -> Result<()> {
        let mut reader = FramePackReader::new(Cursor::new(bytes))?;
        (0..reader.len()).try_for_each(|frame| reader.frame(frame).map(drop))
    };
    readable(&whole).unwrap();
    for length in (0..whole.len()).step_by(97) {
        assert!(readable(&whole[..length]).is_err(), "{length}");
    }
    for at in (0..whole.len()).step_by(whole.len() / 199) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x20;
        assert!(readable(&bytes).is_err(), "byte {at}");
    }
}

#[test]
fn images_that_do_not_fit_are_refused_by_name() {
    let mut writer =
        FramePackWriter::new(vec![], &PackHeader::new(64, 48, 500, EncodingConfig::default(), 0.5)).unwrap();
    let mut bad = images(0);
    bad.depth_m[7] = f32::NAN;
    assert!(writer.frame(&bad).unwrap_err().message.contains("depth of pixel 7 is `NaN`"));
    let mut bad = images(0);
    bad.instance[1] = 70_000;
    assert!(writer.frame(&bad).unwrap_err().message.contains("70000"));
    assert!(PackHeader::new(0, 48, 1, EncodingConfig::default(), 0.5).check().is_err());
}
