"""Reads exports for trackers with the software that they are made for: TrackEval and got10k.

python check_trackers.py DATASET FOLDER     FOLDER has mot/, otb/, uav123/ and lasot/
"""

import configparser
import glob
import json
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import got10k.datasets
import numpy as np
import pyarrow.parquet as parquet
import trackeval
from PIL import Image

dataset, folder = Path(sys.argv[1]), Path(sys.argv[2])


def rows_of(table, without=()):
    for path in sorted(glob.glob(str(dataset / f"data/{table}/*.parquet"))):
        yield from parquet.read_table(path).drop(list(without)).to_pylist()


frames, people, flights = defaultdict(dict), defaultdict(list), {row["trajectory_id"]: row for row in rows_of("trajectories")}
for row in rows_of("frames", ["preview"]):
    frames[row["trajectory_id"]][row["frame"]] = row
for row in rows_of("bodies"):
    if row["visible_pixels"]:
        people[row["trajectory_id"], row["frame"]].append(row)


def box(edges):
    left, top, right, bottom = edges
    return [left + 1, top + 1, right - left, bottom - top]


def sequences(export):
    return list(map(json.loads, (folder / export / "sequences.jsonl").read_text().splitlines()))


def frame_of(row, picture):
    return row["first_frame"] + (picture - 1) * row["every"]


