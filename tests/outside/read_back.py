"""Reads a finished dataset with other people's software only and fails on the first thing that does not work.

    python3 -m venv venv && venv/bin/pip install -r tests/outside/requirements.txt
    venv/bin/python tests/outside/read_back.py DATASET_FOLDER

Each check prints one line. Exit code 0: every reader read everything."""

import hashlib
import json
import logging
import math
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from shared import bytes_of, command_line, picture, require, run, said

for name in ("HF_HUB_OFFLINE", "HF_DATASETS_OFFLINE", "HF_HUB_DISABLE_TELEMETRY"):
    os.environ.setdefault(name, "1")

TABLES = ["trajectories", "frames", "waypoints", "captions", "pairs", "bodies", "windows", "objects", "rejected"]
# A number of each table whose sum shows that the rows are the same ones, too.
SUMS = {"trajectories": "frames", "frames": "drone_x_m", "windows": "start_frame", "bodies": "frame", "objects": "instance", "pairs": "frames"}
FRAME_TOPICS = [
    "/camera/rgb/image", "/camera/rgb/camera_info", "/camera/rgb/annotations", "/camera/depth/image",
    "/camera/semantic/image", "/camera/instance/image", "/tf", "/drone/pose", "/target/pose", "/target/state",
]
# Channels that a recipe may ask for: encoding and bytes of a pixel.
ON_REQUEST = {"/camera/mask/image": ("mono8", 1), "/camera/normals/image": ("rgb8", 3)}
PREVIEW_TOPICS = [f"/camera/{name}/preview" for name in ("rgb", "depth", "semantic", "mask", "normals")]
ONCE_TOPICS = ["/drone/path", "/target/path", "/scene"]


def check_hashes(folder):
    """Every file is listed once and has the size and hash that is written down."""
    import pyarrow.parquet as pq

    for line in (folder / "SHA256SUMS").read_text().splitlines():
        digest, name = line.split("  ")
        require(hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest, f"{name} differs from SHA256SUMS")
    listed = {row["path"]: row for row in pq.read_table(folder / "files.parquet").to_pylist()}
    present = {name: digest for name, digest in bytes_of(folder).items() if not name.startswith(".")}
    for name in ("files.parquet", "croissant.json", "SHA256SUMS"):
        del present[name]
    require(set(present) == set(listed), f"files.parquet and the folder differ: {sorted(set(present) ^ set(listed))[:5]}")
    for name, row in listed.items():
        size = (folder / name).stat().st_size
        require(size == row["bytes"], f"{name} has {size} bytes, not {row['bytes']}")
        require(present[name] == row["sha256"], f"{name} differs from its hash")
    said("hashlib", f"{len(listed)} files")


def check_pyarrow(folder):
    import pyarrow.dataset as ds

    counts = {}
    for table in TABLES:
        rows = ds.dataset(folder / "data" / table, format="parquet").to_table()
        rows.validate(full=True)
        counts[table] = rows.num_rows
    trajectories = ds.dataset(folder / "data" / "trajectories", format="parquet").to_table().to_pylist()
    require(sum(row["frames"] for row in trajectories) == counts["frames"] == counts["waypoints"], "frame counts differ")
    said("pyarrow", ", ".join(f"{name} {count}" for name, count in counts.items()))
    return counts, trajectories


