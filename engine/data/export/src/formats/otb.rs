//! OTB and UAV123: a folder of pictures per flight, with the box of its target.

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::sequence::{self, Sequence, SequenceList, box_text};
use crate::shared_options::PictureOptions;
use crate::single_target::{self, each_sequence};
use crate::source::{ExportedFlight, Source};
use cosfly_diagnose::Result;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sequences for trackers of single targets.
pub struct Otb;

/// Options of `otb`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct Options {
    #[serde(flatten)]
    pictures: PictureOptions,
    /// Names of folders and files
    #[serde(default)]
    layout: Layout,
}

/// Names of folders and files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// `FLIGHT/img/0001.jpg` and `FLIGHT/groundtruth_rect.txt`
    #[default]
    Otb,
    /// `data_seq/UAV123/FLIGHT/000001.jpg` and `anno/UAV123/FLIGHT.txt`
    Uav123,
}

impl Layout {
    /// Names of one length: readers sort them as texts.
    fn picture(self, split: &str, name: &str, [number, pictures]: [usize; 2]) -> String {
        let digits = pictures.to_string().len().max(4);
        match self {
            Self::Otb => format!("{split}/{name}/img/{number:0digits$}.jpg"),
            Self::Uav123 => format!("{split}/data_seq/UAV123/{name}/{number:06}.jpg"),
        }
    }

    fn boxes(self, split: &str, name: &str) -> String {
        match self {
            Self::Otb => format!("{split}/{name}/groundtruth_rect.txt"),
            Self::Uav123 => format!("{split}/anno/UAV123/{name}.txt"),
        }
    }

    fn body(self) -> &'static str {
        match self {
            Self::Otb => OTB_BODY,
            Self::Uav123 => UAV123_BODY,
        }
    }
}

impl Format for Otb {
    const NAME: &'static str = "otb";
    const DOC: &'static str = "OTB or UAV123: pictures of each flight, the target's box in each";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let layout = options.layout;
        let mut list = SequenceList::default();
        let name = |_, episode: &ExportedFlight<'_>| episode.flight.trajectory_id.clone();
        let remarks = each_sequence(source, options.pictures.every, &name, &mut |sequence| {
            let split = &sequence.episode.flight.split;
            let (name, pictures) = (&sequence.name, sequence.frames.len());
            sequence.write_pictures(out, &|number| layout.picture(split, name, [number, pictures]))?;
            out.put(&layout.boxes(split, name), boxes(sequence).as_bytes())?;
            list.add(sequence);
            Ok(())
        })?;
        list.write(out)?;
        let body = format!("{}{BODY}\n{}{}", layout.body(), single_target::CARD, sequence::CARD);
        ExportCard { format: "OTB", body, ..ExportCard::default() }.write(source, out)?;
        Ok(remarks)
    }
}

/// A line per picture; `NaN` where the target is not seen.
fn boxes(sequence: &Sequence<'_>) -> String {
    let rows = sequence.frames.iter().map(|frame| &sequence.episode.frames[*frame]);
    let lines = rows.map(|row| row.visible_box_px.map_or("NaN,NaN,NaN,NaN".to_owned(), box_text));
    lines.map(|line| format!("{line}\n")).collect()
}

const OTB_BODY: &str = "\
```
<split>/<flight>/img/<picture>.jpg
<split>/<flight>/groundtruth_rect.txt
```

```python
import json
from pathlib import Path
import numpy

for row in map(json.loads, Path(\"sequences.jsonl\").read_text().splitlines()):
    folder = Path(row[\"split\"]) / row[\"sequence\"]
    pictures = sorted(folder.glob(\"img/*.jpg\"), key=lambda path: int(path.stem))
    boxes = numpy.loadtxt(folder / \"groundtruth_rect.txt\", delimiter=\",\", ndmin=2)
    assert len(pictures) == len(boxes)
    seen = ~numpy.isnan(boxes).any(axis=1)
```
";

const UAV123_BODY: &str = "\
```
<split>/data_seq/UAV123/<flight>/<picture>.jpg
<split>/anno/UAV123/<flight>.txt
```

```python
import json
from pathlib import Path
import numpy

for row in map(json.loads, Path(\"sequences.jsonl\").read_text().splitlines()):
    folder = Path(row[\"split\"])
    pictures = sorted(folder.glob(f\"data_seq/UAV123/{row['sequence']}/*.jpg\"))
    boxes = numpy.loadtxt(folder / f\"anno/UAV123/{row['sequence']}.txt\", delimiter=\",\", ndmin=2)
    assert len(pictures) == len(boxes)
    seen = ~numpy.isnan(boxes).any(axis=1)
```
";

const BODY: &str = "
A line of boxes is a picture. `NaN,NaN,NaN,NaN` means that the target is not seen: hidden or out of the picture. So it is in UAV123;
OTB itself has no such frames, and readers that cannot take `NaN` should skip them.
";
