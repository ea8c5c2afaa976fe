//! Clouds of lidars: a file per sweep, as KITTI and SemanticKITTI have them, PLY, or LAS.

mod las;

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::FOLDER_LIMIT;
use crate::source::Source;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::DMat3;
use cosfly_read::LoggedSweep;
use cosfly_schema::log::cloud::CloudPoint;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// Sweeps of lidars as files.
pub struct Clouds;

/// Options of `clouds`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct Options {
    /// Kind of the files
    #[serde(default)]
    cloud_files: CloudFiles,
}

/// Kind of the files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CloudFiles {
    /// `velodyne/000000.bin` and `labels/000000.label`
    #[default]
    Kitti,
    /// `las/000000.las`, LAS 1.4 with all numbers of each point
    Las,
    /// `ply/000000.ply`, with all numbers of each point
    Ply,
}

impl Format for Clouds {
    const NAME: &'static str = "clouds";
    const DOC: &'static str =
        "Lidar clouds: a file per sweep as in KITTI and SemanticKITTI, PLY, or LAS, with poses and times";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let (mut number, mut lidars, mut sweeps) = (0, 0, 0);
        source.each_flight(&mut |episode| {
            let flight = episode.flight;
            let folder = format!("{}/{:03}/{}", flight.split, number / FOLDER_LIMIT, flight.trajectory_id);
            number += 1;
            for (lidar, all) in episode.sweeps()? {
                (lidars, sweeps) = (lidars + 1, sweeps + all.len());
                write_lidar(options.cloud_files, &format!("{folder}/{lidar}"), &all, out)?;
            }
            Ok(())
        })?;
        if lidars == 0 {
            return Err(Diagnostic::new("export-no-cloud", Fault::Recipe, "no chosen flight has a lidar")
                .hint("a stage `scan` of the recipe gives flights a lidar"));
        }
        if sweeps == 0 {
            return Err(Diagnostic::new("export-no-cloud", Fault::Recipe, "no chosen flight is as long as a sweep")
                .hint("a higher `rate_hz` of the stage `scan` makes sweeps shorter"));
        }
        let body = format!("{}{BODY}", options.cloud_files.body());
        ExportCard { format: "lidar clouds", body, ..ExportCard::default() }.write(source, out)?;
        Ok(vec![])
    }
}

impl CloudFiles {
    fn body(self) -> &'static str {
        match self {
            Self::Kitti => KITTI_BODY,
            Self::Las => LAS_BODY,
            Self::Ply => PLY_BODY,
        }
    }
}

/// Files of a lidar of one flight.
fn write_lidar(files: CloudFiles, folder: &str, all: &[LoggedSweep], out: &OutFolder) -> Result<()> {
    let (mut times, mut poses) = (String::new(), String::new());
    for (number, sweep) in all.iter().enumerate() {
        let points: Vec<CloudPoint> = sweep.points.iter().map(CloudPoint::of).collect();
        match files {
            CloudFiles::Kitti => {
                let numbers = |it: &CloudPoint| [it.place_m[0], it.place_m[1], it.place_m[2], it.intensity];
                let bytes: Vec<u8> = points.iter().flat_map(numbers).flat_map(f32::to_le_bytes).collect();
                out.put(&format!("{folder}/velodyne/{number:06}.bin"), &bytes)?;
                let label = |it: &CloudPoint| (it.instance << 16 | u32::from(it.label)).to_le_bytes();
                let bytes: Vec<u8> = points.iter().flat_map(label).collect();
                out.put(&format!("{folder}/labels/{number:06}.label"), &bytes)?;
            }
            CloudFiles::Las => {
                out.put(&format!("{folder}/las/{number:06}.las"), &las::file(sweep.time_ns as f64 * 1e-9, &points))?;
            }
            CloudFiles::Ply => out.put(&format!("{folder}/ply/{number:06}.ply"), &ply(&points))?,
        }
        let _ = writeln!(times, "{:.6}", sweep.time_ns as f64 * 1e-9);
        let turn = DMat3::from_quat(sweep.rotation.normalize()).transpose();
        let rows = [turn.x_axis, turn.y_axis, turn.z_axis].into_iter().zip(sweep.position.to_array());
        let rows: Vec<String> =
            rows.map(|(row, place)| format!("{:.9} {:.9} {:.9} {place:.6}", row.x, row.y, row.z)).collect();
        let _ = writeln!(poses, "{}", rows.join(" "));
    }
    out.put(&format!("{folder}/times.txt"), times.as_bytes())?;
    out.put(&format!("{folder}/poses.txt"), poses.as_bytes())
}

