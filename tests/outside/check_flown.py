"""The logs, clips and page of a result of `cosfly fly`, read by others: the package mcap, pillow, an HTML parser.

Usage: `check_flown.py RESULT_FOLDER [BAGS]`. With the folder that `cosfly fly bags` made of it, its bags are read by rosbags and mcap-ros2-support,
compared with the steps, and imported by Rerun."""

import html.parser
import json
import math
import pathlib
import sys
from collections import defaultdict

from PIL import Image
from shared import imported_by_rerun, json_lines, messages

folder = pathlib.Path(sys.argv[1])
card = json.loads((folder / "card.json").read_text())
rows = json_lines(folder / "episodes.jsonl")
weights = card["environment"]["reward_weights"]
terms = ["visibility", "framing", "distance", "effort", "collision", "loss"]
lost = 0


def steps_of(name):
    return json_lines(folder / "logs" / f"{name}.jsonl")


for row in rows:
    name, score = row["episode"], row["score"]
    steps = steps_of(name)
    assert len(steps) == score["steps"], name
    topics = defaultdict(list)
    for topic, message, time, _ in messages(folder / "logs" / f"{name}.mcap"):
        topics[topic].append((time, message))
    for topic in ("/tf", "/drone/pose", "/target/pose", "/target/state", "/camera/rgb/camera_info", "/flight/step"):
        assert [time for time, _ in topics[topic]] == [round(1e9 * step["time_s"]) for step in steps], (name, topic)
    assert any(entity.cubes for entity in topics["/scene"][0][1].entities), name
    reward = 0.0
    for step, (_, pose), (_, state), (_, flown) in zip(steps, topics["/drone/pose"], topics["/target/state"], topics["/flight/step"], strict=True):
        (x, y, z), at = step["position_in_world"], pose.pose.position
        assert (at.x, at.y, at.z) == (x, -y, z)
        assert (state.feet_x_m, -state.feet_y_m, state.feet_z_m) == tuple(step["target_in_world"])
        assert math.isclose(state.distance_m, math.dist(step["position_in_world"], step["target_in_world"]))
        assert (flown.tracked, flown.visible, list(flown.reward_terms)) == (step["tracked"], step["visible"], step["reward"])
        assert math.isclose(flown.reward, sum(weights[key] * term for key, term in zip(terms, step["reward"])), abs_tol=1e-9)
        reward += flown.reward
    assert math.isclose(reward, score["reward_sum"], rel_tol=1e-9, abs_tol=1e-6), name
    events = [event.message for _, event in topics["/flight/events"]]
    assert sum(event.startswith("target lost: ") for event in events) == score["losses"], (name, events)
    lost += score["losses"]
    end = {"finished": "end of the walk", "collision": "collision", "lost": "target lost for too long"}.get(score["end"])
    assert end is None or any(event.startswith(end) for event in events), (name, events)

clips = sorted((folder / "clips").iterdir())
assert len(clips) == min(card["kept"]["clips"], len(rows)), clips
by_rate = sorted(rows, key=lambda row: row["score"]["tracked_steps"] / max(row["score"]["planned_steps"], 1))
assert {clip.stem for clip in clips} == {row["episode"] for row in by_rate[: len(clips)]}
for clip in clips:
    with Image.open(clip) as picture:
        assert picture.n_frames > 1 and picture.size == (480, 266), (picture.n_frames, picture.size)


class Page(html.parser.HTMLParser):
    """Collects the files that a page refers to."""

    def handle_starttag(self, tag, attributes):
        links.extend(value for key, value in attributes if key in ("src", "href") and not value.startswith(("#", "data:")))


links = []
Page().feed((folder / "report.html").read_text())
assert links and all((folder / link).is_file() for link in links), links
print(f"{len(rows)} logs with {lost} losses, {len(clips)} clips and the page hold together")


