//! The Hugging Face card (`README.md`) and the `LICENSE` file.

use super::citation::citation;
use super::summary::Summary;
use super::viewers;
use cosfly_diagnose::{counted, visible_text};
use cosfly_plot::text::{markdown, markdown_code, markdown_words, quoted};
use cosfly_schema::config::{DatasetConfig, OWN_LICENSE};
use cosfly_schema::extras::{self, ExtraShape, ExtraSummary};
use cosfly_schema::flight_table::ColumnKind;
use cosfly_schema::tables::{self, Table};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Licences that Hugging Face knows by name; any other needs `license_name` and `license_link`.
const KNOWN_LICENSES: [&str; 14] = [
    "apache-2.0",
    "cc",
    "cc-by-2.0",
    "cc-by-4.0",
    "cc-by-nc-4.0",
    "cc-by-nc-nd-4.0",
    "cc-by-nc-sa-4.0",
    "cc-by-nd-4.0",
    "cc-by-sa-4.0",
    "cc0-1.0",
    "cdla-permissive-2.0",
    "mit",
    "odbl",
    "odc-by",
];

/// The text of `LICENSE`.
pub fn license_text(config: &DatasetConfig) -> String {
    let license = &config.license;
    match (license.text.trim_end(), license.name.as_str()) {
        ("", OWN_LICENSE) => include_str!("../../assets/LICENSE-data.txt").to_owned(),
        ("", name) => format!("The data in this folder are licensed under {name}.\n{}\n", license.url),
        (text, _) => format!("{text}\n"),
    }
}

/// The text of `README.md`.
pub fn readme(config: &DatasetConfig, summary: &Summary) -> String {
    let mut text = front_matter(config, summary);
    let _ = write!(text, "\n# {}\n\n{}\n\n", markdown(&config.title), visible_text(&config.description));
    text.push_str(&figures(config, summary));
    text.push_str(&loading(config, summary));
    let camera = match summary.has_lens {
        true => "the lens that `camera_lens_model` and `camera_k1` to `camera_k4` of table `trajectories` state",
        false => "pinhole without distortion",
    };
    text.push_str(&CONVENTIONS.replace("pinhole without distortion", camera));
    if summary.has_depth_along_rays {
        text.push_str("* Depth where `camera_depth_is_along_rays` is true: along the ray of the pixel, not along the optical axis.\n");
    }
    for channel in summary.channels.iter().filter(|channel| channel.is_on_request()) {
        let _ = writeln!(text, "* Channel `{}`: {}", channel.name, channel.doc);
    }
    text.push('\n');
    text.push_str("## Tables\n\n");
    tables::of_trajectories().iter().for_each(|table| text.push_str(&table_section(table)));
    text.push_str(&table_section(&tables::of_objects()));
    text.push_str(&table_section(&tables::of_rejections()));
    text.push_str(&table_section(&tables::of_files()));
    summary.extras.iter().for_each(|kept| text.push_str(&extra_section(kept)));
    text.push_str(&invented(summary));
    text.push_str(&super::datasheet::section(config, summary));
    let _ = write!(
        text,
        "## Responsible use\n\n{}\n\n## Licence\n\nThe data: {} ({}), see `LICENSE`. The software that made them: MIT OR \
         Apache-2.0.\n\n## Citation\n\n```bibtex\n{}\n```\n",
        config.license.responsible_use.trim(),
        markdown(&config.license.name),
        markdown(&config.license.url),
        citation(config)
    );
    text
}

fn front_matter(config: &DatasetConfig, summary: &Summary) -> String {
    let mut text = format!("---\npretty_name: {}\n", quoted(&config.title));
    let license = &config.license;
    if KNOWN_LICENSES.contains(&license.name.as_str()) {
        let _ = writeln!(text, "license: {}", license.name);
    } else {
        let (name, link) = (quoted(&license.name), quoted(&license.url));
        let _ = write!(text, "license: other\nlicense_name: {name}\nlicense_link: {link}\n");
    }
    let size = match summary.frames {
        0..1_000 => "n<1K",
        1_000..10_000 => "1K<n<10K",
        10_000..100_000 => "10K<n<100K",
        100_000..1_000_000 => "100K<n<1M",
        1_000_000..10_000_000 => "1M<n<10M",
        _ => "10M<n<100M",
    };
    let languages: String = summary.text_languages().iter().map(|code| format!("- {code}\n")).collect();
    let _ = writeln!(text, "size_categories:\n- {size}\nlanguage:\n{languages}task_categories:\n- robotics");
    text.push_str("- depth-estimation\n- image-segmentation\n- image-text-to-text\n");
    text.push_str("tags:\n- croissant\n- mcap\n- drone\n- uav\n- tracking\n- trajectory\n- synthetic\nconfigs:\n");
    table_names().iter().for_each(|name| text.push_str(&config_entry(name, summary)));
    for ExtraSummary { source, rows, .. } in &summary.extras {
        text.push_str(&config_of(&source.name, rows));
    }
    text.push_str("- config_name: files\n  data_files:\n  - split: files\n    path: files.parquet\n---\n");
    text
}

