#!/usr/bin/env python3
"""Frames per second of CPU time of random windows (5 frames, RGB and depth, 224 x 126) from a dataset, on one core.

Usage: `loading_speed.py out/carla_town [--windows 20] [--trajectories 8]`. Compared are the package `cosfly` (logs, and a training pack) and the
pure-Python way: the `mcap` package, Pillow, numpy. Pillow's scaled decoding (`draft`) is libjpeg-turbo's. Needs cosfly, mcap, mcap-protobuf-support,
numpy, pillow, pyarrow. Beside the pack stand the loaders of LeRobot, webdataset and litdata, where they are installed, on the same frames at the same
size (`loading_of_others.py`), of the first trajectories only: they take long to write. Each way must give windows with the same shapes; the process
has one thread."""

import io
import os
import tempfile
import time
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from PIL import Image

for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"

import cosfly
import loading_of_others
from shared import command_line

SIZE = (224, 126)


def seconds_of(read, cases):
    began = time.process_time()
    for case in cases:
        read(*case)
    return time.process_time() - began


def measure(name, read, windows):
    read(*windows[0])
    took = seconds_of(read, windows)
    print(f"{name:44} {5 * len(windows) / took:8.1f} frames per CPU second, {1e3 * took / 5 / len(windows):7.2f} ms a frame")


def main():
    options = command_line("dataset", windows=20, trajectories=8)
    rows = {row["trajectory_id"]: row for row in pq.read_table(options.dataset / "data/trajectories").to_pylist()}
    windows = cosfly.Dataset(options.dataset, size=SIZE).windows()
    numbers = np.random.default_rng(7).integers(0, len(windows), options.windows)
    places = [(int(number), *windows._index[number]) for number in numbers]
    readers = {}

    def plain(draft):
        def read(_, name, start):
            row = rows[name]
            if name not in readers:
                file = open(options.dataset / row["mcap_path"], "rb")
                readers[name] = make_reader(file, decoder_factories=[DecoderFactory()])
            first, last = (round((start + k) * row["dt_s"] * 1e9) for k in (0, 4))
            topics = ["/camera/rgb/image", "/camera/depth/image"]
            found = []
            for _, channel, _, it in readers[name].iter_decoded_messages(topics, starting_at=first, ending_at=last):
                if channel.topic == topics[0]:
                    image = Image.open(io.BytesIO(it.data))
                    if draft:
                        image.draft("RGB", SIZE)
                    found.append(np.array(image.resize(SIZE, Image.BOX)))
                else:
                    depth = np.frombuffer(it.data, "<f4").reshape(it.height, it.width)
                    rows_, columns = (np.arange(n) * 2 + 1 for n in (SIZE[1], SIZE[0]))
                    found.append(depth[rows_ * it.height // (2 * SIZE[1])][:, columns * it.width // (2 * SIZE[0])])
            assert len(found) == 10
        return read

    measure("mcap, Pillow, numpy", plain(False), places)
    measure("mcap, Pillow with scaled decoding, numpy", plain(True), places)
    measure("cosfly.Dataset, from the logs", lambda number, *_: windows[number], places)
    for channel in ("rgb", "depth"):
        alone = cosfly.Dataset(options.dataset, size=SIZE, channels=(channel,)).windows()
        measure(f"  {channel} alone", lambda number, *_: alone[number], places)
    files = [(windows._reader.rgb_file(windows._number[name], start),) for _, name, start in places]

    def turbo(file):
        image = Image.open(io.BytesIO(file))
        image.draft("RGB", SIZE)
        image.load()

    one = lambda decode: [1e3 * seconds_of(decode, files) / len(files) for _ in range(3)][-1]
    ours, theirs = one(lambda file: cosfly.decode_rgb(file, (320, 180))), one(turbo)
    print(f"a JPEG file to a quarter of its size: {ours:.2f} ms, libjpeg-turbo {theirs:.2f} ms, ratio {ours / theirs:.2f}")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        cosfly.pack(options.dataset, scratch / "pack", size=SIZE, progress=False)
        packed = cosfly.Pack(scratch / "pack", options.dataset).windows()
        many = lambda: [(int(number),) for number in np.random.default_rng(8).integers(0, len(packed), 20 * options.windows)]
        measure("cosfly.Pack", lambda number: packed[number], many())
        few = packed.trajectory_ids[: options.trajectories]
        packed = cosfly.Pack(scratch / "pack", options.dataset, trajectories=few).windows()
        frames = cosfly.Dataset(options.dataset, size=SIZE, trajectories=few)
        print(f"on {len(packed)} windows of {len(few)} trajectories:")
        measure("cosfly.Pack", lambda number: packed[number], many())
        for name, function in loading_of_others.all_of().items():
            windows = function(packed, frames, scratch / name.split()[0])
            measure(name, lambda *_: next(windows), many())
        measure("cosfly.Pack, again", lambda number: packed[number], many())


main()
