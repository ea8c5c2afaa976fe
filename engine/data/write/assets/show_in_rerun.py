#!/usr/bin/env python3
"""Shows flights of this dataset in Rerun: images, depth as a point cloud, labels, boxes, paths, curves.

    pip install rerun-sdk mcap mcap-protobuf-support numpy
    python layouts/show_in_rerun.py mcap/TOWN/000/expert-p00000.mcap               opens the viewer
    python layouts/show_in_rerun.py mcap/TOWN/000/*.mcap --save flights.rrd        writes a file for `rerun flights.rrd`
    python layouts/show_in_rerun.py mcap/TOWN/000/expert-p00000.mcap --every 5     every fifth frame only
"""

import argparse
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

CAMERA = "map/drone/camera"
PIXELS = {"mono8": np.uint8, "16UC1": np.uint16, "32UC1": np.uint32, "32FC1": np.float32}


def vector(v):
    return [v.x, v.y, v.z]


def rotation(q):
    return rr.Quaternion(xyzw=[q.x, q.y, q.z, q.w])


def image(message):
    return np.frombuffer(message.data, PIXELS[message.encoding]).reshape(message.height, message.width)


def on_rgb(message):
    rr.log(f"{CAMERA}/rgb", rr.EncodedImage(contents=message.data, media_type=f"image/{message.format}"))


def on_depth(message):
    depth = image(message)
    rr.log(f"{CAMERA}/depth", rr.DepthImage(np.where(np.isfinite(depth), depth, 0.0), meter=1.0))


def on_semantic(message):
    rr.log(f"{CAMERA}/labels", rr.SegmentationImage(image(message)))


def on_instance(message):
    rr.log(f"{CAMERA}/instances", rr.SegmentationImage(image(message)))


def on_camera(message):
    size = [message.width, message.height]
    rr.log(CAMERA, rr.Pinhole(image_from_camera=np.array(message.K).reshape(3, 3), resolution=size))


def on_tf(message):
    places = {"drone": "map/drone", "camera_optical": CAMERA, "target": "map/target"}
    for transform in message.transforms:
        if transform.child_frame_id in places:
            pose = rr.Transform3D(translation=vector(transform.translation), quaternion=rotation(transform.rotation))
            rr.log(places[transform.child_frame_id], pose)


def on_state(message):
    for name in ("visible_by_rays", "visible_by_pixels"):
        rr.log(f"visibility/{name}", rr.Scalars(getattr(message, name)))
    rr.log("distance/drone_to_target_m", rr.Scalars(message.distance_m))
    rr.log("distance/drone_to_obstacle_m", rr.Scalars(message.drone_clearance_m))
    half = [message.radius_m, message.radius_m, 0.5 * message.height_m]
    box = rr.Boxes3D(centers=[[0.0, 0.0, half[2]]], half_sizes=[half], colors=[[255, 60, 60]], labels=["target"])
    rr.log("map/target/body", box)
    boxes = (("full", message.full_box_px, [255, 220, 40]), ("visible", message.visible_box_px, [60, 255, 90]))
    for order, (name, edges, colour) in enumerate(boxes, 31):
        if len(edges) == 4:
            box = rr.Boxes2D(
                array=list(edges), array_format=rr.Box2DFormat.XYXY, colors=[colour], draw_order=float(order)
            )
            rr.log(f"{CAMERA}/target/{name}", box)
        else:
            rr.log(f"{CAMERA}/target/{name}", rr.Clear(recursive=False))


def on_path(entity, colour):
    def show(message):
        points = [vector(pose.position) for pose in message.poses]
        rr.log(entity, rr.LineStrips3D([points], colors=[colour], radii=[0.15]), static=True)

    return show


def on_scene(message):
    for entity in message.entities:
        if entity.frame_id != "map" or not entity.cubes:
            continue
        rr.log(
            f"map/{entity.id}",
            rr.Boxes3D(
                centers=[vector(cube.pose.position) for cube in entity.cubes],
                half_sizes=[[0.5 * side for side in vector(cube.size)] for cube in entity.cubes],
                quaternions=[rotation(cube.pose.orientation) for cube in entity.cubes],
                colors=[[round(255 * c) for c in (cube.color.r, cube.color.g, cube.color.b)] for cube in entity.cubes],
                # Walls hide the depth points and paths; their edges do not.
                fill_mode="majorwireframe" if entity.id.endswith("Building") else "solid",
            ),
            static=True,
        )


