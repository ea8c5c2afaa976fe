//! The reported metrics: each is the mean of a value over windows (or over boxes).

use crate::boxes::iou;
use crate::waypoint::{LastingErrors, WaypointErrors};
use serde::Serialize;

/// Direction of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// Larger values are better.
    Higher,
    /// Smaller values are better.
    Lower,
}

/// Unit of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Share, 0..=1; shown in percent.
    Share,
    /// Metres.
    Metres,
    /// Degrees.
    Degrees,
    /// Metres and degrees in one number.
    Mixed,
    /// Number without unit, 0..=1.
    Plain,
}

/// Names and meaning of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Metric {
    /// Key in JSON.
    pub key: &'static str,
    /// Name in tables.
    pub name: &'static str,
    /// Unit of the values.
    pub unit: Unit,
    /// Direction of the metric.
    pub better: Better,
    /// Definition in one line.
    pub meaning: &'static str,
}

const fn metric(key: &'static str, name: &'static str, unit: Unit, better: Better, meaning: &'static str) -> Metric {
    Metric { key, name, unit, better, meaning }
}

const fn share(key: &'static str, name: &'static str, meaning: &'static str) -> Metric {
    metric(key, name, Unit::Share, Better::Higher, meaning)
}

/// Number of metrics.
pub const COUNT: usize = 19;

/// Metrics of whole flights; these are the first ones.
const OF_FLIGHTS: usize = 2;

/// Index of the first metric of boxes; these are the last ones.
pub const FIRST_OF_BOXES: usize = 17;

/// All metrics, in the order of tables.
pub const METRICS: [Metric; COUNT] = {
    use Better::{Higher, Lower};
    use Unit::{Degrees, Metres, Mixed, Plain, Share};
    [
        metric(
            "lasting_m",
            "Lasting error",
            Metres,
            Lower,
            "length of a flight's mean error of the last waypoint along the heading, mean over flights",
        ),
        metric(
            "lasting_turn_deg",
            "Lasting turn",
            Degrees,
            Lower,
            "length of a flight's mean error of pitch and yaw at the last waypoint, mean over flights",
        ),
        metric("sr_0_5m", "SR@0.5m", Share, Higher, "windows whose last waypoint is within 0.5 m of the truth"),
        metric("sr_1m", "SR@1m", Share, Higher, "windows whose last waypoint is within 1 m"),
        metric("sr_2m", "SR@2m", Share, Higher, "windows whose last waypoint is within 2 m"),
        metric("ade_m", "ADE", Metres, Lower, "mean distance from the truth over all waypoints"),
        metric("fde_m", "FDE", Metres, Lower, "distance from the truth at the last waypoint"),
        metric("rot_acc_1deg", "RotAcc@1", Share, Higher, "windows whose yaw at the last waypoint is within 1 degree"),
        metric("rot_acc_5deg", "RotAcc@5", Share, Higher, "windows whose yaw at the last waypoint is within 5 degrees"),
        metric("yaw_mae_deg", "Yaw MAE", Degrees, Lower, "mean absolute yaw error over all waypoints"),
        metric(
            "joint_sr_0_5m_1deg",
            "JointSR@(0.5m,1)",
            Share,
            Higher,
            "within 0.5 m and 1 degree of yaw at the last waypoint",
        ),
        metric(
            "joint_sr_1m_5deg",
            "JointSR@(1m,5)",
            Share,
            Higher,
            "within 1 m and 5 degrees of yaw at the last waypoint",
        ),
        metric("mae", "MAE", Mixed, Lower, "mean absolute error of all six numbers, metres and degrees mixed"),
        metric("position_mae_m", "MAE position", Metres, Lower, "mean absolute error of x, y, z"),
        metric("rotation_mae_deg", "MAE rotation", Degrees, Lower, "mean absolute error of pitch, yaw, roll"),
        metric("final_yaw_mae_deg", "Yaw MAE final", Degrees, Lower, "mean absolute yaw error at the last waypoint"),
        metric("hard_fail", "HardFail", Share, Lower, "windows with a final error of more than 10 m"),
        metric("miou", "mIoU", Plain, Higher, "mean intersection over union of predicted and true target boxes"),
        metric("iou_0_75", "IoU>=0.75", Share, Higher, "boxes that overlap the true one by at least 0.75"),
    ]
};

/// Sums and numbers of values per metric; their means are the scores.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Sum of the values of each metric.
    pub sums: [f64; COUNT],
    /// Number of windows.
    pub windows: f64,
    /// Number of boxes.
    pub boxes: f64,
}

impl Tally {
    /// Adds the waypoints of a window.
    pub fn add_window(&mut self, errors: &WaypointErrors) {
        let share = |holds: bool| f64::from(u8::from(holds));
        let (fde, yaw) = (errors.fde_m, errors.final_yaw_deg);
        let values = [
            share(fde <= 0.5),
            share(fde <= 1.0),
            share(fde <= 2.0),
            errors.ade_m,
            fde,
            share(yaw <= 1.0),
            share(yaw <= 5.0),
            errors.yaw_mae_deg,
            share(fde <= 0.5 && yaw <= 1.0),
            share(fde <= 1.0 && yaw <= 5.0),
            errors.mae,
            errors.position_mae_m,
            errors.rotation_mae_deg,
            yaw,
            share(fde > 10.0),
        ];
        for (sum, value) in self.sums[OF_FLIGHTS..].iter_mut().zip(values) {
            *sum += value;
        }
        self.windows += 1.0;
    }

