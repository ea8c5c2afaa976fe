"""Judges the optical flow of a dataset by reprojection: from depth, ids, the camera's poses and the tables of bodies alone.

Usage: `check_flow.py DATASET_FOLDER [--least-pixels N] [--plant FAULT]`. Shares no code with cosfly. What stands (town, ground, sky)
and vehicles must agree to 0.01 px beyond the step of the stored depth, through the lens. People move part by part: their pixels may differ from their
body's motion by what a limb can do in a frame, and most of the ways that the mask calls seen must end on the same person. The mask is compared with
the depth that the neighbouring frame has there. With a rolling shutter each row has the pose of its own moment, from the strips in the log's
`cosfly.camera`: a way must end in a row whose moment shows the point there. `--plant` spoils the flow first, or turns, doubles or forgets the
read-out: the check must then fail."""

import json
from collections import defaultdict

import numpy as np
from shared import axes_of, command_line, end_with, flown, messages, pixels, place, require, rows, turned, world_from_body

RIDER = 13
VEHICLES = {"bicycle", "motorcycle", "e_scooter", "car", "van", "truck", "bus"}
MOST_PX = 0.01
STEP_M = 0.5 / 1024
LIMB_MPS = 8.0
EDGE_PX = 0.05
ANGLES = ["pitch_deg", "yaw_deg", "roll_deg"]
SPOILT_FLOWS = {None: lambda it: it, "scale": lambda it: it * 1.02, "sign": lambda it: -it, "swap": lambda it: it[..., ::-1], "frame": lambda it: it}
SPOILT_SHUTTERS = {"readout-sign": -1, "readout-double": 2, "readout-none": 0}
CHANNELS = ["depth", "instance", "semantic", "flow_forward", "flow_forward_valid", "flow_back", "flow_back_valid"]


class Lens:
    def __init__(self, flight):
        self.focal, self.is_fisheye = flight["camera_focal_px"], flight["camera_lens_model"] == "fisheye"
        self.k = [flight[f"camera_k{number}"] for number in (1, 2, 3, 4)]
        self.centre = np.array([flight["camera_width_px"], flight["camera_height_px"]]) / 2

    def bend(self, ideal):
        at = (ideal - self.centre) / self.focal
        off = np.sqrt((at**2).sum(-1, keepdims=True))
        bent = np.arctan(off) if self.is_fisheye else off
        bent = bent * (1 + sum(k * bent ** (2 * power) for power, k in enumerate(self.k, 1)))
        return self.centre + self.focal * at * np.divide(bent, off, out=np.ones_like(off), where=off > 0)

    def sampled(self, seen):
        """Pixel centre of the ideal picture that a finished pixel shows."""
        if not (self.is_fisheye or any(self.k)):
            return seen
        ideal = seen.copy()
        for _ in range(60):
            ideal -= self.bend(ideal) - seen
        return np.floor(np.round((ideal - 0.5) * 256) / 256 + 0.5) + 0.5


def moved(points, here, there):
    """Points of a rigid body that goes from one state to another."""
    feet = lambda row: np.array(row["feet_in_world_m"])
    return feet(there) + (points - feet(here)) @ world_from_body(0, there["heading_deg"] - here["heading_deg"], 0).T


def eye(row):
    """Position of the camera."""
    own = row["camera_in_world_m"]
    return np.array(place(row, "drone") if own is None else own)


def project(points, row, lens):
    seen = (points - eye(row)) @ row["axes"]  # ahead, right, up
    ahead = np.where(seen[..., 0] > 0.05, seen[..., 0], np.nan)
    ideal = lens.centre + lens.focal * np.stack([seen[..., 1], -seen[..., 2]], -1) / ahead[..., None]
    return lens.bend(ideal), ahead, ideal[..., 1]


