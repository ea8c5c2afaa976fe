"""Reads bags of a dataset with rosbags, mcap-ros2-support and Rerun, and compares them with the dataset's tables, those of sensors among them. The
frames are computed here anew: from CARLA's left-handed angles, by matrices, without a line of cosfly.

Usage: `check_ros2.py DATASET EXPORT`."""

import dataclasses
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pyarrow.dataset
from mcap_ros2.reader import read_ros2_messages
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation
from shared import POINT, axes_of, flown, imported_by_rerun, place, rows, xyz

dataset, export = Path(sys.argv[1]), Path(sys.argv[2])
MIRROR = np.diag([1.0, -1.0, 1.0])
# Columns: right, down and ahead of a camera whose axes are x ahead, y right, z up.
OPTICAL = np.array([[0.0, 0, 1], [1, 0, 0], [0, -1, 0]])
LATCHED = {"/tf_static", "/town", "/instruction"}
flights, frames, people = flown(dataset)
# Readings by table and flight: tables with a time that is not that of a frame.
sensors, readings = {}, []
for table in sorted(path.name for path in (dataset / "data").iterdir()):
    if {"row", "time_s"} <= set(pyarrow.dataset.dataset(dataset / "data" / table).schema.names):
        sensors[table] = defaultdict(list)
        for row in sorted(rows(dataset, table), key=lambda row: row["row"]):
            sensors[table][row["trajectory_id"]].append(row)
objects = defaultdict(set)
for row in rows(dataset, "objects"):
    x, y, z = row["center_in_world_m"]
    objects[row["town"]].add(tuple(np.round([x, -y, z, *row["size_m"]], 6)))


def matrix(q):
    assert abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1) < 1e-9
    return Rotation.from_quat([q.x, q.y, q.z, q.w]).as_matrix()


def turn(vector):
    """The rotation by a vector's length around it."""
    return Rotation.from_rotvec(vector).as_matrix()


def nanoseconds(stamp):
    return stamp.sec * 10**9 + stamp.nanosec


class Tree:
    """Transforms: child -> parent, rotation, place."""

    def __init__(self):
        self.edges = {}

    def add(self, message):
        for it in message.transforms:
            self.edges[it.child_frame_id] = it.header.frame_id, matrix(it.transform.rotation), xyz(it.transform.translation)

    def in_map(self, frame):
        rotation, place = np.eye(3), np.zeros(3)
        while frame != "map":
            frame, r, t = self.edges[frame]
            rotation, place = r @ rotation, r @ place + t
        return rotation, place


def check_tree(tree, row):
    drone, at = MIRROR @ axes_of(row, "drone") @ MIRROR, MIRROR @ place(row, "drone")
    rotation, found = tree.in_map("base_link")
    assert np.allclose(rotation, drone, atol=1e-9) and np.allclose(found, at, atol=1e-9)
    # The optical frame is right-handed in the mirrored world: right, down and ahead of the camera.
    camera = MIRROR @ axes_of(row) @ OPTICAL
    rotation, found = tree.in_map("camera_optical_frame")
    assert np.allclose(rotation, camera, atol=1e-7) and np.allclose(found, at, atol=1e-9) and np.linalg.det(rotation) > 0
    if not flights[row["trajectory_id"]]["target_kind"]:
        assert "target" not in tree.edges
        return
    rotation, found = tree.in_map("target")
    assert np.allclose(found, MIRROR @ place(row, "target"), atol=1e-9)
    assert np.allclose(rotation, turn([0, 0, -np.radians(row["target_heading_deg"])]), atol=1e-9)


def check_motion(message, after, dt_s):
    """Motion leads from a pose to the next one."""
    pose, next_pose = message.pose.pose, after.pose.pose
    rotation, twist = matrix(pose.orientation), message.twist.twist
    assert np.allclose(xyz(pose.position) + rotation @ xyz(twist.linear) * dt_s, xyz(next_pose.position), atol=1e-9)
    assert np.allclose(rotation @ turn(xyz(twist.angular) * dt_s), matrix(next_pose.orientation), atol=1e-9)


