#!/usr/bin/env python3
"""Memory and file descriptors over many random accesses to a dataset: python million_accesses.py DATASET [--accesses 1000000]

Reads random frames of all channels through `cosfly.Dataset` (and, in turn, windows of a training pack and tables), and stops with an error if memory
grows or a descriptor is lost between the first tenth and the end."""

import ctypes
import os
import tempfile
import time

import numpy as np

import cosfly
from shared import command_line

GROWTH_MIB = 24


def state():
    """Resident memory in MiB, and the number of open descriptors."""
    ctypes.CDLL(None).malloc_trim(0)  # what the allocator keeps for later is no leak
    with open("/proc/self/status") as status:
        kib = next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))
    return kib / 1024, len(os.listdir("/proc/self/fd"))


options = command_line("dataset", accesses=1_000_000)
dataset = cosfly.Dataset(options.dataset, channels=(), size=(64, 36))
channels = dataset.channels_of(dataset.trajectory_ids[0])
rng, began = np.random.default_rng(1), time.time()
with tempfile.TemporaryDirectory() as scratch:
    cosfly.pack(options.dataset, f"{scratch}/pack", size=(64, 36), progress=False)
    pack = cosfly.Pack(f"{scratch}/pack", options.dataset).windows()
    first = None
    for access in range(options.accesses):
        name, frame = dataset._index[rng.integers(len(dataset))]
        images = dataset.frame(name, frame, channels=[channels[access % len(channels)]])
        assert all(image.shape[:2] == (36, 64) for image in images.values())
        if access % 10 == 0:
            assert pack[int(rng.integers(len(pack)))]["rgb"].shape[1:3] == (36, 64)
        if access % 1000 == 0:
            assert len(dataset.table("trajectories")["frames"]) > 0
        if access % (options.accesses // 10) == 0:
            memory, descriptors = state()
            print(f"{access:9} accesses: {memory:7.1f} MiB, {descriptors} descriptors, {time.time() - began:6.0f} s", flush=True)
            first = first or (access and (memory, descriptors)) or None
memory, descriptors = state()
print(f"{options.accesses:9} accesses: {memory:7.1f} MiB, {descriptors} descriptors, {time.time() - began:6.0f} s")
assert memory < first[0] + GROWTH_MIB, f"memory grew from {first[0]:.1f} to {memory:.1f} MiB"
assert descriptors <= first[1], f"descriptors grew from {first[1]} to {descriptors}"
