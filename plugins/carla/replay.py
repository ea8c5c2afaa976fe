#!/usr/bin/env python3
"""Flies the flights of a cosfly dataset through a running CARLA server and writes the same logs with its pictures.

    pip install -r plugins/carla/requirements.txt
    cosfly carla-job out/Town01 --out job.json
    ./CarlaUE4.sh -RenderOffScreen &
    python plugins/carla/replay.py job.json out/Town01 --out out/Town01-carla

The server runs in synchronous mode, one tick per frame. Colour, depth, semantic and instance cameras hang at the flight's
poses with the flight's lens; one walker stands where the target is; the weather has the flight's 14 numbers. Each log is a
copy of the dataset's log in which the messages of the images are the server's: same topics, schemas, times, poses.
"""

import argparse
import contextlib
import io
import json
import queue
import sys
from pathlib import Path

import carla
import numpy as np
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from mcap_protobuf.decoder import DecoderFactory
from PIL import Image

FORMAT, VERSION = "cosfly-carla-job", 1
# Topic of the full image -> blueprint of the camera that fills it.
CAMERAS = {
    "/camera/rgb/image": "sensor.camera.rgb",
    "/camera/depth/image": "sensor.camera.depth",
    "/camera/semantic/image": "sensor.camera.semantic_segmentation",
    "/camera/instance/image": "sensor.camera.instance_segmentation",
}
FAR_M = 1000.0  # CARLA's far plane; what lies there is sky
PEDESTRIAN = 12
WITHOUT_INSTANCE = (0, 1, 2, 10, 11, 23, 24, 25)  # nothing, roads, pavements, terrain, sky, water, road lines, ground
WARM_UP_TICKS = 10  # textures and exposure settle
TIMEOUT_S = 60.0


class ReplayError(Exception):
    """Something that the user can mend, in words."""


# -- the job -------------------------------------------------------------------------------------------------------------


def load_job(path):
    """The job in `path`, checked as far as a wrong one would be misread."""
    try:
        job = json.loads(Path(path).read_text())
    except (OSError, ValueError) as error:
        raise ReplayError(f"{path} is no job file: {error}") from error
    if not isinstance(job, dict) or job.get("format") != FORMAT:
        raise ReplayError(f"{path} is no job file; `cosfly carla-job DATASET --out job.json` writes one")
    if job.get("version") != VERSION:
        raise ReplayError(f"{path} has version {job.get('version')}; this script reads version {VERSION}")
    for flight in job["flights"]:
        numbers = [n for frame in flight["frames"] for n in frame["camera"] + frame["target"]]
        if not np.isfinite(numbers).all():
            raise ReplayError(f"{path}: flight {flight['trajectory_id']} has a number that is not finite")
        unknown = [name for name in flight["weather"] if not hasattr(carla.WeatherParameters(), name)]
        if unknown:
            raise ReplayError(f"{path}: this carla package knows no weather parameter {unknown}")
    return job


def camera_transform(frame):
    """Metres and degrees, CARLA's own frame and signs."""
    x, y, z, pitch, yaw, roll = frame["camera"]
    return carla.Transform(carla.Location(x=x, y=y, z=z), carla.Rotation(pitch=pitch, yaw=yaw, roll=roll))


def walker_transform(frame, feet_below_m):
    """A walker's own origin lies in its middle, `feet_below_m` above its feet."""
    x, y, z, heading, _ = frame["target"]
    return carla.Transform(carla.Location(x=x, y=y, z=z + feet_below_m), carla.Rotation(yaw=heading))


def walker_control(frame):
    heading, speed = np.radians(frame["target"][3]), frame["target"][4]
    direction = carla.Vector3D(x=float(np.cos(heading)), y=float(np.sin(heading)), z=0.0)
    return carla.WalkerControl(direction=direction, speed=float(speed), jump=False)


# -- the server's pictures -----------------------------------------------------------------------------------------------


def bgra(image):
    return np.frombuffer(image.raw_data, np.uint8).reshape(image.height, image.width, 4)


def rgb_of(image):
    return np.ascontiguousarray(bgra(image)[:, :, 2::-1])


def depth_of(image):
    """Planar depth in metres: 24 bits over 1000 m, red lowest; +inf for what lies at the far plane."""
    b, g, r = (bgra(image)[:, :, i].astype(np.uint32) for i in range(3))
    bits = r + (g << 8) + (b << 16)
    depth = bits.astype(np.float64) * (FAR_M / (2**24 - 1))
    return np.where(bits >= 2**24 - 1, np.inf, depth).astype("<f4")


def labels_of(image):
    return np.ascontiguousarray(bgra(image)[:, :, 2])


