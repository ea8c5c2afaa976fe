//! COCO: pictures with boxes and masks of everything that has an instance id.

mod mask;

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::{ending, picture_path};
use crate::shared_options::PictureOptions;
use crate::source::Source;
use cosfly_diagnose::Result;
use cosfly_domain::{KEY_POINTS, SKELETON, SemanticLabel, TARGET_INSTANCE};
use cosfly_read::{SpaceReader, SpaceRow};
use mask::{Mask, masks};
use serde_json::{Map, Value, json};
use std::io::Write;

/// Boxes and masks.
pub struct Coco;

impl Format for Coco {
    const NAME: &'static str = "coco";
    const DOC: &'static str = "COCO: pictures, boxes and masks of all things, a file of annotations per split";
    type Options = PictureOptions;

    fn write(options: &PictureOptions, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        for split in source.splits() {
            write_split(options.every, source, out, split)?;
        }
        ExportCard {
            format: "COCO",
            front_matter: "task_categories:\n- object-detection\n- image-segmentation\n".into(),
            body: BODY.replace("SPLIT", source.splits().first().copied().unwrap_or_default()),
        }
        .write(source, out)?;
        Ok(vec![])
    }
}

/// Writes the file of a split from front to end: annotations while the pictures are read, then the list of pictures.
fn write_split(every: usize, source: &Source<'_>, out: &OutFolder, split: &str) -> Result<()> {
    let name = format!("annotations/instances_{split}.json");
    let mut file = out.create(&name)?;
    let refused = |error: std::io::Error| out.refusal(&name, &error);
    let categories: Vec<Value> = SemanticLabel::ALL.iter().map(category).collect();
    let mut in_space = SpaceReader::of(source.dataset)?;
    let head = json!({"description": source.name(), "contributor": "cosfly", "version": env!("CARGO_PKG_VERSION")});
    write!(file, "{{\"info\":{head},\"licenses\":[],\"categories\":{},\"annotations\":[", json!(categories))
        .map_err(refused)?;
    let (mut flight, mut image_id, mut annotation_id) = (0, 0u64, 0u64);
    let mut images: Vec<&str> = vec![];
    source.each_flight_of(&|flight| flight.split == split, &mut |episode| {
        let id = &episode.flight.trajectory_id;
        let place = source.dataset.place(id).unwrap_or_default();
        let rows = in_space.at(source.dataset, place)?;
        episode.each_picture(
            &episode.every_nth_frame(every),
            |frame, logged| {
                let ending = ending(&logged.rgb_format);
                let path = picture_path(flight, id, frame, ending);
                out.put(&format!("{split}/{path}"), &logged.rgb_file)?;
                let size = [logged.width, logged.height];
                Ok((ending, size, masks(&logged.instance, &logged.semantic, size)))
            },
            |frame, (ending, size, masks)| {
                image_id += 1;
                images.push(ending);
                for mask in masks {
                    let separator = if annotation_id == 0 { "" } else { ",\n" };
                    annotation_id += 1;
                    let row = rows.iter().find(|row| (row.frame as usize, row.instance) == (frame, mask.instance));
                    let mut annotation = annotation(&mask, annotation_id, image_id, size);
                    if let Some(row) = row.filter(|row| !row.key_points.is_empty()) {
                        annotation.extend(key_points(row));
                    }
                    let annotation = Value::Object(annotation);
                    write!(file, "{separator}{annotation}").map_err(refused)?;
                }
                Ok(())
            },
        )?;
        flight += 1;
        Ok(())
    })?;
    write!(file, "],\n\"images\":[").map_err(refused)?;
    let mut endings = images.into_iter().zip(1u64..);
    for (number, flight) in source.flights().filter(|flight| flight.split == split).enumerate() {
        for frame in (0..flight.frames).step_by(every.max(1)) {
            let Some((ending, image_id)) = endings.next() else { break };
            let image = json!({
                "id": image_id,
                "file_name": picture_path(number, &flight.trajectory_id, frame, ending),
                "width": flight.camera.width,
                "height": flight.camera.height,
                "trajectory_id": flight.trajectory_id,
                "frame": frame,
            });
            write!(file, "{}{image}", if image_id == 1 { "" } else { ",\n" }).map_err(refused)?;
        }
    }
    file.write_all(b"]}\n").and_then(|()| file.flush()).map_err(refused)
}

fn category(label: &SemanticLabel) -> Value {
    let mut category = json!({"id": label.id(), "name": label.name(), "supercategory": "carla"});
    if *label == SemanticLabel::Pedestrian {
        category["keypoints"] = json!(KEY_POINTS);
        // Counted from 1.
        category["skeleton"] = json!(SKELETON.map(|line| line.map(|end| end + 1)));
    }
    category
}

/// Key points as `person_keypoints` has them: right, down, and 0, 1 or 2 for each.
fn key_points(row: &SpaceRow) -> Map<String, Value> {
    let flat: Vec<f64> = row.key_points.iter().flat_map(|it| [it.pixel[0], it.pixel[1], f64::from(it.shown)]).collect();
    let count = row.key_points.iter().filter(|point| point.shown > 0).count();
    [("keypoints".to_owned(), json!(flat)), ("num_keypoints".to_owned(), json!(count))].into_iter().collect()
}

fn annotation(mask: &Mask, id: u64, image_id: u64, [width, height]: [u32; 2]) -> Map<String, Value> {
    let fields = json!({
        "id": id,
        "image_id": image_id,
        "category_id": mask.label,
        "bbox": mask.bbox,
        "area": mask.area,
        "iscrowd": 0,
        "segmentation": {"size": [height, width], "counts": mask.counts},
        "instance": mask.instance,
        "is_target": mask.instance == TARGET_INSTANCE,
    });
    match fields {
        Value::Object(fields) => fields,
        _ => Map::new(),
    }
}

const BODY: &str = "\
```
annotations/instances_<split>.json
<split>/<thousands of flights>/<flight>/<thousands of frames>/<frame>.jpg
```

```python
from PIL import Image
from pycocotools.coco import COCO

coco = COCO(\"annotations/instances_SPLIT.json\")
for image in coco.loadImgs(coco.getImgIds()):
    rgb = Image.open(\"SPLIT/\" + image[\"file_name\"])
    for person in coco.loadAnns(coco.getAnnIds(imgIds=[image[\"id\"]], catIds=[12])):
        left, top, width, height = person[\"bbox\"]
        mask = coco.annToMask(person)  # rows x columns, 1 where the person is seen
```

`file_name` is relative to the folder of the split. Category ids are CARLA's labels. Every thing with an id has an annotation
for its visible pixels: its box, its area and its mask as compressed run lengths; ground and sky have none. `instance` is the id
of the thing in its flight's log, `is_target` marks the one who is followed. Of datasets with key points (`bodies_3d`), people on
foot have `keypoints` and `num_keypoints`, as in COCO's `person_keypoints`: right, down, and 2 where the point is seen, 1 where it is
hidden, 0 out of the picture.
";
