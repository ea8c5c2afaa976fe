"""Plants faults in the sensors of a dataset and has `cosfly verify` find each: `check_sensor_faults.py COSFLY FOLDER [--only WORD]`.

The dataset is made in FOLDER by `sensors.toml` beside this script: a stereo pair with every channel, boxes and key points, six sensors and a lidar
among people and vehicles. A fault changes tables, logs or both, and all digests and sizes with them, so that only the contents can tell: shifted
time stamps, swapped axes, scales, flipped signs, masks, labels, masks of other frames. Shares no code with cosfly."""

import hashlib
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
from shared import POINT, command_line, end_with, messages, pixels, require, rows, run, said


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def put(path, write):
    """Another file in the place of a link."""
    beside = path.with_name(f"{path.name}.new")
    write(beside)
    beside.replace(path)


class Columns(dict):
    """Columns of a table by name, numbers as arrays; what nobody asks for stays as it is."""

    def __init__(self, table):
        super().__init__()
        self.table = table

    def __missing__(self, name):
        column = self.table[name]
        is_number = pa.types.is_floating(column.type) or pa.types.is_integer(column.type)
        self[name] = column.to_numpy().copy() if is_number else column.to_pylist()
        return self[name]

    def array(self, field):
        return pa.array(self[field.name], field.type) if field.name in self else self.table[field.name]


class Copy:
    """A copy of a dataset whose files are links until they change."""

    def __init__(self, dataset, folder):
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(dataset, folder, copy_function=os.link)
        self.folder, self.changed = folder, set()

    def table(self, name, change):
        """Changes each file of a table; `change` gets columns as arrays or lists, by name."""
        for path in sorted((self.folder / "data" / name).glob("*.parquet")):
            old = parquet.read_table(path)
            columns = Columns(old)
            change(columns)
            new = pa.table([columns.array(field) for field in old.schema], schema=old.schema)
            put(path, lambda beside: parquet.write_table(new, beside, compression="zstd", use_compliant_nested_type=False))
            self.changed.add(path)

    def log(self, topic, change):
        """Changes each message of a topic in the first log that has it; `change` gets the decoded message, its number and a list of all that come before,
        and may give another time."""
        path = next(path for path in sorted((self.folder / "mcap").glob("*/*/*.mcap")) if self.rewrite(path, topic, change))
        self.changed.add(path)

    def metadata(self, name, change):
        """Changes the entries of a record of metadata in every log."""
        for path in sorted((self.folder / "mcap").glob("*/*/*.mcap")):
            self.rewrite(path, None, None, {name: change})
            self.changed.add(path)

    def rewrite(self, path, topic, change, of_metadata={}):
        from mcap.reader import make_reader
        from mcap.writer import Writer
        from mcap_protobuf.decoder import DecoderFactory

        with open(path, "rb") as file:
            reader = make_reader(file, decoder_factories=[DecoderFactory()])
            summary = reader.get_summary()
            if topic and topic not in [channel.topic for channel in summary.channels.values()]:
                return False
            former = []
            spoilt = {}
            for schema, channel, message, decoded in reader.iter_decoded_messages([topic]) if topic else ():
                former.append(type(decoded).FromString(message.data))
                time_ns = change(decoded, len(former) - 1, former)
                spoilt[len(former) - 1] = (decoded.SerializeToString(), message.log_time if time_ns is None else time_ns)
            beside = path.with_name(f"{path.name}.new")
            with open(beside, "wb") as out:
                writer = Writer(out)
                header = reader.get_header()
                writer.start(profile=header.profile, library=header.library)
                schemas = {id: writer.register_schema(name=it.name, encoding=it.encoding, data=it.data) for id, it in summary.schemas.items()}
                channels = {id: writer.register_channel(topic=it.topic, message_encoding=it.message_encoding, schema_id=schemas[it.schema_id],
                                                        metadata=it.metadata) for id, it in summary.channels.items()}
                for metadata in reader.iter_metadata():
                    writer.add_metadata(metadata.name, of_metadata.get(metadata.name, dict)(metadata.metadata))
                number = 0
                for schema, channel, message in reader.iter_messages(log_time_order=False):
                    data, time_ns = message.data, message.log_time
                    if channel.topic == topic:
                        data, time_ns = spoilt[number]
                        number += 1
                    writer.add_message(channels[channel.id], log_time=time_ns, publish_time=time_ns, sequence=message.sequence, data=data)
                writer.finish()
        beside.replace(path)
        return True

    def seal(self):
        """Sizes and digests of what has changed, in all places that have them."""
        logs = {str(path.relative_to(self.folder)): path for path in self.changed if path.suffix == ".mcap"}
        if logs:
            def of_logs(columns):
                for row, path in enumerate(columns["mcap_path"]):
                    if path in logs:
                        columns["mcap_bytes"][row], columns["mcap_sha256"][row] = logs[path].stat().st_size, digest(logs[path])
            self.table("trajectories", of_logs)
        before = digest(self.folder / "files.parquet"), (self.folder / "files.parquet").stat().st_size
        listed = parquet.read_table(self.folder / "files.parquet").to_pydict()
        for row, path in enumerate(listed["path"]):
            if self.folder / path in self.changed:
                listed["bytes"][row], listed["sha256"][row] = (self.folder / path).stat().st_size, digest(self.folder / path)
        schema = parquet.read_schema(self.folder / "files.parquet")
        put(self.folder / "files.parquet", lambda beside: parquet.write_table(pa.table(listed, schema=schema), beside))
        after = digest(self.folder / "files.parquet"), (self.folder / "files.parquet").stat().st_size
        croissant = self.folder / "croissant.json"
        text = croissant.read_text().replace(before[0], after[0]).replace(f'"{before[1]} B"', f'"{after[1]} B"')
        put(croissant, lambda beside: beside.write_text(text))
        put(self.folder / "SHA256SUMS", lambda beside: beside.write_text(f"{after[0]}  files.parquet\n{digest(croissant)}  croissant.json\n"))


