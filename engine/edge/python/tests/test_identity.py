"""Pictures and labels are of one dataset: packs, open objects, worker processes and states of loaders know theirs."""

import json
import multiprocessing
import os
import pickle
import shutil

import numpy as np
import pytest

import cosfly

FORK = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")


@pytest.fixture(scope="module")
def other(folder):
    """A dataset of the same recipe with another seed: the same ids, other pictures, other labels."""
    os.chdir(folder)
    assert cosfly.run("small", set={"seed": 43}, out="other", progress=False).outcome == "complete"
    return "other"


def test_a_pack_is_refused_beside_another_dataset_and_taken_beside_a_copy(tmp_path, other):
    cosfly.pack("data", tmp_path / "pack", size=(64, 36), progress=False)
    with pytest.raises(cosfly.Error) as caught:
        cosfly.Pack(tmp_path / "pack", other).windows()
    assert caught.value.code == "pack-of-other" and "cosfly.pack" in " ".join(caught.value.hints)
    ours, theirs = (cosfly.Dataset(name, channels=()).identity for name in ("data", other))
    for named in ("data", "other", ours[:12], theirs[:12], str(tmp_path / "pack")):
        assert named in str(caught.value), (named, str(caught.value))
    shutil.copytree("data", tmp_path / "copy")
    assert len(cosfly.Pack(tmp_path / "pack", tmp_path / "copy").windows()) > 0


def test_packs_of_an_older_format_and_damaged_ones_say_what_to_do(tmp_path):
    cosfly.pack("data", tmp_path / "pack", size=(64, 36), progress=False)
    path = tmp_path / "pack" / "pack.json"
    about = json.loads(path.read_text())
    path.write_text(json.dumps({**about, "format": "cosfly-pack-1"}))
    with pytest.raises(ValueError, match="older cosfly.*cosfly.pack"):
        cosfly.Pack(tmp_path / "pack", "data")
    for damage in ([], 7, {**about, "dataset": None}, {**about, "dataset": {}}, {**about, "first_frame": 3}):
        path.write_text(json.dumps(damage))
        with pytest.raises((cosfly.Error, ValueError)):
            cosfly.Pack(tmp_path / "pack", "data")
    path.write_text(json.dumps({**about, "size": [32, 18]}))
    with pytest.raises(cosfly.Error, match="rgb.npy"):
        cosfly.Pack(tmp_path / "pack", "data")


def made_anew(tmp_path, other, windows=False, **options):
    """An open dataset whose folder holds another one now."""
    shutil.copytree("data", tmp_path / "live")
    dataset = cosfly.Dataset(tmp_path / "live", size=(64, 36), **options)
    dataset = dataset.windows() if windows else dataset
    shutil.rmtree(tmp_path / "live")
    shutil.copytree(other, tmp_path / "live")
    return dataset


def refused(work):
    with pytest.raises(cosfly.Error) as caught:
        work()
    return caught.value.code


@pytest.mark.parametrize("windows", [False, True])
def test_a_folder_that_was_made_anew_is_refused_everywhere(tmp_path, other, windows):
    dataset = made_anew(tmp_path, other, windows=windows)
    for work in (
        lambda: dataset[0],
        lambda: dataset.table("frames"),
        lambda: dataset.frame(dataset.trajectory_ids[0], 0),
        lambda: dataset.town()._repr_png_(),
        lambda: dataset._repr_html_(),
        lambda: pickle.loads(pickle.dumps(dataset))[0],
        dataset.check,
    ):
        assert refused(work) == "dataset-changed"


def test_a_table_that_was_asked_for_before_is_refused_after(tmp_path, other):
    shutil.copytree("data", tmp_path / "live")
    table = cosfly.Dataset(tmp_path / "live", channels=()).table("frames")
    shutil.rmtree(tmp_path / "live")
    shutil.copytree(other, tmp_path / "live")
    assert refused(lambda: table["drone_x_m"]) == "dataset-changed"


@FORK
def test_a_worker_that_is_forked_later_is_refused(tmp_path, other):
    dataset = made_anew(tmp_path, other, windows=True)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        with pytest.raises(cosfly.Error, match=r"made\s+anew"):
            pool.apply(dataset.__getitem__, (0,))


@FORK
def test_a_run_into_the_same_folder_is_seen_by_workers_and_one_that_changes_nothing_is_not():
    cosfly.run("small", out="again", progress=False)
    dataset = cosfly.Dataset("again", size=(64, 36)).windows()
    first = dataset[0]
    fork = multiprocessing.get_context("fork")
    cosfly.run("small", out="again", progress=False)
    with fork.Pool(1) as pool:
        assert np.array_equal(pool.apply(dataset.__getitem__, (0,))["rgb"], first["rgb"])
    cosfly.run("small", set={"seed": 43}, out="again", progress=False)
    with fork.Pool(1) as pool, pytest.raises(cosfly.Error, match="open the folder again"):
        pool.apply(dataset.__getitem__, (0,))


