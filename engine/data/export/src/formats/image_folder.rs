//! ImageFolder: picture files and one line of facts for each, as Hugging Face's `imagefolder` reads them.

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::{ending, picture_path};
use crate::pixels::{depth_png, ending_on_request, file_on_request, gray8_png};
use crate::sample_text::frame_facts;
use crate::shared_options::PictureAndTextOptions;
use crate::source::Source;
use cosfly_diagnose::Result;
use serde_json::json;
use std::io::Write;

/// Picture files with a line of facts for each.
pub struct ImageFolder;

impl Format for ImageFolder {
    const NAME: &'static str = "imagefolder";
    const DOC: &'static str = "ImageFolder: files of colours, depth and labels with a line of facts for each frame";
    type Options = PictureAndTextOptions;

    fn write(options: &PictureAndTextOptions, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        for split in source.splits() {
            write_split(options, source, out, split)?;
        }
        let mut front_matter = String::from("configs:\n- config_name: default\n  data_files:\n");
        for split in source.splits() {
            front_matter.push_str(&format!("  - split: {split}\n    path: {split}/**\n"));
        }
        let mut body = BODY.replace("SPLIT", source.splits().first().copied().unwrap_or_default());
        for channel in source.channels_on_request()? {
            body.push_str(&format!("\n`{}`: {}\n", channel.name, channel.doc));
        }
        ExportCard { format: "ImageFolder", front_matter, body }.write(source, out)?;
        Ok(vec![])
    }
}

fn write_split(options: &PictureAndTextOptions, source: &Source<'_>, out: &OutFolder, split: &str) -> Result<()> {
    let name = format!("{split}/metadata.jsonl");
    let mut file = out.create(&name)?;
    let mut number = 0;
    source.each_flight_of(&|flight| flight.split == split, &mut |episode| {
        let (flight, rows) = (episode.flight, &episode.frames[..]);
        let text = episode.instruction(options.instructions.language);
        episode.each_picture(
            &episode.every_nth_frame(options.pictures.every),
            |frame, logged| {
                let size = [logged.width, logged.height];
                let mut line = frame_facts(flight, &rows[frame], frame, text);
                let mut pictures = vec![
                    ("image_file_name".to_owned(), "rgb", ending(&logged.rgb_format), logged.rgb_file.clone()),
                    ("depth_file_name".to_owned(), "depth", "png", depth_png(&logged.depth_m, size)?),
                    ("semantic_file_name".to_owned(), "semantic", "png", gray8_png(&logged.semantic, size)?),
                ];
                for image in &logged.on_request {
                    let (ending, file) = (ending_on_request(image.channel), file_on_request(image, size)?);
                    // Columns called `..._file_name` are read as pictures.
                    let key = if ending == "png" { "file_name" } else { "path" };
                    pictures.push((format!("{}_{key}", image.channel.name), image.channel.name, ending, file));
                }
                for (key, kind, ending, bytes) in pictures {
                    let path = format!("{kind}/{}", picture_path(number, &flight.trajectory_id, frame, ending));
                    out.put(&format!("{split}/{path}"), &bytes)?;
                    line[key] = json!(path);
                }
                Ok(line)
            },
            |_, line| writeln!(file, "{line}").map_err(|error| out.refusal(&name, &error)),
        )?;
        number += 1;
        Ok(())
    })?;
    file.flush().map_err(|error| out.refusal(&name, &error))
}

const BODY: &str = "\
```python
import datasets
rows = datasets.load_dataset(\"imagefolder\", data_files={\"SPLIT\": \"SPLIT/**\"}, split=\"SPLIT\")
rows[0][\"image\"], rows[0][\"depth\"], rows[0][\"semantic\"], rows[0][\"instruction\"]
```

`<split>/metadata.jsonl` has a line per frame: paths of the pictures, flight, frame, time, poses (m and degrees, CARLA's axes),
target, boxes (left, top, right, bottom; null where nothing is seen), instruction. Depth is 16 bits: centimetres along the optical
axis, at most 65,534; 65,535 is the sky. Labels are CARLA's.
";
