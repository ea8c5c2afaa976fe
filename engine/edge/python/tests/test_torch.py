"""The package in PyTorch's loaders; skipped where torch is absent."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

import cosfly

torch = pytest.importorskip("torch", reason="torch is not installed: its loaders are not tested (pip install torch)")
from torch.utils.data import DataLoader  # noqa: E402

import cosfly.torch  # noqa: E402

WORKERS = 4
pytestmark = pytest.mark.filterwarnings("ignore:This DataLoader will create")

TRAINING = """
import json, os, sys, time
import cosfly, cosfly.torch
kill_after, workers = int(sys.argv[1]), int(sys.argv[2])
windows = cosfly.Dataset("data", size=(32, 18)).windows()
loader = cosfly.torch.Loader(windows, 3, seed=5, workers=workers)
if os.path.exists("state.json"):
    loader.load_state_dict(json.load(open("state.json")))
while loader.epoch < 2:
    for batch in loader:
        rows = [[name, int(start), int(rgb.sum())] for name, start, rgb in zip(batch["trajectory_id"], batch["start_frame"], batch["rgb"])]
        with open("seen.jsonl", "a") as seen:
            seen.write(json.dumps(rows) + "\\n")
        with open("state.tmp", "w") as state:
            json.dump(loader.state_dict(), state)
        os.replace("state.tmp", "state.json")
        if sum(1 for _ in open("seen.jsonl")) == kill_after:
            print("waiting", flush=True)
            time.sleep(600)
"""


def samples(loader):
    return [
        (name, int(start), int(rgb.sum()))
        for batch in loader
        for name, start, rgb in zip(batch["trajectory_id"], batch["start_frame"], batch["rgb"])
    ]


def test_data_loaders_take_the_dataset_as_it_is():
    windows = cosfly.Dataset("data", channels=("rgb", "depth", "instance"), size=(32, 18), captions="en").windows()
    order = windows.order(seed=1)
    assert len(windows) > 12
    plain = samples(DataLoader(windows, batch_size=4, sampler=order))
    assert samples(DataLoader(windows, batch_size=4, sampler=order, num_workers=WORKERS)) == plain
    assert samples(DataLoader(windows, batch_size=4, sampler=order[8:], num_workers=WORKERS)) == plain[8:]
    batch = next(iter(DataLoader(windows, batch_size=4, shuffle=True, num_workers=WORKERS)))
    assert batch["rgb"].shape == (4, 5, 18, 32, 3) and batch["rgb"].dtype == torch.uint8
    assert batch["depth"].dtype == torch.float32 and len(batch["captions"]) == 4


def test_the_order_is_that_of_the_loader_without_torch():
    windows = cosfly.Dataset("data", size=(32, 18)).windows()
    plain = samples(windows.loader(3, seed=5))
    for workers in (0, 1, WORKERS):
        assert samples(cosfly.torch.Loader(windows, 3, seed=5, workers=workers)) == plain
    shards = [samples(cosfly.torch.Loader(windows, 3, seed=5, shard=(rank, 2), workers=2)) for rank in range(2)]
    assert not set(shards[0]) & set(shards[1]) and set(shards[0] + shards[1]) <= set(plain)


def test_a_training_that_is_killed_and_resumed_sees_the_same_samples(tmp_path):
    os.symlink(os.path.abspath("data"), tmp_path / "data")
    command = lambda kill_after, workers: [sys.executable, "-c", TRAINING, str(kill_after), str(workers)]
    seen, state = tmp_path / "seen.jsonl", tmp_path / "state.json"
    subprocess.run(command(0, WORKERS), cwd=tmp_path, check=True, timeout=300)
    whole = [json.loads(line) for line in open(seen)]
    seen.unlink(), state.unlink()
    assert len(whole) > 6
    for kill_after in (2, len(whole) // 2 + 1):  # in the first epoch, in the second
        training = subprocess.Popen(command(kill_after, WORKERS), cwd=tmp_path, stdout=subprocess.PIPE)
        assert training.stdout.readline() == b"waiting\n"
        training.send_signal(signal.SIGKILL)
        training.wait()
    subprocess.run(command(0, 2), cwd=tmp_path, check=True, timeout=300)  # another number of workers
    assert [json.loads(line) for line in open(seen)] == whole


def test_a_fork_in_the_middle_of_an_epoch_reads_on_in_both_processes():
    windows = cosfly.Dataset("data", size=(32, 18)).windows()
    whole = samples(cosfly.torch.Loader(windows, 3, seed=5))
    loader = cosfly.torch.Loader(windows, 3, seed=5, workers=2)
    batches = iter(loader)
    first = samples([next(batches)])
    child = os.fork()
    if child == 0:  # the child has no workers of its own yet: it goes on from the state
        mine = cosfly.torch.Loader(windows, 3, seed=5)
        mine.load_state_dict(loader.state_dict())
        os._exit(0 if samples(mine) == whole[3:] else 1)
    assert first + samples(batches) == whole
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_packs_go_through_workers(tmp_path):
    cosfly.pack("data", tmp_path / "pack", size=(32, 18), progress=False)
    windows = cosfly.Pack(tmp_path / "pack", "data").windows()
    plain = samples(windows.loader(3, seed=5))
    assert samples(cosfly.torch.Loader(windows, 3, seed=5, workers=WORKERS)) == plain


def test_errors_of_workers_name_the_file(tmp_path):
    import shutil

    shutil.copytree("data", tmp_path / "data")
    windows = cosfly.Dataset(tmp_path / "data", size=(32, 18)).windows()
    for log in (tmp_path / "data" / "mcap").rglob("*.mcap"):
        log.write_bytes(log.read_bytes()[:5000])
    began = time.time()
    with pytest.raises(cosfly.Error, match="mcap") as caught:
        samples(cosfly.torch.Loader(windows, 3, workers=2))
    assert caught.value.code == "dataset-damaged" and time.time() - began < 60
