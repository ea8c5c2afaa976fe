//! Fuzz targets: every reader of foreign bytes as a function that must not panic, hang or take memory without bound.
//!
//! `fuzz_targets/NAME.rs` hands them to libFuzzer; `tests/fuzzing.rs` runs them over damaged files of `corpus/NAME`.

use cosfly_domain::{Camera, channels};
use cosfly_fly::bundle::Bundle;
use cosfly_fly::pilot::{OnnxPolicy, Runnable};
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_maps::{MapConfig, read_town};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use cosfly_onnx::{OnnxModel, Tensor};
#[cfg(feature = "plugins")]
use cosfly_plugin_host::{Host, PluginLimits};
use cosfly_read::predictions::run_lengths::Runs;
use cosfly_scans::tiles::{TilesChoice, join};
use cosfly_scans::up_axis::UpAxis;
use cosfly_schema::flight_table::{ColumnKind, DeclaredColumn, MOST_ROWS, read_answer};
use cosfly_schema::log::FrameTimes;
use cosfly_splats::{SplatRenderer, SplatView, SplatsConfig};
use cosfly_town::MapError;
use cosfly_write::FramePackReader;
use std::io::{Cursor, Write};
use std::path::Path;

/// A fuzz target.
pub type Target = fn(&[u8]);

/// All targets, sorted by name.
pub const TARGETS: &[(&str, Target)] = &[
    ("arrow_answers", arrow_answers),
    ("boxes", map),
    ("bundles", bundles),
    ("cityjson", map),
    ("frame_pack", frame_pack),
    ("generated", map),
    ("gltf", scan),
    ("image_log", image_log),
    ("jpeg", jpeg),
    ("las", scan),
    ("mcap", mcap),
    ("meshes", meshes),
    ("mp4", mp4),
    ("obj", scan),
    ("onnx", onnx),
    ("opendrive", map),
    ("osm", map),
    ("pcd", scan),
    #[cfg(feature = "plugins")]
    ("plugins", plugins),
    ("ply", scan),
    ("predictions", predictions),
    ("recipes", recipes),
    ("run_lengths", run_lengths),
    ("splats", splats),
    ("tiles", tiles),
];

/// The target called `name`.
///
/// # Panics
/// When there is none.
pub fn target(name: &str) -> Target {
    TARGETS.iter().find(|(known, _)| *known == name).expect("targets are listed").1
}

/// A map of any format.
fn map(bytes: &[u8]) {
    drop(refusal(bytes));
}

/// A measured shape: whatever is refused comes with a way out.
fn scan(bytes: &[u8]) {
    if let Some(error) = refusal(bytes) {
        assert!(!error.hints.is_empty(), "{error}");
    }
}

fn refusal(bytes: &[u8]) -> Option<MapError> {
    match read_town(bytes, &MapConfig::default(), Seed::of_item(1, "fuzz", "town")) {
        Ok((town, _)) => {
            cosfly_town::assert_well_formed(&town).map(|()| None).expect("a town that was read is well formed")
        }
        Err(error) => Some(error),
    }
}

/// A bundle, as a file and as the text in it, which a digest does not keep: policies in it are read, too.
fn bundles(bytes: &[u8]) {
    let read = [Bundle::of_bytes(bytes).ok(), str::from_utf8(bytes).ok().and_then(|text| Bundle::of_text(text).ok())];
    for bundle in read.into_iter().flatten() {
        let _ = Runnable::of(&bundle.card.policy, bundle.policy.as_deref());
    }
}

/// A network in ONNX, which runs once, and as a policy.
fn onnx(bytes: &[u8]) {
    if let Ok(model) = OnnxModel::read(bytes) {
        let zeros = model.inputs().iter().map(|port| Tensor::zeros(port.kind, &port.shape));
        let _ = model.run(zeros.collect());
    }
    let _ = OnnxPolicy::of_bytes("policy", bytes.to_vec());
}