/// All tables with splits.
fn table_names() -> Vec<&'static str> {
    let others = [tables::of_objects().name, tables::of_rejections().name];
    tables::of_trajectories().iter().map(|table| table.name).chain(others).collect()
}

/// The Hugging Face config of a table.
fn config_entry(table: &str, summary: &Summary) -> String {
    summary.rows.get(table).map_or_else(String::new, |rows| config_of(table, rows))
}

/// Splits without rows are left out, because they keep the loader from reading the others. A table without any row keeps its
/// config, with all its files: its names and types are known, and its stream has no rows.
fn config_of(table: &str, rows: &BTreeMap<String, u64>) -> String {
    let is_empty = rows.values().all(|rows| *rows == 0);
    let splits = rows.iter().filter(|(_, rows)| is_empty || **rows > 0);
    let files: String =
        splits.map(|(split, _)| format!("  - split: {split}\n    path: data/{table}/{split}-*.parquet\n")).collect();
    if files.is_empty() {
        return String::new();
    }
    let default = if table == "trajectories" { "  default: true\n" } else { "" };
    format!("- config_name: {table}\n{default}  data_files:\n{files}")
}

fn figures(config: &DatasetConfig, summary: &Summary) -> String {
    let sizes: Vec<String> = summary.image_sizes.iter().map(|(width, height)| format!("{width} x {height}")).collect();
    let mut text = String::from("## In figures\n\n| | |\n| --- | --- |\n");
    let mut row = |name: &str, value: String| {
        let _ = writeln!(text, "| {name} | {value} |");
    };
    row("flights", format!("{} expert, {} perturbed", summary.experts, summary.perturbed));
    row("targets", summary.pedestrians.len().to_string());
    row("frames", summary.frames.to_string());
    row("time flown", format!("{:.1} min", summary.duration_s / 60.0));
    row("image size", sizes.join(", "));
    row("mean visibility of the target (by rays)", summary.mean_visibility());
    row("flights whose certificate does not hold", summary.uncertified.to_string());
    row("items without a flight", format!("{}, each with its reason in `rejected`", summary.rejected));
    row("logs", format!("{:.1} MB", summary.mcap_bytes as f64 / 1e6));
    row("weather", markdown(&summary.weathers.iter().cloned().collect::<Vec<_>>().join(", ")));
    if summary.rows.get("windows").is_none_or(|rows| rows.values().all(|&rows| rows == 0)) {
        let frames = config.windows.size;
        row("training windows", format!("none: no flight has the {frames} frames of one"));
    }
    let languages: Vec<String> = summary.languages.iter().cloned().collect();
    row(
        "languages of the captions",
        if languages.is_empty() { "none: no captions".into() } else { languages.join(", ") },
    );
    for (town, figures) in &summary.towns {
        row(&format!("town {}", markdown_code(town)), counted(figures.flights, "flight"));
    }
    for split in cosfly_schema::Split::ALL {
        let (flights, frames) = summary.splits.get(split.name()).copied().unwrap_or_default();
        row(
            &format!("split `{}`", split.name()),
            format!("{}, {}", counted(flights, "flight"), counted(frames, "frame")),
        );
    }
    text.push_str("\nFlights behind one target, and behind targets whose ways overlap, are always in the same split (`splits.json`). `report/index.html` shows all of this as a page: maps, \
         curves, distributions, worst cases with their pictures.\n\n");
    text
}

