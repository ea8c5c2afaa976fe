"""People found and followed in real footage by networks that have seen cosfly's pictures alone.

    python recipes/training/footage/run.py --out out/footage --people FRAMES BOXES

Makes the pictures of `data.toml`, trains a detector of people and a tracker of boxes on them, and scores both on pictures of a town that
they have not seen and on sequences of yours: a folder of frames, and a text file with one box a line, `left,top,width,height` in pixels,
as UAV123, OTB and LaSOT have them. Writes `report.md`, `detector.pt` and `tracker.pt`. The book's page "Real footage" says more.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from pathlib import Path
from typing import Dict

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))  # tools.py, boxes.py
import tools

# What `--without` leaves out of the recipe, one at a time.
PARTS = {
    "optics": ["stages.frames.optics.preset=ideal"],
    "weathers": ['stages.frames.weathers=["ClearNoon"]'],
    "parked": ["stages.street.vehicles.parked_share=0.0"],
    "crowd": ["stages.street.people.count=0", 'stages.street.follow.kinds=["car"]'],
    "look": ["stages.frames.look=simple"],
    "lenses": ["stages.frames.fov_range_deg=[79.9, 80.0]"],
    "heights": ["stages.low.view={}"],
    "nothing": [],  # with another `--seed`: what chance in training does
}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--out", type=Path, default=Path("out/footage"), help="folder of data, networks and report (default: out/footage)")
    add("--cosfly", default="cosfly", help="the program (default: cosfly)")
    sequence = {"nargs": "+", "action": "append", "default": [], "metavar": "PATH"}
    add("--people", **sequence, help="FRAMES BOXES [FIRST]: a sequence that follows a person; FIRST is the picture of the first line, from 1")
    add("--others", **sequence, help="the same for a sequence that follows anything else: for the tracker alone")
    add("--without", choices=sorted(PARTS), help="leave a part of the recipe out, to see what it is good for; judged beside OUT/all, where that is")
    add("--set", action="append", default=[], metavar="KEY=VALUE", help="change the recipe, as in `cosfly run`")
    add("--steps", type=tools.counted, default=4000, help="steps of training of both networks at once (default: 4000)")
    add("--alone", type=tools.counted, default=2000, help="steps in which the detector then learns alone (default: 2000; together about 40 minutes of one core)")
    add("--per-frame", type=tools.counted, default=3, help="bodies around which squares are cut from each picture (default: 3)")
    add("--every", type=tools.counted, default=4, help="score the detector on every n-th picture of a sequence (default: 4)")
    add("--briefly", action="store_true", help="score the detector in squares alone: not in whole frames, and no tracker")
    add("--seed", type=int, default=1)
    add("--threads", type=tools.counted, default=1, help="threads of torch: other numbers give other last bits (default: 1)")
    options = parser.parse_args()
    for sequence in options.people + options.others:
        if len(sequence) not in (2, 3) or (len(sequence) == 3 and not (sequence[2].isdigit() and int(sequence[2]))):
            parser.error(f"a sequence is FRAMES BOXES [FIRST], not {' '.join(sequence)}")
    return options


def data(options: argparse.Namespace, out: Path) -> Path:
    sets = [part for pair in [*(PARTS[options.without] if options.without else []), *options.set] for part in ("--set", pair)]
    command = [options.cosfly, "run", str(HERE / "data.toml"), "--out", str(out / "data"), "--store", str(options.out / "store"), *sets]
    tools.cosfly(command)
    return out / "data"


def networks_of(options: argparse.Namespace, out: Path, dataset: Path) -> Dict[str, "object"]:
    """The networks, trained, or read where the same settings trained them on the same pictures."""
    import cosfly
    import networks
    import torch
    from crops import squares_of

    pictures = hashlib.sha256((dataset / "SHA256SUMS").read_bytes()).hexdigest()
    asked = {name: getattr(options, name) for name in ("steps", "alone", "per_frame", "seed", "threads")}
    made = json.dumps({**asked, "pictures": pictures})
    found = {"detector": networks.Detector(), "tracker": networks.Tracker()}
    kept = {name: torch.load(out / f"{name}.pt") for name in found if (out / f"{name}.pt").exists()}
    if [kept.get(name, {}).get("made") for name in found] == [made] * len(found):
        for name, network in found.items():
            network.load_state_dict(kept[name]["weights"])
            network.eval()
        return found
    squares = squares_of(cosfly.Dataset(dataset, split="train", channels=("rgb",)), options.per_frame, options.seed)
    torch.manual_seed(options.seed)
    detector, tracker = found["detector"], found["tracker"] = networks.Detector(), networks.Tracker()
    weights = sum(it.numel() for it in networks.on_one_trunk(detector, tracker).parameters())
    print(f"{weights:,} weights, {len(squares.bodies):,} squares", flush=True)
    networks.train(detector, tracker, squares, options.steps, options.alone, options.seed, lambda line: print(line, flush=True))
    for name, network in found.items():
        torch.save({"made": made, "weights": network.state_dict()}, out / f"{name}.pt")
    return found


def main() -> None:
    options = arguments()
    tools.need("torch", "numpy", "PIL", "cosfly")
    import torch

    torch.set_num_threads(options.threads)
    import networks
    import scores

    people, others = ([scores.Sequence(*it) for it in of] for of in (options.people, options.others))
    out = options.out / (f"without_{options.without}" if options.without else "all")
    out.mkdir(parents=True, exist_ok=True)
    dataset = data(options, out)
    trained = networks_of(options, out, dataset)
    detectors, whole = [trained["detector"]], options.out / "all"
    if options.without and (whole / "detector.pt").exists():
        # On the same pictures as the whole recipe, and beside its network.
        dataset = whole / "data"
        detectors.append(networks.Detector())
        detectors[1].load_state_dict(torch.load(whole / "detector.pt")["weights"])
        detectors[1].eval()
    report = scores.report(detectors, trained["tracker"], dataset, people, others, options.every, options.briefly)
    (out / "report.md").write_text(report)
    print(f"\n{report}\n{out / 'report.md'}")


if __name__ == "__main__":
    tools.script(main)
