"""How far the pictures of kinds of places are apart, of a dataset whose towns are named KIND_NUMBER, as those of `kinds.toml` are.

    python recipes/training/paper/kind_distances.py out/kinds/data --pack out/kinds/small

Features of a picture: shares of the ten commonest labels, the logarithm of the median distance in nine fields, mean and spread of the colours.
Printed is the Frechet distance between the features of two towns, in units of their spread over all pictures: the mean over the towns of one kind,
and over those of two kinds."""

import argparse
import re
import sys
from itertools import combinations, product
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))  # tools.py
import tools

tools.need("numpy", "cosfly", "pyarrow.parquet")
import numpy as np

FARTHEST_M = 1000.0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("dataset", type=Path)
    parser.add_argument("--pack", type=Path, required=True, help="folder for the small pictures, made where it is missing")
    return parser.parse_args()


def features(rgb, depth_m, labels, common):
    """Numbers of pictures: (pictures, height, width[, 3]) arrays."""
    count, height, width = labels.shape
    shares = np.stack([(labels == label).mean(axis=(1, 2)) for label in common], axis=1)
    far = np.log(np.clip(np.nan_to_num(depth_m, nan=FARTHEST_M, posinf=FARTHEST_M), 0.5, FARTHEST_M))
    rows, columns = height // 3, width // 3
    fields = far[:, : 3 * rows, : 3 * columns].reshape(count, 3, rows, 3, columns)
    medians = np.median(fields.transpose(0, 1, 3, 2, 4).reshape(count, 9, -1), axis=2)
    colours = rgb.reshape(count, -1, 3) / 255.0
    return np.concatenate([shares, medians, colours.mean(axis=1), colours.std(axis=1)], axis=1)


def frechet(a, b):
    """Frechet distance of two clouds of rows of numbers."""
    one, other = np.cov(a.T), np.cov(b.T)
    both = np.clip(np.linalg.eigvals(one @ other).real, 0.0, None)
    means = ((a.mean(axis=0) - b.mean(axis=0)) ** 2).sum()
    return float(means + np.trace(one) + np.trace(other) - 2.0 * np.sqrt(both).sum())


def clouds(dataset, folder):
    """Features of all pictures of each town, in units of their spread."""
    import cosfly

    if not folder.exists():
        cosfly.pack(dataset, folder, size=(64, 36), channels=("rgb", "depth", "semantic"), progress=False)
    pack = cosfly.Pack(folder, dataset)
    labels = pack.array("semantic")
    common = np.argsort(np.bincount(labels.reshape(-1), minlength=32))[::-1][:10]
    numbers = features(np.asarray(pack.array("rgb")), np.asarray(pack.array("depth"), dtype=np.float32), labels, common)
    numbers /= numbers.std(axis=0) + 1e-9
    towns = {}
    for flight, frames in frames_of(dataset, folder):
        towns.setdefault(flight, []).append(numbers[frames])
    return {town: np.concatenate(parts) for town, parts in towns.items()}


def frames_of(dataset, folder):
    """Town and places in the pack of every flight."""
    import json

    import pyarrow.parquet as parquet

    first = json.loads((folder / "pack.json").read_text())["first_frame"]
    for path in sorted((dataset / "data" / "trajectories").glob("*.parquet")):
        for row in parquet.read_table(path, columns=["trajectory_id", "town", "frames"]).to_pylist():
            begin = first[row["trajectory_id"]]
            yield row["town"], slice(begin, begin + row["frames"])


def main():
    given = arguments()
    towns = clouds(given.dataset, given.pack)
    kinds = {}
    for town in sorted(towns):
        kinds.setdefault(re.sub(r"_\d+$", "", town), []).append(towns[town])
    mean = lambda pairs: float(np.mean([frechet(*pair) for pair in pairs]))
    apart = {frozenset(pair): mean(product(*(kinds[kind] for kind in pair))) for pair in combinations(kinds, 2)}
    print("| kind | towns of it | nearest kind | | farthest kind | |\n| --- | ---: | --- | ---: | --- | ---: |")
    for kind, parts in kinds.items():
        own = mean(combinations(parts, 2)) if len(parts) > 1 else float("nan")
        others = sorted((apart[frozenset((kind, other))], other) for other in kinds if other != kind)
        (near, nearest), (far, farthest) = others[0], others[-1]
        print(f"| `{kind}` | {own:.1f} | `{nearest}` | {near:.1f} | `{farthest}` | {far:.1f} |")


if __name__ == "__main__":
    tools.script(main)