def scale(factor, *names):
    def change(columns):
        for name in names:
            columns[name] = columns[name] * factor
    return change


def swap(*pairs):
    def change(columns):
        for a, b in pairs:
            columns[a], columns[b] = columns[b], columns[a]
    return change


def truth(*names):
    """Names with those of their truth."""
    return [name for own in names for name in (own, f"true_{own}")]


def later(by_s):
    """Readings of another time: each row has the numbers of the reading so much later."""
    def change(columns):
        ids, times = np.array(columns["trajectory_id"]), columns["time_s"]
        step = int(round(by_s / (times[1] - times[0])))
        fixed = ("trajectory_id", "row", "frame", "time_s")
        for name in columns.table.schema.names:
            if name not in fixed:
                moved = columns[name] if isinstance(columns[name], list) else list(columns[name])
                columns[name] = [moved[row + step] if row + step < len(ids) and ids[row + step] == ids[row] else moved[row] for row in range(len(ids))]
                if name not in ("cloud",):
                    columns[name] = np.array(columns[name])
    return change


def table(name, change):
    return lambda copy: copy.table(name, change)


def sensor(name, change):
    """Changes the readings of the first flight, in the table and in its log."""
    def both(copy):
        first = next(path for path in sorted((copy.folder / "mcap").glob("*/*/*.mcap")) if path.stem.endswith("_left"))
        spoilt = {}

        def of_first(columns):
            ids = np.array(columns["trajectory_id"])
            if first.stem not in ids:
                return
            old = {field: columns[field].copy() for field in columns.table.schema.names if field != "trajectory_id"}
            change(columns)
            for field in old:
                columns[field] = np.where(ids == first.stem, columns[field], old[field])
                spoilt[field] = columns[field][ids == first.stem]

        def of_log(message, number, former):
            for name in spoilt.keys() & numbers_of(message):
                setattr(message, name, spoilt[name][number])
        copy.table(name, of_first)
        copy.log(f"/sensor/{name}", of_log)
    return both


def image(channel, change):
    """Changes the pixels of a channel: `change` gets the array, the frame and those before it."""
    def of_message(message, number, former):
        array = change(pixels(message).copy(), number, [pixels(it) for it in former[:-1]])
        message.data = np.ascontiguousarray(array).tobytes()
    return lambda copy: copy.log(f"/camera/{channel}/image", of_message)