def instances_of(image, target_box):
    """Ids as in cosfly's logs: 0 ground and sky, 1 the target, else the server's id + 2.

    The server does not say which id an actor has. The only walker of the world is the target: its id is that of most
    pedestrian pixels in the box where its body must be.
    """
    pixels = bgra(image)
    label = pixels[:, :, 2]
    raw = pixels[:, :, 1].astype(np.uint32) | pixels[:, :, 0].astype(np.uint32) << 8
    ids = np.minimum(raw + 2, np.iinfo(np.uint16).max)
    ids[np.isin(label, WITHOUT_INSTANCE)] = 0
    if target_box is not None:
        left, top, right, bottom = target_box
        found = raw[top:bottom, left:right][label[top:bottom, left:right] == PEDESTRIAN]
        if found.size:
            ids[(label == PEDESTRIAN) & (raw == np.bincount(found).argmax())] = 1
    return ids


def grown(box, width, height):
    """A box of the body, half as large again on every side: meshes are wider than the planned cylinder."""
    if len(box) != 4:
        return None
    left, top, right, bottom = (int(edge) for edge in box)
    dx, dy = (right - left + 1) // 2 + 2, (bottom - top + 1) // 2 + 2
    return max(left - dx, 0), max(top - dy, 0), min(right + dx, width), min(bottom + dy, height)


def box_of(mask):
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not rows.size:
        return []
    return [int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1]


# -- flying --------------------------------------------------------------------------------------------------------------


def connect(host, port):
    client = carla.Client(host, port)
    client.set_timeout(TIMEOUT_S)
    try:
        client.get_server_version()
    except RuntimeError as error:
        raise ReplayError(f"no CARLA server answers at {host}:{port}: {error}") from error
    return client


def world_for(client, town, keep_map):
    """The world with the flight's map."""
    current = client.get_world().get_map().name.split("/")[-1]
    if keep_map or current == town or current == f"{town}_Opt":
        return client.get_world()
    available = [name.split("/")[-1] for name in client.get_available_maps()]
    if town not in available:
        raise ReplayError(
            f"the server has no map {town}; it has {', '.join(sorted(available))}. Load the right one and give --keep-map, "
            "or fly a dataset that was planned in one of its towns"
        )
    return client.load_world(town)


@contextlib.contextmanager
def synchronous(world, dt_s):
    """One tick is one frame; the former settings come back, whatever happens."""
    before = world.get_settings()
    settings = world.get_settings()
    settings.synchronous_mode = True
    settings.fixed_delta_seconds = dt_s
    settings.substepping = True  # the server wants dt <= substeps * their length
    settings.max_substep_delta_time = max(0.01, dt_s / 16.0)
    settings.max_substeps = 16
    world.apply_settings(settings)
    try:
        yield
    finally:
        world.apply_settings(before)


def spawn_cameras(world, flight, transform):
    library = world.get_blueprint_library()
    lens = flight["camera"]
    cameras = {}
    for topic, name in CAMERAS.items():
        blueprint = library.find(name)
        blueprint.set_attribute("image_size_x", str(lens["width_px"]))
        blueprint.set_attribute("image_size_y", str(lens["height_px"]))
        blueprint.set_attribute("fov", repr(lens["fov_deg"]))
        blueprint.set_attribute("sensor_tick", "0.0")
        for attribute in ("motion_blur_intensity", "lens_flare_intensity"):
            if blueprint.has_attribute(attribute):
                blueprint.set_attribute(attribute, "0.0")
        actor = world.spawn_actor(blueprint, transform)
        images = queue.Queue()
        actor.listen(images.put)
        cameras[topic] = (actor, images)
    return cameras


def spawn_walker(world, flight):
    blueprints = sorted(world.get_blueprint_library().filter("walker.pedestrian.*"), key=lambda it: it.id)
    if not blueprints:
        raise ReplayError("the server has no walkers")
    blueprint = blueprints[flight["target"]["walker"] % len(blueprints)]
    if blueprint.has_attribute("is_invincible"):
        blueprint.set_attribute("is_invincible", "true")
    # Spawned above the place, because a spawn that touches anything fails; the first tick brings it down.
    walker = world.try_spawn_actor(blueprint, walker_transform(flight["frames"][0], 3.0))
    if walker is None:
        raise ReplayError(f"no walker could be spawned at the start of {flight['trajectory_id']}: is it the right map?")
    walker.set_simulate_physics(False)
    return walker


def picture_of(images, tick):
    """The picture of one tick; older ones are thrown away."""
    while True:
        try:
            image = images.get(timeout=TIMEOUT_S)
        except queue.Empty:
            raise ReplayError(f"the server gave no picture of tick {tick} within {TIMEOUT_S:.0f} s") from None
        if image.frame >= tick:
            return image