/// A pack of rendered frames.
fn frame_pack(bytes: &[u8]) {
    let Ok(mut pack) = FramePackReader::new(Cursor::new(bytes)) else { return };
    for frame in 0..pack.len().min(8) {
        let _ = pack.frame(frame);
        for channel in channels::ALL {
            let _ = pack.raw_pixels(channel, frame);
        }
    }
    let _ = pack.preview_strip();
}

const FRAMES: FrameTimes = FrameTimes { begins_ns: 0, dt_s: 0.5 };

/// The log of a flight.
fn mcap(bytes: &[u8]) {
    let _ = cosfly_read::read_records(&mut Cursor::new(bytes), &mut |_| {});
    in_a_file(bytes, "mcap", |path| {
        if let Ok(mut log) = cosfly_read::LogReader::open(path, FRAMES) {
            let _ = (log.topics(), log.frame(0), log.frame_with_instances(1));
        }
    });
}

/// The images of a log, at random.
fn image_log(bytes: &[u8]) {
    in_a_file(bytes, "mcap", |path| {
        let Ok(log) = cosfly_read::ImageLog::open(path, FRAMES) else { return };
        for (channel, frame) in channels::ALL.iter().flat_map(|channel| [1, 0, 2].map(|frame| (channel, frame))) {
            if let Ok(cosfly_read::StoredImage::Raw { data, width, height, pixel_bytes }) = log.image(channel, frame) {
                assert_eq!(data.len(), width as usize * height as usize * pixel_bytes, "an image has its bytes");
            }
        }
    });
}

/// A JPEG file: whole, and scaled while it is decoded.
fn jpeg(bytes: &[u8]) {
    for size in [None, Some([1, 1]), Some([9, 5]), Some([16, 16])] {
        if let Ok(picture) = cosfly_images::read::picture(bytes, "jpeg", size) {
            assert_eq!(picture.rgb.len(), 3 * picture.size[0] * picture.size[1], "a picture has its pixels");
            assert!(size.is_none_or(|size| size == picture.size), "a scaled picture has the wanted size");
        }
    }
}

/// The boxes of a video file.
fn mp4(bytes: &[u8]) {
    in_a_file(bytes, "mp4", |path| drop(cosfly_episodes::lerobot::video::seconds(path)));
}

/// A plugin, a core module or a component: its code runs, and its answers are read by the canonical ABI.
#[cfg(feature = "plugins")]
fn plugins(bytes: &[u8]) {
    let limits = PluginLimits { memory_mib: 4, call_ms: 1000, fuel: 100_000 };
    if let Ok(plugin) = Host::new(None).load_bytes(bytes, "fuzz.wasm", None, limits) {
        let metadata = &plugin.metadata;
        let _ = cosfly_plugin_host::check_schema(&metadata.params_schema);
    }
}

/// Predictions of models: waypoints, and detections with masks.
fn predictions(bytes: &[u8]) {
    in_a_file(bytes, "jsonl", |path| {
        let _ = cosfly_read::predictions::read(path);
        let _ = cosfly_read::predictions::detections::read(path);
        let _ = cosfly_read::predictions::detections::read_images(path);
    });
}

/// A recipe, checked against the stages of the binary.
fn recipes(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = cosfly_recipe::read(Path::new("fuzz/recipe.toml"), text, &[], &cosfly_stages::registry());
}

/// COCO's run lengths: the first two bytes are the number of pixels, the rest is the text.
fn run_lengths(bytes: &[u8]) {
    let Some((pixels, text)) = bytes.split_first_chunk::<2>() else { return };
    let pixels = u64::from(u16::from_le_bytes(*pixels));
    if let Ok(text) = std::str::from_utf8(text)
        && let Ok(runs) = Runs::of_text(text, pixels)
    {
        assert!(runs.0.iter().all(|[from, to]| from < to && u64::from(*to) <= pixels), "runs lie in the image");
    }
}