def flow_of_bodies(copy):
    """Halves the flow of people and vehicles; that of what stands stays."""
    path = next(path for path in sorted((copy.folder / "mcap").glob("*/*/*.mcap")))
    ids = [pixels(it) for _, it, *_ in messages(path, ["/camera/instance/image"])]
    standing = [0, *(row["instance"] for row in rows(copy.folder, "objects", ["instance"]))]

    def change(message, number, former):
        flow = pixels(message).copy()
        flow[~np.isin(ids[number], standing)] *= 0.5
        message.data = flow.tobytes()
    copy.log("/camera/flow_forward/image", change)


def cloud(name, field, value):
    """Other values of a field of the points of each sweep of a table, and of its log, whose y goes to the left."""
    def spoilt(data, mirror=1):
        points = np.frombuffer(data, POINT).copy()
        points["place"][:, 1] *= mirror
        points[field] = value(points[field])
        points["place"][:, 1] *= mirror
        return points.tobytes()

    def of_log(message, number, former):
        message.data = spoilt(message.data, -1)

    def both(copy):
        copy.table(name, lambda columns: columns.update(cloud=list(map(spoilt, columns["cloud"]))))
        copy.log(f"/sensor/{name}", of_log)
    return both


def left_for_right(columns):
    """Each left key point is named as the right one, and the other way round: COCO's order."""
    order = [0, 2, 1, 4, 3, 6, 5, 8, 7, 10, 9, 12, 11, 14, 13, 16, 15]
    for name in ("key_points_px", "key_points_depth_m", "key_points_in_world_m", "key_points_shown"):
        columns[name] = [it and [it[k] for k in order] if it and len(it) == 17 else it for it in columns[name]]


def others_turned(columns):
    for name in ("yaw_in_world_deg", "yaw_in_camera_deg"):
        columns[name] = np.where(np.array(columns["instance"]) != 1, (columns[name] + 10 + 180) % 360 - 180, columns[name])


def shown(columns):
    columns["key_points_shown"] = [it and [{2: 1, 1: 2}.get(k, k) for k in it] for it in columns["key_points_shown"]]


def numbers_of(message):
    return [it.name for it in message.DESCRIPTOR.fields if it.cpp_type == it.CPPTYPE_DOUBLE]


def reading_of_log(message, number, former):
    setattr(message, numbers_of(message)[0], -1.01 * getattr(message, numbers_of(message)[0]) - 0.01)


def half_a_second_later(message, number, former):
    for name in numbers_of(message):
        setattr(message, name, getattr(former[max(number - 100, 0)], name))


def readout(factor, is_in_log=True):
    """Another read-out of the rolling shutter, in the table and in the logs; 0: none."""
    def of_log(about):
        offsets = [factor * it for it in json.loads(about["readout_offsets_s"])]
        kept = {name: it for name, it in about.items() if factor or not name.startswith("readout")}
        return kept | ({"readout_offsets_s": json.dumps(offsets), "readout_s": str(factor * float(about["readout_s"]))} if factor else {"readout_s": "0"})

    def both(copy):
        copy.table("trajectories", scale(factor, "camera_readout_s"))
        if is_in_log:
            copy.metadata("cosfly.camera", of_log)
    return both


