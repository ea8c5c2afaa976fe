"""What must be an exception with the words of the command line, and never a crash of the interpreter."""

import os
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

import cosfly

LINUX = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork and no file limits")

FULL = """
import resource, sys
import cosfly
work, limit = sys.argv[1], int(sys.argv[2])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
calls = {
    "run": lambda: cosfly.run("small", set={"seed": 77}, out="full/run", store="full/store", progress=False),
    "pack": lambda: cosfly.pack("data", "full/pack", size=(224, 126), progress=False),
    "v7": lambda: cosfly.export("data", "v7", "full/v7", progress=False),
    "lerobot": lambda: cosfly.export("data", "lerobot", "full/lerobot", progress=False),
    "preview": lambda: cosfly.preview("data", out="full/preview", progress=False),
    "evaluate": lambda: cosfly.evaluate("data", out="full/evaluation"),
}
try:
    made = calls[work]()
    print(getattr(made, "outcome", "made"), *getattr(made, "messages", []))
except cosfly.Error as error:
    print("refused", error.code, error)
"""


def check_full(work, limit, expected):
    done = subprocess.run([sys.executable, "-c", FULL, work, str(limit)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, (done.returncode, done.stderr[-2000:])
    assert done.stdout.startswith(("refused", "failed")) and expected in done.stdout, done.stdout
    assert "internal error" not in done.stdout + done.stderr


@LINUX
@pytest.mark.parametrize("work", ["run", "pack", "v7", "lerobot", "preview", "evaluate"])
def test_files_that_may_not_grow_are_refused(work):
    """A limit on the size of files stops writes as a quota does."""
    shutil.rmtree("full", ignore_errors=True)
    os.mkdir("full")
    check_full(work, 2000, "machine-io")
    left = [name for name in os.listdir("full") if name not in ("store", "preview")]
    assert left in ([], [".v7.unfinished"], [".lerobot.unfinished"], ["evaluation"]), left
    shutil.rmtree("full")


@LINUX
def test_full_disks_are_refused():
    shutil.rmtree("full", ignore_errors=True)
    os.mkdir("full")
    mounted = os.geteuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "none", "full"], capture_output=True)
    if not mounted or mounted.returncode:
        pytest.skip("a small file system cannot be mounted here (it needs root)")
    try:
        for work in ("run", "pack", "v7", "lerobot", "preview"):
            check_full(work, 1 << 40, "disk-full")
    finally:
        subprocess.run(["umount", "-l", "full"], check=True)


def test_packs_that_change_under_the_reader_are_errors(tmp_path):
    cosfly.pack("data", tmp_path / "pack", size=(80, 45), progress=False)
    pack = cosfly.Pack(tmp_path / "pack", "data").windows()
    pack[3]
    rgb = tmp_path / "pack/rgb.npy"
    os.truncate(rgb, os.path.getsize(rgb) // 2)
    with pytest.raises(cosfly.Error, match="rgb.npy") as caught:
        for place in range(len(pack)):
            pack[place]
    assert caught.value.code == "dataset-damaged" and "cosfly.pack" in caught.value.hints[0]
    rgb.write_bytes(b"nothing")
    with pytest.raises(cosfly.Error, match="rgb.npy"):
        cosfly.Pack(tmp_path / "pack", "data")
    (tmp_path / "pack/pack.json").write_text("{")
    with pytest.raises(cosfly.Error, match="pack.json"):
        cosfly.Pack(tmp_path / "pack", "data")
    with pytest.raises(cosfly.Error, match="cosfly.pack"):
        cosfly.Pack(tmp_path, "data")


def test_tables_that_change_under_the_reader_are_errors(tmp_path):
    shutil.copytree("data", tmp_path / "data")
    dataset = cosfly.Dataset(tmp_path / "data", channels=())
    table = dataset.table("frames")
    assert len(table["frame"]) == len(table)
    for path in (tmp_path / "data/data/frames").iterdir():
        whole = path.read_bytes()
        for damage in (whole[: len(whole) // 2], whole[: len(whole) // 2] + bytes(len(whole) - len(whole) // 2), b""):
            path.write_bytes(damage)
            with pytest.raises(cosfly.Error):
                table["drone_x_m"]
        path.unlink()
    with pytest.raises(cosfly.Error, match="frames"):
        table["drone_x_m"]
    shutil.rmtree(tmp_path / "data/data")
    with pytest.raises(cosfly.Error):
        dataset.table("windows")


def test_numbers_that_are_none_are_refused():
    expert = cosfly.Expert("small")
    good = {"trajectory_id": "expert-p00000", "frame": 4, "position_in_world": [0.0, 0.0, 9.0]}
    for field, value in [
        ("position_in_world", [float("nan"), 0, 0]), ("position_in_world", [float("inf"), 0, 0]), ("velocity_in_world", np.array([np.nan] * 3)),
        ("frame", float("nan")), ("frame", -1), ("frame", 1 << 70), ("horizon_s", float("inf")), ("horizon_s", -1),
        ("position_in_world", []), ("position_in_world", None), ("trajectory_id", "nobody"), ("trajectory_id", 7),
    ]:  # fmt: skip
        [answer] = expert.plan_from([{**good, field: value}])
        assert not answer.planned and answer.error, (field, value, answer)
    for path, value in [("stages.walkers.speed_mps", float("nan")), ("stages.walkers.count", float("nan")), ("seed", -1)]:
        with pytest.raises(cosfly.Error):
            cosfly.run("small", set={path: value}, progress=False)


@LINUX
def test_forks_in_the_middle_go_on():
    """The parent has used every kind of threads; its child uses them again."""

    def work():
        assert cosfly.verify("data", progress=False)
        cosfly.evaluate("data", out=f"forked/{os.getpid()}")
        cosfly.export("data", "coco", f"forked/{os.getpid()}-coco", progress=False)
        assert cosfly.run("small", out=f"forked/{os.getpid()}-data", progress=False).outcome == "complete"
        return cosfly.Dataset("data", size=(32, 18), jobs=4)[5]["rgb"].sum()

    expected = work()
    child = os.fork()
    if child == 0:
        signal.alarm(120)  # a child that waits for threads forever is ended
        os._exit(0 if work() == expected else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
