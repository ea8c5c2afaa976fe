"""Compares our metrics with evo, trajnetplusplustools, pycocotools, scikit-learn and scipy on random data.

    cargo build --profile ci -p cosfly-metrics --example metrics_of_stdin
    venv/bin/python tests/outside/check_metrics.py target/ci/examples/metrics_of_stdin [--seed N]

Each check prints one line. Exit code 0: everything agrees to 1e-9.
"""

import argparse
import contextlib
import io
import json
import subprocess

import numpy as np

TOLERANCE = 1e-9


def require(name, ours, theirs):
    """Both must have the same shape and be equal to the tolerance."""
    ours, theirs = np.asarray(ours, dtype=float), np.asarray(theirs, dtype=float)
    worst = np.abs(ours - theirs).max() if ours.size else 0.0
    if ours.shape != theirs.shape or not worst <= TOLERANCE:
        raise SystemExit(f"check_metrics: {name} differs by {worst}:\n ours {ours}\n theirs {theirs}")
    print(f"ok  {name:<44} {ours.size} numbers, largest difference {worst:.1e}", flush=True)


def random_windows(rng, windows=300, steps=5):
    truth = np.concatenate([rng.uniform(-60, 60, (windows, steps, 3)), rng.uniform(-180, 180, (windows, steps, 3))], axis=2)
    scale = rng.choice([0.1, 0.7, 3.0, 40.0], (windows, 1, 1))
    noise = rng.normal(0, 1, (windows, steps, 6)) * scale
    return truth, truth + noise


def check_waypoints(ours, truth, predicted):
    """Distances against evo's absolute pose error and trajnet++ (planar), angles against scipy, shares by hand."""
    from evo.core import metrics, trajectory
    from scipy.spatial.transform import Rotation
    from trajnetplusplustools import TrackRow
    from trajnetplusplustools.metrics import average_l2, final_l2

    each = np.array(ours["windows"])

    def path(poses, yaw_only):
        angles = poses[:, 4] if yaw_only else np.zeros(len(poses))
        quaternions = Rotation.from_euler("z", angles[:, None], degrees=True).as_quat()[:, [3, 0, 1, 2]]
        return trajectory.PoseTrajectory3D(poses[:, :3], quaternions, np.arange(len(poses)) * 0.5)

    ade, fde, yaw = [], [], []
    for true, guess in zip(truth, predicted):
        ape = metrics.APE(metrics.PoseRelation.translation_part)
        ape.process_data((path(true, False), path(guess, False)))
        ade.append(ape.get_statistic(metrics.StatisticsType.mean))
        fde.append(ape.error[-1])
        turn = metrics.APE(metrics.PoseRelation.rotation_angle_deg)
        turn.process_data((path(true, True), path(guess, True)))
        yaw.append(turn.error)
    yaw = np.array(yaw)
    require("ADE against evo", each[:, 0], ade)
    require("FDE against evo", each[:, 1], fde)
    require("yaw error of last waypoints against evo", each[:, 2], yaw[:, -1])
    require("mean yaw error against evo", each[:, 3], yaw.mean(axis=1))

    flat_truth, flat_guess = truth.copy(), predicted.copy()
    flat_truth[:, :, 2] = flat_guess[:, :, 2] = 20.0
    flat = np.array(call(binary, {"windows": rows_of(flat_truth, flat_guess)})["windows"])
    rows = lambda poses: [TrackRow(frame, 1, x, y) for frame, (x, y) in enumerate(poses[:, :2])]
    steps = truth.shape[1]
    require("planar ADE against trajnet++", flat[:, 0], [average_l2(rows(t), rows(g), n_predictions=steps) for t, g in zip(flat_truth, flat_guess)])
    require("planar FDE against trajnet++", flat[:, 1], [final_l2(rows(t), rows(g)) for t, g in zip(flat_truth, flat_guess)])

    from sklearn.metrics import mean_absolute_error

    wrapped = (predicted - truth).reshape(-1, 6)
    wrapped[:, 3:] = (wrapped[:, 3:] + 180) % 360 - 180
    zeros = np.zeros_like(wrapped)
    means = ours["means"]
    require("MAE against scikit-learn", means["mae"], mean_absolute_error(zeros, wrapped))
    require("MAE of positions against scikit-learn", means["position_mae_m"], mean_absolute_error(zeros[:, :3], wrapped[:, :3]))
    require("MAE of rotations against scikit-learn", means["rotation_mae_deg"], mean_absolute_error(zeros[:, 3:], wrapped[:, 3:]))
    fde, last = np.array(fde), yaw[:, -1]
    for key, share in {
        "sr_0_5m": fde <= 0.5, "sr_1m": fde <= 1, "sr_2m": fde <= 2, "rot_acc_1deg": last <= 1, "rot_acc_5deg": last <= 5,
        "joint_sr_0_5m_1deg": (fde <= 0.5) & (last <= 1), "joint_sr_1m_5deg": (fde <= 1) & (last <= 5), "hard_fail": fde > 10,
    }.items():
        require(f"{key} by evo's errors", means[key], share.mean())


def check_interval(ours):
    """A 95 % interval by our resamples against scipy's: only as near as resampling allows."""
    from scipy.stats import bootstrap

    ade = np.array(ours["windows"])[:, 0]
    theirs = bootstrap((ade,), np.mean, n_resamples=9999, method="percentile", random_state=1).confidence_interval
    width = theirs.high - theirs.low
    for mine, other in zip(ours["ade_interval"], theirs):
        if abs(mine - other) > 0.08 * width:
            raise SystemExit(f"check_metrics: interval {ours['ade_interval']} is not near scipy's {theirs}")
    print(f"ok  {'95 % interval near that of scipy':<44} {ours['ade_interval']} {tuple(map(float, theirs))}", flush=True)


