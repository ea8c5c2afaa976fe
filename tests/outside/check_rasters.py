"""Lanes and walkable polygons of our OpenDRIVE reader against independent rasters of the same CARLA towns.

Usage: `check_rasters.py FOLDER_OF_EXAMPLES XODR_FOLDER RASTER_FOLDER` (pip install numpy h5py). The folder holds the examples `dump_lanes` and
`ground_labels` of the room `maps`, built. A raster is HDF5 with layers `road`, `sidewalk` and the attributes `pixels_per_meter` and
`world_offset_in_meters`; column = (x - offset) * ppm, row = (y - offset) * ppm, y being CARLA's. The rasters leave out the pavements of junction
corners and draw the others about half a metre wider on either side than the lanes are: hence shares below 1. Grass on road is the share of the
raster's road whose pixels are grass in our surfaces, seen from above; mostly edges of half a metre. Exits 1 below the shares listed in LEAST, and
above those in MOST_GRASS."""

import pathlib
import sys

import h5py
import numpy
from shapely import Polygon, contains_xy
from shared import json_of, run

# Shares: lane centres on road, pavement centres on pavement, area of pavement polygons on pavement,
# area of the raster's pavement that is ours.
LEAST = {
    "Town01": (0.99, 0.93, 0.95, 0.75),
    # Its raster is of a newer town, and leaves out the `bidirectional` lanes: `driving` ones alone are on road to 0.998.
    "Town03_2019-04": (0.90, 0.68, 0.70, 0.60),
    "Town04": (0.99, 0.86, 0.90, 0.70),
    "Town06": (0.99, 0.0, 0.0, 0.0),  # no pavements
    "Town07": (0.99, 0.78, 0.80, 0.60),
}

MOST_GRASS = {"Town01": 0.001, "Town03_2019-04": 0.017, "Town04": 0.005, "Town06": 0.005, "Town07": 0.03}
GRASS = 10  # CARLA's label of terrain


class Raster:
    def __init__(self, path):
        with h5py.File(path) as file:
            self.ppm = float(file.attrs["pixels_per_meter"])
            self.offset = numpy.array(file.attrs["world_offset_in_meters"], dtype=float)
            self.layers = {name: file[name][:] > 0 for name in ("road", "sidewalk", "shoulder", "parking")}

    def pixels(self, points):
        return (numpy.asarray(points)[:, :2] - self.offset) * self.ppm

    def share(self, points, *names):
        """Share of points on any of the layers."""
        if len(points) == 0:
            return 0.0
        layer = numpy.logical_or.reduce([self.layers[name] for name in names])
        columns, rows = numpy.floor(self.pixels(points)).astype(int).T
        inside = (columns >= 0) & (rows >= 0) & (columns < layer.shape[1]) & (rows < layer.shape[0])
        return float(layer[rows[inside], columns[inside]].sum() / len(points))

    def drawn(self, outlines):
        """Mask of the pixels whose centres lie in any outline."""
        mask = numpy.zeros(self.layers["road"].shape, dtype=bool)
        for outline in outlines:
            shape = Polygon(self.pixels(outline))
            low = numpy.maximum(numpy.floor(shape.bounds[:2]).astype(int), 0)
            high = numpy.minimum(numpy.ceil(shape.bounds[2:]).astype(int), mask.shape[::-1])
            if (high <= low).any():
                continue
            x, y = numpy.meshgrid(numpy.arange(low[0], high[0]) + 0.5, numpy.arange(low[1], high[1]) + 0.5)
            mask[low[1] : high[1], low[0] : high[0]] |= contains_xy(shape, x, y)
        return mask


def grass_on_road(examples, xodr, raster):
    """Share of the raster's road that is grass in our surfaces."""
    road = raster.layers["road"]
    numbers = [*raster.offset, *road.shape[::-1], 1 / raster.ppm]
    labels = numpy.frombuffer(run(examples / "ground_labels", xodr, *numbers, text=False), numpy.uint8)
    return float((labels.reshape(road.shape) == GRASS)[road].mean())


def check(examples, xodr, raster_path):
    dump = json_of(examples / "dump_lanes", xodr, 2)
    raster = Raster(raster_path)
    grass = grass_on_road(examples, xodr, raster)
    centres = {"Carriageway": [], "Sidewalk": [], "Shoulder": []}
    for sample in dump["lanes"]:
        if sample["width"] > 0.5 and sample["kind"] in centres:
            centres[sample["kind"]].append(sample["position"])
    ours = raster.drawn([polygon["outline"] for polygon in dump["walkable"] if polygon["kind"] == "Sidewalk"])
    theirs = raster.layers["sidewalk"]
    both, either = (ours & theirs).sum(), (ours | theirs).sum()
    on_road = (ours & raster.layers["road"] & ~theirs).sum()
    shares = (
        raster.share(centres["Carriageway"], "road", "parking", "shoulder"),
        raster.share(centres["Sidewalk"], "sidewalk"),
        float(both / ours.sum()) if ours.any() else 0.0,
        float(both / theirs.sum()) if theirs.any() else 0.0,
    )
    print(
        f"{xodr.stem} ({raster.ppm:.0f} px/m): lane centres on road {shares[0]:.4f}, pavement centres on pavement "
        f"{shares[1]:.4f}; pavement polygons: {shares[2]:.4f} of ours is theirs, {shares[3]:.4f} of theirs is ours, "
        f"overlap over union {both / max(either, 1):.4f}, {on_road / max(ours.sum(), 1):.4f} of ours is road there; grass on road {grass:.4f}"
    )
    least = LEAST.get(xodr.stem, (0.0,) * 4)
    return all(share >= wanted for share, wanted in zip(shares, least)) and grass <= MOST_GRASS.get(xodr.stem, 1.0)


programs, xodr_folder, raster_folder = map(pathlib.Path, sys.argv[1:])
rasters = [(xodr, raster_folder / f"{xodr.stem.split('_')[0]}_4ppm.h5") for xodr in sorted(xodr_folder.glob("*.xodr"))]
results = [check(programs, xodr, path) for xodr, path in rasters if path.is_file()]
print(f"{len(results)} towns have rasters")
sys.exit(not all(results))
