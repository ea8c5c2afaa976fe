//! CPU time of one frame on one core, split by stage: drawing, encoding by channel, writing.

use super::flight::{DT_S, StoredFile, flight};
use super::options::RenderOptions;
use super::views::{Ground, View};
use crate::clock::timed;
use cosfly_channel_pictures::previews::SmallImages;
use cosfly_diagnose::Result;
use cosfly_domain::{ChannelSet, FrameImages, Weather};
use cosfly_frames::simd::Level;
use cosfly_images::{depth, ids, rgb};
use cosfly_render::{FrameParts, FrameSetup, PictureLook, Renderer};
use cosfly_write::frame_pack::chunk_compressor;
use cosfly_write::{FramePackReader, FramePackWriter, PackHeader, write_log};
use serde::Serialize;
use std::fs::File;
use std::hint::black_box;
use std::io::BufReader;

/// Consecutive frames of each view, as in a flight: the town's shadows are drawn for the first, and again when the
/// camera leaves their area.
const STEPS: usize = 4;

/// CPU time per frame, milliseconds. The stages of a group add up to its total except for rounding and clocks.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct StageTimes {
    /// Nearest face at each pixel.
    pub visibility_ms: f64,
    /// Depth and ids of those faces, and the target's view.
    pub ids_ms: f64,
    /// Colours: light, materials, weather, edges.
    pub colour_ms: f64,
    /// Encoding of the colour image.
    pub encode_rgb_ms: f64,
    /// Encoding of depth: rounding and compression.
    pub encode_depth_ms: f64,
    /// Compression of both id images.
    pub encode_ids_ms: f64,
    /// Encoding of the three previews.
    pub encode_previews_ms: f64,
    /// Packing of whole frames into a file: all encoding, checks, hashing, writing.
    pub pack_ms: f64,
    /// Conversion of the pack into the finished, hashed log on disk.
    pub log_ms: f64,
    /// Size of a frame in the log, bytes.
    pub log_bytes: f64,
    /// Size of depth and both id images of a frame, compressed, bytes.
    pub depth_and_ids_bytes: f64,
}

impl StageTimes {
    /// Total time of drawing, milliseconds.
    pub fn render_ms(&self) -> f64 {
        self.visibility_ms + self.ids_ms + self.colour_ms
    }

    /// Total time of a frame in a finished log, milliseconds.
    pub fn whole_ms(&self) -> f64 {
        self.render_ms() + self.pack_ms + self.log_ms
    }

    /// Total time of depth and ids, drawn and compressed, milliseconds.
    pub fn depth_and_ids_ms(&self) -> f64 {
        self.visibility_ms + self.ids_ms + self.encode_depth_ms + self.encode_ids_ms
    }

    /// Minimum of each stage; a stage of drawing is the difference of two minima, not the minimum of differences.
    fn least(self, other: Self) -> Self {
        let drawn = |it: &Self| [it.visibility_ms, it.visibility_ms + it.ids_ms, it.render_ms()];
        let (a, b) = (drawn(&self), drawn(&other));
        let least: [f64; 3] = core::array::from_fn(|i| a[i].min(b[i]));
        Self {
            visibility_ms: least[0],
            ids_ms: least[1] - least[0],
            colour_ms: least[2] - least[1],
            encode_rgb_ms: self.encode_rgb_ms.min(other.encode_rgb_ms),
            encode_depth_ms: self.encode_depth_ms.min(other.encode_depth_ms),
            encode_ids_ms: self.encode_ids_ms.min(other.encode_ids_ms),
            encode_previews_ms: self.encode_previews_ms.min(other.encode_previews_ms),
            pack_ms: self.pack_ms.min(other.pack_ms),
            log_ms: self.log_ms.min(other.log_ms),
            log_bytes: other.log_bytes,
            depth_and_ids_bytes: other.depth_and_ids_bytes,
        }
    }
}

/// Minimum of each stage over all rounds; a round is the mean over all views.
pub fn times(ground: &Ground, weather: &Weather, look: PictureLook, options: &RenderOptions<'_>) -> Result<StageTimes> {
    let mut renderer = Renderer::new(ground.camera);
    renderer.set_look(look);
    let mut least: Option<StageTimes> = None;
    for _ in 0..options.rounds.max(1) {
        let round = round(ground, weather, options, &mut renderer)?;
        least = Some(least.map_or(round, |least| least.least(round)));
    }
    Ok(least.unwrap_or_default())
}