FORCE, RATE = [f"force_{a}_mps2" for a in "xyz"], [f"rate_{a}_rad_s" for a in "xyz"]
FIELD = [f"field_{a}_ut" for a in "xyz"]
BY_TWO, BEFORE, MIRRORED = (lambda it, *_: it * np.float32(1.02)), (lambda it, n, old: old[-1] if n else it), (lambda it, *_: it[:, ::-1])
IMAGES = {
    **{f"{channel} {fault}": (channel, change) for channels, fault, change in (
        ("depth_stereo depth_sensor flow_forward flow_back", "scaled", BY_TWO),
        ("disparity depth_stereo depth_sensor normals mask mask_amodal flow_forward", "of the frame before", BEFORE),
        ("depth_stereo depth_sensor", "mirrored", MIRRORED),
    ) for channel in channels.split()},
    "disparity scaled": ("disparity", lambda it, *_: it * np.float32(1.01)),
    "depth_sensor in millimetres": ("depth_sensor", lambda it, *_: it * np.float32(1000)),
    "normals flipped": ("normals", lambda it, *_: 255 - it if it.dtype == np.uint8 else -it),
    "normals with swapped axes": ("normals", lambda it, *_: it[..., [1, 0, 2]]),
    "mask empty": ("mask", lambda it, *_: it * 0),
    "mask_amodal is the mask": ("mask_amodal", lambda it, n, old: np.where(np.cumsum(it, 1) % 2, it, 0).astype(it.dtype)),
    "flow_forward flipped": ("flow_forward", lambda it, *_: -it),
    "flow_forward with swapped axes": ("flow_forward", lambda it, *_: it[..., ::-1]),
    "flow_forward_valid inverted": ("flow_forward_valid", lambda it, n, old: 1 - it),
    "flow_forward_valid all 1": ("flow_forward_valid", lambda it, n, old: it * 0 + it.any()),
    "flow_forward_valid all 0": ("flow_forward_valid", lambda it, n, old: it * 0),
    "flow_back_valid of the frame before": ("flow_back_valid", lambda it, n, old: old[-1] if n > 1 else it),
}
FAULTS = {
    **{name: image(*what) for name, what in IMAGES.items()},
    "flow of bodies halved": flow_of_bodies,
    "inertial: x and z of the force swapped": sensor("inertial_unit", swap(FORCE[::2])),
    "inertial: y and z of the rates and their truth swapped": sensor("inertial_unit", swap(RATE[1:], [f"true_{it}" for it in RATE[1:]])),
    "inertial: rate z flipped": sensor("inertial_unit", scale(-1, RATE[2])),
    "inertial: rate z and its truth flipped": sensor("inertial_unit", scale(-1, *truth(RATE[2]))),
    "inertial: force z scaled": sensor("inertial_unit", scale(1.03, FORCE[2])),
    "inertial: forces and truth scaled": sensor("inertial_unit", scale(1.03, *truth(*FORCE))),
    "inertial: a frame later": sensor("inertial_unit", later(0.5)),
    "inertial: velocities flipped": sensor("inertial_unit", scale(-1, "true_velocity_x_mps")),
    "barometer: altitude scaled": sensor("barometer", scale(1.5, "altitude_m")),
    "barometer: pressures scaled": sensor("barometer", scale(1.02, *truth("pressure_hpa"))),
    "barometer: a second later": sensor("barometer", later(1.0)),
    "magnetometer: x and y swapped": sensor("magnetometer", swap(FIELD[:2])),
    "magnetometer: x and y and truth swapped": sensor("magnetometer", swap(FIELD[:2], [f"true_{it}" for it in FIELD[:2]])),
    "magnetometer: y and truth flipped": sensor("magnetometer", scale(-1, *truth(FIELD[1]))),
    "magnetometer: all scaled": sensor("magnetometer", scale(1.05, *truth(*FIELD))),
    "magnetometer: two seconds later": sensor("magnetometer", later(2.0)),
    "receiver: east and north swapped": sensor("satellite_receiver", swap(["east_m", "north_m"])),
    "receiver: velocity north and truth flipped": sensor("satellite_receiver", scale(-1, *truth("velocity_north_mps"))),
    "receiver: velocities swapped": sensor("satellite_receiver", swap(["velocity_east_mps", "velocity_north_mps"], ["true_velocity_east_mps", "true_velocity_north_mps"])),
    "receiver: latitude and longitude swapped": sensor("satellite_receiver", swap(["latitude_deg", "longitude_deg"])),
    "receiver: latitude flipped": sensor("satellite_receiver", scale(-1, "latitude_deg")),
    "receiver: a second later": sensor("satellite_receiver", later(1.0)),
    "altimeter: range scaled": sensor("laser_altimeter", scale(1.05, "range_m")),
    "altimeter: a second later": sensor("laser_altimeter", later(1.0)),
    "altimeter: no hits": sensor("laser_altimeter", scale(0, "is_hit")),
    "odometry: axes swapped": sensor("odometry", swap(["axis_x", "axis_y"])),
    "odometry: velocity flipped": sensor("odometry", scale(-1, "velocity_x_mps")),
    "odometry: velocity scaled": sensor("odometry", scale(1.05, "velocity_x_mps", "velocity_y_mps", "velocity_z_mps")),
    "odometry: a second later": sensor("odometry", later(1.0)),
    "lidar: ranges scaled": cloud("vlp16", "place", lambda it: 1.03 * it),
    "lidar: axes swapped": cloud("vlp16", "place", lambda it: it[:, [1, 0, 2]]),
    "lidar: to the left": cloud("vlp16", "place", lambda it: it * [1, -1, 1]),
    "lidar: labels of something else": cloud("vlp16", "label", lambda it: np.where(it == 3, 9, it)),
    "lidar: instances of something else": cloud("vlp16", "instance", lambda it: np.where(it > 1, it + 1, it)),
    "lidar: intensity doubled": cloud("vlp16", "intensity", lambda it: 2 * it),
    "lidar: a sweep later": table("vlp16", later(0.3)),
    "lidar: times backwards": cloud("vlp16", "time", lambda it: 0.1 - it),
    "boxes: others turned": table("bodies_3d", others_turned),
    "boxes: size scaled": table("bodies_3d", lambda columns: columns.update(size_m=[[1.05 * v for v in it] for it in columns["size_m"]])),
    "key points: left for right": table("bodies_3d", left_for_right),
    "key points: seen for hidden": table("bodies_3d", shown),
    **{f"log of {name} differs from its table": (lambda name: lambda copy: copy.log(f"/sensor/{name}", reading_of_log))(name)
       for name in ("inertial_unit", "barometer", "magnetometer", "satellite_receiver", "laser_altimeter", "odometry")},
    "log of inertial_unit half a second later": lambda copy: copy.log("/sensor/inertial_unit", half_a_second_later),
}