/// How to load: everything in ```python``` runs as it stands in the dataset's folder; `tests/outside/check_snippets.py` does it.
fn loading(config: &DatasetConfig, summary: &Summary) -> String {
    let rows =
        |table: &str, split: &str| summary.rows.get(table).and_then(|rows| rows.get(split)).copied().unwrap_or(0);
    let used = |table: &str| cosfly_schema::Split::ALL.iter().map(|it| it.name()).find(|split| rows(table, split) > 0);
    let others: Vec<&str> =
        table_names().into_iter().filter(|name| *name != "frames" && used(name).is_some()).collect();
    let mut text = String::from("## How to load\n\nIn this folder:\n\n```python\n");
    text.push_str(&LOADING.replace("SPLIT", used("frames").unwrap_or("train")).replace("OTHERS", &others.join(", ")));
    text.push_str("```\n\n");
    text.push_str(&without_rows(summary));
    if let Some(split) = used("windows").filter(|split| rows("captions", split) > 0) {
        text.push_str("Training windows with their instructions and pictures:\n\n```python\n");
        text.push_str(&JOINING.replace("SPLIT", split).replace("HISTORY", &config.windows.history.to_string()));
        text.push_str("```\n\n");
    }
    let _ = write!(
        text,
        "{}\n\n`sha256sum -c SHA256SUMS` checks `files.parquet` and `croissant.json`; `files.parquet` holds the hash of every \
         other file; `cosfly verify .` checks everything. In a folder that `cosfly run` wrote, `.cosfly-version` is no part of \
         the dataset and in no list: by it `cosfly run` knows a folder that it may replace; leave it out of uploads.\n\nVersion {} of {}, published {}.\n\n",
        viewers::USE,
        config.version,
        config.name,
        config.date_published
    );
    text
}

/// How tables without rows load, where there are some.
fn without_rows(summary: &Summary) -> String {
    let is_empty = |rows: &BTreeMap<String, u64>| !rows.is_empty() && rows.values().all(|rows| *rows == 0);
    let own = table_names().into_iter().filter(|name| summary.rows.get(*name).is_some_and(is_empty));
    let given = summary.extras.iter().filter(|kept| is_empty(&kept.rows)).map(|kept| kept.source.name.as_str());
    let names: Vec<String> = own.chain(given).map(|name| format!("`{name}`")).collect();
    if names.is_empty() {
        return String::new();
    }
    format!(
        "Tables without rows in this dataset: {}. Their files have all columns, so pyarrow, DuckDB, polars and \
         `load_dataset(FOLDER, NAME, streaming=True)` read 0 rows; without `streaming=True`, `datasets` refuses a table \
         without rows (\"corresponds to no data\").\n\n",
        names.join(", ")
    )
}

