//! WebDataset: shards of samples in tar files, read from front to end.

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::ending;
use crate::pixels::{ending_on_request, file_on_request, gzip, npy};
use crate::sample_text::frame_facts;
use crate::shared_options::{InstructionOptions, PictureOptions};
use crate::source::Source;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Channel;
use cosfly_read::LoggedFrame;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};

/// Shards of samples.
pub struct WebDataset;

/// Options of `webdataset`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct Options {
    #[serde(flatten)]
    pictures: PictureOptions,
    #[serde(flatten)]
    instructions: InstructionOptions,
    /// Size from which on a new file begins, MB
    #[serde(default = "shard_mb")]
    #[schemars(range(min = 1, max = 1_000_000), title = "MB")]
    shard_mb: u64,
}

fn shard_mb() -> u64 {
    300
}

impl Format for WebDataset {
    const NAME: &'static str = "webdataset";
    const DOC: &'static str = "WebDataset: tar shards of colours, depth, labels, ids and facts, a sample per frame";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let keys = keys(source)?;
        for split in source.splits() {
            let mut shards = Shards { out, split, limit: options.shard_mb * 1_000_000, number: 0, open: None };
            source.each_flight_of(&|flight| flight.split == split, &mut |episode| {
                let key = &keys[&episode.flight.trajectory_id];
                let (flight, rows) = (episode.flight, &episode.frames[..]);
                let text = episode.instruction(options.instructions.language);
                episode.each_picture(
                    &episode.every_nth_frame(options.pictures.every),
                    |frame, logged| files(&logged, &frame_facts(flight, &rows[frame], frame, text)),
                    |frame, files| shards.sample(&format!("{key}_{frame:06}"), &files),
                )
            })?;
            shards.end()?;
        }
        let mut body = body(source)?;
        for channel in source.channels_on_request()? {
            body.push_str(&format!("| `{}` | {} |\n", part_on_request(channel), channel.doc));
        }
        ExportCard { format: "WebDataset", front_matter: front_matter(source), body }.write(source, out)?;
        Ok(vec![])
    }
}

/// Names of samples by trajectory id. They have no dots: readers cut a name at its first dot.
fn keys(source: &Source<'_>) -> Result<BTreeMap<String, String>> {
    let keys: BTreeMap<String, String> =
        source.flights().map(|flight| (flight.trajectory_id.clone(), flight.trajectory_id.replace('.', "_"))).collect();
    let mut taken: BTreeMap<&str, &str> = BTreeMap::new();
    for (id, key) in &keys {
        if let Some(other) = taken.insert(key, id) {
            let message = format!("flights `{other}` and `{id}` would have the same samples: dots of names become `_`");
            return Err(Diagnostic::new("export-names", Fault::Recipe, message)
                .hint("export them one after the other with `--trajectory`"));
        }
    }
    Ok(keys)
}

/// Endings and bytes of a sample. Numbers are NumPy files: decoders of pictures make 8 bits of all PNG files.
fn files(logged: &LoggedFrame, facts: &serde_json::Value) -> Result<Vec<(String, Vec<u8>)>> {
    let size = [logged.width, logged.height];
    let mut files = vec![
        (format!("rgb.{}", ending(&logged.rgb_format)), logged.rgb_file.clone()),
        ("depth.npy.gz".into(), gzip(&npy(&logged.depth_m, size))?),
        ("semantic.npy.gz".into(), gzip(&npy(&logged.semantic, size))?),
        ("instance.npy.gz".into(), gzip(&npy(&logged.instance, size))?),
    ];
    for image in &logged.on_request {
        let file = file_on_request(image, size)?;
        let is_numbers = ending_on_request(image.channel) == "npy";
        files.push((part_on_request(image.channel), if is_numbers { gzip(&file)? } else { file }));
    }
    files.push(("json".into(), format!("{facts}\n").into_bytes()));
    Ok(files)
}

/// Name of the part of a channel on request.
fn part_on_request(channel: &Channel) -> String {
    match ending_on_request(channel) {
        "npy" => format!("{}.npy.gz", channel.name),
        ending => format!("{}.{ending}", channel.name),
    }
}

