//! LaSOT: a folder of pictures per flight, with the box of its target, absence by reason, and a sentence about the target.

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::sequence::{self, Sequence, SequenceList, box_text};
use crate::shared_options::PictureAndTextOptions;
use crate::single_target::{self, each_sequence, is_seen, target_word};
use crate::source::{ExportedFlight, Source};
use cosfly_diagnose::Result;
use cosfly_read::FrameRow;

/// Sequences for trackers of single targets, with words.
pub struct LaSot;

impl Format for LaSot {
    const NAME: &'static str = "lasot";
    const DOC: &'static str = "LaSOT: pictures of each flight, the target's box, occlusion and absence, a sentence";
    type Options = PictureAndTextOptions;

    fn write(options: &PictureAndTextOptions, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let mut list = SequenceList::default();
        // Readers cut a name at its dash.
        let name = |number, episode: &ExportedFlight<'_>| format!("{}-{number}", target_word(episode));
        let remarks = each_sequence(source, options.pictures.every, &name, &mut |sequence| {
            let flight = sequence.episode.flight;
            let folder = format!("{}/{}/{}", flight.split, target_word(sequence.episode), sequence.name);
            sequence.write_pictures(out, &|number| format!("{folder}/img/{number:08}.jpg"))?;
            let put = |name: &str, text: String| out.put(&format!("{folder}/{name}"), text.as_bytes());
            put("groundtruth.txt", boxes(sequence))?;
            put("full_occlusion.txt", flags(sequence, |row| row.in_view && !is_seen(row)))?;
            put("out_of_view.txt", flags(sequence, |row| !row.in_view && !is_seen(row)))?;
            put("nlp.txt", format!("{}\n", sequence.episode.instruction(options.instructions.language)))?;
            list.add(sequence);
            Ok(())
        })?;
        list.write(out)?;
        let body = format!("{BODY}\n{}{}", single_target::CARD, sequence::CARD);
        ExportCard { format: "LaSOT", body, ..ExportCard::default() }.write(source, out)?;
        Ok(remarks)
    }
}

fn rows<'a>(sequence: &'a Sequence<'_>) -> impl Iterator<Item = &'a FrameRow> {
    sequence.frames.iter().map(|frame| &sequence.episode.frames[*frame])
}

/// A line per picture; zeros where the target is not seen.
fn boxes(sequence: &Sequence<'_>) -> String {
    rows(sequence).map(|row| row.visible_box_px.map_or("0,0,0,0\n".to_owned(), |it| box_text(it) + "\n")).collect()
}

/// One line with a 0 or a 1 for each picture.
fn flags(sequence: &Sequence<'_>, is_set: impl Fn(&FrameRow) -> bool) -> String {
    let flags: Vec<&str> = rows(sequence).map(|row| if is_set(row) { "1" } else { "0" }).collect();
    flags.join(",") + "\n"
}

const BODY: &str = "\
```
<split>/<kind>/<kind>-<number>/img/<picture>.jpg
<split>/<kind>/<kind>-<number>/groundtruth.txt
<split>/<kind>/<kind>-<number>/full_occlusion.txt
<split>/<kind>/<kind>-<number>/out_of_view.txt
<split>/<kind>/<kind>-<number>/nlp.txt
```

```python
import json
from pathlib import Path
import numpy

for row in map(json.loads, Path(\"sequences.jsonl\").read_text().splitlines()):
    kind = row[\"sequence\"].split(\"-\")[0]
    folder = Path(row[\"split\"]) / kind / row[\"sequence\"]
    pictures = sorted(folder.glob(\"img/*.jpg\"))
    boxes = numpy.loadtxt(folder / \"groundtruth.txt\", delimiter=\",\", ndmin=2)
    occluded, outside = (numpy.loadtxt(folder / name, delimiter=\",\", ndmin=1) for name in (\"full_occlusion.txt\", \"out_of_view.txt\"))
    sentence = (folder / \"nlp.txt\").read_text()
    seen = (occluded == 0) & (outside == 0)
    assert len(pictures) == len(boxes) == len(seen) and ((boxes[:, 2] > 0) == seen).all()
```

A line of `groundtruth.txt` is a picture; `0,0,0,0` where the target is not seen. `full_occlusion.txt` has a 1 where it stands in the
picture and something hides all of it, `out_of_view.txt` a 1 where it is outside of the picture. `nlp.txt` is the flight's instruction.
`<kind>` is that of the target, such as `pedestrian`.
";