def check_place(image, wanted):
    found, place = image.transform.location, wanted.location
    apart = max(abs(found.x - place.x), abs(found.y - place.y), abs(found.z - place.z))
    if apart > 0.01:
        raise ReplayError(f"tick {image.frame} was drawn {apart:.2f} m from where the camera should be")


def fly(world, flight):
    """Yields the four pictures of each frame, by topic."""
    weather = carla.WeatherParameters()
    for name, value in flight["weather"].items():
        setattr(weather, name, value)
    world.set_weather(weather)
    actors = []
    try:
        with synchronous(world, flight["dt_s"]):
            walker = spawn_walker(world, flight)
            actors.append(walker)
            body = walker.bounding_box
            feet_below_m = body.extent.z - body.location.z
            cameras = spawn_cameras(world, flight, camera_transform(flight["frames"][0]))
            actors.extend(actor for actor, _ in cameras.values())
            for number, frame in enumerate(flight["frames"]):
                wanted = camera_transform(frame)
                walker.set_transform(walker_transform(frame, feet_below_m))
                walker.apply_control(walker_control(frame))
                for actor, _ in cameras.values():
                    actor.set_transform(wanted)
                for _ in range(WARM_UP_TICKS if number == 0 else 0):
                    world.tick()
                tick = world.tick()
                pictures = {topic: picture_of(images, tick) for topic, (_, images) in cameras.items()}
                for image in pictures.values():
                    check_place(image, wanted)
                yield pictures
    finally:
        for actor in actors:
            if hasattr(actor, "stop"):
                actor.stop()
            actor.destroy()


# -- the log -------------------------------------------------------------------------------------------------------------


def image_file(rgb, kind, **options):
    file = io.BytesIO()
    Image.fromarray(rgb).save(file, kind, **options)
    return file.getvalue()


