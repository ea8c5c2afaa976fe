"""Flies a dataset through a CARLA server that is not there: a stand-in that answers with the dataset's own pictures in CARLA's encodings. What comes
back must be the dataset's logs again. Poses, weathers and control use the real `carla` package.

Usage: `check_carla_replay.py COSFLY_BINARY DATASET_FOLDER`. What it cannot check: how a real server draws, how its walkers move, how long it takes."""

import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from types import SimpleNamespace

import carla
import numpy as np
from mcap.reader import make_reader
from scipy.spatial.transform import Rotation
from shared import messages, module, picture, pixels, require, run, said, xyz

WALKER = 4242  # the raw instance id of the walker


def read_log(path):
    """Time, message and schema of messages by topic."""
    log = defaultdict(list)
    for topic, message, time, schema in messages(path):
        log[topic].append((time, message, schema))
    return dict(log)


def rotated(q, v):
    """A vector turned by a quaternion."""
    return Rotation.from_quat([q.x, q.y, q.z, q.w]).apply(v)


class Transforms:
    """Where camera and target are in CARLA's world at each frame, from /tf alone: an independent way to the job's numbers."""

    def __init__(self, log, offset):
        self.camera, self.ahead, self.feet = [], [], []
        for _, message, _ in log["/tf"]:
            by_child = {t.child_frame_id: t for t in message.transforms}
            place, axis, frame = np.zeros(3), np.array([0.0, 0.0, 1.0]), "camera_optical"
            while frame != "map":
                t = by_child[frame]
                place, axis, frame = xyz(t.translation) + rotated(t.rotation, place), rotated(t.rotation, axis), t.parent_frame_id
            flip = np.array([1.0, -1.0, 1.0])
            self.camera.append(place * flip + offset)
            self.ahead.append(axis * flip)
            self.feet.append(xyz(by_child["target"].translation) * flip + offset)


class StandIn:
    """Client, library and world of a server that shows a log."""

    def __init__(self, log, transforms):
        self.log, self.transforms = log, transforms
        self.frame, self.ticks, self.sensors, self.weather, self.alive = 100, 0, [], None, set()
        self.settings, self.history, self.lagging = carla.WorldSettings(), [], False

    # the client
    get_server_version = lambda self: "0.9.16"
    get_world = get_blueprint_library = lambda self: self
    get_available_maps = lambda self: ["/Game/Carla/Maps/Town01", "/Game/Carla/Maps/Town02"]

    def load_world(self, name):
        raise AssertionError(f"{name} is not there")

    # the library
    find = lambda self, name: Blueprint(name)

    def filter(self, pattern):
        require(pattern == "walker.pedestrian.*", pattern)
        return [Blueprint(f"walker.pedestrian.{i:04}") for i in (3, 1, 2)]

    # the world
    get_map = lambda self: SimpleNamespace(name="Carla/Maps/plain")

    def get_settings(self):
        copy = carla.WorldSettings()
        for name in ("synchronous_mode", "fixed_delta_seconds", "substepping", "max_substep_delta_time", "max_substeps"):
            setattr(copy, name, getattr(self.settings, name))
        return copy

    def apply_settings(self, settings):
        self.settings = settings
        self.history.append((settings.synchronous_mode, settings.fixed_delta_seconds))

    def set_weather(self, weather):
        self.weather = weather

    def spawn_actor(self, blueprint, transform):
        actor = Actor(self, blueprint, transform)
        self.alive.add(actor)
        return actor

    try_spawn_actor = spawn_actor

    def tick(self):
        require(self.settings.synchronous_mode, "a tick outside of synchronous mode")
        self.frame += 1
        self.ticks += 1
        for sensor in self.sensors:
            distances = [np.abs(xyz(sensor.transform.location) - camera).max() for camera in self.transforms.camera]
            number = int(np.argmin(distances))
            require(distances[number] < 2e-3, f"the camera is {distances[number]} m from every frame")
            turned = np.abs(xyz(sensor.transform.get_forward_vector()) - self.transforms.ahead[number]).max()
            require(turned < 1e-4, f"the camera of frame {number} is turned by {turned}")
            sensor.callback(self.picture(sensor, number))
        return self.frame

    def picture(self, sensor, number):
        kind = sensor.blueprint.id.split(".")[-1]
        if kind == "rgb":
            rgb = np.asarray(picture(self.log["/camera/rgb/image"][number][1]).convert("RGB"))
            channels = [rgb[:, :, 2], rgb[:, :, 1], rgb[:, :, 0]]
        elif kind == "depth":
            depth = pixels(self.log["/camera/depth/image"][number][1]).astype(np.float64)
            bits = np.rint(np.minimum(depth, 1000.0) * (2**24 - 1) / 1000.0).astype(np.uint32)
            channels = [bits >> 16, bits >> 8 & 255, bits & 255]
        else:
            label = pixels(self.log["/camera/semantic/image"][number][1])
            ids = pixels(self.log["/camera/instance/image"][number][1]).astype(np.int64)
            raw = np.where(ids == 1, WALKER, np.maximum(ids - 2, 0))
            channels = [raw >> 8, raw & 255, label] if kind == "instance_segmentation" else [label * 0, label * 0, label]
        bgra = np.stack([*channels, np.full_like(channels[0], 255)], axis=2).astype(np.uint8)
        place = sensor.transform.location
        seen_from = carla.Transform(carla.Location(x=place.x - 1.0, y=place.y, z=place.z)) if self.lagging else sensor.transform
        return SimpleNamespace(raw_data=bgra.tobytes(), height=bgra.shape[0], width=bgra.shape[1], frame=self.frame, transform=seen_from)