    /// Adds the lasting errors of a flight whose windows have been added; its weight is the number of its windows.
    pub fn add_lasting(&mut self, lasting: &LastingErrors) {
        for (sum, value) in self.sums.iter_mut().zip(lasting.lengths()) {
            *sum += value;
        }
    }

    /// Adds a predicted box; a missing one has an overlap of 0.
    pub fn add_box(&mut self, predicted: Option<&[f64; 4]>, truth: &[f64; 4]) {
        let overlap = predicted.map_or(0.0, |predicted| iou(predicted, truth));
        self.sums[FIRST_OF_BOXES] += overlap;
        self.sums[FIRST_OF_BOXES + 1] += f64::from(u8::from(overlap >= 0.75));
        self.boxes += 1.0;
    }

    /// Adds another tally.
    pub fn add(&mut self, other: &Self) {
        self.add_times(other, 1.0);
    }

    /// Adds another tally `times` times.
    pub fn add_times(&mut self, other: &Self, times: f64) {
        for (sum, more) in self.sums.iter_mut().zip(&other.sums) {
            *sum += times * more;
        }
        self.windows += times * other.windows;
        self.boxes += times * other.boxes;
    }

    /// Scores; `None` for metrics without values.
    pub fn means(&self) -> [Option<f64>; COUNT] {
        core::array::from_fn(|metric| {
            let number = if metric < FIRST_OF_BOXES { self.windows } else { self.boxes };
            (number > 0.0).then(|| self.sums[metric] / number)
        })
    }
}

/// Metrics of depth images: means over images.
pub const OF_DEPTH: [Metric; 3] = {
    use Better::{Higher, Lower};
    [
        metric(
            "abs_rel",
            "AbsRel",
            Unit::Plain,
            Lower,
            "mean of |predicted - true| / true over pixels, then over images",
        ),
        metric("rmse_m", "RMSE", Unit::Metres, Lower, "root mean square of predicted - true, then mean over images"),
        metric("delta1", "delta1", Unit::Share, Higher, "pixels with max(predicted / true, true / predicted) < 1.25"),
    ]
};

/// Metrics of label images.
pub const OF_LABELS: [Metric; 2] = {
    use Better::Higher;
    [
        metric(
            "miou",
            "mIoU",
            Unit::Plain,
            Higher,
            "intersection over union of a class over all images at once, mean over the classes that occur",
        ),
        metric("pixel_accuracy", "Pixel accuracy", Unit::Share, Higher, "pixels whose label is right"),
    ]
};

/// Metrics of detected boxes or masks: means over the classes with true objects.
pub const OF_DETECTIONS: [Metric; 4] = {
    use Better::Higher;
    [
        metric("ap50", "AP50", Unit::Share, Higher, "COCO's average precision at an overlap of 0.5"),
        metric("ap75", "AP75", Unit::Share, Higher, "COCO's average precision at an overlap of 0.75"),
        metric("ap", "AP", Unit::Share, Higher, "COCO's average precision, mean over overlaps 0.5, 0.55 ... 0.95"),
        metric(
            "mean_overlap",
            "mIoU",
            Unit::Plain,
            Higher,
            "mean over true objects of the overlap of the detection of their class that overlaps them most; 0 for none",
        ),
    ]
};

/// Metrics of trackers of many bodies, TrackEval's: means over the classes with true boxes.
pub const OF_TRACKS: [Metric; 5] = [
    share("hota", "HOTA", "geometric mean of DetA and AssA, mean over overlaps 0.05, 0.1 ... 0.95"),
    share("det_a", "DetA", "matched boxes among true and found ones, mean over the overlaps of HOTA"),
    share(
        "ass_a",
        "AssA",
        "matches of two tracks among the boxes of both, mean over matched boxes, then over overlaps",
    ),
    share("idf1", "IDF1", "F1 of the boxes of true and found tracks in their best pairs for the whole sequence"),
    share("mota", "MOTA", "1 - (missed boxes + false boxes + changes of identity) / true boxes; may be below 0"),
];

/// Metrics of trackers of one target, got10k's: means over pictures that show the target, then over sequences.
pub const OF_TARGETS: [Metric; 3] = [
    share("success", "Success", "pictures whose overlap is above a threshold, mean over thresholds 0, 0.05 ... 1"),
    share("precision", "Precision", "pictures whose middle is within 20 pixels of the true one"),
    share(
        "normalised_precision",
        "Normalised precision",
        "pictures whose middle is within a share of the target's size, mean over shares 0, 0.01 ... 0.5",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_count_as_reached_and_a_hard_fail_is_beyond_ten_metres() {
        let mut tally = Tally::default();
        tally.add_window(&WaypointErrors { fde_m: 0.5, final_yaw_deg: 1.0, ..Default::default() });
        tally.add_window(&WaypointErrors { fde_m: 10.0, final_yaw_deg: 1.5, ..Default::default() });
        let means = tally.means();
        let of = |key: &str| means[METRICS.iter().position(|metric| metric.key == key).unwrap()];
        assert_eq!((of("sr_0_5m"), of("joint_sr_0_5m_1deg"), of("hard_fail")), (Some(0.5), Some(0.5), Some(0.0)));
        assert_eq!((of("fde_m"), of("miou")), (Some(5.25), None));
    }
}