/// A file of splats, which is drawn once: whatever is refused comes with a way out.
fn splats(bytes: &[u8]) {
    let file = match cosfly_splats::read(bytes) {
        Ok(file) => file,
        Err(error) => return assert!(!error.hints.is_empty(), "{error}"),
    };
    let config = SplatsConfig::new("", UpAxis::Z);
    let placement = config.placement(DVec3::ZERO).expect("the plain place");
    let camera = Camera { width: 40, height: 20, horizontal_fov_rad: 1.5 };
    let pose = Pose::looking_at(DVec3::new(-4.0, 0.3, 1.0), DVec3::ZERO);
    let view = SplatView::new(&camera, &pose, &placement, true);
    let picture = SplatRenderer::default().draw(&file.cloud, &view, None).clone();
    assert!(picture.transmittance.iter().all(|light| (0.0..=1.0).contains(light)), "light is a share");
}

/// A textured mesh, some of whose triangles are looked at. The file stands for its materials and pictures, too.
fn meshes(bytes: &[u8]) {
    let place = MeshConfig::new("").place(DVec3::ZERO).expect("the plain place");
    let beside = [("scan.mtl".to_owned(), bytes.to_vec()), ("scan.png".to_owned(), bytes.to_vec())];
    let mesh = match TexturedMesh::read(bytes, &beside, &place) {
        Ok(mesh) => mesh,
        Err(error) => return assert!(!error.hints.is_empty(), "{error}"),
    };
    for triangle in mesh.triangles.iter().take(100) {
        let look = mesh.look_at(triangle, [0.2, 0.3, 0.5], [[0.01, 0.0], [0.002, 0.3]]);
        assert!(look.iter().all(|share| (0.0..=1.001).contains(share)), "{look:?}");
    }
}

/// A tileset with a mesh in the place of each tile, or any file as the only tile of one; what is joined is read again.
fn tiles(bytes: &[u8]) {
    const ONE: &str = r#"{"asset":{"version":"1.0"},"root":{"content":{"uri":"0.b3dm"}}}"#;
    let is_text = bytes.starts_with(b"{");
    let plain = if is_text { TexturedMesh::EXAMPLE } else { bytes };
    let tileset = if is_text { bytes } else { ONE.as_bytes() };
    let choice = TilesChoice { area_m: Some([-1e4, -1e4, 1e4, 1e4]), ..TilesChoice::default() };
    let mut opened = 0;
    let joined = join("tileset.json", &choice, &mut |path| {
        assert!(!path.starts_with('/') && !path.split('/').any(|part| part == ".."), "`{path}` leads out");
        opened += 1;
        let is_known = opened < 200;
        is_known
            .then(|| if path == "tileset.json" { tileset } else { plain }.to_vec())
            .ok_or_else(|| MapError::new("enough"))
    });
    match joined {
        Ok(joined) => meshes(&joined.glb),
        Err(error) => assert!(!error.hints.is_empty(), "{error}"),
    }
}

/// The answer of a plugin: an Arrow stream of declared columns.
fn arrow_answers(bytes: &[u8]) {
    let column = |name: &str, kind| DeclaredColumn { name: name.into(), kind, doc: String::new() };
    let declared = [
        column("real", ColumnKind::Real),
        column("integer", ColumnKind::Integer),
        column("flag", ColumnKind::Boolean),
        column("words", ColumnKind::Text),
    ];
    for count in 1..=declared.len() {
        let _ = read_answer(bytes, &declared[..count], 0..=MOST_ROWS);
    }
}

/// Calls `read` with the path of a file of these bytes.
fn in_a_file(bytes: &[u8], extension: &str, read: impl FnOnce(&Path)) {
    let mut file = tempfile::Builder::new().suffix(&format!(".{extension}")).tempfile().expect("a scratch file");
    file.write_all(bytes).expect("a scratch file can be written");
    read(file.path());
}