def check_detections(message, row, others):
    expected = {str(body["instance"]): (body["kind"], body["visible_box_px"]) for body in others}
    if row["visible_box_px"]:
        expected["1"] = flights[row["trajectory_id"]]["target_kind"], row["visible_box_px"]
    assert {found.id for found in message.detections} == set(expected)
    for found in message.detections:
        kind, (left, top, right, bottom) = expected[found.id]
        center, (result,) = found.bbox.center.position, found.results
        assert (found.bbox.size_x, found.bbox.size_y) == (right - left, bottom - top) and result.hypothesis.class_id == kind
        assert (center.x + 0.5, center.y + 0.5) == ((left + right) / 2, (top + bottom) / 2)


def check_geometry(of, tree, row, camera="/camera", optical="camera_optical_frame"):
    """Pixels of the target, back in the map, are where the target is; a bent lens is left out."""
    flight, info = flights[row["trajectory_id"]], of[f"{camera}/camera_info"]
    depth, labels = of[f"{camera}/depth/image_raw"], of[f"{camera}/semantic/image_raw"]
    assert info.header.frame_id == depth.header.frame_id == labels.header.frame_id == optical
    assert (depth.encoding, labels.encoding, depth.step, labels.step) == ("32FC1", "mono8", 4 * depth.width, labels.width)
    depth = np.frombuffer(bytes(depth.data), np.float32).reshape(depth.height, depth.width)
    labels = np.frombuffer(bytes(labels.data), np.uint8).reshape(depth.shape)
    assert np.isinf(depth[labels == 11]).all()
    if info.distortion_model != "plumb_bob":
        return 0
    assert list(info.d[2:]) == [0, 0, 0]
    if row["visible_pixels"] < 8 or flight["target_kind"] != "pedestrian" or info.d[0] or info.d[1]:
        return 0
    left, top, right, bottom = (int(edge) for edge in row["visible_box_px"])
    v, u = np.add(np.nonzero(labels[top:bottom, left:right] == 12), [[top], [left]])
    z = depth[v, u].astype(float)
    rays = np.linalg.inv(np.array(info.k).reshape(3, 3)) @ np.array([u, v, np.ones(len(u))])
    rotation, place = tree.in_map(optical)
    points = (rotation @ (rays * z)).T + place
    away = np.median(points, axis=0) - tree.in_map("target")[1]
    assert np.hypot(*away[:2]) < 0.6 and 0 < away[2] < flight["target_height_m"], away
    return 1


def vector(row, name, unit, axes="xyz"):
    return np.array([row[f"{name}_{axis}{unit}"] for axis in axes])


def axial(left_handed):
    """An angular velocity in the mirrored world, by the matrix that takes a place to its velocity."""
    x, y, z = left_handed
    across = MIRROR @ np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ MIRROR
    return np.array([across[2, 1], across[0, 2], across[1, 0]])


