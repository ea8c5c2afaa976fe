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
use cosfly_schema::mot_class::{DISTRACTOR, mot_class};
use std::collections::BTreeMap;

/// Sequences for trackers of many bodies.
pub struct Mot;

impl Format for Mot {
    const NAME: &'static str = "mot";
    const DOC: &'static str =
        "MOTChallenge: pictures of each flight, boxes and ids of the target and all visible bodies";
    type Options = PictureOptions;

    fn write(options: &PictureOptions, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let mut bodies = SightingReader::of(source.dataset)?;
        let mut list = SequenceList::default();
        let mut names: BTreeMap<String, String> = BTreeMap::new();
        source.each_flight(&mut |episode| {
            let flight = episode.flight;
            let place = source.dataset.place(&flight.trajectory_id).unwrap_or_default();
            let sequence = Sequence {
                name: flight.trajectory_id.clone(),
                episode,
                frames: episode.every_nth_frame(options.every),
                every: options.every,
            };
            let folder = format!("{}/{}", flight.split, sequence.name);
            sequence.write_pictures(out, &|number| format!("{folder}/img1/{number:06}.jpg"))?;
            let truth = ground_truth(episode, &sequence.frames, bodies.at(source.dataset, place)?);
            out.put(&format!("{folder}/gt/gt.txt"), truth.as_bytes())?;
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

/// Lines of `gt.txt`, by id and picture.
fn ground_truth(episode: &ExportedFlight<'_>, frames: &[usize], bodies: &[SeenBody]) -> String {
    let number = |frame: usize| frames.binary_search(&frame).ok().map(|place| place + 1);
    let mut lines: BTreeMap<(u32, usize), String> = BTreeMap::new();
    let target = mot_class(episode.flight.target_kind.as_deref().unwrap_or_default());
    for (place, frame) in frames.iter().enumerate() {
        let row = &episode.frames[*frame];
        if let Some(edges) = row.visible_box_px {
            let key = (TARGET_INSTANCE, place + 1);
            lines.insert(key, line(key, &box_text(edges), target, &format!("{:.4}", row.visible_by_pixels)));
        }
    }
    for body in bodies {
        if let Some(number) = number(body.frame as usize) {
            let key = (body.instance, number);
            lines.insert(key, line(key, &box_text(body.visible_box_px), mot_class(&body.kind), "-1"));
        }
    }
    lines.into_values().collect()
}

fn line((id, number): (u32, usize), edges: &str, class: u8, visibility: &str) -> String {
    let counts = u8::from(class != DISTRACTOR);
    format!("{number},{id},{edges},{counts},{class},{visibility}\n")
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
visible share of the target's pixels, and -1 (not measured) of the others. `frameRate` may have decimals. There is no `det/det.txt`:
detections would be those of some detector, and the dataset has none.
";