def check_pictures(row, files):
    """As many as the list says, of the camera's size."""
    assert len(files) == row["pictures"] and [int(Path(file).stem) for file in files] == list(range(1, len(files) + 1))
    flight = flights[row["trajectory_id"]]
    for file in files[:: max(1, len(files) // 3)]:
        with Image.open(file) as picture:
            assert picture.size == (flight["camera_width_px"], flight["camera_height_px"]) and picture.format == "JPEG"


def scores(split, results):
    """HOTA and IDF1 of results, a dictionary of lines by sequence, as TrackEval has them."""
    quiet = {"PRINT_CONFIG": False}
    with tempfile.TemporaryDirectory() as trackers:
        place = Path(trackers) / "mine/data"
        place.mkdir(parents=True)
        for name, lines in results.items():
            (place / f"{name}.txt").write_text("".join(lines))
        root = folder / "mot"
        data = {"GT_FOLDER": str(root / split), "SEQMAP_FILE": str(root / f"seqmaps/{split}.txt"), "SKIP_SPLIT_FOL": True,
                "TRACKERS_FOLDER": trackers, **quiet}
        config = {"PRINT_RESULTS": False, "TIME_PROGRESS": False, "OUTPUT_SUMMARY": False, "OUTPUT_DETAILED": False, "PLOT_CURVES": False,
                  "BREAK_ON_ERROR": True, **quiet}
        metrics = [trackeval.metrics.HOTA(), trackeval.metrics.Identity({"THRESHOLD": 0.5, **quiet})]
        found, _ = trackeval.Evaluator(config).evaluate([trackeval.datasets.MotChallenge2DBox(data)], metrics)
    found = found["MotChallenge2DBox"]["mine"]["COMBINED_SEQ"]["pedestrian"]
    return found["HOTA"]["HOTA"].mean(), found["Identity"]["IDF1"]


def mot():
    lines, without, counts = defaultdict(dict), defaultdict(dict), defaultdict(lambda: [0, 0])
    for row in sequences("mot"):
        id, split = row["trajectory_id"], row["split"]
        root = folder / "mot" / split / row["sequence"]
        info = configparser.ConfigParser()
        info.read(root / "seqinfo.ini")
        info = info["Sequence"]
        assert int(info["seqLength"]) == row["pictures"] == len(frames[id]) and info["name"] == id
        assert abs(float(info["frameRate"]) * flights[id]["dt_s"] - 1) < 1e-5
        check_pictures(row, sorted(glob.glob(str(root / info["imDir"] / f"*{info['imExt']}"))))
        truth = np.loadtxt(root / "gt/gt.txt", delimiter=",", ndmin=2).reshape(-1, 9)
        expected = {}
        for number, known in frames[id].items():
            if known["visible_box_px"]:
                expected[number + 1, 1] = box(known["visible_box_px"])
            for body in people[id, number]:
                expected[number + 1, body["instance"]] = box(body["visible_box_px"])
        found = {(int(line[0]), int(line[1])): list(line[2:6]) for line in truth}
        assert found == expected and len(found) == len(truth)
        for line in truth:
            if line[1] == 1:
                assert abs(line[8] - frames[id][int(line[0]) - 1]["visible_by_pixels"]) < 1e-4
        as_result = [",".join(f"{number:g}" for number in (*line[:6], 1, -1, -1, -1)) + "\n" for line in truth if line[7] == 1]
        lines[split][row["sequence"]] = as_result
        without[split][row["sequence"]] = [line for line in as_result if line.split(",")[1] != "1"]
        counts[split][0] += len(as_result)
        counts[split][1] += len(as_result) - len(without[split][row["sequence"]])
    for split, (all_boxes, of_targets) in counts.items():
        assert np.allclose(scores(split, lines[split]), 1), split
        _, idf1 = scores(split, without[split])
        kept = all_boxes - of_targets
        assert np.isclose(idf1, 2 * kept / (2 * kept + of_targets)), (split, idf1)
    return f"{sum(count for count, _ in counts.values())} boxes, scored by TrackEval"


def check_target(row, boxes, absent):
    """Boxes of the target against the table; `absent` tells rows without one."""
    assert len(boxes) == row["pictures"]
    for picture, found in enumerate(boxes, 1):
        known = frames[row["trajectory_id"]][frame_of(row, picture)]["visible_box_px"]
        assert absent(found) if known is None else list(found) == box(known)
    assert not absent(boxes[0]), "trackers start from the first box"


def without_a_box(found):
    return bool(np.isnan(found).all())


def otb():
    names = defaultdict(list)
    for row in sequences("otb"):
        names[row["split"]].append(row)
    for split, rows in names.items():
        got10k.datasets.OTB._OTB__version_dict["cosfly"] = [row["sequence"] for row in rows]
        data = got10k.datasets.OTB(str(folder / "otb" / split), "cosfly", download=False)
        assert len(data) == len(rows)
        for row in rows:
            files, boxes = data[row["sequence"]]
            check_pictures(row, files)
            check_target(row, boxes, without_a_box)
    return f"{sum(map(len, names.values()))} sequences, read by got10k"


class Metas:
    """Stands for `json` in got10k's reader, which knows the names of UAV123's own sequences."""

    @staticmethod
    def load(_):
        entry = {row["sequence"]: {"folder_name": row["sequence"], "start_frame": 1, "end_frame": row["pictures"]} for row in sequences("uav123")}
        return {"UAV123": entry}


def uav123():
    reader = sys.modules["got10k.datasets.uav123"]
    reader.json, count = Metas, 0
    reader.UAV123._check_integrity = lambda *_: None
    for split in sorted({row["split"] for row in sequences("uav123")}):
        data = got10k.datasets.UAV123(str(folder / "uav123" / split))
        for row in (row for row in sequences("uav123") if row["split"] == split):
            files, boxes = data[row["sequence"]]
            check_pictures(row, files)
            check_target(row, boxes, without_a_box)
            count += 1
        assert len(data) == len(list((folder / "uav123" / split / "data_seq/UAV123").iterdir()))
    return f"{count} sequences, read by got10k"


def lasot():
    absences = np.zeros(2, int)
    for row in sequences("lasot"):
        # Its constructor cannot run (0.1.3); what it would set are the names of LaSOT's own sequences.
        data = object.__new__(got10k.datasets.LaSOT)
        name = row["sequence"]
        place = folder / "lasot" / row["split"] / name[: name.rfind("-")] / name
        data.seq_names, data.seq_dirs, data.anno_files, data.return_meta = [name], [str(place / "img")], [str(place / "groundtruth.txt")], True
        files, boxes, meta = data[name]
        check_pictures(row, files)
        check_target(row, boxes, lambda found: list(found) == [0, 0, 0, 0])
        for picture in range(1, row["pictures"] + 1):
            known = frames[row["trajectory_id"]][frame_of(row, picture)]
            is_hidden = known["in_view"] and known["visible_box_px"] is None
            assert [meta["full_occlusion"][picture - 1], meta["out_of_view"][picture - 1]] == [is_hidden, not known["in_view"]]
            absences += [is_hidden, not known["in_view"]]
        assert meta["nlp"]
    return f"{len(sequences('lasot'))} sequences, read by got10k; target hidden in {absences[0]} pictures, outside in {absences[1]}"


for check in (mot, otb, uav123, lasot):
    print(f"{check.__name__}: {check()}")