@FORK
def test_a_pack_that_was_made_anew_is_refused_in_workers(tmp_path, other):
    cosfly.pack("data", tmp_path / "pack", size=(64, 36), progress=False)
    pack = cosfly.Pack(tmp_path / "pack", "data").windows()
    shutil.rmtree(tmp_path / "pack")
    cosfly.pack(other, tmp_path / "pack", size=(64, 36), progress=False)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        with pytest.raises(cosfly.Error, match=r"made\s+anew"):
            pool.apply(pack.__getitem__, (0,))


def test_states_of_loaders_say_what_their_batches_are_of(other):
    windows = cosfly.Dataset("data", channels=()).windows()
    state = windows.loader(4).state_dict()
    for name, loader in [
        ("dataset", cosfly.Dataset(other, channels=()).windows().loader(4)),
        ("batch_size", windows.loader(8)),
        ("shards", windows.loader(4, shard=(0, 2))),
        ("shuffle", windows.loader(4, shuffle=False)),
        ("anchor", cosfly.Dataset("data", channels=()).windows(anchor="expert").loader(4)),
    ]:
        with pytest.raises(ValueError, match=name):
            loader.load_state_dict(state)
    first, second = (cosfly.Dataset("data", channels=(), trajectories=windows.trajectory_ids[it]).loader(4) for it in (0, 1))
    with pytest.raises(ValueError, match="flights"):  # as many samples, but others
        second.load_state_dict(first.state_dict())
    with pytest.raises(cosfly.WrongType, match="the state is None"):
        windows.loader(4).load_state_dict(None)
    for wrong in ({"batch": -1}, {"batch": 10**9}, {"epoch": 1.5}):
        with pytest.raises((ValueError, TypeError)):
            windows.loader(4).load_state_dict({**state, **wrong})
    old = {name: state[name] for name in ("epoch", "batch", "seed", "samples")}
    with pytest.warns(UserWarning, match="older cosfly"):
        windows.loader(4).load_state_dict(old)


@pytest.mark.parametrize("windows", [False, True])
def test_samples_are_numbered_as_lists_are(tmp_path, windows):
    dataset = cosfly.Dataset("data", channels=())
    dataset = dataset.windows() if windows else dataset
    cosfly.pack("data", tmp_path / "pack", size=(64, 36), progress=False)
    pack = cosfly.Pack(tmp_path / "pack", "data")
    pack = pack.windows() if windows else pack
    flight = dataset.trajectory(dataset.trajectory_ids[0])
    for of in (dataset, pack, flight):
        for wrong in (1.5, 1.0, float("nan"), np.float32(1), np.float64(2), "1", None, slice(0, 2), [0], np.array([0, 1])):
            with pytest.raises(TypeError):
                of[wrong]
        for beyond in (len(of), -len(of) - 1, 1 << 70, -(1 << 70), np.int64(1 << 40)):
            with pytest.raises(IndexError):
                of[beyond]
    for place in (0, -1, np.int8(1), np.uint64(1)):
        a, b = dataset[place], dataset[int(place) % len(dataset)]
        assert a["trajectory_id"] == b["trajectory_id"]
    assert dataset[-1]["trajectory_id"] == dataset[len(dataset) - 1]["trajectory_id"]
    name = dataset.trajectory_ids[0]
    for of in (dataset, pack):  # a pack has the pictures of the next flight right after
        for beyond in (-1, len(flight), 1 << 70):
            with pytest.raises(IndexError, match=name):
                of.frame(name, beyond, channels=("rgb",))
        with pytest.raises(TypeError):
            of.frame(name, 1.5, channels=("rgb",))
    for wrong in ({"jobs": 0}, {"jobs": -1}):
        with pytest.raises(ValueError, match="jobs"):
            cosfly.Dataset("data", **wrong)
    with pytest.raises(TypeError, match="batch_size"):
        dataset.loader(1.5)
    with pytest.raises(ValueError, match="shard"):
        dataset.loader(2, shuffle=False, shard=(3, 2))


def test_a_split_without_flights_has_no_samples_and_all_columns():
    whole = cosfly.Dataset("data", channels=())
    used = set(whole._reader.splits)
    empty = next((split for split in ("val", "test", "train") if split not in used), None)
    if empty is None:
        pytest.skip("the small recipe has flights in all splits")
    for windows in (False, True):
        dataset = cosfly.Dataset("data", split=empty, channels=(), columns=() if windows else ("drone_x_m",))
        dataset = dataset.windows() if windows else dataset
        assert len(dataset) == 0 and list(dataset) == [] and list(dataset.loader(2)) == []
    assert dataset.table("frames").columns == whole.table("frames").columns
    for column in ("waypoint_deltas_in_body", "input_boxes_px", "current_pose_in_world"):
        assert dataset.array(column).shape == (0, *whole.windows().array(column).shape[1:]), column