/// The shards of a split, one of them open.
struct Shards<'a> {
    out: &'a OutFolder,
    split: &'a str,
    limit: u64,
    number: usize,
    open: Option<(tar::Builder<BufWriter<File>>, u64)>,
}

impl Shards<'_> {
    fn name(&self) -> String {
        format!("data/{}-{:05}.tar", self.split, self.number)
    }

    fn sample(&mut self, key: &str, files: &[(String, Vec<u8>)]) -> Result<()> {
        if self.open.as_ref().is_some_and(|(_, bytes)| *bytes >= self.limit) {
            self.end()?;
            self.number += 1;
        }
        let (out, name) = (self.out, self.name());
        if self.open.is_none() {
            self.open = Some((tar::Builder::new(out.create(&name)?), 0));
        }
        let Some((builder, bytes)) = &mut self.open else { return Ok(()) };
        for (ending, file) in files {
            // Owner, time and permissions are the same everywhere.
            let mut header = tar::Header::new_ustar();
            header.set_size(file.len() as u64);
            header.set_mode(0o644);
            header.set_mtime(0);
            let path = format!("{key}.{ending}");
            builder.append_data(&mut header, path, &file[..]).map_err(|error| out.refusal(&name, &error))?;
            *bytes += file.len() as u64;
        }
        Ok(())
    }

    fn end(&mut self) -> Result<()> {
        let Some((builder, _)) = self.open.take() else { return Ok(()) };
        let ended = builder.into_inner().and_then(|mut file| file.flush());
        ended.map_err(|error| self.out.refusal(&self.name(), &error))
    }
}

fn front_matter(source: &Source<'_>) -> String {
    let mut text = String::from("configs:\n- config_name: default\n  data_files:\n");
    for split in source.splits() {
        text.push_str(&format!("  - split: {split}\n    path: data/{split}-*.tar\n"));
    }
    text
}

/// The card's body, with the names of a split and of its pictures.
fn body(source: &Source<'_>) -> Result<String> {
    let split = source.splits().first().copied().unwrap_or_default();
    let Some(first) = source.flights().next() else { return Ok(String::new()) };
    let rgb = ending(&source.dataset.log(first)?.frame(0)?.rgb_format);
    Ok(BODY.replace("SPLIT", split).replace("RGB", rgb))
}

const BODY: &str = "\
```python
import glob
import webdataset

shards = sorted(glob.glob(\"data/SPLIT-*.tar\"))
for sample in webdataset.WebDataset(shards, shardshuffle=False).decode(\"pil\"):
    rgb = sample[\"rgb.RGB\"]                 # a picture of PIL; `.decode()` leaves the bytes of the file
    depth_m = sample[\"depth.npy.gz\"]        # float32, rows x columns, metres
    labels = sample[\"semantic.npy.gz\"]      # uint8
    instances = sample[\"instance.npy.gz\"]   # uint32
    facts = sample[\"json\"]
```

The same with `datasets`, which makes lists of arrays:

```python
import datasets
import numpy

rows = datasets.load_dataset(\"webdataset\", data_files={\"SPLIT\": \"data/SPLIT-*.tar\"}, split=\"SPLIT\", streaming=True)
for row in rows:
    rgb = row[\"rgb.RGB\"]
    depth_m = numpy.array(row[\"depth.npy.gz\"], numpy.float32)
    facts = row[\"json\"]
```

A sample is a frame; its key is the flight and the frame, with `_` for dots. A shard has frames of one split. Depths, labels and ids
are NumPy files, not pictures: decoders of pictures make three times 8 bits of every PNG file.

| part | what |
| --- | --- |
| `rgb.jpg` or `rgb.png` | the colours, as in the dataset's log |
| `depth.npy.gz` | 32-bit floats, rows x columns: metres along the optical axis; infinity is the sky |
| `semantic.npy.gz` | 8 bits: CARLA's labels |
| `instance.npy.gz` | 32 bits: 0 ground and sky, 1 the target, then objects and people, as in the dataset's tables |
| `json` | flight, frame, time, split, poses (m and degrees, CARLA's axes), target, boxes (left, top, right, bottom), instruction |
";
