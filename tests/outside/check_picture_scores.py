"""Compares `cosfly eval` for depth, labels, boxes and masks with numpy, scikit-learn and pycocotools, which read the dataset by other ways: pictures
from its MCAP logs, annotations from its COCO export.

Usage: `check_picture_scores.py target/release/cosfly DATASET EXPORTS`. EXPORTS has imagefolder/ and coco/ of the dataset. Each check prints one line.
Exit code 0: everything agrees to 1e-9."""

import contextlib
import copy
import io
import json
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from pycocotools import mask as masks
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval
from shared import agree, flown, json_of, messages, pixels, said
from sklearn.metrics import jaccard_score, mean_absolute_percentage_error, root_mean_squared_error

binary, dataset, exports = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
scratch = tempfile.TemporaryDirectory()
work = Path(scratch.name)
rng = np.random.default_rng(7)
CAP_M = 80.0
flights = flown(dataset)[0].values()


def evaluate(predictions, *options, code=0):
    return json_of(binary, "eval", dataset, predictions, "--out", work / "scores", "--json", "--resamples", 50, *options, code=code)


def scores(report, *keys):
    return [report["scores"][key]["value"] for key in keys]


def pictures(row, topic):
    return (pixels(image) for _, image, *_ in messages(dataset / row["mcap_path"], [topic]))


def made(folder):
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def depth():
    """Noisy depths as NumPy arrays: every image by scikit-learn, then means, overall and by weather."""
    folder, found = work / "depth", []
    for row in flights:
        place = made(folder / row["trajectory_id"])
        for frame, truth in enumerate(pictures(row, "/camera/depth/image")):
            guess = (truth * rng.normal(1, 0.2, truth.shape)).astype(np.float32)
            guess[rng.random(truth.shape) < 0.01] = np.inf
            np.save(place / f"{frame:06d}.npy", guess)
            valid = np.isfinite(truth) & (truth > 0) & (truth <= CAP_M)
            t, p = truth[valid].astype(float), np.clip(guess[valid].astype(float), 1e-3, CAP_M)
            errors = mean_absolute_percentage_error(t, p), root_mean_squared_error(t, p), np.mean(np.maximum(t / p, p / t) < 1.25)
            found.append((row["weather_preset"], *errors))
    report = evaluate(folder)
    keys = ["abs_rel", "rmse_m", "delta1"]
    agree("depth: AbsRel, RMSE, delta1 against scikit-learn", scores(report, *keys), np.mean([row[1:] for row in found], axis=0))
    for weather, ours in report["strata"]["weather"].items():
        theirs = np.mean([row[1:] for row in found if row[0] == weather], axis=0)
        agree(f"depth: the same in {weather}", scores(ours, *keys), theirs)
    report = evaluate(exports / "imagefolder", "--kind", "depth")
    agree("depth: the ImageFolder export of the truth", scores(report, *keys), [0, 0, 1], tolerance=0.005)
    assert report["frames"]["scored"] == len(found) and report["files"]["malformed"] == 0
    # Whole numbers in millimetres, every second frame.
    folder = made(work / "millimetres")
    for row in flights:
        for frame, truth in [*enumerate(pictures(row, "/camera/depth/image"))][::2]:
            depth_mm = np.clip(np.round(truth * 1000), 0, 65535).astype(np.uint16)
            Image.fromarray(depth_mm).save(folder / f"{row['trajectory_id']}_{frame}.png")
    wrong = evaluate(folder, "--every", "2")
    assert any("a wrong unit?" in note for note in wrong["notes"]), wrong["notes"]
    right = evaluate(folder, "--every", "2", "--depth-per-metre", "1000", "--max-depth-m", "60")
    agree("depth: millimetres, every second frame", scores(right, *keys), [0, 0, 1], tolerance=0.001)
    assert right["frames"]["without_prediction"] == 0 and right["notes"] == []


def labels():
    """Labels of which some are wrong: IoU by scikit-learn over all pixels at once."""
    folder, truths, guesses = work / "labels", [], []
    for row in flights:
        place = made(folder / row["split"] / "semantic" / row["trajectory_id"])
        for frame, truth in enumerate(pictures(row, "/camera/semantic/image")):
            guess = np.where(rng.random(truth.shape) < 0.2, rng.integers(0, 25, truth.shape, dtype=np.uint8), truth)
            Image.fromarray(guess).save(place / f"frame_{frame}.png")
            truths.append(truth.ravel())
            guesses.append(guess.ravel())
    report = evaluate(folder)
    truth, guess = np.concatenate(truths), np.concatenate(guesses)
    names = np.union1d(truth, guess)
    theirs = jaccard_score(truth, guess, labels=names, average=None)
    agree("labels: IoU of every class against scikit-learn", [row["scores"]["iou"] for row in report["classes"]], theirs)
    agree("labels: mIoU and accuracy", scores(report, "miou", "pixel_accuracy"), [theirs.mean(), np.mean(truth == guess)])
    report = evaluate(exports / "imagefolder", "--kind", "semantic")
    agree("labels: the ImageFolder export of the truth", scores(report, "miou", "pixel_accuracy"), [1, 1])


def average_precision(truth, found, kind, categories):
    truth, found = copy.deepcopy(truth), copy.deepcopy(found)  # pycocotools writes into both
    with contextlib.redirect_stdout(io.StringIO()):
        evaluation = COCOeval(truth, truth.loadRes(found), kind)
        if categories:
            evaluation.params.catIds = categories
        evaluation.evaluate()
        evaluation.accumulate()
        evaluation.summarize()
    return [evaluation.stats[1], evaluation.stats[2], evaluation.stats[0]]