class Shutter:
    """Strips of rows, of the picture without its lens, that are taken together."""

    def __init__(self, log, flight, factor):
        from mcap.reader import make_reader

        self.ends, self.offsets = np.array([np.inf]), np.zeros(1)
        if flight["camera_readout_s"]:
            with open(log, "rb") as file:
                said = next(it.metadata for it in make_reader(file).iter_metadata() if it.name == "cosfly.camera")
            self.ends, self.offsets = np.array(json.loads(said["readout_ends_px"])), factor * np.array(json.loads(said["readout_offsets_s"]))
            begins = np.r_[flight["camera_height_px"] - self.ends[-1], self.ends[:-1]]
            due = flight["camera_readout_s"] * ((begins + self.ends) / 2 / flight["camera_height_px"] - 0.5)
            scale = flight["camera_height_px"] / (self.ends[-1] - begins[0])
            require(np.allclose(self.offsets, factor * scale * due, atol=1e-9), "the strips of the log are not those of `camera_readout_s`")

    def strip(self, row):
        return np.minimum(np.searchsorted(self.ends, row, "right"), len(self.ends) - 1)

    def is_edge(self, strip, row):
        """Whether a row is so near to an edge of the strip that the step of the depth decides on which side it is."""
        edges = np.r_[-np.inf, self.ends[:-1], np.inf]
        return np.minimum(np.abs(row - edges[strip]), np.abs(row - edges[strip + 1])) < EDGE_PX


def later(before, after, share, places, angles):
    """Numbers of two rows, some share of the way between them; angles turn the short way."""
    row = {name: (1 - share) * np.array(before[name]) + share * np.array(after[name]) for name in places}
    return row | {name: before[name] + share * turned(after[name], before[name]) for name in angles}