fn round(
    ground: &Ground,
    weather: &Weather,
    options: &RenderOptions<'_>,
    renderer: &mut Renderer,
) -> Result<StageTimes> {
    let ms_per_frame = 1e3 / ground.views.len().max(1) as f64;
    let followed: Vec<View> = (0..ground.views.len())
        .flat_map(|view| (0..STEPS).map(move |step| ground.followed(view, step, DT_S)))
        .collect();
    let drawn = [FrameParts::Visibility, FrameParts::Ids, FrameParts::All].map(|parts| {
        let all = || {
            for view in &followed {
                let setup = FrameSetup { pose: view.pose, weather, target: Some(view.target), others: &[] };
                black_box(renderer.render_parts(&ground.scene, &setup, parts));
            }
        };
        ms_per_frame / STEPS as f64 * timed(all).1
    });
    let mut images: Vec<FrameImages> = vec![];
    let mut views = vec![];
    for view in &ground.views {
        let setup = FrameSetup { pose: view.pose, weather, target: Some(view.target), others: &[] };
        let rendered = renderer.render(&ground.scene, &setup);
        images.push(rendered.images.clone());
        views.push(rendered.target_view);
    }
    let (encoded, depth_and_ids_bytes) = encoding_s(&images, options)?;
    let encoded = encoded.map(|spent_s| ms_per_frame * spent_s);
    let flight = flight(ground, weather, &ground.views, views);
    let header = PackHeader::new(
        ground.camera.width,
        ground.camera.height,
        ground.largest_instance(),
        options.encoding,
        flight.dt_s(),
    );
    let (pack_path, log_path) = (options.scratch.join("stages.pack"), options.scratch.join("stages.mcap"));
    let (packed, pack_s) = timed(|| -> Result<()> {
        let mut pack = FramePackWriter::new(StoredFile::create(&pack_path)?, &header)?;
        images.iter().try_for_each(|images| pack.frame(images))?;
        pack.finish()?.finish();
        Ok(())
    });
    packed?;
    let (logged, log_s) = timed(|| -> Result<u64> {
        let mut pack = FramePackReader::new(BufReader::new(StoredFile::open(&pack_path)?))?;
        let mut output = StoredFile::create(&log_path)?;
        write_log(&mut output, &flight, &mut pack, &[], &[], &ground.town, &|| Ok(()))?;
        output.finish();
        Ok(File::open(&log_path).and_then(|file| file.metadata()).map_or(0, |data| data.len()))
    });
    Ok(StageTimes {
        visibility_ms: drawn[0],
        ids_ms: drawn[1] - drawn[0],
        colour_ms: drawn[2] - drawn[1],
        encode_rgb_ms: encoded[0],
        encode_depth_ms: encoded[1],
        encode_ids_ms: encoded[2],
        encode_previews_ms: encoded[3],
        pack_ms: ms_per_frame * pack_s,
        log_ms: ms_per_frame * log_s,
        log_bytes: logged? as f64 / images.len().max(1) as f64,
        depth_and_ids_bytes: depth_and_ids_bytes as f64 / images.len().max(1) as f64,
    })
}

/// CPU time of encoding all images: colour, depth, ids, previews, seconds; bytes of depth and ids.
fn encoding_s(images: &[FrameImages], options: &RenderOptions<'_>) -> Result<([f64; 4], u64)> {
    let quality = options.encoding.jpeg_quality;
    let mut file = vec![];
    let (encoded, rgb_s) = timed(|| -> Result<()> {
        images.iter().try_for_each(|it| {
            rgb::jpeg(&it.rgb, it.width, it.height, quality, &mut file)?;
            black_box(&file);
            Ok(())
        })
    });
    encoded?;
    let mut compressor = chunk_compressor()?;
    let mut bytes = vec![0; 4 * images.iter().map(|it| it.depth_m.len()).max().unwrap_or(0)];
    let mut stored = Vec::with_capacity(zstd::zstd_safe::compress_bound(bytes.len()));
    let mut all_bytes = 0;
    let mut compressed = |bytes: &[u8]| {
        stored.clear();
        let length = black_box(compressor.compress_to_buffer(bytes, &mut stored));
        all_bytes += length.expect("room for what is compressed") as u64;
    };
    let ((), depth_s) = timed(|| {
        for it in images {
            depth::grid_bytes(Level::best(), &it.depth_m, &mut bytes);
            compressed(&bytes);
        }
    });
    let ((), ids_s) = timed(|| {
        for it in images {
            compressed(&it.semantic);
            ids::u16_bytes(Level::best(), &it.instance, &mut bytes);
            compressed(&bytes[..2 * it.instance.len()]);
        }
    });
    let mut small = SmallImages::default();
    let (encoded, previews_s) = timed(|| -> Result<()> {
        for it in images {
            for channel in ChannelSet::default().iter() {
                small.draw(channel, it, &mut file)?;
                black_box(&file);
            }
        }
        Ok(())
    });
    encoded.map(|()| ([rgb_s, depth_s, ids_s, previews_s], all_bytes))
}
