#!/usr/bin/env python3
"""The paper's tables, by one command: makes the data, trains every row, and says which findings hold.

    python recipes/training/paper/run.py --out out/paper
    python recipes/training/paper/run.py --out out/paper --data out/hundred     # another dataset with perturbed twins
    python recipes/training/paper/run.py --out out/paper --pictures             # rows with pictures, too: for a card
    python recipes/training/paper/run.py --out out/paper --model FOLDER         # a pretrained model of vision and language, too

Needs `cosfly` on the path, torch 1.13 or newer, numpy and pyarrow; rows with pictures need the package cosfly, `mcap` and
`mcap-protobuf-support` besides, a pretrained model `transformers` and `pillow`. A row's result of one seed is a file: what is there is not
trained again, so that a run that was ended (`--minutes`) goes on. Writes `report.md`, and prints it. The book's page "The paper's tables" has the figures.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
from pathlib import Path
from typing import Dict, List

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))  # tools.py, boxes.py
import tools

tools.need("torch", "numpy", "pyarrow.dataset")
import numpy as np
import report
import torch
from jobs import Jobs, run_recipe, write_whole
from rows import PERTURBED, EXPERT, ROWS, ZERO, PaperWindows, Row, fine_tuned, trained

# Pictures in which a person is 15 pixels high in the median, in the full look; `pictures.SIZE` is what networks see of them.
WITH_PICTURES = ["stages.frames.look=full", "stages.frames.width=640", "stages.frames.height=360"]


# The last one is of depth, labels and people.
TABLES = [*dict.fromkeys(row.table for row in ROWS), "Scene"]


def make_data(chosen: argparse.Namespace) -> Path:
    if chosen.data:
        return chosen.data
    folder = chosen.out / ("data_with_pictures" if chosen.pictures else "data")
    settings = (WITH_PICTURES if chosen.pictures else []) + chosen.set
    run_recipe(chosen.cosfly, "data.toml", folder, settings)
    return folder


def is_asked(row: Row, chosen: argparse.Namespace) -> bool:
    return row.table in chosen.tables and (chosen.pictures or not row.needs_pictures()) and (chosen.model is not None or not row.pretrained)


def scene_job(chosen: argparse.Namespace, pack: "object", lessons: PaperWindows, judged: PaperWindows, seed: int) -> np.ndarray:
    import pictures

    learnt_from = np.unique(pack.rows(lessons))
    is_judged = np.ones(len(judged), bool) if judged.is_seen.all() else ~judged.is_seen
    places, first = np.unique(pack.rows(judged)[is_judged, -1], return_index=True)
    flights = judged.walker[is_judged][first]
    found = pictures.scene_scores(pack, learnt_from, places, flights, chosen.steps, seed)
    return np.array([found[name] for name in pictures.METRICS])


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", type=Path, required=True, help="folder of data, results and the report")
    arguments.add_argument("--data", type=Path, help="a finished dataset with windows of split train and of others, instead of data.toml")
    arguments.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="setting of data.toml, as of `cosfly run`")
    arguments.add_argument("--cosfly", default="cosfly", help="the program (default cosfly)")
    arguments.add_argument("--pictures", action="store_true", help="rows with pictures, too")
    arguments.add_argument("--anchor", choices=["expert", "input"], default="expert", help="where waypoints begin (default expert, the paper's)")
    arguments.add_argument("--steps", type=tools.counted, default=3000, help="steps of training (default 3000)")
    arguments.add_argument("--seeds", type=tools.counted, default=3, help="networks of each row (default 3)")
    arguments.add_argument("--model", help="folder or name on the hub of a pretrained model of vision and language to fine-tune; makes larger pictures, too")
    arguments.add_argument("--model-steps", type=tools.counted, default=1672, help="steps of its fine-tuning (default 1672, the paper's)")
    arguments.add_argument("--tables", nargs="+", choices=TABLES, default=TABLES, metavar="TABLE", help=f"tables to train (default all: {', '.join(TABLES)})")
    arguments.add_argument("--minutes", type=float, help="begin no job after so many minutes; run again to go on")
    chosen = arguments.parse_args()
    chosen.pictures |= chosen.model is not None
    # Small networks gain nothing from more, and the same seed gives the same results on machines of any size.
    torch.set_num_threads(1)
    data = make_data(chosen)
    names = {file.name.split("-")[0] for file in (data / "data/windows").glob("*.parquet")}
    if "train" not in names or len(names) < 2:
        found = ", ".join(sorted(names)) or "none"
        raise SystemExit(f"`{data}` is no dataset with windows of split `train` and of another one; splits found: {found}")
    # Results are of these data, these settings and this code; pictures of the data alone.
    identity = (data / "SHA256SUMS").read_bytes()
    code = b"".join((HERE / name).read_bytes() for name in ("networks.py", "rows.py", "pictures.py", "../small_networks.py"))
    digest = lambda whole: hashlib.sha256(whole).hexdigest()[:12]
    key = digest(identity + code + f"{chosen.anchor} {chosen.steps} {torch.__version__}".encode())
    jobs = Jobs(chosen.out / "rows" / key, chosen.minutes)
    lessons = PaperWindows(data, ["train"], [PERTURBED, EXPERT], chosen.anchor)
    judged = PaperWindows(data, sorted(names - {"train"}), [PERTURBED], chosen.anchor)
    pack = None
    if chosen.pictures:
        from pictures import Pack

        pack = Pack(data, chosen.out / f"pack-{digest(identity)}")
        for windows in (lessons, judged):
            windows.read_depth(data)
            windows.seen_m, windows.depth_m = windows.depth_m, None
    results: Dict[Row, List[np.ndarray]] = {}
    for row in ROWS:
        if not is_asked(row, chosen) or (row != ZERO and not lessons.chosen(row).any()):
            continue
        for seed in range(1 if row == ZERO else chosen.seeds):
            name = f"{row.slug()}-{seed}"
            make = lambda: trained(row, lessons, judged, pack, chosen.steps, seed)
            if row.pretrained:
                name = f"{name}-{chosen.model_steps}-{digest(chosen.model.encode())}"
                make = lambda: fine_tuned(chosen.model, lessons, judged, pack, chosen.model_steps, seed, jobs.folder / f"{name}.pt", jobs.end)
            result = jobs.result(name, make)
            if result is not None:
                results.setdefault(row, []).append(result)
    scene = jobs.result("scene-0", lambda: scene_job(chosen, pack, lessons, judged, 0)) if pack and "Scene" in chosen.tables else None
    counts = {row: int(lessons.chosen(row).sum()) for row in results if row != ZERO}
    text = report.written(results, counts, judged, scene, chosen.anchor)
    write_whole(chosen.out / "report.md", lambda file: file.write(text.encode()))
    print(text)
    if jobs.left:
        print(f"{jobs.left} jobs are left: run the command again", file=sys.stderr)


if __name__ == "__main__":
    tools.script(main)