class Judge:
    def __init__(self, folder, plant):
        self.folder, self.plant, self.wrong, self.counts, self.worst = folder, plant, [], defaultdict(int), defaultdict(float)
        self.objects = {row["instance"] for row in rows(folder, "objects", ["instance"])}
        self.flights, self.frames, _ = flown(folder)
        self.bodies = defaultdict(dict)
        for row in rows(folder, "bodies", ["trajectory_id", "frame", "instance", "kind", "feet_in_world_m", "heading_deg"]):
            self.bodies[row["trajectory_id"], row["frame"]][row["instance"]] = row

    def camera(self, flight, frame, offset_s):
        """The camera some seconds after a frame: the drone moves evenly from frame to frame, and on beyond the first and the last one; its mount goes along."""
        all_rows = self.frames[flight["trajectory_id"]]
        first = int(np.clip(np.floor(frame + offset_s / flight["dt_s"]), 0, len(all_rows) - 2))
        turning = [f"{'camera' if flight['camera_mount_levelled'] else 'drone'}_{angle}" for angle in ANGLES]
        rows = []
        for row in (all_rows[first], all_rows[first + 1]):
            drone, mount = axes_of(row, "drone"), eye(row) - place(row, "drone")
            rows.append({"drone_m": place(row, "drone"), "mount_m": drone.T @ mount, "in_drone": drone.T @ axes_of(row)} | dict(row))
        share = frame - first + offset_s / flight["dt_s"]
        drone = later(*rows, share, ["drone_m", "mount_m"], [f"drone_{angle}" for angle in ANGLES])
        turned_by = later(*rows, share, [], turning)
        axes = axes_of(turned_by, turning[0].split("_")[0])
        at = drone["drone_m"] + axes_of(drone, "drone") @ drone["mount_m"]
        return {"camera_in_world_m": at, "axes": axes if flight["camera_mount_levelled"] else axes @ rows[0]["in_drone"]}

    def bodies_at(self, flight, frame, offset_s):
        """Everybody some seconds after a frame; where others come and go they stand."""
        here, step = self.about(flight, frame), -1 if offset_s < 0 else 1
        if not offset_s:
            return here
        last = len(self.frames[flight["trajectory_id"]]) - 1
        other = frame + step if 0 <= frame + step <= last else frame - step
        beside, share = self.about(flight, other), offset_s / flight["dt_s"] / (other - frame)
        moved = {}
        for instance, row in here.items():
            part = share if instance == 1 else max(share, 0)
            numbers = later(row, beside[instance], part, ["feet_in_world_m"], ["heading_deg"]) if instance in beside else row
            moved[instance] = {"kind": row["kind"], **numbers}
        return moved

    def about(self, flight, frame):
        """Bodies of a frame by instance id, the target among them."""
        row = self.frames[flight["trajectory_id"]][frame]
        target = {"kind": flight["target_kind"], "feet_in_world_m": place(row, "target"), "heading_deg": row["target_heading_deg"]}
        return {1: target, **self.bodies[flight["trajectory_id"], frame]}

    def flight(self, flight):
        whole = (flight["camera_every"], flight["duration_s"]) == (1, flight["dt_s"] * (flight["frames"] - 1))
        require(not flight["camera_readout_s"] or whole, "the tables do not have the motion between pictures that are not of every frame")
        self.shutter = Shutter(self.folder / flight["mcap_path"], flight, SPOILT_SHUTTERS.get(self.plant, 1))
        logged = defaultdict(list)
        for topic, image, *_ in messages(self.folder / flight["mcap_path"], [f"/camera/{name}/image" for name in CHANNELS]):
            logged[topic.split("/")[2]].append(pixels(image))
        for name, step in (("flow_forward", 1), ("flow_back", -1)):
            for frame, flow in enumerate(logged[name]):
                other = frame + step + (self.plant == "frame")
                place = f"{flight['trajectory_id']} frame {frame} {name}"
                valid, is_there = logged[f"{name}_valid"][frame], 0 <= frame + step < len(logged[name])
                if not is_there and (flow.any() or valid.any()):
                    self.wrong.append(f"{place}: there is no such frame, and not all is 0")
                elif is_there and 0 <= other < len(logged[name]):
                    self.pair(place, flight, logged, (frame, other), SPOILT_FLOWS.get(self.plant, SPOILT_FLOWS[None])(flow), valid)

    def pair(self, place, flight, logged, pair, flow, valid):
        lens, (frame, other) = Lens(flight), pair
        depth, ids, labels = (logged[name][frame] for name in ("depth", "instance", "semantic"))
        depth, offsets = depth.astype(float), self.shutter.offsets
        rows_, columns = np.indices(depth.shape)
        centre = lens.sampled(np.stack([columns, rows_], -1) + 0.5)
        own = self.shutter.strip(centre[..., 1])
        here, there = ([self.camera(flight, it, offset) for offset in offsets] for it in pair)
        around, around_there = ([self.bodies_at(flight, it, offset) for offset in offsets] for it in pair)
        ray = np.concatenate([np.ones((*depth.shape, 1)), (centre - lens.centre) / lens.focal * [1, -1]], -1)
        from_ = np.zeros(ray.shape)
        for strip in range(len(offsets)):
            ray[own == strip] = ray[own == strip] @ here[strip]["axes"].T
            from_[own == strip] = eye(here[strip])
        kinds = np.zeros(depth.shape, "U8")
        kinds[(ids == 0) | np.isin(ids, list(self.objects))] = "standing"
        carried = []
        for instance in set(np.unique(ids)) - self.objects - {0}:
            body = self.about(flight, frame).get(instance)
            if body and instance in self.about(flight, other):
                mask = ids == instance
                kinds[mask] = "vehicle" if body["kind"] in VEHICLES else "person"
                kinds[mask & (labels == RIDER)] = "rider"
                carried += [(instance, strip, mask & (own == strip)) for strip in np.unique(own[mask])]

        def ways(depth_m, strip):
            at = from_ + np.minimum(depth_m, 1e9)[..., None] * ray
            for instance, its, mask in carried:
                at[mask] = moved(at[mask], around[its][instance], around_there[strip][instance])
            end, ahead, row = project(at, there[strip], lens)
            return end - lens.bend(centre), end, ahead, self.shutter.strip(row) == strip, self.shutter.is_edge(strip, row)

        # The row of the end tells its moment, and the moment tells the row: every strip is tried, and the nearest of those that agree counts.
        expected, end, ahead = np.full(flow.shape, np.nan), np.full(flow.shape, np.nan), np.full(depth.shape, np.nan)
        nearer, least = np.full(flow.shape, np.nan), np.full(depth.shape, np.inf)
        at_edge = np.zeros(depth.shape, bool)
        for strip in range(len(offsets)):
            ways_, ends, aheads, is_there, is_edge = ways(depth, strip)
            at_edge |= is_edge
            off = np.where(is_there, np.linalg.norm(flow - ways_, axis=-1), np.inf)
            chosen = off < least
            nearer[chosen] = ways(depth - STEP_M, strip)[0][chosen]
            least[chosen], expected[chosen], end[chosen], ahead[chosen] = off[chosen], ways_[chosen], ends[chosen], aheads[chosen]
        kinds[at_edge] = ""
        if (valid[np.isnan(ahead) & (kinds == "standing")] == 1).any():
            self.wrong.append(f"{place}: the mask says that points are seen which no row shows at its moment")
        error = np.linalg.norm(flow - expected, axis=-1)
        allowed = MOST_PX + 1e-4 * np.linalg.norm(expected, axis=-1) + 1.5 * np.linalg.norm(nearer - expected, axis=-1)
        limb = LIMB_MPS * flight["dt_s"] * lens.focal / np.maximum(ahead - 1, 0.5)
        for kind in ("standing", "vehicle", "person", "rider"):
            chosen = (kinds == kind) & np.isfinite(ahead)
            beyond = chosen & (error > (allowed if kind in ("standing", "vehicle") else allowed + limb))
            self.counts[kind] += chosen.sum()
            if chosen.any() and kind in ("standing", "vehicle"):
                self.worst[kind] = max(self.worst[kind], (error - allowed + MOST_PX)[chosen].max())
            if beyond.any():
                v, u = np.argwhere(beyond)[0]
                self.wrong.append(f"{place}: {beyond.sum()} pixels of kind {kind}, the first at ({u}, {v}): {flow[v, u]} instead of {expected[v, u]}")
        self.mask(place, logged, other, flow + lens.bend(centre), valid, kinds, ids, ahead)

    def mask(self, place, logged, other, end, valid, kinds, ids, ahead):
        """The mask against what the other frame shows at the ends of the ways, which begin at the points that pixels show."""
        height, width = ids.shape
        inside = (end >= 0.01).all(-1) & (end[..., 0] < width - 0.01) & (end[..., 1] < height - 0.01)
        outside = (end < -0.6).any(-1) | (end[..., 0] > width + 0.6) | (end[..., 1] > height + 0.6)
        u, v = (np.clip(np.nan_to_num(end[..., k]), 0, size - 1).astype(int) for k, size in ((0, width), (1, height)))
        found, theirs = logged["depth"][other].astype(float), logged["instance"][other]
        about = np.stack([np.roll(found, (down - 1, right - 1), (0, 1)) for down, right in np.ndindex(3, 3)])[:, v, u]
        near, far = about.min(0), about.max(0)
        standing = kinds == "standing"
        self.counts["hidden"] += (standing & inside & (valid == 0)).sum()
        bad = (valid == 1) & outside
        # Said to be hidden, and nothing near the end of the way is nearer.
        bad |= standing & inside & (valid == 0) & (near > ahead * 0.999) & np.isfinite(ahead)
        # Said to be seen, and all that is near the end of the way is much nearer; walls seen along them change by metres within a pixel.
        bad |= standing & inside & (valid == 1) & (far < ahead * 0.9 - 0.5)
        if bad.sum() > 0.002 * bad.size:
            self.wrong.append(f"{place}: the mask of {bad.sum()} pixels differs from the depths of the other frame")
        people = (kinds == "person") & (valid == 1) & inside
        # A far person is a few pixels wide: a way may end beside its last pixel.
        around = np.stack([np.roll(theirs, shift, (0, 1)) for shift in ((0, 0), (0, 1), (0, -1), (1, 0), (-1, 0))])
        self.counts["landed"] += (around[:, v, u] == ids).any(0)[people].sum()
        self.counts["people seen"] += people.sum()


given = command_line("folder", least_pixels=10_000, plant=str)
require(given.plant in SPOILT_FLOWS or given.plant in SPOILT_SHUTTERS, f"--plant `{given.plant}` is none of {[*SPOILT_FLOWS][1:] + [*SPOILT_SHUTTERS]}")
judge = Judge(given.folder, given.plant)
for flight in judge.flights.values():
    judge.flight(flight)
counts, worst = judge.counts, {kind: round(error, 4) for kind, error in judge.worst.items()}
print(", ".join(f"{name} {count}" for name, count in counts.items()), "| worst beyond the depth's step, px:", worst)
if counts["standing"] < given.least_pixels:
    judge.wrong.append(f"only {counts['standing']} pixels were compared")
if counts["people seen"] and counts["landed"] < 0.85 * counts["people seen"]:
    judge.wrong.append(f"{counts['landed']} of {counts['people seen']} ways of people end on the same person")
end_with(judge.wrong)