/// A PLY file with all numbers.
fn ply(points: &[CloudPoint]) -> Vec<u8> {
    let reals = ["x", "y", "z", "intensity", "time"].map(|name| format!("property float {name}\n")).concat();
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{reals}property ushort ring\nproperty ushort label\n\
         property uint instance\nend_header\n",
        points.len()
    )
    .into_bytes();
    bytes.extend(points.iter().flat_map(CloudPoint::bytes));
    bytes
}

const KITTI_BODY: &str = "\
```
<split>/<thousands of flights>/<flight>/<lidar>/velodyne/<sweep>.bin
<split>/<thousands of flights>/<flight>/<lidar>/labels/<sweep>.label
<split>/<thousands of flights>/<flight>/<lidar>/poses.txt, times.txt
```

```python
from pathlib import Path
import numpy

for lidar in sorted(path.parent for path in Path(\".\").glob(\"*/*/*/*/poses.txt\")):
    poses = numpy.loadtxt(lidar / \"poses.txt\", ndmin=2).reshape(-1, 3, 4)
    for pose, path in zip(poses, sorted(lidar.glob(\"velodyne/*.bin\"))):
        points = numpy.fromfile(path, numpy.float32).reshape(-1, 4)
        labels = numpy.fromfile(lidar / \"labels\" / f\"{path.stem}.label\", numpy.uint32)
        assert len(points) == len(labels)
        semantic, instance = labels & 0xFFFF, labels >> 16
```

A `.bin` file is that of KITTI: x, y, z, intensity, 32-bit. A `.label` file is that of SemanticKITTI: the lower half of a number is CARLA's label, the
upper half the lower 16 bits of the instance id.
";

const PLY_BODY: &str = "\
```
<split>/<thousands of flights>/<flight>/<lidar>/ply/<sweep>.ply
<split>/<thousands of flights>/<flight>/<lidar>/poses.txt, times.txt
```

A file has x, y, z, intensity, time since the sweep's beginning in seconds, ring, CARLA's label and the instance id of each point.
";

const LAS_BODY: &str = "\
```
<split>/<thousands of flights>/<flight>/<lidar>/las/<sweep>.las
<split>/<thousands of flights>/<flight>/<lidar>/poses.txt, times.txt
```

```python
from pathlib import Path
import laspy

for path in sorted(Path(\".\").glob(\"*/*/*/*/las/*.las\")):
    cloud = laspy.read(path)
    assert len(cloud.xyz) == len(cloud.gps_time) == len(cloud[\"instance\"])
```

Files are LAS 1.4, point format 6, in steps of 0.1 mm. `intensity` is 65535 times that of the dataset, `classification` CARLA's label, which is not
a class of the ASPRS. `gps_time` is the time of the shot in seconds since the flight began. `instance` (32 bits) and `ring` (16 bits) are extra bytes.
";

const BODY: &str = "
Axes are right-handed: x ahead, y left, z up, those of the lidar at the time of the point's shot. A line of `poses.txt` is a matrix of 3 rows and
4 columns: from the axes at the sweep's beginning to the frame `map`, whose y is minus that of the dataset's world. `times.txt` has the
beginnings in seconds since the flight began.
";
