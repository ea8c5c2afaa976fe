//! MOTChallenge: a folder of pictures per flight, with the boxes of everybody who is seen.

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::sequence::{self, Sequence, SequenceList, box_text};
use crate::shared_options::PictureOptions;
use crate::source::{ExportedFlight, Source};
use cosfly_diagnose::Result;
use cosfly_domain::TARGET_INSTANCE;
use cosfly_read::{SeenBody, SightingReader};
use cosfly_schema::mot_class::{DISTRACTOR, PEDESTRIAN, mot_class};
use cosfly_schema::tables::Edges;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Sequences for trackers of many bodies.
pub struct Mot;

/// Options of `mot`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct Options {
    #[serde(flatten)]
    pictures: PictureOptions,
    /// Bodies whose boxes are detections, in `det/det.txt`
    #[serde(default)]
    detections: Detections,
}

/// Bodies whose boxes are detections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Detections {
    /// People on foot, the only ones that TrackEval scores
    #[default]
    Pedestrians,
    /// All that count, with the class in column 8
    All,
}

/// A body in a picture.
struct Seen {
    id: u32,
    /// Number of the picture, from 1.
    picture: usize,
    edges_px: Edges,
    class: u8,
    /// Visible share of its pixels, where it is measured.
    visible: Option<f64>,
}

impl Format for Mot {
    const NAME: &'static str = "mot";
    const DOC: &'static str =
        "MOTChallenge: pictures of each flight, boxes and ids of the target and all visible bodies";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let mut bodies = SightingReader::of(source.dataset)?;
        let mut list = SequenceList::default();
        let mut names: BTreeMap<String, String> = BTreeMap::new();
        source.each_flight(&mut |episode| {
            let flight = episode.flight;
            let place = source.dataset.place(&flight.trajectory_id).unwrap_or_default();
            let every = options.pictures.every;
            let frames = episode.every_nth_frame(every);
            let sequence = Sequence { name: flight.trajectory_id.clone(), episode, frames, every };
            let folder = format!("{}/{}", flight.split, sequence.name);
            sequence.write_pictures(out, &|number| format!("{folder}/img1/{number:06}.jpg"))?;
            let seen = seen(episode, &sequence.frames, bodies.at(source.dataset, place)?);
            out.put(&format!("{folder}/gt/gt.txt"), ground_truth(&seen).as_bytes())?;
            out.put(&format!("{folder}/det/det.txt"), options.detections.lines(&seen).as_bytes())?;
            out.put(&format!("{folder}/seqinfo.ini"), info(&sequence).as_bytes())?;
            list.add(&sequence);
            let names = names.entry(flight.split.clone()).or_insert_with(|| "name\n".to_owned());
            names.push_str(&format!("{}\n", sequence.name));
            Ok(())
        })?;
        for (split, names) in names {
            out.put(&format!("seqmaps/{split}.txt"), names.as_bytes())?;
        }
        list.write(out)?;
        let split = source.splits().first().copied().unwrap_or_default();
        let body = format!("{}\n{}", BODY.replace("NAME_OF_SPLIT", split), sequence::CARD);
        ExportCard { format: "MOTChallenge", front_matter: "task_categories:\n- object-detection\n".into(), body }
            .write(source, out)?;
        Ok(vec![])
    }
}

/// All who are seen, by id and picture.
fn seen(episode: &ExportedFlight<'_>, frames: &[usize], bodies: &[SeenBody]) -> Vec<Seen> {
    let class = mot_class(episode.flight.target_kind.as_deref().unwrap_or_default());
    let target = frames.iter().zip(1..).filter_map(|(frame, picture)| {
        let row = &episode.frames[*frame];
        let visible = Some(row.visible_by_pixels);
        row.visible_box_px.map(|edges_px| Seen { id: TARGET_INSTANCE, picture, edges_px, class, visible })
    });
    let others = bodies.iter().filter_map(|body| {
        let picture = 1 + frames.binary_search(&(body.frame as usize)).ok()?;
        let (edges_px, class) = (body.visible_box_px, mot_class(&body.kind));
        Some(Seen { id: body.instance, picture, edges_px, class, visible: None })
    });
    let mut seen: Vec<Seen> = target.chain(others).collect();
    seen.sort_by_key(|it| (it.id, it.picture));
    seen
}

/// Lines of `gt.txt`, by id and picture.
fn ground_truth(seen: &[Seen]) -> String {
    let line = |Seen { id, picture, edges_px, class, visible }: &Seen| {
        let (edges, counts) = (box_text(*edges_px), u8::from(*class != DISTRACTOR));
        let visible = visible.map_or("-1".to_owned(), |share| format!("{share:.4}"));
        format!("{picture},{id},{edges},{counts},{class},{visible}\n")
    };
    seen.iter().map(line).collect()
}