def shrunk(array, width):
    return Image.fromarray(array).resize((width, max(1, array.shape[0] * width // array.shape[1])))


def depth_colours(depth):
    """Near is bright, far is dark, on a logarithmic scale: a picture to look at."""
    near, far = 0.5, FAR_M
    bright = 1.0 - np.log(np.clip(depth, near, far) / near) / np.log(far / near)
    return (255.0 * np.where(np.isfinite(depth), bright, 0.0)).astype(np.uint8)


class FrameImages:
    """The images of one frame in the forms that the messages take."""

    def __init__(self, pictures, state):
        self.rgb = rgb_of(pictures["/camera/rgb/image"])
        self.depth = depth_of(pictures["/camera/depth/image"])
        self.labels = labels_of(pictures["/camera/semantic/image"])
        height, width = self.labels.shape
        box = grown(state.full_box_px, width, height)
        self.instances = instances_of(pictures["/camera/instance/image"], box)
        self.visible = self.instances == 1

    def fill(self, topic, message, palette):
        """Puts the server's picture into a message of `topic`; gives whether it belongs to the pictures."""
        if topic == "/camera/rgb/image":
            message.data = image_file(self.rgb, message.format.upper(), **({"quality": 95} if message.format == "jpeg" else {}))
        elif topic == "/camera/depth/image":
            message.data = self.depth.tobytes()
        elif topic == "/camera/semantic/image":
            message.data = self.labels.tobytes()
        elif topic == "/camera/instance/image":
            message.data = self.instances.astype("<u2" if message.encoding == "16UC1" else "<u4").tobytes()
        elif topic == "/camera/rgb/preview":
            small = shrunk(self.rgb, min(320, self.rgb.shape[1]))
            message.data = image_file(np.asarray(small), "JPEG", quality=85)
        elif topic == "/camera/depth/preview":
            step = max(1, self.depth.shape[1] // 640)
            message.data = image_file(depth_colours(self.depth[::step, ::step]), "JPEG", quality=85)
        elif topic == "/camera/semantic/preview":
            step = max(1, self.labels.shape[1] // 640)
            small = Image.fromarray(np.ascontiguousarray(self.labels[::step, ::step])).convert("P")
            small.putpalette(palette)
            file = io.BytesIO()
            small.save(file, "PNG")
            message.data = file.getvalue()
        elif topic == "/target/state":
            self.fill_state(message)
        elif topic == "/camera/rgb/annotations":
            self.fill_annotations(message)
        else:
            return False
        return True

    def fill_state(self, state):
        """What can be seen in the server's pictures; the rest is the plan's. No unoccluded silhouette: no share by pixels."""
        state.visible_pixels = int(self.visible.sum())
        del state.visible_box_px[:]
        state.visible_box_px.extend(box_of(self.visible))
        state.visible_by_pixels = float("nan")
        state.occluder_instance = 0

    def fill_annotations(self, annotations):
        """The planned body's box stays; the green box is that of the pixels."""
        del annotations.texts[:]
        while len(annotations.points) > 1:
            del annotations.points[-1]
        box = box_of(self.visible)
        if not box:
            return
        left, top, right, bottom = box
        outline = annotations.points.add()
        if len(annotations.points) > 1:
            outline.CopyFrom(annotations.points[0])
            del outline.points[:]
        outline.type = 2  # LINE_LOOP
        outline.thickness = 2.0
        outline.outline_color.r, outline.outline_color.g, outline.outline_color.b, outline.outline_color.a = 0.0, 1.0, 0.0, 1.0
        for x, y in ((left, top), (right, top), (right, bottom), (left, bottom)):
            corner = outline.points.add()
            corner.x, corner.y = x, y


def palette_of(metadata):
    """Red, green, blue of all ids, out of `cosfly.semantic_labels`."""
    palette = [0] * 768
    for number, text in metadata.get("cosfly.semantic_labels", {}).items():
        colour = text.split(" #")[-1]
        palette[3 * int(number) : 3 * int(number) + 3] = [int(colour[i : i + 2], 16) for i in (0, 2, 4)]
    return palette


def copy_log(source, target, flight, frames, about):
    """Copies a log with the pictures of `frames`, which yields those of one frame after the other."""
    with source.open("rb") as file:
        metadata = {record.name: dict(record.metadata) for record in make_reader(file).iter_metadata()}
    metadata.setdefault("cosfly.conventions", {})["instance"] = (
        "0 ground and sky, 1 the target, else the CARLA server's id + 2; unsigned, little-endian"
    )
    metadata["cosfly.carla"] = about
    palette = palette_of(metadata)
    partial = target.with_suffix(".part")
    partial.parent.mkdir(parents=True, exist_ok=True)
    with source.open("rb") as file, partial.open("wb") as output:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        writer = Writer(output, chunk_size=4 << 20, compression=CompressionType.ZSTD)
        writer.start(library="cosfly carla replay")
        for name, entries in metadata.items():
            writer.add_metadata(name, entries)
        schemas, channels, done = {}, {}, 0
        for batch in frames_of(reader):
            images = None
            for schema, channel, message, decoded in batch:
                if schema.id not in schemas:
                    schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
                if channel.id not in channels:
                    channels[channel.id] = writer.register_channel(
                        channel.topic, channel.message_encoding, schemas[schema.id], channel.metadata
                    )
                if images is None and any(it[1].topic == "/target/state" for it in batch):
                    state = next(it[3] for it in batch if it[1].topic == "/target/state")
                    images = FrameImages(next(frames), state)
                    done += 1
                data = message.data
                if images is not None and images.fill(channel.topic, decoded, palette):
                    data = decoded.SerializeToString()
                writer.add_message(channels[channel.id], message.log_time, data, message.publish_time, message.sequence)
        writer.finish()
    if done != len(flight["frames"]):
        raise ReplayError(f"{source} has {done} frames; the job has {len(flight['frames'])}")
    for _ in frames:  # lets the server's side end
        raise ReplayError(f"{source} has fewer frames than the job")
    partial.replace(target)


def frames_of(reader):
    """All messages, in groups of the same time."""
    group = []
    for message in reader.iter_decoded_messages(log_time_order=True):
        if group and message[2].log_time != group[0][2].log_time:
            yield group
            group = []
        group.append(message)
    if group:
        yield group


def replay(client, job, dataset, out, keep_map, say=print):
    version = client.get_server_version()
    for number, flight in enumerate(job["flights"], 1):
        source, target = dataset / flight["log"], out / flight["log"]
        if not source.is_file():
            raise ReplayError(f"{source} is missing: the job was made from another dataset")
        world = world_for(client, flight["town"], keep_map)
        about = {"server_version": version, "map": world.get_map().name, "trajectory_id": flight["trajectory_id"]}
        frames = fly(world, flight)
        try:
            copy_log(source, target, flight, frames, about)
        finally:
            frames.close()
        say(f"{number}/{len(job['flights'])}  {target}  {len(flight['frames'])} frames")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("job", type=Path, help="what `cosfly carla-job` wrote")
    parser.add_argument("dataset", type=Path, help="the dataset's folder")
    parser.add_argument("--out", type=Path, required=True, help="folder for the logs")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=2000)
    parser.add_argument("--keep-map", action="store_true", help="fly in the map that is loaded, whatever its name")
    arguments = parser.parse_args()
    try:
        job = load_job(arguments.job)
        replay(connect(arguments.host, arguments.port), job, arguments.dataset, arguments.out, arguments.keep_map)
    except ReplayError as error:
        sys.exit(f"replay: {error}")


if __name__ == "__main__":
    main()
