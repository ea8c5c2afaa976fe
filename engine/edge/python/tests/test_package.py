"""The package against the command line and other readers. Needs the package, numpy, pyarrow, pillow, mcap, pytest."""

import io
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from PIL import Image

import cosfly


def logged(dataset, trajectory, frame):
    """Images of a frame by the mcap package and Pillow."""
    rows = pq.read_table(f"{dataset}/data/trajectories").to_pylist()
    row = next(row for row in rows if row["trajectory_id"] == trajectory)
    time_ns, found = round(frame * row["dt_s"] * 1e9), {}
    with open(f"{dataset}/{row['mcap_path']}", "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            if message.log_time == time_ns:
                found[channel.topic] = decoded
    raw = lambda topic, kind: np.frombuffer(found[topic].data, kind).reshape(found[topic].height, found[topic].width)
    return {
        "rgb": np.array(Image.open(io.BytesIO(found["/camera/rgb/image"].data))),
        "depth": raw("/camera/depth/image", "<f4"),
        "semantic": raw("/camera/semantic/image", "u1"),
        "instance": raw("/camera/instance/image", {"16UC1": "<u2", "32UC1": "<u4"}[found["/camera/instance/image"].encoding]),
    }


def test_run_is_the_command_line(folder):
    again = cosfly.run("small", out="data", progress=False)
    assert [stage.ran for stage in again.stages] == [0] * len(again.stages)
    text = subprocess.run(
        [sys.executable, "-m", "cosfly", "run", "small", "--out", "data2", "--json"], check=True, capture_output=True
    ).stdout
    assert again.version in text.decode()
    assert cosfly.plan("small").to_run == 0
    of_cargo = os.environ.get("COSFLY_DATASET_OF_CARGO")
    if of_cargo:  # the same recipe, run by the command line that cargo built
        files = lambda folder: {path.relative_to(folder): path for path in Path(folder).rglob("*") if path.is_file()}
        ours, theirs = files("data"), files(of_cargo)
        assert ours.keys() == theirs.keys() and all(ours[it].read_bytes() == theirs[it].read_bytes() for it in ours)
    assert cosfly.plan("small", set={"stages.walkers.frames": 25}).to_run > 0
    assert cosfly.why("small", "expert").cached
    assert cosfly.verify("data", progress=False)


def test_recipes_are_dictionaries_too():
    recipe = {
        "name": "dict", "seed": 1,
        "stages": {
            "town": {"use": "map", "source": "small/towns/downtown.xodr"},
            "walkers": {"use": "pedestrians", "inputs": {"town": "town"}, "count": 1, "frames": 20},
        },
    }  # fmt: skip
    seen = []
    made = cosfly.run(recipe, set={"seed": 2}, progress=lambda progress: seen.append(progress))
    assert made.outcome == "complete" and [stage.items for stage in made.stages] == [1, 1]
    assert seen and seen[-1]["walkers"] == (1, 1) or list(seen[-1]["walkers"]) == [1, 1]


def test_errors_are_those_of_the_command_line():
    with pytest.raises(cosfly.Error) as caught:
        cosfly.run("small", set={"stages.walkers.cuont": 3}, progress=False)
    assert "count" in str(caught.value) and caught.value.code.startswith("recipe"), caught.value
    assert pickle.loads(pickle.dumps(caught.value)).problems == caught.value.problems
    with pytest.raises(cosfly.Error, match="does not exist") as caught:
        cosfly.Dataset("nowhere")
    assert caught.value.code == "dataset-none" and caught.value.hints
    with pytest.raises(ValueError):
        cosfly.export("data", "no-such-format", "x", progress=False)
    with pytest.raises(cosfly.Error):
        cosfly.run({"name": "x", "stages": {"a": {"use": "nothing"}}}, progress=False)


def test_ctrl_c_stops_and_keeps_finished_items():
    began = time.time()
    threading.Timer(1.0, lambda: signal.raise_signal(signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        cosfly.run("small", set={"stages.walkers.count": 60, "seed": 5}, out="long", progress=False)
    assert time.time() - began < 60 and not Path("long").exists()


@pytest.mark.parametrize("work", ["run", "regenerate"])
def test_ctrl_c_acts_in_the_middle_of_an_item(work):
    """In a process of its own: a walk of hours, whose thread ends with the process. Two seconds are promised; a busy machine gets more."""
    endless = {"stages.walkers.count": 1, "stages.walkers.frames": 40000}
    call = {
        "run": f"cosfly.run('small', set={endless}, out='endless', progress=False)",
        "regenerate": f"cosfly.verify('data', regenerate=1, recipe='small', set={endless}, progress=False)",
    }[work]
    program = f"""
import signal, threading, time, cosfly
sent = []
threading.Timer(5.0, lambda: (sent.append(time.time()), signal.raise_signal(signal.SIGINT))).start()
try:
    {call}
except KeyboardInterrupt:
    print(time.time() - sent[0], flush=True)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and float(done.stdout) < 5.0, done
    assert not Path("endless").exists()


@pytest.mark.parametrize("work", ["verify", "doctor"])
def test_ctrl_c_acts_in_the_middle_of_a_flight(work):
    """The dataset is checked again and again until a signal hits it at work; each call must end soon after its signal, on a busy machine, too."""
    call = {"verify": lambda: cosfly.verify("data", jobs=1, progress=False), "doctor": lambda: cosfly.doctor("data", progress=False)}[work]
    interrupted = []
    for delay in (0.05, 0.2, 0.4):
        sent = []
        timer = threading.Timer(delay, lambda: (sent.append(time.time()), signal.raise_signal(signal.SIGINT)))
        try:
            timer.start()
            while True:
                call()
        except KeyboardInterrupt:
            interrupted.append(time.time() - sent[0])
        timer.join()
    assert max(interrupted) < 5.0, interrupted


def test_tables_are_those_of_pyarrow():
    dataset = cosfly.Dataset("data")
    for name in ("trajectories", "frames", "windows", "captions"):
        theirs, ours = pq.read_table(f"data/data/{name}"), pa.table(dataset.table(name))
        assert ours.num_rows == theirs.num_rows == len(dataset.table(name)) and ours.column_names == theirs.column_names
    frames = dataset.table("frames")
    assert np.array_equal(frames["frame"], pa.table(frames)["frame"].to_numpy())
    with pytest.raises(KeyError, match="drone_x_m"):
        frames["nothing"]


def test_frames_are_bit_for_bit_those_of_the_log():
    dataset = cosfly.Dataset("data", channels=("rgb", "depth", "semantic", "instance"))
    name = dataset.trajectory_ids[-1]
    for frame in (0, 7):
        ours, theirs = dataset.frame(name, frame), logged("data", name, frame)
        for channel in ("depth", "semantic", "instance"):
            assert np.array_equal(ours[channel], theirs[channel]), channel
        assert np.abs(ours["rgb"].astype(int) - theirs["rgb"]).max() <= 4  # two JPEG decoders
    small = dataset.frame(name, 3, size=(64, 36))
    whole = Image.fromarray(dataset.frame(name, 3)["rgb"]).resize((64, 36), Image.BOX)
    assert small["rgb"].shape == (36, 64, 3) and small["depth"].shape == (36, 64)
    # Fractions of JPEG files come from their low frequencies, which is close to the mean of the area.
    difference = np.abs(small["rgb"].astype(int) - np.array(whole))
    assert difference.mean() <= 4 and difference.max() <= 48


def test_windows_align_with_their_frames():
    windows = cosfly.Dataset("data", channels=("rgb", "depth"), size=(80, 45), captions="en").windows()
    rows = pq.read_table("data/data/windows").to_pylist()
    assert len(windows) == len(rows)
    sample = windows[3]
    assert sample["rgb"].shape == (5, 45, 80, 3) and sample["depth"].dtype == np.float32 and sample["captions"]
    row = next(it for it in rows if it["trajectory_id"] == sample["trajectory_id"] and it["start_frame"] == sample["start_frame"])
    assert np.allclose(sample["waypoint_deltas_in_world"].ravel(), row["waypoint_deltas_in_world"])
    assert np.allclose(sample["input_boxes_px"].ravel(), np.array(row["input_boxes_px"]) / 4)
    alone = windows.frame(sample["trajectory_id"], sample["start_frame"] + 2)
    assert np.array_equal(sample["rgb"][2], alone["rgb"])
    experts = cosfly.Dataset("data", role="expert").windows()
    assert 0 < len(experts) < len(windows) and experts[0]["role"] == "expert"


def test_orders_and_loaders_are_deterministic_and_resume():
    windows = cosfly.Dataset("data", channels=()).windows()
    assert sorted(windows.order(3)) == list(range(len(windows))) and list(windows.order(3)) != list(windows.order(4))
    shards = [set(windows.order(3, 1, (rank, 3)).tolist()) for rank in range(3)]
    assert len(set().union(*shards)) == 3 * len(shards[0])
    key = lambda batch: list(zip(batch["trajectory_id"], batch["start_frame"].tolist()))
    loader = windows.loader(4, seed=9)
    first, state = next(iter(loader)), loader.state_dict()
    rest = [key(batch) for batch in loader]
    resumed = cosfly.Loader(windows, 4)
    resumed.load_state_dict(state)
    assert [key(batch) for batch in resumed] == rest and key(first) not in rest
    with pytest.raises(ValueError, match="samples"):
        resumed.load_state_dict({**state, "samples": 1})


def test_packs_give_the_same_samples():
    pack = cosfly.pack("data", "packed", size=(80, 45), channels=("rgb", "depth"), progress=False)
    assert len(pack) == len(cosfly.Dataset("data"))
    windows = cosfly.Pack("packed", "data").windows()
    plain = cosfly.Dataset("data", size=(80, 45)).windows()
    a, b = windows[5], plain[5]
    assert np.array_equal(a["rgb"], b["rgb"]) and np.allclose(a["depth"], b["depth"], rtol=1e-3)
    with pytest.raises(cosfly.InvalidValue):
        cosfly.pack("data", "packed", progress=False)


def test_packs_of_some_flights_and_whole_arrays():
    with pytest.warns(UserWarning, match="pixels high at 80 x 45"):
        pack = cosfly.pack("data", "packed-twins", size=(80, 45), channels=("rgb",), role="perturbed", trajectories="perturbed-*", progress=False)
    plain = cosfly.Dataset("data", size=(80, 45), channels=("rgb",), role="perturbed")
    assert 0 < len(pack) == len(plain) < len(cosfly.Dataset("data"))
    assert np.array_equal(pack.array("rgb")[pack.rows[7]], plain[7]["rgb"])
    windows = pack.windows()
    assert np.array_equal(pack.array("rgb")[windows.rows[2]], plain.windows()[2]["rgb"])
    assert np.array_equal(windows.array("input_boxes_px")[2], windows[2]["input_boxes_px"])
    with pytest.raises(cosfly.InvalidValue, match="no pictures of"):
        cosfly.Pack("packed-twins", "data", role="expert")
    with pytest.raises(cosfly.InvalidValue, match="no pictures of"):
        cosfly.Pack("packed-twins", "data", trajectories="expert-*")
    with pytest.raises(KeyError, match="none matches it"):
        cosfly.Dataset("data", trajectories=["expert-p00000", "expert_p*"])


def test_batches_are_the_samples_one_by_one():
    dataset = cosfly.Dataset("data", size=(160, 90), columns=["visible_box_px", "drone_x_m"], jobs=2)
    numbers = [3, -1, dataset.number_of(dataset.trajectory_ids[1], 4)]
    for samples in (dataset, dataset.windows()):
        chosen = [number % len(samples) for number in numbers]
        batch, alone = samples.batch(chosen), [samples[number] for number in chosen]
        for name in ("rgb", "depth"):
            assert np.array_equal(batch[name], np.stack([sample[name] for sample in alone])), name
        assert list(batch["trajectory_id"]) == [sample["trajectory_id"] for sample in alone]
    row = pq.read_table("data/data/frames", filters=[("trajectory_id", "=", dataset[3]["trajectory_id"]), ("frame", "=", 3)]).to_pylist()[0]
    assert row["visible_box_px"] and np.allclose(dataset[3]["visible_box_px"], np.array(row["visible_box_px"]) / 2)
    windows = dataset.windows()
    number = windows.number_of(windows[4]["trajectory_id"], windows[4]["start_frame"])
    assert number == 4 and windows[4]["split"] in ("train", "val", "test") and windows[4]["town"] == "downtown"
    with pytest.raises(KeyError, match="no sample of frame 1;"):
        windows.number_of(windows[4]["trajectory_id"], 1)
    assert windows[4]["difficulty"] in ("easy", "medium", "hard") and windows[4]["expert_boxes_px"].shape == (10, 4)


def test_lengths_in_pixels_are_those_of_the_scaled_pictures():
    cameras = {"pair": {"base_line_m": 0.2}, "wide": {"fov_deg": 100}}
    channels = ["rgb", "depth", "semantic", "instance", "disparity", "flow_forward"]
    changes = {"stages.walkers.count": 1, "stages.walkers.frames": 16, "stages.frames.cameras": cameras, "stages.frames.channels": channels}
    cosfly.run("small", set=changes, out="rig", progress=False)
    options = {"trajectories": "*-pair_left", "channels": ["disparity", "flow_forward", "depth"], "columns": "full_box_px"}
    whole, small = cosfly.Dataset("rig", **options), cosfly.Dataset("rig", size=(160, 60), **options)
    a, b = whole[3], small[3]  # 320 x 180: half as wide, a third as high
    assert np.abs(a["flow_forward"]).max() > 1 and a["disparity"].max() > 0.5
    assert np.allclose(b["flow_forward"], a["flow_forward"][1::3, 1::2] * np.array([1 / 2, 1 / 3], np.float32))
    assert np.allclose(b["disparity"], a["disparity"][1::3, 1::2] / 2)
    assert np.array_equal(b["depth"], a["depth"][1::3, 1::2])
    assert np.allclose(b["full_box_px"], a["full_box_px"] * np.array([1 / 2, 1 / 3, 1 / 2, 1 / 3]))
    with pytest.raises(cosfly.Error, match="wide.* has no channel\\s+`disparity`"):  # of the last camera, before the first sample
        cosfly.Dataset("rig", channels=["rgb", "disparity"], trajectories=["*-pair_left", "*-wide"])


def test_absent_whole_numbers_are_not_zero():
    table, rows = cosfly.Dataset("data", channels=()).table("frames"), pq.read_table("data/data/frames")
    frames = rows["expert_frame"].to_pylist()
    assert None in frames and np.array_equal(table["expert_frame"], [np.nan if it is None else it for it in frames], equal_nan=True)
    assert table["frame"].dtype == np.int64 and table["in_view"].dtype == np.int64
    assert np.isnan(cosfly.Dataset("data", role="expert", channels=(), columns="position_event")[0]["position_event"])


def test_the_anchor_of_windows():
    twins = cosfly.Dataset("data", role="perturbed", channels=())
    ours, theirs = twins.windows(), twins.windows(anchor="expert")
    a, b = ours[2], theirs[2]
    assert np.array_equal(b["waypoint_deltas_in_world"], a["expert_steps_in_world"][4:])
    assert np.array_equal(a["waypoint_deltas_in_world"][1:], b["waypoint_deltas_in_world"][1:])
    assert np.allclose(a["waypoint_deltas_in_world"][0, :3] - a["correction_in_world"][-1, :3], b["waypoint_deltas_in_world"][0, :3], atol=1e-4)
    with pytest.raises(cosfly.InvalidValue, match="anchors are"):
        twins.windows(anchor="target")


def test_runs_say_their_time_and_size():
    made = cosfly.run("small", out="data", progress=False)
    assert made.frames == len(cosfly.Dataset("data", channels=())) and made.seconds > 0


def test_plans_write_nothing(tmp_path):
    store = tmp_path / "nowhere"
    assert cosfly.plan("small", store=store).to_run > 0 and not store.exists()


def test_the_expert_answers_batches():
    expert = cosfly.Expert("small")
    poses = pq.read_table("data/data/frames").to_pylist()
    row = next(it for it in poses if it["trajectory_id"] == "expert-p00000" and it["frame"] == 4)
    place = [row["drone_x_m"], row["drone_y_m"], row["drone_z_m"]]
    states = [{"trajectory_id": "expert-p00000", "frame": 4, "position_in_world": np.array(place), "horizon_s": 2}] * 3
    states.append({"trajectory_id": "expert-p00000", "frame": 4, "position_in_world": [float("nan"), 0, 0]})
    answers = expert.plan_from(states, jobs=2)
    assert [answer.planned for answer in answers] == [True, True, True, False]
    assert answers[0].poses.shape[1] == 5 and np.allclose(answers[0].poses[0, :3], place, atol=1e-6)
    assert "position" in answers[3].error


def test_broken_logs_are_errors(tmp_path):
    import shutil

    shutil.copytree("data", tmp_path / "broken")
    log = next((tmp_path / "broken" / "mcap").rglob("*.mcap"))
    dataset = cosfly.Dataset(tmp_path / "broken", channels=("rgb", "depth"))
    frames = [place for place, (name, _) in enumerate(dataset._index) if name == log.stem]
    whole = log.read_bytes()
    for cut in (0, 100, len(whole) // 2, len(whole) - 1):
        log.write_bytes(whole[:cut])
        fresh = cosfly.Dataset(tmp_path / "broken", channels=("rgb", "depth"))
        with pytest.raises(cosfly.Error):
            for place in frames:
                fresh[place]
    rng = np.random.default_rng(1)
    for _ in range(100):
        bad = bytearray(whole)
        for place in rng.integers(0, len(bad), 20):
            bad[place] = rng.integers(256)
        log.write_bytes(bad)
        try:
            cosfly.Dataset(tmp_path / "broken", channels=("rgb", "depth"))[frames[0]]
        except cosfly.Error:
            pass


def test_notebooks_show_pictures():
    pictures = cosfly.preview("data", "expert-p00001", out="pictures", progress=False)
    assert Image.open(pictures.sheet).width > 100 and pictures.clip.suffix == ".gif" and pictures.plan.exists()
    assert pictures._repr_html_().count("<img") == 3 and "<img" in cosfly.Dataset("data")._repr_html_()


def test_logs_that_change_under_the_reader_are_errors(tmp_path):
    import shutil

    shutil.copytree("data", tmp_path / "changing")
    dataset = cosfly.Dataset(tmp_path / "changing", channels=("depth",))
    dataset[0]
    for log in (tmp_path / "changing" / "mcap").rglob("*.mcap"):
        log.write_bytes(log.read_bytes()[:5000])
    with pytest.raises(cosfly.Error, match="damaged"):
        for sample in dataset:
            assert sample["depth"].shape


def test_forks_and_pickles_read_on():
    dataset = cosfly.Dataset("data", size=(32, 18))
    expected = dataset[5]["rgb"]
    child = os.fork()
    if child == 0:
        os._exit(0 if np.array_equal(dataset[5]["rgb"], expected) else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert np.array_equal(pickle.loads(pickle.dumps(dataset))[5]["rgb"], expected)


def test_many_random_accesses_need_no_more_memory_and_descriptors():
    import resource

    dataset = cosfly.Dataset("data", channels=("semantic",), size=(32, 18))
    order = np.random.default_rng(0).integers(0, len(dataset), 3000)
    for place in order[:500]:
        dataset[place]
    memory, descriptors = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, len(os.listdir("/proc/self/fd"))
    for place in order:
        dataset[place]
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < memory + 20_000
    assert len(os.listdir("/proc/self/fd")) <= descriptors + 1
