//! Metrics of a JSON document on standard input, as JSON; the outside check compares them with independent software.

use cosfly_frames::{DVec3, Pose};
use cosfly_metrics::{LastingErrors, METRICS, Tally, bootstrap, boxes, errors};
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
    let (mut all, mut lasting) = (Tally::default(), LastingErrors::default()); // all windows are of one flight
    let mut clusters = vec![];
    let mut each = vec![];
    for window in rows(&given["windows"]) {
        let found = errors(&poses(&window["predicted"]), &poses(&window["truth"]));
        let mut tally = Tally::default();
        tally.add_window(&found);
        all.add(&tally);
        lasting.add(&found);
        clusters.push(tally);
        each.push(json!([found.ade_m, found.fde_m, found.final_yaw_deg, found.yaw_mae_deg, found.mae]));
    }
    all.add_lasting(&lasting);
    let mut ious = vec![];
    for pair in rows(&given["boxes"]) {
        let (predicted, truth) = (edges(&pair[0]), edges(&pair[1]));
        all.add_box(Some(&predicted), &truth);
        ious.push(boxes::iou(&predicted, &truth));
    }
    let means: serde_json::Map<String, Value> =
        METRICS.iter().zip(all.means()).map(|(metric, mean)| (metric.key.to_owned(), json!(mean))).collect();
    let intervals = bootstrap::intervals(&clusters, bootstrap::RESAMPLES, 1);
    println!("{}", json!({ "windows": each, "means": means, "iou": ious, "ade_interval": intervals[5] }));
}