ROLLED = {
    "read-out of the wrong sign": readout(-1),
    "read-out of double length": readout(2),
    "no read-out": readout(0),
    "read-out of the table alone": readout(1.01, False),
    **{f"rolled {name}": image(*IMAGES[name]) for name in IMAGES if "flow" in name},
    "rolled flow of bodies halved": flow_of_bodies,
}


def missed(cosfly, dataset, folder, faults):
    """Faults of a dataset that nobody finds."""
    for name, plant in faults.items():
        copy = Copy(dataset, folder)
        plant(copy)
        require(copy.changed, f"`{name}` changed nothing")
        copy.seal()
        done = subprocess.run([cosfly, "verify", copy.folder, "--json"], capture_output=True, text=True)
        findings = json.loads(done.stdout)["findings"]
        rules = {re.search(r"\[(verify-[a-z0-9-]+)\]", line).group(1) for line in findings}
        require(not rules & {"verify-hash", "verify-size", "verify-extra-file", "verify-croissant", "verify-crc"}, f"`{name}` is badly sealed: {findings[:2]}")
        if rules:
            said(name, f"{len(findings)} {sorted(rules)} {findings[0][:160]}")
        else:
            print("MISSED", name, flush=True)
            yield f"not found: {name}"


def main():
    given = command_line("cosfly folder", only=str, dataset=Path)
    folder, wrong = given.folder.resolve(), []
    folder.mkdir(parents=True, exist_ok=True)
    recipe = Path(__file__).with_name("sensors.toml")
    rolled = ["stages.street.frames=6", "stages.street.follow.count=1", "stages.frames.rolling_shutter.readout_s=0.06", "stages.dataset.inputs.extras=[]"]
    for name, options, faults in (("sound", [], FAULTS), ("rolled", rolled, ROLLED)):
        if given.dataset and name == "rolled":
            continue
        dataset = given.dataset or folder / name
        if not dataset.exists():
            run(given.cosfly, "run", recipe, "--out", dataset, "--store", folder / "store", "--quiet", *[word for it in options for word in ("--set", it)])
        run(given.cosfly, "verify", dataset)
        wrong += missed(given.cosfly, dataset, folder / "planted", {fault: it for fault, it in faults.items() if not given.only or given.only in fault})
    end_with(wrong)


if __name__ == "__main__":
    main()