class Blueprint:
    def __init__(self, name):
        self.id = name

    has_attribute = lambda self, name: name in ("motion_blur_intensity", "is_invincible")
    set_attribute = lambda self, name, value: require(isinstance(value, str), f"{name} must be text")


class Actor:
    def __init__(self, world, blueprint, transform):
        self.world, self.blueprint, self.transform = world, blueprint, transform
        self.bounding_box = carla.BoundingBox(carla.Location(), carla.Vector3D(x=0.2, y=0.2, z=0.93))
        self.places, self.controls, self.callback = [], [], None

    def listen(self, callback):
        self.callback = callback
        self.world.sensors.append(self)

    def stop(self):
        if self in self.world.sensors:
            self.world.sensors.remove(self)

    def destroy(self):
        self.world.alive.discard(self)

    def set_transform(self, transform):
        self.transform = transform
        self.places.append(transform)

    def apply_control(self, control):
        self.controls.append(control)
        self.world.walker = self

    def set_simulate_physics(self, enabled):
        require(not enabled, "the walker must not fall")


def same_pictures(before, after, world):
    for topic, logged in before.items():
        require(topic in after, f"{topic} is missing")
        require([m[0] for m in logged] == [m[0] for m in after[topic]], f"times of {topic}")
        require(logged[0][2] == after[topic][0][2], f"schema of {topic}")
        if not topic.startswith("/camera/") and topic != "/target/state" or topic == "/camera/rgb/camera_info":
            sent = [[m[1].SerializeToString() for m in log[topic]] for log in (before, after)]
            require(sent[0] == sent[1], f"{topic} changed")
    worst = 0.0
    for number in range(len(before["/tf"])):
        old, new = ({t: log[t][number][1] for t in log if t.startswith(("/camera/", "/target/state"))} for log in (before, after))
        a, b = pixels(old["/camera/depth/image"]), pixels(new["/camera/depth/image"])
        near = a < 999.9
        require(np.isinf(b[~near]).all() and np.isfinite(b[near]).all(), f"sky of frame {number}")
        worst = max(worst, float(np.abs(a[near] - b[near]).max(initial=0.0)))
        require((pixels(old["/camera/semantic/image"]) == pixels(new["/camera/semantic/image"])).all(), f"labels of {number}")
        target = [pixels(log["/camera/instance/image"]) == 1 for log in (old, new)]
        require((target[0] == target[1]).all(), f"the target's pixels of frame {number}")
        states = [log["/target/state"] for log in (old, new)]
        told = [(it.visible_pixels, list(it.visible_box_px), it.feet_x_m, it.distance_m) for it in states]
        require(told[0] == told[1], f"pixels, box and the plan's numbers of frame {number}: {told}")
        images = [picture(log["/camera/rgb/image"]).convert("RGB") for log in (old, new)]
        difference = np.abs(np.asarray(images[0], np.int16) - np.asarray(images[1], np.int16)).mean()
        require(difference < 3.0, f"colours of frame {number} differ by {difference}")
        for topic in ("/camera/rgb/preview", "/camera/depth/preview", "/camera/semantic/preview"):
            if topic in new:
                picture(new[topic]).load()
        outlines = new["/camera/rgb/annotations"].points
        require(len(outlines) == (len(states[1].full_box_px) > 0) + (len(states[1].visible_box_px) > 0), "annotations")
    require(worst <= 1000.0 / 2**24 + 1e-4, f"depth differs by {worst} m")
    return worst