def perturbed(truth):
    """Shifted boxes and masks, some twice, some missing, some strangers, scores with ties."""
    found = []
    for image in truth.imgs.values():
        height, width = image["height"], image["width"]
        for ann in truth.imgToAnns[image["id"]]:
            for _ in range(rng.choice([0, 1, 1, 1, 2])):
                left, top, w, h = ann["bbox"]
                spread = 0.1 * min(w, h)
                box = [left + rng.normal(0, spread), top + rng.normal(0, spread), w * rng.uniform(0.8, 1.2), h * rng.uniform(0.8, 1.2)]
                pixels = np.roll(truth.annToMask(ann), rng.integers(-1, 2, 2), axis=(0, 1))
                code = masks.encode(np.asfortranarray(pixels))
                category = ann["category_id"] if rng.random() < 0.95 else 12
                found.append({"image_id": image["id"], "category_id": int(category), "bbox": [float(x) for x in box],
                              "segmentation": {"size": [height, width], "counts": code["counts"].decode()}, "score": float(rng.integers(0, 20) / 20)})
    return found


def things():
    listed = exports / "coco/annotations/instances_train.json"
    with contextlib.redirect_stdout(io.StringIO()):
        truth = COCO(str(listed))
    keys = ["ap50", "ap75", "ap"]
    found, plain = perturbed(truth), lambda rows, *gone: [{key: value for key, value in row.items() if key not in gone} for row in rows]
    path = work / "found.json"
    for kind, name, rows in [("bbox", "boxes", plain(found, "segmentation")), ("segm", "masks", plain(found, "bbox"))]:
        path.write_text(json.dumps(rows))
        ours = evaluate(path, "--images", listed)
        assert ours["settings"]["kind"] == name
        agree(f"{name}: AP50, AP75, AP against pycocotools", scores(ours, *keys), average_precision(truth, rows, kind, None))
        ours = evaluate(path, "--images", listed, "--category", "12")
        agree(f"{name}: the same of pedestrians alone", scores(ours, *keys), average_precision(truth, rows, kind, [12]))
        lines, images = work / "found.jsonl", [truth.imgs[row["image_id"]] for row in rows]
        placed = [row | {key: image[key] for key in ("trajectory_id", "frame")} for row, image in zip(rows, images)]
        lines.write_text("".join(json.dumps(row) + "\n" for row in plain(placed, "image_id")))
        agree(f"{name}: the same by flight and frame", scores(evaluate(lines, "--category", "12", "--split", "train"), *keys), scores(ours, *keys))
    exact = [{key: ann[key] for key in ("image_id", "category_id", "bbox", "segmentation")} | {"score": 0.5} for ann in truth.anns.values()]
    path.write_text(json.dumps(exact))
    for kind in ["boxes", "masks"]:
        report = evaluate(path, "--images", listed, "--kind", kind)
        agree(f"{kind}: the annotations themselves", scores(report, *keys, "mean_overlap"), [1, 1, 1, 1])


def malformed():
    """What is wrong is counted and named, and the rest is scored."""
    folder, row = work / "faulty", next(iter(flights))
    name = row["trajectory_id"]
    place, truth = made(folder / name), list(pictures(row, "/camera/depth/image"))
    files = {f"{name}/{frame}": depth_m for frame, depth_m in enumerate(truth[:-2])}
    files |= {f"{name}/0": truth[0][:-1], f"{name}/2_000002": truth[2], f"{name}/3": truth[0].astype(np.int64)}
    files |= dict.fromkeys([f"{name}/9999", f"{name}/nameless", "stranger_3"], truth[0])
    for stem, numbers in files.items():
        np.save(folder / f"{stem}.npy", numbers)
    (place / "1.npy").write_bytes(b"\x93NUMPY")
    Image.fromarray(np.zeros((2, 2), np.uint8)).save(place / "4.png")
    (folder / "notes.txt").write_text("not a picture")
    report = evaluate(folder, "--split", row["split"], code=1)
    expected = {"size": 1, "unreadable": 2, "duplicate": 2, "no-frame": 1, "name": 1, "unknown-trajectory": 1}
    assert report["files"]["kinds"] == expected, report["files"]
    last = len(truth) - 2
    assert report["frames"]["missing"][name] == f"{last}-{last + 1}", report["frames"]
    assert report["files"]["passed_over"] == 1 and report["frames"]["scored"] == len(truth) - 5
    agree("files: the sound ones of a faulty folder", scores(report, "abs_rel", "delta1"), [0, 1])
    path = work / "faulty.json"
    sound = {"trajectory_id": name, "frame": 0, "category_id": 12, "bbox": [1, 2, 3, 4], "score": 0.5}
    rows = [sound, *(sound | wrong for wrong in ({"frame": 10**6}, {"trajectory_id": "nobody"}, {"category_id": 99}, {"bbox": [1]}))]
    rows.append({"image_id": 1, "category_id": 12, "bbox": [1, 2, 3, 4], "score": 1})
    path.write_text(json.dumps(rows))
    report = evaluate(path, code=1)
    assert report["files"]["kinds"] == {"no-frame": 1, "unknown-trajectory": 1, "category": 1, "field-type": 1, "image": 1}
    said("malformed files and rows are counted and named")


depth()
labels()
things()
malformed()
print("check_picture_scores: everything agrees")