const LOADING: &str = "\
from datasets import load_dataset
frames = load_dataset(\"parquet\", data_files={\"SPLIT\": \"data/frames/SPLIT-*.parquet\"}, split=\"SPLIT\")
# tables: frames, OTHERS

import pyarrow.dataset as ds
table = ds.dataset(\"data/frames\").to_table(filter=ds.field(\"split\") == \"SPLIT\")

import mlcroissant  # one Dataset object reads one record set; make another for the next
records = mlcroissant.Dataset(\"croissant.json\").records(\"trajectories\")

import glob
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
with open(sorted(glob.glob(\"mcap/*/*/*.mcap\"))[0], \"rb\") as log:
    reader = make_reader(log, decoder_factories=[DecoderFactory()])
    for schema, channel, message, depth in reader.iter_decoded_messages([\"/camera/depth/image\"], starting_at=0):
        print(depth.width, depth.height, depth.encoding, len(depth.data))  # `32FC1`: 32-bit floats, metres
        break
";

const JOINING: &str = "\
import io
import pyarrow.dataset as ds
from PIL import Image

windows = ds.dataset(\"data/windows\").to_table(filter=ds.field(\"split\") == \"SPLIT\")
captions = {row[\"caption_id\"]: row for row in ds.dataset(\"data/captions\").to_table().to_pylist()}
for window in windows.slice(0, 4).to_pylist():
    instructions = [window[\"instruction_en\"]] + [captions[it][\"text\"] for it in window[\"caption_ids\"]]
    seen = [window[\"start_frame\"] + i for i in range(HISTORY)]
    is_seen = (ds.field(\"trajectory_id\") == window[\"trajectory_id\"]) & ds.field(\"frame\").isin(seen)
    rows = ds.dataset(\"data/frames\").to_table(columns=[\"frame\", \"preview\"], filter=is_seen).sort_by(\"frame\").to_pylist()
    pictures = [Image.open(io.BytesIO(row[\"preview\"][\"bytes\"])) for row in rows if row[\"preview\"]]
    print(instructions, [picture.size for picture in pictures])
";

const CONVENTIONS: &str = "## Conventions\n\n\
* Tables: CARLA's world frame, left-handed, x east, y south, z up, metres; angles in degrees; positive yaw turns x \
towards y, positive pitch lifts the nose, positive roll lowers the right side.\n\
* Logs: right-handed frame `map` with x east, y north, z up (y changes sign); `drone` x ahead, y left, z up; \
`camera_optical` x right, y down, z ahead. Frame i is at i * dt after time 0.\n\
* Camera: pinhole without distortion, square pixels, optical centre in the image centre; pixel (0, 0) is the top-left \
one and its centre is at (0.5, 0.5).\n\
* Depth: planar, along the optical axis, metres, 32-bit float, +inf for sky.\n\
* Semantic images: CARLA's label ids (0.9.14 and later). Instance images: 0 ground and sky, 1 the target, object id + \
2 (table `objects`), then people, vehicles and drones (table `bodies`).\n\
* Boxes: left, top, right, bottom edges in pixels; right and bottom lie outside.\n\
* Words in texts: the left of a picture is left of 0.3 of its width, the middle from 0.4 to 0.6, the right beyond 0.7, by the \
middle of the visible box. A turn to a side is a bend of 60 to 125 degrees within 12 m, by chords of 3 and 5 m; a turn around leads \
back within 3 m and 6 s of walking; texts name no turns where some bend may or may not be one. Soon: the first turn comes in the \
first fifth of the time and the first 6 s; late: in the second half and after 10 s. Distances and angles are means of the flight; \
a pace is the length over the time, without the stops where the text says so.\n";

fn table_section<S>(table: &Table<S>) -> String {
    let mut text = format!("### {}\n\n{}\n\n| column | type | meaning |\n| --- | --- | --- |\n", table.name, table.doc);
    for column in &table.columns {
        let null = if column.nullable() { " or null" } else { "" };
        let _ = writeln!(text, "| `{}` | {}{null} | {} |", column.name(), column.kind().words(), column.doc());
    }
    text.push('\n');
    text
}

/// A table or a folder that a plugin gave.
fn extra_section(kept: &ExtraSummary) -> String {
    let source = &kept.source;
    let giver = if source.shape == ExtraShape::Readings { "sensor" } else { "plugin" };
    let mut text = format!(
        "### {}\n\nGiven by the {giver} {} {}: {}",
        markdown(&source.name),
        markdown_code(&source.plugin),
        markdown(&source.version),
        markdown(&source.summary)
    );
    if source.shape == ExtraShape::Files {
        let _ = write!(
            text,
            "\n\n{}, `extras/{}/TOWN/NUMBER/TRAJECTORY/...`, beside each other as the logs are.\n\n",
            counted(kept.files, "file"),
            source.name
        );
        return text;
    }
    text.push_str("\n\n| column | type | meaning |\n| --- | --- | --- |\n");
    for column in extras::columns_of(source) {
        let kind = match column.kind {
            ColumnKind::Real => "float64",
            ColumnKind::Integer => "int64",
            ColumnKind::Boolean => "bool",
            ColumnKind::Text => "text",
            ColumnKind::Bytes => "bytes",
        };
        let _ = writeln!(text, "| {} | {kind} | {} |", markdown_code(&column.name), markdown_words(&column.doc));
    }
    text.push('\n');
    text
}

fn invented(summary: &Summary) -> String {
    let mut text = String::from(
        "## What is invented\n\nAll flights, people, vehicles and images are simulated. Beyond that, of the towns:\n\n",
    );
    for (town, figures) in &summary.towns {
        let _ = writeln!(text, "* {} (geometry BLAKE3 `{}`)", markdown_code(town), figures.geometry_digest);
        if figures.synthetic_notes.is_empty() {
            text.push_str("  * nothing was added to its map file\n");
        }
        figures.synthetic_notes.iter().for_each(|note| {
            let _ = writeln!(text, "  * {}", markdown_words(note));
        });
    }
    text.push('\n');
    text
}