def random_boxes(rng, count):
    corners = np.sort(rng.uniform(0, 200, (count, 2, 2)), axis=1)
    return corners.reshape(count, 4)


def xywh(boxes):
    boxes = np.asarray(boxes, dtype=float).reshape(-1, 4)
    return np.concatenate([boxes[:, :2], boxes[:, 2:] - boxes[:, :2]], axis=1)


def check_boxes(ours, pairs):
    from pycocotools import mask

    theirs = [mask.iou(xywh(a), xywh(b), [False])[0, 0] for a, b in pairs]
    require("IoU of boxes against pycocotools", ours["iou"], theirs)
    require("mIoU against pycocotools", ours["means"]["miou"], np.mean(theirs))
    require("IoU>=0.75 against pycocotools", ours["means"]["iou_0_75"], np.mean(np.array(theirs) >= 0.75))


def check_depth(ours, images):
    from sklearn.metrics import mean_absolute_percentage_error, root_mean_squared_error

    theirs = []
    for image in images:
        truth, guess = (np.array(image[key], dtype=np.float32).astype(float) for key in ("truth", "predicted"))
        valid = np.isfinite(truth) & (truth > 0) & (truth <= 80)
        truth, guess = truth[valid], np.clip(guess[valid], 1e-3, 80)
        ratio = np.maximum(truth / guess, guess / truth)
        theirs.append([mean_absolute_percentage_error(truth, guess), root_mean_squared_error(truth, guess), np.mean(ratio < 1.25)])
    require("AbsRel, RMSE, delta1 against scikit-learn", ours["depth"], theirs)


def check_labels(ours, images):
    from sklearn.metrics import jaccard_score

    truth, guess = (np.concatenate([image[key] for image in images]) for key in ("truth", "predicted"))
    labels = np.union1d(truth, guess)
    theirs = jaccard_score(truth, guess, labels=labels, average=None)
    require("IoU of classes against scikit-learn", [iou for iou in ours["class_iou"] if iou is not None], theirs)
    require("segmentation mIoU against scikit-learn", ours["mean_iou"], theirs.mean())


def random_detections(rng, images=60):
    made = []
    for _ in range(images):
        truth = random_boxes(rng, rng.integers(0, 4))
        near = [box + rng.normal(0, 6, 4) for box in truth for _ in range(rng.integers(0, 3))]
        predicted = np.array([*near, *random_boxes(rng, rng.integers(0, 3))]).reshape(-1, 4)
        predicted[:, 2:] = np.maximum(predicted[:, 2:], predicted[:, :2] + 0.5)
        # Few different scores, so that ties are tried as well.
        scores = rng.integers(0, 12, len(predicted)) / 12
        made.append({"truth": truth.tolist(), "predicted": predicted.tolist(), "scores": scores.tolist()})
    return made


def check_detection(ours, images):
    from pycocotools.coco import COCO
    from pycocotools.cocoeval import COCOeval

    truth, found = COCO(), []
    annotations = []
    for number, image in enumerate(images, 1):
        for x, y, w, h in xywh(image["truth"]).tolist():
            annotations.append({"id": len(annotations) + 1, "image_id": number, "category_id": 1, "bbox": [x, y, w, h], "area": w * h, "iscrowd": 0})
        for (x, y, w, h), score in zip(xywh(image["predicted"]).tolist(), image["scores"]):
            found.append({"image_id": number, "category_id": 1, "bbox": [x, y, w, h], "score": score})
    truth.dataset = {"info": {}, "images": [{"id": n} for n in range(1, len(images) + 1)], "annotations": annotations, "categories": [{"id": 1, "name": "target"}]}
    with contextlib.redirect_stdout(io.StringIO()):
        truth.createIndex()
        evaluation = COCOeval(truth, truth.loadRes(found), "bbox")
        evaluation.evaluate()
        evaluation.accumulate()
        evaluation.summarize()
    ap, ap50, ap75 = evaluation.stats[:3]
    require("AP50, AP75, AP against pycocotools", ours["average_precision"], [ap50, ap75, ap])


def rows_of(truth, predicted):
    return [{"truth": t.tolist(), "predicted": p.tolist()} for t, p in zip(truth, predicted)]


def call(binary, data):
    done = subprocess.run([binary], input=json.dumps(data), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def main():
    global binary
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary", help="the example metrics_of_stdin")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    binary, rng = arguments.binary, np.random.default_rng(arguments.seed)

    truth, predicted = random_windows(rng)
    boxes = random_boxes(rng, 200)
    pairs = [[box.tolist(), (np.sort((box + rng.normal(0, spread, 4)).reshape(2, 2), axis=0).reshape(4)).tolist()] for box, spread in zip(boxes, np.tile([1, 5, 20, 100], 50))]
    depth = []
    for _ in range(20):
        metres = rng.uniform(0.5, 120, 400)
        metres[rng.random(400) < 0.1] = 1e9
        depth.append({"truth": metres.tolist(), "predicted": (metres * rng.normal(1, 0.3, 400)).tolist()})
    labels = []
    for _ in range(10):
        names = rng.integers(0, 20, 500)
        labels.append({"truth": names.tolist(), "predicted": np.where(rng.random(500) < 0.6, names, rng.integers(0, 23, 500)).tolist()})
    detections = random_detections(rng)
    ours = call(binary, {"windows": rows_of(truth, predicted), "boxes": pairs, "depth": depth, "labels": labels, "detections": detections})

    check_waypoints(ours, truth, predicted)
    check_interval(ours)
    check_boxes(ours, pairs)
    check_depth(ours, depth)
    check_labels(ours, labels)
    check_detection(ours, detections)


if __name__ == "__main__":
    main()