def check_tables(folder, cache):
    """DuckDB, polars and `datasets` (streaming, too) agree on rows, flights and sums; pictures of frames can be opened."""
    import datasets
    import duckdb
    import polars
    import pyarrow.dataset as ds

    datasets.disable_progress_bars()
    load = lambda config, **options: datasets.load_dataset(str(folder), config, cache_dir=cache, **options)
    close = lambda a, b: math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9)
    for place in sorted((folder / "data").iterdir()):
        table, glob = place.name, str(place / "*.parquet")
        column, columns = SUMS.get(table), set(ds.dataset(place, format="parquet").schema.names)
        require(column is None or column in columns, f"{table} has no column {column}")
        rows, total = duckdb.sql(f"select count(*), coalesce({f'sum({column})' if column else '0'}, 0) from read_parquet('{glob}')").fetchall()[0]
        number, *sums = polars.scan_parquet(glob).select([polars.len(), *([polars.col(column).sum()] if column else [])]).collect().row(0)
        require(number == rows and all(close(it, total) for it in sums), f"{table}: {rows} rows and {total} in DuckDB, {number} and {sums} in polars")
        streamed = load(table, streaming=True)
        if not rows:  # the config stays, and its stream has no rows
            require(all(list(part) == [] and set(part.column_names or ()) == columns for part in streamed.values()), f"the stream of {table}")
            continue
        whole, sum_of_stream = load(table), 0
        require(sum(part.num_rows for part in whole.values()) == rows, f"datasets sees other rows of {table}")
        for split, part in streamed.items():
            own = [row[column] if column else 0 for row in part.remove_columns([name for name in columns if name == "preview"])]
            require(len(own) == whole[split].num_rows, f"{table}/{split}: {len(own)} rows streamed")
            sum_of_stream += sum(own)
        require(close(sum_of_stream, total), f"{table}: {sum_of_stream} in the stream, {total} in DuckDB")
        said(f"readers of {table}", f"{rows} rows in DuckDB, polars, datasets and its stream")
        for part in whole.values() if table == "frames" else ():
            require(isinstance(part.features["preview"], datasets.Image), "frames.preview is not an Image")
            require(part.features["role"].names == ["expert", "perturbed"], "frames.role is not a ClassLabel")
            for preview in filter(None, part["preview"]):
                preview.load()
    require(sum(part.num_rows for part in load("files").values()) > 0, "datasets sees no files")
    by_flight = f"select trajectory_id, count(*) n from read_parquet('{folder}/data/frames/*.parquet') group by 1"
    flights = polars.read_parquet(str(folder / "data/trajectories/*.parquet")).select("trajectory_id", "frames").rows()
    require(dict(duckdb.sql(by_flight).fetchall()) == dict(flights), "frames by flight differ from the table of flights")
    said("frames by flight", f"{len(flights)} flights in DuckDB and polars")


def check_croissant(folder, counts):
    import mlcroissant as mlc

    path = folder / "croissant.json"
    told = run(Path(sys.executable).with_name("mlcroissant"), "validate", "--jsonld", path, stderr=subprocess.STDOUT)
    require("WARNING" not in told.upper(), f"mlcroissant warns: {told[-2000:]}")
    said("mlcroissant validate")
    logging.getLogger().setLevel(logging.ERROR)  # mlcroissant tries its path expressions on split names, too
    document = json.loads(path.read_text())
    rai = [key for key in document if key.startswith("rai:")]
    require(len(rai) == 21 and "prov:wasGeneratedBy" in document, f"{len(rai)} rai: terms")
    for record_set in document["recordSet"]:
        name = record_set["@id"]
        dataset = mlc.Dataset(jsonld=str(path))
        records = list(dataset.records(record_set=name))
        require(name not in counts or len(records) == counts[name], f"{len(records)} records of {name}")
        fields = {field["@id"] for field in record_set["field"]}
        require(not records or set(records[0]) == fields, f"{name}: {fields}")
        said(f"mlcroissant {name}", f"{len(records)} records")
    splits = {path.name.split("-")[0] for path in (folder / "data" / "trajectories").iterdir()}
    for split in sorted(splits):
        dataset = mlc.Dataset(jsonld=str(path))
        filtered = list(dataset.records(record_set="frames", filters={"frames/split": split}))
        require(filtered and all(row["frames/split"].decode() == split for row in filtered), f"filter {split}")
        said(f"mlcroissant filter {split}", f"{len(filtered)} frames")