def check_walker(world, flight, transforms):
    walker = world.walker
    require(len(walker.places) == len(flight["frames"]), "one place per frame")
    for place, control, feet, frame in zip(walker.places, walker.controls, transforms.feet, flight["frames"]):
        found = xyz(place.location) - [0, 0, 0.93]
        require(np.abs(found - feet).max() < 2e-3, f"the walker stands at {found}, not {feet}")
        require(abs(control.speed - frame["target"][4]) < 1e-5, "its speed")
        ahead = place.get_forward_vector()
        require(abs(ahead.x - control.direction.x) + abs(ahead.y - control.direction.y) < 1e-4, "it walks where it looks")


def check_flight(replay, dataset, out, flight, offset):
    source = dataset / flight["log"]
    before = read_log(source)
    world = StandIn(before, Transforms(before, offset))
    job = {"flights": [flight]}
    replay.replay(world, job, dataset, out, True, say=lambda _: None)
    require(not world.alive and not world.sensors, "actors stay behind")
    require(world.history == [(True, flight["dt_s"]), (False, None)] or not world.history[-1][0], f"{world.history}")
    require(world.ticks == len(flight["frames"]) + replay.WARM_UP_TICKS, f"{world.ticks} ticks")
    for name, value in flight["weather"].items():
        require(abs(getattr(world.weather, name) - value) < 1e-4, f"weather {name}")
    check_walker(world, flight, world.transforms)
    worst = same_pictures(before, read_log(out / flight["log"]), world)
    said(f"replay {flight['trajectory_id']}", f"{len(flight['frames'])} frames, depth within {1e3 * worst:.2f} mm")
    return before


def check_refusals(replay, dataset, scratch, flight, log, offset):
    def refusal(change):
        try:
            change()
        except replay.ReplayError as error:
            return str(error)
        raise SystemExit("check_carla_replay: nothing was refused")

    for text, words in (("{}", "no job file"), ('{"format": "cosfly-carla-job", "version": 9, "flights": []}', "version 9")):
        (scratch / "other.json").write_text(text)
        require(words in refusal(lambda: replay.load_job(scratch / "other.json")), words)
    world = StandIn(log, Transforms(log, offset))
    elsewhere = {"flights": [{**flight, "town": "Atlantis"}]}
    require("no map Atlantis" in refusal(lambda: replay.replay(world, elsewhere, dataset, scratch, False)), "a map")
    world.lagging = True
    job = {"flights": [flight]}
    require("from where" in refusal(lambda: replay.replay(world, job, dataset, scratch / "lag", True)), "a late picture")
    require(not world.alive and not world.settings.synchronous_mode, "after a refusal the server is as before")
    require(not list((scratch / "lag").rglob("*.mcap")), "half a log")
    said("refusals", "wrong file, newer job, unknown map, late picture")


cosfly, dataset = (Path(argument).resolve() for argument in sys.argv[1:])
replay = module("plugins/carla/replay.py")
with tempfile.TemporaryDirectory() as scratch:
    scratch = Path(scratch)
    run(cosfly, "carla-job", dataset, "--out", scratch / "job.json")
    job = replay.load_job(scratch / "job.json")
    said("cosfly carla-job", f"{len(job['flights'])} flights")
    for flight in job["flights"][:2]:
        # The town's offset, once more from the log's metadata.
        with (dataset / flight["log"]).open("rb") as file:
            records = {r.name: r.metadata for r in make_reader(file).iter_metadata()}
        offset = np.array([float(n) for n in records["cosfly.trajectory"]["town_offset_m"].strip("[]").split(",")])
        log = check_flight(replay, dataset, scratch / "out", flight, offset)
    check_refusals(replay, dataset, scratch, flight, log, offset)
