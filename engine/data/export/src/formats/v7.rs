//! The layout of the published CosFly-Track release, `drone_nav_traj_v7`: a folder per town, pair, trace and frame.
//!
//! The published parts of the format are followed to the letter; the other parts are our own design and sit under keys called
//! `cosfly` or is listed in the card, and the book's page "Export formats" says which is which.
//!
//! * [`names`]: towns, pairs and traces as folders.
//! * [`document`]: `trajectory.json` and `perturbation_report.json`.
//! * [`pictures`]: the files of a frame.
//! * [`short_ids`]: instance ids of 16 bits.
//! * [`reader`]: a strict reader, which every export must pass before it gets its name.

pub mod document;
pub mod names;
pub mod pictures;
pub mod reader;
pub mod short_ids;

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::source::{ExportedFlight, Source};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_plot::text::markdown_code;
use names::{Names, Place, TownName};
use schemars::JsonSchema;
use serde::Deserialize;
use short_ids::ShortIds;
use std::fmt::Write;

/// Folder below which the towns lie.
pub const ROOT: &str = "data_v7";

/// The layout of the published release.
pub struct V7;

/// Options of `v7`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct Options {
    /// CARLA's name for a town of another name, such as downtown=Town01
    #[serde(default)]
    #[schemars(title = "TOWN=NAME")]
    town: Vec<TownName>,
    /// Leave out `debug.png`, the colours with the target's box
    #[serde(default)]
    no_debug: bool,
}

impl Format for V7 {
    const NAME: &'static str = "v7";
    const DOC: &'static str =
        "the layout of the published CosFly-Track release: a folder per town, pair, trace and frame";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let names = Names::of(source, &options.town)?;
        let largest = source.dataset.largest_objects()?;
        let mut changed = 0;
        let is_placed = |flight: &cosfly_read::PublishedFlight| names.place(&flight.trajectory_id).is_some();
        source.each_flight_of(&is_placed, &mut |episode| match names.place(&episode.flight.trajectory_id) {
            Some(place) => {
                let largest = largest.get(&episode.flight.town).copied().unwrap_or_default();
                let ids = ShortIds::of_frames(episode, &episode.all_frames(), largest)?;
                changed += usize::from(ids.changed().next().is_some());
                write_trace(episode, place, &ids, !options.no_debug, out)
            }
            None => Ok(()),
        })?;
        card(&names).write(source, out)?;
        let reading = reader::read(&out.path(ROOT))?;
        match reading.problems.first() {
            None => Ok([names.remarks(), remarks(changed)].concat()),
            Some(problem) => {
                Err(Diagnostic::new("export-check", Fault::Bug, "the export breaks a rule of v7").because(problem))
            }
        }
    }
}

fn remarks(changed: usize) -> Vec<String> {
    let remark = format!(
        "{} with things whose ids are beyond 65,535: `instance.png` has other numbers for these, listed in \
         `trajectory.json` under `cosfly.instances`",
        counted(changed, "flight")
    );
    if changed > 0 { vec![remark] } else { Vec::new() }
}

fn write_trace(
    episode: &ExportedFlight<'_>,
    place: &Place,
    ids: &ShortIds,
    with_debug: bool,
    out: &OutFolder,
) -> Result<()> {
    let frames = episode.all_frames();
    let parts = place.ids.len();
    frames.chunks(names::PART_FRAMES).take(parts).enumerate().try_for_each(|(part, frames)| {
        let range = frames[0]..frames[0] + frames.len();
        write_part(&episode.part(range), &place.of_part(part), (frames, ids), with_debug, out)
    })
}

/// A trace of some frames of a flight; `frames` are their numbers in the flight.
fn write_part(
    episode: &ExportedFlight<'_>,
    place: &Place,
    (frames, ids): (&[usize], &ShortIds),
    with_debug: bool,
    out: &OutFolder,
) -> Result<()> {
    let first = frames[0];
    let folder = format!("{ROOT}/{}", place.folder());
    let json =
        |name: &str, value: &serde_json::Value| out.put(&format!("{folder}/{name}"), format!("{value}\n").as_bytes());
    json("trajectory.json", &document::trajectory(episode, place, ids))?;
    json("perturbation_report.json", &document::perturbation_report(episode, place))?;
    episode.each_picture(
        frames,
        |frame, logged| {
            let folder = format!("{folder}/{}/frame_{:05}", document::FRAMES_DIR, frame - first);
            pictures::write(&logged, ids, with_debug, &mut |name, bytes| out.put(&format!("{folder}/{name}"), bytes))
        },
        |_, ()| Ok(()),
    )
}

fn card(names: &Names) -> ExportCard {
    let mut body = String::from(BODY);
    body.push_str("\n| folder | town of the dataset |\n| --- | --- |\n");
    for (folder, town) in names.towns() {
        let _ = writeln!(body, "| `{folder}` | {} |", markdown_code(town));
    }
    ExportCard { format: "v7", front_matter: "tags:\n- drone\n- trajectory\n- synthetic\n".into(), body }
}

const BODY: &str = "\
```
data_v7/<Town>/trajectory_<id>/<trace>/trajectory.json
data_v7/<Town>/trajectory_<id>/<trace>/perturbation_report.json
data_v7/<Town>/trajectory_<id>/<trace>/frames_playback/frame_<index>/{rgb.png,depth.npy,instance.png,debug.png}
```

```python
import json
from pathlib import Path

import numpy
from PIL import Image

for file in sorted(Path(\"data_v7\").glob(\"Town*/trajectory_*/*/trajectory.json\")):
    flight = json.loads(file.read_text())
    for point in flight[\"points\"]:
        time_s, pose = point[\"timing\"][\"timestamp\"], point[\"drone_pose\"]
        frame = file.parent / f\"frames_playback/frame_{point['index']:05d}\"
        rgb, depth_m = Image.open(frame / \"rgb.png\"), numpy.load(frame / \"depth.npy\")
        label, low, high = numpy.moveaxis(numpy.asarray(Image.open(frame / \"instance.png\")), -1, 0)
        instance = low + 256 * high.astype(numpy.uint16)  # 1: the target
```

`ORI` is the expert's flight, `aug_001` its perturbed twin. The keys and rules are those that readers of the published
release (`drone_nav_traj_v7`, `7.0.0`) rely on. Its full description is not public, so these choices are ours:

* Everything under a key `cosfly`, and the whole of `perturbation_report.json`.
* `waypoints` repeats index, timing and pose of `points`, and `timing` has the time by three names: readers differ in what they look for.
* A flight of more than 1,000 frames becomes several trajectories with the same `source`; `cosfly.part` says which.
* `<id>`: ten digits made from the expert's name. They look like the release's Unix times but are not.
* `drone_pose` is the drone's; with a turned mount, `cosfly.camera_pose` is that of the pictures.
* `target.world_location` is the middle of the body; `image_uv` and `depth` (along the optical axis) are its projection.
* `target.visible`: at least one pixel shows the target. `bbox_2d`: the edges around those pixels.
* `depth.npy`: 32-bit floats, rows x columns, metres along the optical axis, at most 1,000, which is also the sky, as in CARLA.
* `instance.png`: red is CARLA's label, green + 256 blue the instance id: 0 ground and sky, 1 the target. Ids beyond 65,535 have
  free numbers; `cosfly.instances` lists these, each with its id in the dataset's tables.
* `debug.png`: the colours with the target's box, yellow without obstacles, green of what can be seen; absent from exports with
  `--no-debug`.

A town that is not one of CARLA's has the name of a free CARLA town, since readers look for `Town*`:
";