def check_mcap(folder, trajectories):
    """Records, times, counts and CRCs of all logs; every message of one log of each role, decoded."""
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    first = {row["role"]: row["trajectory_id"] for row in reversed(trajectories)}
    for row in trajectories:
        path, counts = folder / row["mcap_path"], Counter()
        with path.open("rb") as file:
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            require(reader.get_header().library == "cosfly", f"{path}: library")
            names = {record.name for record in reader.iter_metadata()}
            require({"cosfly.trajectory", "cosfly.weather", "cosfly.conventions"} <= names, f"{path}: metadata {names}")
        with path.open("rb") as file:
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            decode = row["trajectory_id"] == first[row["role"]]
            for _, channel, message, *decoded in reader.iter_decoded_messages() if decode else reader.iter_messages():
                topic = channel.topic
                require(message.log_time == round(counts[topic] * row["dt_s"] * 1e9) or topic == "/captions", f"{path}: time of {topic}")
                counts[topic] += 1
                if decode:
                    check_message(row, topic, decoded[0], path)
        for topics, allowed in ((FRAME_TOPICS, [row["frames"]]), ([*PREVIEW_TOPICS, *ON_REQUEST], [0, row["frames"]]), (ONCE_TOPICS, [1])):
            for topic in topics:
                require(counts[topic] in allowed, f"{path}: {counts[topic]} messages on {topic}")
        require(sum(counts.values()) == row["mcap_messages"], f"{path}: number of messages")
    said("mcap, CRCs, protobuf", f"{len(trajectories)} logs, {len(first)} of them decoded")


def check_message(row, topic, decoded, path):
    pixels = row["camera_width_px"] * row["camera_height_px"]
    if topic == "/camera/depth/image":
        require(decoded.encoding == "32FC1" and len(decoded.data) == 4 * pixels, f"{path}: depth")
    elif topic == "/camera/semantic/image":
        require(decoded.encoding == "mono8" and len(decoded.data) == pixels, f"{path}: semantic")
        unknown = decoded.data.translate(None, bytes(range(29)))
        require(not unknown, f"{path}: labels {set(unknown)}")
    elif topic in ON_REQUEST:
        encoding, size = ON_REQUEST[topic]
        require(decoded.encoding == encoding and len(decoded.data) == size * pixels, f"{path}: {topic}")
    elif topic == "/camera/rgb/image":
        image = picture(decoded)
        image.load()
        require(image.size == (row["camera_width_px"], row["camera_height_px"]), f"{path}: rgb {image.size}")
    elif topic == "/camera/semantic/preview":
        require(picture(decoded).mode == "P", f"{path}: semantic preview")
    elif topic == "/camera/rgb/camera_info":
        require(math.isclose(decoded.K[0], row["camera_focal_px"]), f"{path}: focal length")
    elif topic == "/target/state":
        require(math.isclose(decoded.height_m, row["target_height_m"]), f"{path}: target height")


def check_rerun(folder, trajectories):
    rerun = Path(sys.executable).with_name("rerun")
    run(rerun, "analytics", "disable")
    for row in trajectories:
        run(rerun, "mcap", "check", folder / row["mcap_path"])
    said("rerun mcap check", f"{len(trajectories)} logs")
    with tempfile.TemporaryDirectory() as scratch:
        script, saved = folder / "layouts/show_in_rerun.py", Path(scratch) / "flight.rrd"
        run(sys.executable, script, folder / trajectories[0]["mcap_path"], "--every", 10, "--save", saved)
        run(rerun, "rrd", "verify", saved)
    said("layouts/show_in_rerun.py, rerun rrd verify")


arguments = command_line("folder", cache=str)
dataset = arguments.folder.resolve()
check_hashes(dataset)
rows_of_tables, flights = check_pyarrow(dataset)
check_tables(dataset, arguments.cache)
check_croissant(dataset, rows_of_tables)
check_mcap(dataset, flights)
check_rerun(dataset, flights)
print("read_back: all readers read everything")