def check_bag(bag, steps):
    from mcap_ros2.reader import read_ros2_messages
    from rosbags.highlevel import AnyReader

    (file,), topics = bag.glob("*.mcap"), defaultdict(list)
    with AnyReader([bag]) as reader:
        for connection, time, raw in reader.messages():
            topics[connection.topic].append((time, reader.deserialize(raw, connection.msgtype)))
    theirs = [it.channel.topic for it in read_ros2_messages(str(file))]
    assert sorted(theirs) == sorted(topic for topic, all_of_it in topics.items() for _ in all_of_it)
    times = [round(1e9 * step["time_s"]) + 10**9 for step in steps]
    assert topics["/town"][0][1].markers
    for topic in ("/clock", "/odom", "/target/odom", "/flight/step"):
        assert [time for time, _ in topics[topic]] == times, topic
    asked = dict(topics["/cmd_vel"] or topics["/flight/action"])
    for time, step, (_, drone), (_, target), (_, flown) in zip(times, steps, topics["/odom"], topics["/target/odom"], topics["/flight/step"]):
        for message, key in (drone, "position_in_world"), (target, "target_in_world"):
            place, (x, y, z) = message.pose.pose.position, step[key]
            assert (place.x, place.y, place.z) == (x, -y, z), key
        assert list(flown.data[:2]) == [step["tracked"], step["visible"]] and list(flown.data[4:]) == step["reward"]
        if "action" in step and topics["/cmd_vel"]:
            ahead, right, up, pitch, yaw = step["action"]
            linear, angular = asked[time].twist.linear, asked[time].twist.angular
            assert (linear.x, linear.y, linear.z) == (ahead, -right, up)
            assert math.isclose(math.degrees(-angular.y), pitch) and math.isclose(math.degrees(-angular.z), yaw)
    check_frames(topics, steps)
    return len(steps)


def check_frames(topics, steps):
    """Frames of camera and commands by the angles of the steps, computed anew; motion, inertial unit and receiver by the places of the frames."""
    import numpy as np
    from scipy.spatial.transform import Rotation
    from shared import world_from_body, xyz

    mirror = np.diag([1.0, -1, 1])
    turn = lambda q: Rotation.from_quat([q.x, q.y, q.z, q.w])
    bodies = [turn(message.pose.pose.orientation) for _, message in topics["/odom"]]
    for step, body, (_, odometry), (_, tf) in zip(steps, bodies, topics["/odom"], topics["/tf"], strict=True):
        edges = {it.child_frame_id: (it.header.frame_id, turn(it.transform.rotation), xyz(it.transform.translation)) for it in tf.transforms}
        at = mirror @ step["position_in_world"]
        for frame, angles in ("camera_link", (step["pitch_deg"], step["yaw_deg"], 0)), ("base_stabilized", (0, step["yaw_deg"], 0)):
            parent, found, place = edges[frame]
            found, place = (body * found, at + body.apply(place)) if parent == "base_link" else (found, place)
            assert np.allclose(found.as_matrix(), mirror @ world_from_body(*angles) @ mirror, atol=1e-9) and np.allclose(place, at), frame
        assert np.allclose(edges["base_link"][1].as_matrix(), body.as_matrix()) and np.allclose(edges["base_link"][2], at)
        assert np.allclose(body.apply(xyz(odometry.twist.twist.linear)), mirror @ step["velocity_in_world"], atol=1e-9)
    assert {message.header.frame_id for _, message in topics["/cmd_vel"]} <= {"base_stabilized"}
    times, speeds = np.array([time for time, _ in topics["/odom"]]) / 1e9, np.array([mirror @ step["velocity_in_world"] for step in steps])
    sensed = np.array([[time / 1e9, *xyz(it.angular_velocity), *xyz(it.linear_acceleration)] for time, it in topics["/imu"]]).reshape(-1, 7)
    wrong = []
    for first, (begin, end) in enumerate(zip(times, times[1:])):
        within = sensed[(sensed[:, 0] > begin) & (sensed[:, 0] <= end), 1:]
        if len(within) > 1:
            middle = Rotation.concatenate(bodies[first : first + 2]).mean()
            turned = (bodies[first].inv() * bodies[first + 1]).as_rotvec() / (end - begin)
            felt = (speeds[first + 1] - speeds[first]) / (end - begin) + [0, 0, 9.81]
            wrong.append([*np.abs(within[:, :3].mean(0) - turned), *np.abs(middle.apply(within[:, 3:].mean(0)) - felt)])
    if wrong:
        assert (np.mean(wrong, axis=0) < [0.02, 0.02, 0.02, 0.15, 0.15, 0.15]).all(), np.mean(wrong, axis=0)
        fixes = [(xyz(it.pose.pose.position), mirror @ steps[round((time / 1e9 - times[0]) / (times[1] - times[0]))]["position_in_world"])
                 for time, it in topics["/gnss"] if time / 1e9 <= times[-1]]
        away = np.abs(np.mean([place - true for place, true in fixes], axis=0))
        assert (away < [6, 6, 12]).all(), away


if len(sys.argv) > 2:
    bags = sorted(path.parent for path in pathlib.Path(sys.argv[2]).glob("*/*/metadata.yaml"))
    assert {bag.name for bag in bags} == {row["episode"] for row in rows}
    print(f"{len(bags)} bags, {sum(check_bag(bag, steps_of(bag.name)) for bag in bags)} steps")
    imported_by_rerun(*bags[0].glob("*.mcap"), "Transform3D", "Pinhole")
