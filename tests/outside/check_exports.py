"""Reads exports of a dataset with the software that they are made for: pycocotools, webdataset, datasets.

Usage: `check_exports.py DATASET FOLDER CACHE`. FOLDER has coco/, webdataset/, imagefolder/ and vlm/."""

import glob
import importlib.util
import json
import sys
from pathlib import Path

import datasets
import numpy as np
import webdataset
from PIL import Image
from pycocotools import mask as masks
from pycocotools.coco import COCO
from shared import place, rows

dataset, folder, cache = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
frames = {(row["trajectory_id"], row["frame"]): row for row in rows(dataset, "frames")}
flights = {row["trajectory_id"]: row for row in rows(dataset, "trajectories")}
torch_is_there = importlib.util.find_spec("torch") is not None
splits = sorted({row["split"] for row in frames.values()})


def coco():
    root, seen, things = folder / "coco", 0, 0
    for split in splits:
        data = COCO(str(root / f"annotations/instances_{split}.json"))
        assert len(data.imgs) == sum(row["split"] == split for row in frames.values())
        for image in data.imgs.values():
            row = frames[image["trajectory_id"], image["frame"]]
            with Image.open(root / split / image["file_name"]) as picture:
                assert picture.size == (image["width"], image["height"])
            anns = data.imgToAnns[image["id"]]
            covered = np.zeros((image["height"], image["width"]), int)
            for ann in anns:
                rle, binary = ann["segmentation"], data.annToMask(ann)
                covered += binary
                assert masks.area(rle) == binary.sum() == ann["area"] > 0 and list(masks.toBbox(rle)) == ann["bbox"]
                assert masks.encode(np.asfortranarray(binary))["counts"].decode() == rle["counts"], "the same bytes as pycocotools writes"
            assert covered.max() <= 1, "no pixel belongs to two things"
            target = [(ann["area"], ann["category_id"], ann["bbox"]) for ann in anns if ann["is_target"]]
            left, top, right, bottom = row["visible_box_px"] or [0] * 4
            shown = [(row["visible_pixels"], 12, [left, top, right - left, bottom - top])]
            assert target == (shown if row["visible_pixels"] else [])
            things, seen = things + len(anns), seen + len(target)
    assert seen
    return f"{things} things, the target in {seen} frames"


def web_dataset():
    root, samples = folder / "webdataset", 0
    shards = sorted(glob.glob(str(root / "data/*.tar")))
    assert len(shards) >= len(splits)
    whole = webdataset.WebDataset(shards, shardshuffle=False)
    for sample in whole.decode("pil"):
        facts, row = sample["json"], row_of(sample)
        size = tuple(flights[facts["trajectory_id"]][f"camera_{side}_px"] for side in ("width", "height"))
        assert sample["rgb.jpg"].size == size
        assert sample["__key__"] == f"{facts['trajectory_id'].replace('.', '_')}_{facts['frame']:06d}"
        assert abs(facts["drone_pose"][0] - row["drone_x_m"]) < 1e-9 and facts["split"] == row["split"]
        labels_of(sample, row, size)
        samples += 1
    assert samples == len(frames)
    # Whatever the pictures are decoded to, numbers stay as they are.
    for decoded in (whole.decode(), whole.decode("rgb"), whole.decode("pil"), whole.decode("torchrgb8") if torch_is_there else whole.decode("rgb8")):
        sample = next(iter(decoded))
        labels_of(sample, row_of(sample), sample["depth.npy.gz"].shape[::-1])
    found = datasets.load_dataset(str(root), split=splits[0], streaming=True, cache_dir=cache)
    first = next(iter(found))
    kinds = {"depth.npy.gz": np.float32, "semantic.npy.gz": np.uint8, "instance.npy.gz": np.uint32}
    labels_of({name: np.array(first[name], kind) for name, kind in kinds.items()}, row_of(first), first["rgb.jpg"].size)
    return f"{samples} samples in {len(shards)} shards"


def row_of(sample):
    return frames[sample["json"]["trajectory_id"], sample["json"]["frame"]]


def labels_of(sample, row, size):
    """Depths, labels and ids of a sample against the row of the frame."""
    depth, labels, ids = (sample[f"{name}.npy.gz"] for name in ("depth", "semantic", "instance"))
    assert (depth.dtype, labels.dtype, ids.dtype) == (np.float32, np.uint8, np.uint32)
    assert depth.shape == labels.shape == ids.shape == size[::-1]
    target = ids == 1
    assert target.sum() == row["visible_pixels"] and set(np.unique(labels[target])) <= {12}
    assert np.isinf(depth[labels == 11]).all() and depth[np.isfinite(depth)].max() > 2.55
    if target.any():
        assert abs(np.median(depth[target]) - row["distance_m"]) < 3


def image_folder():
    splits = datasets.load_dataset(str(folder / "imagefolder"), cache_dir=cache)
    assert sum(len(part) for part in splits.values()) == len(frames)
    for part in splits.values():
        row = part[len(part) // 2]
        known = frames[row["trajectory_id"], row["frame"]]
        assert row["image"].size == row["semantic"].size == row["depth"].size
        assert row["visible_box_px"] == known["visible_box_px"] and row["instruction"]
    return f"{len(frames)} rows, columns {sorted(splits[next(iter(splits))].features)[:6]} ..."


def small_folders():
    """No folder of any export has more entries than hosts of datasets like."""
    folders = [path for path in folder.rglob("*") if path.is_dir()] + [folder]
    most = max(len(list(path.iterdir())) for path in folders)
    assert most <= 1000
    return f"at most {most} entries in {len(folders)} folders"


def vlm():
    """Five pictures of the size that the text says; the answers lead from the current pose to the expert's (world frame)."""
    root, windows = folder / "vlm", 0
    for entry in json.loads((root / "dataset_info.json").read_text()).values():
        lines = datasets.load_dataset("json", data_files=str(root / entry["file_name"]), split="train", cache_dir=cache)
        for row in lines:
            assert len(row["images"]) == 5
            for image in row["images"]:
                with Image.open(root / image) as picture:
                    assert picture.width <= 448 and f"pixels of {picture.width} x {picture.height}" in row["messages"][1]["content"]
                    picture.verify()
            deltas = json.loads(row["messages"][2]["content"])["waypoint_deltas"]
            assert len(deltas) == 5 and all(len(delta) == 6 for delta in deltas)
            known = frames[row["trajectory_id"], row["frame"] + 4]
            at, expert = place(known, "drone"), flights[row["trajectory_id"]]["expert_id"]
            for step, delta in enumerate(deltas):
                at = at + delta[:3]
                assert np.abs(at - place(frames[expert, known["expert_frame"] + 1 + step], "drone")).max() < 6e-4
            windows += 1
    assert windows
    return f"{windows} windows"


for check in (coco, web_dataset, image_folder, vlm, small_folders):
    print(f"{check.__name__}: {check()}")
