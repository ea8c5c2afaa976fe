"""Other people's loaders on the same small frames, each with the files that it reads fastest; used by `loading_speed.py`.

Each function writes the windows (5 frames, RGB uint8, depth float16) in its library's format and returns an endless iterator of windows in random
order, in this process: no worker helps."""

import itertools
import logging
import os
from pathlib import Path

import numpy as np


def all_of():
    """Names and functions of the libraries that are installed."""
    found = {}
    for name, module, function in (
        ("LeRobot", "lerobot", lerobot), ("webdataset", "webdataset", web), ("litdata", "litdata", lit),
    ):  # fmt: skip
        try:
            version = __import__(module).__version__
            found[f"{name} {version}"] = function
        except ImportError:
            print(f"{name:44} skipped: it is not installed (pip install {module})")
    return found


def lerobot(windows, frames, folder: Path):
    """A dataset with pictures in tables and depth as a feature; windows by `delta_timestamps`, at random."""
    os.environ["HF_HUB_OFFLINE"] = "1"
    logging.disable(logging.WARNING)
    from lerobot.datasets.lerobot_dataset import LeRobotDataset

    width, height = windows.size
    features = {
        "observation.images.rgb": {"dtype": "image", "shape": (height, width, 3), "names": ["height", "width", "channels"]},
        "observation.depth": {"dtype": "float32", "shape": (height, width), "names": None},
    }
    made = LeRobotDataset.create("local/frames", fps=2, features=features, root=folder, use_videos=False)
    first, places = {}, 0
    for name, group in itertools.groupby(range(len(frames)), lambda place: frames._index[place][0]):
        first[name] = places
        for place in group:
            sample = frames[place]
            depth = np.minimum(sample["depth"], 6e4).astype(np.float32)
            made.add_frame({"observation.images.rgb": sample["rgb"], "observation.depth": depth, "task": "follow"})
            places += 1
        made.save_episode()
    made.finalize()
    ahead = [0.5 * it for it in range(5)]
    data = LeRobotDataset("local/frames", root=folder, delta_timestamps={"observation.images.rgb": ahead, "observation.depth": ahead})

    def each():
        rng = np.random.default_rng(8)
        while True:
            name, start = windows._index[rng.integers(len(windows))]
            sample = data[first[name] + start]
            assert sample["observation.images.rgb"].shape == (5, 3, height, width), sample["observation.images.rgb"].shape
            yield sample

    return each()


def web(windows, frames, folder: Path):
    """Shards of windows as .npy members; shuffled by shards and a buffer, since tar files have no random access."""
    import webdataset

    folder.mkdir()
    order = np.random.default_rng(8).permutation(len(windows))
    with webdataset.ShardWriter(str(folder / "%06d.tar"), maxcount=100, verbose=0) as sink:
        for number in order:
            sample = windows[int(number)]
            sink.write({"__key__": f"{number:08}", "rgb.npy": sample["rgb"], "depth.npy": sample["depth"].astype(np.float16)})
    shards = sorted(str(path) for path in folder.glob("*.tar"))
    data = webdataset.WebDataset(shards, shardshuffle=100, empty_check=False, seed=8).shuffle(50).decode().repeat()
    return iter(data)


def lit(windows, frames, folder: Path):
    """Chunks of windows as numpy arrays; shuffled as the library does."""
    import litdata

    os.environ["DATA_OPTIMIZER_CACHE_FOLDER"] = str(folder) + "-cache"
    os.environ["DATA_OPTIMIZER_DATA_CACHE_FOLDER"] = str(folder) + "-cache2"
    cache = litdata.streaming.cache.Cache(str(folder), chunk_bytes="64MB")
    for number in range(len(windows)):
        sample = windows[number]
        cache[number] = {"rgb": sample["rgb"], "depth": sample["depth"].astype(np.float16)}
    cache.done()
    cache.merge()
    data = litdata.StreamingDataset(str(folder), shuffle=True, seed=8)

    def each():
        while True:
            yield from data

    return each()
