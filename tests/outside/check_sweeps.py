"""Sweeps of a lidar as laspy reads them, against the table: `check_sweeps.py DATASET TABLE EXPORT`."""

import sys
from pathlib import Path

import laspy
import numpy as np
from shared import POINT, rows

dataset, table, export = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
count = 0
for row in rows(dataset, table):
    (path,) = export.glob(f"**/{row['trajectory_id']}/**/las/{row['row']:06}.las")
    read, points = laspy.read(path), np.frombuffer(row["cloud"], POINT)
    assert np.abs(np.stack([read.x, read.y, read.z], 1) - points["place"] * [1, -1, 1]).max() < 6e-5, path
    assert np.array_equal(read.classification, points["label"]) and np.array_equal(read.instance, points["instance"]), path
    assert np.array_equal(read.ring, points["ring"]) and np.allclose(read.gps_time, row["time_s"] + points["time"], atol=1e-8), path
    assert np.abs(read.intensity - points["intensity"] * 65535.0).max() < 0.51, path
    count += len(points)
print(f"laspy reads the {count} points of the table")
