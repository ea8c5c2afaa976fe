//! Metrics of a JSON document on standard input, as JSON; the outside check compares them with independent software.

use cosfly_frames::{DVec3, Pose};
use cosfly_metrics::detection::{ImageDetections, average_precision};
use cosfly_metrics::segmentation::Confusion;
use cosfly_metrics::{METRICS, Tally, bootstrap, boxes, depth, errors};
use serde_json::{Value, json};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

fn poses(value: &Value) -> Vec<Pose> {
    let pose = |row: &Value| {
        let n = numbers(row);
        Pose {
            position_in_world: DVec3::new(n[0], n[1], n[2]),
            pitch_rad: n[3].to_radians(),
            yaw_rad: n[4].to_radians(),
            roll_rad: n[5].to_radians(),
        }
    };
    value.as_array().into_iter().flatten().map(pose).collect()
}

fn edges(value: &Value) -> [f64; 4] {
    numbers(value).try_into().expect("four edges")
}

fn rows(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn main() {
    let given: Value = serde_json::from_reader(std::io::stdin().lock()).expect("JSON");
    let mut all = Tally::default();
    let mut clusters = vec![];
    let mut each = vec![];
    for window in rows(&given["windows"]) {
        let found = errors(&poses(&window["predicted"]), &poses(&window["truth"]));
        let mut tally = Tally::default();
        tally.add_window(&found);
        all.add(&tally);
        clusters.push(tally);
        each.push(json!([found.ade_m, found.fde_m, found.final_yaw_deg, found.yaw_mae_deg, found.mae]));
    }
    let mut ious = vec![];
    for pair in rows(&given["boxes"]) {
        let (predicted, truth) = (edges(&pair[0]), edges(&pair[1]));
        all.add_box(Some(&predicted), &truth);
        ious.push(boxes::iou(&predicted, &truth));
    }
    let means: serde_json::Map<String, Value> =
        METRICS.iter().zip(all.means()).map(|(metric, mean)| (metric.key.to_owned(), json!(mean))).collect();
    let floats = |value: &Value| numbers(value).iter().map(|x| *x as f32).collect::<Vec<_>>();
    let depths: Vec<Value> = rows(&given["depth"])
        .map(|image| depth::depth_scores(&floats(&image["predicted"]), &floats(&image["truth"]), 80.0))
        .map(|scores| scores.map_or(Value::Null, |it| json!([it.abs_rel, it.rmse_m, it.delta1])))
        .collect();
    let labels = |value: &Value| numbers(value).iter().map(|x| *x as u8).collect::<Vec<_>>();
    let mut confusion = Confusion::new(29);
    for image in rows(&given["labels"]) {
        confusion.add(&labels(&image["predicted"]), &labels(&image["truth"]));
    }
    let images: Vec<ImageDetections> = rows(&given["detections"])
        .map(|image| {
            let truth: Vec<[f64; 4]> = rows(&image["truth"]).map(edges).collect();
            let overlaps =
                rows(&image["predicted"]).map(|it| truth.iter().map(|t| boxes::iou(&edges(it), t)).collect());
            ImageDetections { scores: numbers(&image["scores"]), overlaps: overlaps.collect(), objects: truth.len() }
        })
        .collect();
    let precision = average_precision(&images).map(|it| json!([it.ap50, it.ap75, it.ap]));
    let intervals = bootstrap::intervals(&clusters, bootstrap::RESAMPLES, 1);
    println!(
        "{}",
        json!({
            "windows": each, "means": means, "iou": ious, "depth": depths, "class_iou": confusion.class_iou(),
            "mean_iou": confusion.mean_iou(), "average_precision": precision, "ade_interval": intervals[3],
        })
    );
}