impl Detections {
    /// Lines of `det.txt`, by picture: what a detector without a fault tells, who knows nobody.
    fn lines(self, seen: &[Seen]) -> String {
        let is_told = |it: &&Seen| match self {
            Self::Pedestrians => it.class == PEDESTRIAN,
            Self::All => it.class != DISTRACTOR,
        };
        let mut told: Vec<&Seen> = seen.iter().filter(is_told).collect();
        told.sort_by_key(|it| it.picture);
        let line = |it: &&Seen| {
            let class = if self == Self::All { it.class.to_string() } else { "-1".to_owned() };
            format!("{},-1,{},1,{class},-1,-1\n", it.picture, box_text(it.edges_px))
        };
        told.iter().map(line).collect()
    }
}

fn info(sequence: &Sequence<'_>) -> String {
    let camera = &sequence.episode.flight.camera;
    format!(
        "[Sequence]\nname={}\nimDir=img1\nframeRate={}\nseqLength={}\nimWidth={}\nimHeight={}\nimExt=.jpg\n",
        sequence.name,
        sequence.rate(),
        sequence.frames.len(),
        camera.width,
        camera.height
    )
}

const BODY: &str = "\
```
<split>/<flight>/seqinfo.ini
<split>/<flight>/img1/<picture>.jpg
<split>/<flight>/gt/gt.txt
<split>/<flight>/det/det.txt
seqmaps/<split>.txt
```

```python
import configparser
from pathlib import Path
import numpy

for name in Path(\"seqmaps/NAME_OF_SPLIT.txt\").read_text().split()[1:]:
    folder = Path(\"NAME_OF_SPLIT\") / name
    info = configparser.ConfigParser()
    info.read(folder / \"seqinfo.ini\")
    rows = numpy.loadtxt(folder / \"gt/gt.txt\", delimiter=\",\", ndmin=2).reshape(-1, 9)
    for picture in range(1, int(info[\"Sequence\"][\"seqLength\"]) + 1):
        file = folder / \"img1\" / f\"{picture:06}.jpg\"
        ids, boxes = rows[rows[:, 0] == picture, 1], rows[rows[:, 0] == picture, 2:6]
```

Results of a tracker, a file `<flight>.txt` for each sequence, are scored by TrackEval (`pip install trackeval`). Here the truth
itself takes the place of the results of a tracker called `truth`:

```python
from pathlib import Path
import tempfile
import trackeval

names = Path(\"seqmaps/NAME_OF_SPLIT.txt\").read_text().split()[1:]
with tempfile.TemporaryDirectory() as trackers:
    results = Path(trackers) / \"truth/data\"
    results.mkdir(parents=True)
    for name in names:
        lines = [line.split(\",\") for line in Path(f\"NAME_OF_SPLIT/{name}/gt/gt.txt\").read_text().splitlines()]
        lines = [\",\".join([*line[:6], \"1\", \"-1\", \"-1\", \"-1\"]) for line in lines if line[7] == \"1\"]
        (results / f\"{name}.txt\").write_text(\"\".join(line + \"\\n\" for line in lines))
    quiet = {\"PRINT_CONFIG\": False}
    data = {\"GT_FOLDER\": \"NAME_OF_SPLIT\", \"SEQMAP_FILE\": \"seqmaps/NAME_OF_SPLIT.txt\", \"SKIP_SPLIT_FOL\": True, \"TRACKERS_FOLDER\": trackers, **quiet}
    config = {\"PRINT_RESULTS\": False, \"TIME_PROGRESS\": False, \"OUTPUT_SUMMARY\": False, \"OUTPUT_DETAILED\": False,
              \"PLOT_CURVES\": False, \"BREAK_ON_ERROR\": True, **quiet}
    dataset = trackeval.datasets.MotChallenge2DBox(data)
    metrics = [trackeval.metrics.HOTA(), trackeval.metrics.Identity({\"THRESHOLD\": 0.5, **quiet})]
    scores, _ = trackeval.Evaluator(config).evaluate([dataset], metrics)
    scores = scores[\"MotChallenge2DBox\"][\"truth\"][\"COMBINED_SEQ\"][\"pedestrian\"]
    print(\"HOTA\", scores[\"HOTA\"][\"HOTA\"].mean(), \"IDF1\", scores[\"Identity\"][\"IDF1\"])
```

A line of `gt.txt` is a body in a picture: picture, id, box, whether it counts, class, visibility. Ids are those of the dataset's
instance images; 1 is the target, who has no line where nobody sees it. Classes are MOTChallenge's: 1 pedestrian, 3 car, van, lorry
or bus, 4 bicycle or e-scooter with rider, 5 motorcycle with rider, 8 anything else, which does not count. Visibility is the
visible share of the target's pixels, and -1 (not measured) of the others. `frameRate` may have decimals.

A line of `det.txt` is a detection: picture, -1, box, score, -1, -1, -1. The dataset has no detector: these are the boxes of `gt.txt`
without their ids, of pedestrians, with score 1, as one without a fault would find them. With `--detections all` they are of all who
count, and the class stands in place of the first -1 behind the score.
";
