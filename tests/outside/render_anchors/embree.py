"""Casts one Embree ray per pixel at the boxes: closest hit, so depth and box of each pixel.

usage: embree.py BOXES.json [--rounds N]
"""

import numpy
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

from scene import Scene, arguments, least_cpu_ms, said

# Corners of a cube by bits x, y, z; two triangles per side.
TRIANGLES = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]


def triangles_of(scene):
    """All boxes and two triangles of ground, as (n, 3, 3) corners; box of triangle k: k // 12."""
    signs = numpy.array([[(k & 1) * 2 - 1, (k >> 1 & 1) * 2 - 1, (k >> 2 & 1) * 2 - 1] for k in range(8)], dtype=float)
    local = signs[None] * scene.halves[:, None]
    cos, sin = numpy.cos(scene.yaws)[:, None], numpy.sin(scene.yaws)[:, None]
    corners = numpy.stack(
        [cos * local[..., 0] - sin * local[..., 1], sin * local[..., 0] + cos * local[..., 1], local[..., 2]], axis=-1
    ) + scene.centers[:, None]
    boxes = corners[:, numpy.array(TRIANGLES)].reshape(-1, 3, 3)
    (x0, y0, z), (x1, y1, _) = scene.ground_low, scene.ground_high
    ground = [[[x0, y0, z], [x1, y0, z], [x1, y1, z]], [[x0, y0, z], [x1, y1, z], [x0, y1, z]]]
    return numpy.concatenate([boxes, numpy.array(ground)]).astype(numpy.float32)


def main():
    options = arguments(__doc__)
    scene = Scene(options.boxes)
    world = rtcore_scene.EmbreeScene()
    TriangleMesh(world, triangles_of(scene))
    across = (numpy.arange(scene.width) + 0.5 - 0.5 * scene.width) / scene.focal_px
    down = (numpy.arange(scene.height) + 0.5 - 0.5 * scene.height) / scene.focal_px
    # Length 1 along the optical axis: a ray's parameter is the planar depth.
    in_body = numpy.stack(
        [numpy.ones((scene.height, scene.width)), *numpy.meshgrid(across, -down)], axis=-1
    ).reshape(-1, 3)
    # Rays are made before the clock starts: the casting alone is measured.
    rays = [
        (numpy.tile(position.astype(numpy.float32), (len(in_body), 1)), (in_body @ axes.T).astype(numpy.float32))
        for position, axes in scene.views[: min(len(scene.views), 6)]
    ]

    def cast(ray):
        return world.run(ray[0], ray[1], query="INTERSECT", output=True)

    cpu_ms = least_cpu_ms(cast, rays, options.rounds)
    hit = cast(rays[0])
    box = hit["primID"] // 12
    on_boxes = (hit["primID"] >= 0) & (box < len(scene.instances))
    instance = numpy.where(on_boxes, scene.instances[numpy.where(on_boxes, box, 0)], 0)
    scene.views = scene.views[: len(rays)]
    said("embree", scene, cpu_ms, hit["tfar"], instance)


if __name__ == "__main__":
    main()
