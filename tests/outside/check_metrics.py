"""Compares our metrics of waypoints and boxes with evo, trajnetplusplustools, pycocotools, scikit-learn and scipy on random data; `check_picture_scores.py`
compares those of depth, labels and detections.

    cargo build --profile ci -p cosfly-metrics --example metrics_of_stdin
    venv/bin/python tests/outside/check_metrics.py target/ci/examples/metrics_of_stdin

Each check prints one line. Exit code 0: everything agrees to 1e-9."""

import json
import sys

import numpy as np
from shared import agree, json_of, require, said, turned


def random_windows(rng, windows=300, steps=5):
    truth = np.concatenate([rng.uniform(-60, 60, (windows, steps, 3)), rng.uniform(-180, 180, (windows, steps, 3))], axis=2)
    return truth, truth + rng.normal(0, 1, (windows, steps, 6)) * rng.choice([0.1, 0.7, 3.0, 40.0], (windows, 1, 1))


def check_waypoints(ours, truth, predicted):
    """Distances against evo's absolute pose error and trajnet++ (planar), angles against scipy, shares by hand."""
    from evo.core import metrics, trajectory
    from scipy.spatial.transform import Rotation
    from trajnetplusplustools import TrackRow
    from trajnetplusplustools.metrics import average_l2, final_l2

    each = np.array(ours["windows"])

    def path(poses):
        quaternions = Rotation.from_euler("z", poses[:, 4, None], degrees=True).as_quat()[:, [3, 0, 1, 2]]
        return trajectory.PoseTrajectory3D(poses[:, :3], quaternions, np.arange(len(poses)) * 0.5)

    def errors(relation):
        found = [metrics.APE(relation) for _ in truth]
        for ape, true, guess in zip(found, truth, predicted):
            ape.process_data((path(true), path(guess)))
        means = [ape.get_statistic(metrics.StatisticsType.mean) for ape in found]
        return means, np.array([ape.error for ape in found])

    ade, away = errors(metrics.PoseRelation.translation_part)
    _, yaw = errors(metrics.PoseRelation.rotation_angle_deg)
    fde = away[:, -1]
    agree("ADE against evo", each[:, 0], ade)
    agree("FDE against evo", each[:, 1], fde)
    agree("yaw error of last waypoints against evo", each[:, 2], yaw[:, -1])
    agree("mean yaw error against evo", each[:, 3], yaw.mean(axis=1))

    flat_truth, flat_guess = truth.copy(), predicted.copy()
    flat_truth[:, :, 2] = flat_guess[:, :, 2] = 20.0
    flat = np.array(json_of(sys.argv[1], input=json.dumps({"windows": rows_of(flat_truth, flat_guess)}))["windows"])
    rows = lambda poses: [TrackRow(frame, 1, x, y) for frame, (x, y) in enumerate(poses[:, :2])]
    steps = truth.shape[1]
    agree("planar ADE against trajnet++", flat[:, 0], [average_l2(rows(t), rows(g), n_predictions=steps) for t, g in zip(flat_truth, flat_guess)])
    agree("planar FDE against trajnet++", flat[:, 1], [final_l2(rows(t), rows(g)) for t, g in zip(flat_truth, flat_guess)])

    from sklearn.metrics import mean_absolute_error

    wrapped = (predicted - truth).reshape(-1, 6)
    wrapped[:, 3:] = turned(wrapped[:, 3:], 0)
    zeros = np.zeros_like(wrapped)
    means = ours["means"]
    agree("MAE against scikit-learn", means["mae"], mean_absolute_error(zeros, wrapped))
    agree("MAE of positions against scikit-learn", means["position_mae_m"], mean_absolute_error(zeros[:, :3], wrapped[:, :3]))
    agree("MAE of rotations against scikit-learn", means["rotation_mae_deg"], mean_absolute_error(zeros[:, 3:], wrapped[:, 3:]))
    ends = wrapped.reshape(predicted.shape)[:, -1]
    ahead = Rotation.from_euler("z", truth[:, -1, 4:5], degrees=True).inv().apply(ends[:, :3])
    agree("lasting error by scipy's rotations", means["lasting_m"], np.linalg.norm(ahead.mean(axis=0)))
    agree("lasting turn by hand", means["lasting_turn_deg"], np.linalg.norm(ends[:, 3:5].mean(axis=0)))
    last = yaw[:, -1]
    for key, share in {
        "sr_0_5m": fde <= 0.5, "sr_1m": fde <= 1, "sr_2m": fde <= 2, "rot_acc_1deg": last <= 1, "rot_acc_5deg": last <= 5,
        "joint_sr_0_5m_1deg": (fde <= 0.5) & (last <= 1), "joint_sr_1m_5deg": (fde <= 1) & (last <= 5), "hard_fail": fde > 10,
    }.items():
        agree(f"{key} by evo's errors", means[key], share.mean())


def check_interval(ours):
    """A 95 % interval by our resamples against scipy's: only as near as resampling allows."""
    from scipy.stats import bootstrap

    ade = np.array(ours["windows"])[:, 0]
    theirs = bootstrap((ade,), np.mean, n_resamples=9999, method="percentile", random_state=1).confidence_interval
    off = np.abs(np.array(ours["ade_interval"]) - [theirs.low, theirs.high]).max()
    require(off <= 0.08 * (theirs.high - theirs.low), f"interval {ours['ade_interval']} is not near scipy's {theirs}")
    said("95 % interval near that of scipy", f"{ours['ade_interval']} {tuple(map(float, theirs))}")


def xywh(box):
    return np.array([[*box[:2], *np.subtract(box[2:], box[:2])]], dtype=float)


def check_boxes(ours, pairs):
    from pycocotools import mask

    theirs = [mask.iou(xywh(a), xywh(b), [False])[0, 0] for a, b in pairs]
    agree("IoU of boxes against pycocotools", ours["iou"], theirs)
    agree("mIoU against pycocotools", ours["means"]["miou"], np.mean(theirs))
    agree("IoU>=0.75 against pycocotools", ours["means"]["iou_0_75"], np.mean(np.array(theirs) >= 0.75))


def rows_of(truth, predicted):
    return [{"truth": t.tolist(), "predicted": p.tolist()} for t, p in zip(truth, predicted)]


rng = np.random.default_rng(1)
truth, predicted = random_windows(rng)
boxes = np.sort(rng.uniform(0, 200, (200, 2, 2)), axis=1)
moved = np.sort(boxes + rng.normal(0, np.tile([1, 5, 20, 100], 50)[:, None, None], boxes.shape), axis=1)
pairs = np.stack([boxes, moved], axis=1).reshape(-1, 2, 4).tolist()
ours = json_of(sys.argv[1], input=json.dumps({"windows": rows_of(truth, predicted), "boxes": pairs}))
check_waypoints(ours, truth, predicted)
check_interval(ours)
check_boxes(ours, pairs)