def on_caption(message):
    rr.log("captions", rr.TextLog(message.message, level="INFO"))


TOPICS = {
    "/camera/rgb/image": on_rgb,
    "/camera/rgb/camera_info": on_camera,
    "/camera/depth/image": on_depth,
    "/camera/semantic/image": on_semantic,
    "/camera/instance/image": on_instance,
    "/tf": on_tf,
    "/target/state": on_state,
    "/drone/path": on_path("map/paths/drone", [60, 200, 120]),
    "/target/path": on_path("map/paths/target", [90, 80, 230]),
    "/scene": on_scene,
    "/captions": on_caption,
}
PER_FRAME = ("/camera/", "/tf", "/target/state")


def labels(reader):
    """CARLA's labels as `id: name #rrggbb`, out of the log's metadata."""
    for record in reader.iter_metadata():
        if record.name == "cosfly.semantic_labels":
            for number, text in sorted(record.metadata.items()):
                name, colour = text.split(" #")
                channels = [int(colour[i : i + 2], 16) for i in (0, 2, 4)]
                yield rr.AnnotationInfo(id=int(number), label=name, color=channels)


def show(path, every):
    with path.open("rb") as file:
        rr.log(f"{CAMERA}/labels", rr.AnnotationContext(list(labels(make_reader(file)))), static=True)
    rr.log("map", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    frame_of = {}
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages(topics=list(TOPICS)):
            frame = frame_of.setdefault(message.log_time, len(frame_of))
            if frame % every and channel.topic.startswith(PER_FRAME):
                continue
            rr.set_time("frame", sequence=frame)
            rr.set_time("time", duration=message.log_time * 1e-9)
            TOPICS[channel.topic](decoded)


def blueprint():
    def pictures(name, *shown):
        contents = [f"{CAMERA}/{entity}/**" for entity in shown]
        return rrb.Spatial2DView(origin=CAMERA, contents=contents, name=name)

    scene = rrb.Spatial3DView(
        origin="map", contents=["map/**", f"- {CAMERA}/labels/**", f"- {CAMERA}/instances/**"], name="Scene"
    )
    channels = rrb.Horizontal(
        pictures("Depth", "depth"), rrb.Tabs(pictures("Labels", "labels"), pictures("Instances", "instances"))
    )
    curves = rrb.Horizontal(
        rrb.TimeSeriesView(origin="visibility", name="Visibility", axis_y=rrb.ScalarAxis(range=(-0.05, 1.05))),
        rrb.TimeSeriesView(origin="distance", name="Distances, m"),
        rrb.TextLogView(origin="captions", name="Captions"),
    )
    left = rrb.Vertical(pictures("Colour", "rgb", "target"), channels, row_shares=[3, 2])
    whole = rrb.Vertical(rrb.Horizontal(left, scene), curves, row_shares=[3, 1])
    return rrb.Blueprint(whole, rrb.TimePanel(timeline="frame", state="collapsed"), collapse_panels=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", type=Path, nargs="+")
    parser.add_argument("--save", type=Path, help="write this .rrd file instead of opening the viewer")
    parser.add_argument("--every", type=int, default=1, help="show every Nth frame (default: all)")
    arguments = parser.parse_args()
    if arguments.every < 1:
        parser.error("--every must be at least 1")
    for path in arguments.logs:
        recording = rr.RecordingStream("cosfly", recording_id=path.stem)
        with recording:
            if arguments.save is None:
                rr.spawn(default_blueprint=blueprint())
            else:
                several = len(arguments.logs) > 1
                target = arguments.save.with_stem(f"{arguments.save.stem}-{path.stem}") if several else arguments.save
                rr.save(target, default_blueprint=blueprint())
            rr.send_recording_name(path.stem)
            show(path, arguments.every)
            recording.flush()


if __name__ == "__main__":
    main()