def check_reading(row, message):
    """A reading of a table as its message; returns the kind of sensor."""
    if "force_x_mps2" in row:
        assert np.allclose(xyz(message.linear_acceleration), MIRROR @ vector(row, "force", "_mps2"), atol=1e-12)
        assert np.allclose(xyz(message.angular_velocity), axial(vector(row, "rate", "_rad_s")), atol=1e-12)
        assert message.orientation_covariance[0] == -1, "no orientation is measured"
        return "imu"
    if "latitude_deg" in row:
        assert np.array_equal([message.latitude, message.longitude, message.altitude], [row[it] for it in ("latitude_deg", "longitude_deg", "up_m")])
        assert (message.status.status, message.position_covariance_type) == (0 if row["is_fix"] else -1, 0)
        return "navsat"
    if "pressure_hpa" in row:
        assert np.isclose(message.fluid_pressure, 100 * row["pressure_hpa"], rtol=1e-14)
        return "pressure"
    if "field_x_ut" in row:
        assert np.allclose(1e6 * xyz(message.magnetic_field), MIRROR @ vector(row, "field", "_ut"), rtol=1e-12)
        return "field"
    if "cloud" in row:
        kinds = {4: "<u2", 6: "<u4", 7: "<f4"}
        names, formats, offsets = zip(*((it.name, kinds[it.datatype], it.offset) for it in message.fields))
        points = np.frombuffer(bytes(message.data), np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": message.point_step}))
        told = np.frombuffer(row["cloud"], POINT)
        assert (message.height, message.width, message.row_step) == (1, row["points"], len(message.data)) and message.is_dense and not message.is_bigendian
        assert np.array_equal(np.stack([points[axis] for axis in "xyz"], 1), told["place"] * np.float32([1, -1, 1]))
        assert all(np.array_equal(points[name], told[name]) for name in ("intensity", "time", "ring", "label", "instance"))
        return "lidar"
    named = dict(zip(message.layout.dim[0].label.split(","), message.data, strict=True))
    assert named and all(np.isclose(row[name], value, equal_nan=True) for name, value in named.items())
    return "numbers"


def check_sensors(id, told, places, tree):
    """Each reading of the tables is a message, at its time, in a frame of its name, whose place `/tf` has where the table has it; others that are
    fixed to the airframe have the turn of the inertial unit."""
    unit = next((name for name in sorted(sensors) if id in sensors[name] and "force_x_mps2" in sensors[name][id][0]), None)
    expected = {name for name, of_flights in sensors.items() if id in of_flights}
    assert {topic.removeprefix("/sensor/") for topic in told} == expected, (id, set(told), expected)
    count = defaultdict(int)
    for name in expected:
        ways = []
        for row, (time_ns, message) in zip(sensors[name][id], told[f"/sensor/{name}"], strict=True):
            assert time_ns == 10**9 + round(row["time_s"] * 1e9), (name, row["row"])
            if hasattr(message, "header"):
                assert (message.header.frame_id, nanoseconds(message.header.stamp)) == (name, time_ns)
            kind = check_reading(row, message)
            count[kind] += 1
            if "true_qw" in row:
                parent, rotation, found = places[name, time_ns]
                wanted = MIRROR @ Rotation.from_quat(vector(row, "true", "", ("qx", "qy", "qz", "qw"))).as_matrix() @ MIRROR
                assert parent == "map" and np.allclose(found, MIRROR @ vector(row, "true", "_m"), atol=1e-9) and np.allclose(rotation, wanted, atol=1e-9)
                ways.append((time_ns / 1e9, rotation, message))
            elif "true_up_m" in row:
                parent, rotation, found = places[name, time_ns]
                assert parent == "map" and np.allclose(rotation, np.eye(3)) and np.allclose(found, vector(row, "true", "_m", ("east", "north", "up")), atol=1e-9)
            elif kind in ("pressure", "field") and unit:
                parent, rotation, found = tree.edges[name]
                assert parent == unit and np.allclose(rotation, np.eye(3)) and not found.any()
        if kind == "imu" and not flights[id]["expert_id"]:
            check_turns(ways)
    return count


def check_turns(ways):
    """The angular velocities of the messages turn the frames of `/tf` from one to the next. In sum, noise averages out and a wrong hand does not."""
    turns = np.array([Rotation.from_matrix(rotation.T @ after).as_rotvec() for (_, rotation, _), (_, after, _) in zip(ways, ways[1:])])
    rates = np.array([xyz(message.angular_velocity) * (after[0] - begin) for (begin, _, message), after in zip(ways, ways[1:])])
    wanted, found = np.abs(turns).sum(0), (np.sign(turns) * rates).sum(0)
    assert (np.abs(found - wanted) < 0.05 + 0.05 * wanted).all(), (found, wanted)


def check_bag(bag):
    id = bag.name
    known, flight = frames[id], flights[id]
    by_time, latched, told, places, seen = defaultdict(dict), {}, defaultdict(list), {}, 0
    with AnyReader([bag]) as reader:
        for connection in reader.connections:
            qualities = connection.ext.offered_qos_profiles
            assert [it.durability.value for it in qualities] == ([1] if connection.topic in LATCHED else []), (connection.topic, qualities)
        for connection, time_ns, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic.startswith("/sensor/"):
                told[connection.topic].append((time_ns, message))
            elif connection.topic == "/tf" and message.transforms[0].child_frame_id in sensors:
                (it,) = message.transforms
                places[it.child_frame_id, time_ns] = it.header.frame_id, matrix(it.transform.rotation), xyz(it.transform.translation)
            else:
                (latched if connection.topic in LATCHED else by_time[time_ns])[connection.topic] = message
    tree, before = Tree(), None
    tree.add(latched["/tf_static"])
    readings.append(check_sensors(id, told, places, tree))
    assert len(by_time) == len(known)
    for (time_ns, of), (frame, row) in zip(sorted(by_time.items()), sorted(known.items())):
        assert time_ns == 10**9 + round(row["time_s"] * 1e9) == nanoseconds(of["/clock"].clock)
        assert all(nanoseconds(message.header.stamp) == time_ns for message in of.values() if hasattr(message, "header"))
        tree.add(of["/tf"])
        check_tree(tree, row)
        if before:
            for topic in ("/odom", "/target/odom") if flight["target_kind"] else ("/odom",):
                check_motion(before[topic], of[topic], flight["dt_s"])
        assert np.array_equal(xyz(of["/odom"].pose.pose.position), tree.in_map("base_link")[1])
        check_detections(of["/detections"], row, people[id, frame])
        seen += check_geometry(of, tree, row)
        before = of
    for marker in latched["/town"].markers:
        box = tuple(np.round([*xyz(marker.pose.position), *xyz(marker.scale)], 6))
        assert marker.type == 1 and marker.header.frame_id == "map" and box in objects[flight["town"]], box
    assert latched["/instruction"].data
    return len(by_time), seen, len(latched["/town"].markers)


def check_rig(bag):
    """Each camera of a flight is where its film's rows have it, with the target's box and depths, at its own times; sensors are those of one film."""
    films = {flight["camera_name"]: id for id, flight in flights.items() if flight["flight_id"] == bag.name}
    tree, shown, told, places, seen = Tree(), defaultdict(list), defaultdict(list), {}, 0
    with AnyReader([bag]) as reader:
        for connection, time_ns, raw in reader.messages():
            message, topic = reader.deserialize(raw, connection.msgtype), connection.topic
            if topic in ("/tf", "/tf_static"):
                tree.add(message)
                places |= {(it.child_frame_id, time_ns): tree.edges[it.child_frame_id] for it in message.transforms if it.child_frame_id in sensors}
            elif topic.startswith("/sensor/"):
                told[topic].append((time_ns, message))
            elif topic.startswith("/camera/"):
                camera = topic.split("/")[2]
                if topic.endswith("/camera_info") and "/depth/" not in topic:
                    shown[camera].append((time_ns, {}, tree.in_map(f"camera_{camera}_optical_frame")))
                shown[camera][-1][1][topic] = message
    assert set(shown) == set(films) and len(films) > 1, bag
    for camera, id in films.items():
        for (time_ns, of, (rotation, found)), (frame, row) in zip(shown[camera], sorted(frames[id].items()), strict=True):
            assert time_ns == 10**9 + round(row["time_s"] * 1e9)
            check_detections(of[f"/camera/{camera}/detections"], row, people[id, frame])
            at = MIRROR @ np.array(row["camera_in_world_m"] or place(row, "drone"))
            assert np.allclose(found, at, atol=1e-4) and np.allclose(rotation, MIRROR @ axes_of(row) @ OPTICAL, atol=1e-5), (id, frame)
            still = Tree()
            still.edges = {"target": ("map", np.eye(3), MIRROR @ place(row, "target")), f"camera_{camera}_optical_frame": ("map", rotation, found)}
            seen += check_geometry(of, still, row, f"/camera/{camera}", f"camera_{camera}_optical_frame")
    for id in [id for id in films.values() if any(id in of_flights for of_flights in sensors.values())][:1]:
        readings.append(check_sensors(id, told, places, tree))
    return sum(map(len, shown.values())), seen


def plain(message):
    """A message of either reader as numbers, texts and lists."""
    if isinstance(message, (bytes, bytearray, memoryview)) or isinstance(message, np.ndarray) and message.dtype == np.uint8:
        return bytes(message)
    if isinstance(message, (list, tuple, np.ndarray)):
        return [plain(item) for item in message]
    is_class = dataclasses.is_dataclass(message)
    names = [field.name for field in dataclasses.fields(message)] if is_class else getattr(message, "__slots__", None)
    if names is None:
        return message
    # Constants are not content.
    return {name: plain(getattr(message, name)) for name in names if not name.isupper() and name != "__msgtype__"}


def both_readers_agree(bag):
    (file,) = bag.glob("*.mcap")
    with AnyReader([bag]) as reader:
        ours = [(it.topic, plain(reader.deserialize(raw, it.msgtype))) for it, _, raw in reader.messages()]
    theirs = [(it.channel.topic, plain(it.ros_msg)) for it in read_ros2_messages(str(file))]
    # Of one topic in the order of their times.
    by_topic = [sorted(messages, key=lambda item: item[0]) for messages in (ours, theirs)]
    assert by_topic[0] == by_topic[1]
    return len(ours)


def definitions_are_those_of_ros(bag):
    """By the hash that ROS 2 compares types with; rosbags has no `vision_msgs` of its own."""
    ros = get_typestore(Stores.ROS2_HUMBLE)
    with AnyReader([bag]) as reader:
        names = set(reader.typestore.fielddefs) & set(ros.fielddefs)
        assert all(reader.typestore.hash_rihs01(name) == ros.hash_rihs01(name) for name in names)
    assert "visualization_msgs/msg/Marker" in names
    return len(names)


bags = sorted(path.parent for path in export.glob("*/*/*/metadata.yaml"))
assert bags, f"{export} has no bags"
if len(bags) < len(flights):
    poses, seen = np.sum([check_rig(bag) for bag in bags], axis=0)
    print(f"{len(bags)} bags of rigs, {poses} camera poses and boxes as in the tables, {seen} with the target found in the depths, "
          f"{sum(sum(it.values()) for it in readings)} readings of sensors")
    sys.exit()
assert {bag.name for bag in bags} == set(flights)
total = np.sum([check_bag(bag) for bag in bags], axis=0)
by_eye = [it for it in flights.values() if it["target_kind"] == "pedestrian" and it["camera_width_px"] >= 320]
assert total[1] or not by_eye, "no picture shows enough of the target"
print(f"{len(bags)} bags, {total[0]} frames, {total[1]} with the target found in the depths, {total[2]} markers")
of_kinds = {kind: sum(it[kind] for it in readings) for kind in sorted({kind for it in readings for kind in it})}
print("readings of sensors, equal to their tables:", ", ".join(f"{count} of {kind}" for kind, count in of_kinds.items()) or "none")
print(f"rosbags and mcap-ros2-support agree in {both_readers_agree(bags[0])} messages")
print(f"{definitions_are_those_of_ros(bags[0])} definitions have the hashes of ROS 2 Humble")
imported_by_rerun(*bags[0].glob("*.mcap"), "EncodedImage", "DepthImage", "Transform3D", "Pinhole")
