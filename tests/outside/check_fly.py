"""`cosfly fly` against policies behind openpi's own codec, against faults, and against itself.

Usage: `check_fly.py COSFLY SUITE WORK_FOLDER`. The policies are servers with the codec of the package openpi-client and the loop of openpi's server."""

import contextlib
import pathlib
import subprocess
import sys
import threading
import time

import follow_policy
import numpy as np
from openpi_client import msgpack_numpy
from shared import bytes_of, json_lines, json_of, require
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import serve

cosfly, suite, work = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
work.mkdir(parents=True, exist_ok=True)
here = pathlib.Path(__file__).parent.resolve()
seen = []


@contextlib.contextmanager
def serving(answer, port=0):
    """The address of a policy server as openpi's: metadata, then an answer for every observation."""
    connections = []

    def handle(connection):
        connections.append(connection)
        connection.send(msgpack_numpy.packb({"model": "numpy"}))
        with contextlib.suppress(ConnectionClosed):
            while True:
                answer(connection, msgpack_numpy.unpackb(connection.recv()))

    server = serve(handle, "127.0.0.1", port, compression=None, max_size=None)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
    server.shutdown()
    for connection in connections:
        connection.socket.close()


def command(out, *arguments, clips=0):
    return [cosfly, "fly", suite, "--store", work / "store", "--out", work / out, "--clips", str(clips), "--json", *arguments]


def fly(out, *arguments, cwd=here, clips=0):
    return json_of(*command(out, *arguments, clips=clips), cwd=cwd, timeout=900)


def refused(out, *arguments, code, words, cwd=here):
    """A run that ends with an exit code and words on standard error."""
    ended = subprocess.run(command(out, *arguments), cwd=cwd, capture_output=True, text=True, timeout=900)
    require(ended.returncode == code and words in " ".join(ended.stderr.split()), f"{arguments}: exit code {ended.returncode}\n{ended.stderr}")


def rows(folder):
    return json_lines(work / folder / "episodes.jsonl")


def same_bytes(first, second):
    require(bytes_of(work / first) == bytes_of(work / second), f"{first} and {second} have other bytes")


def good(connection, observation):
    assert observation["state"].dtype == np.float32 and observation["state"].shape == (16,)
    assert isinstance(observation["prompt"], str) and isinstance(observation["episode"], str)
    seen.append(observation["step"])
    action = follow_policy.act(observation)
    # openpi's server adds its timing to every answer.
    action["server_timing"] = {"infer_ms": time.monotonic()}
    connection.send(msgpack_numpy.packb(action))


# The real codec, and the same policy in a process of its own: the same bytes, for 1 job and 2.
with serving(good) as address:
    mine = ["--policy", address, "--name", "mine"]
    by_socket = fly("one", *mine, "--jobs", "1", clips=1)
    assert seen, "the server was never asked"
    assert fly("two", *mine, "--jobs", "2", clips=1) == by_socket
    same_bytes("one", "two")
    by_python = fly("three", "--policy", "python:follow_policy:act", "--python", sys.executable, "--name", "mine")
    assert by_python == by_socket, "a function in Python flies as the server does"
    print("socket and function: tracking rate", round(by_socket["mine"]["all"]["tracking_rate"]["mean"], 3))

    # In four shares, in another order; then killed again and again and resumed: the same bytes.
    for share in ("3/4", "1/4", "4/4", "2/4"):
        fly("shares", *mine, "--shard", share, clips=1)
    same_bytes("shares", "one")
    killed = command("killed", "--quiet", *mine, "--jobs", "1", clips=1)
    for _ in range(4):
        process = subprocess.Popen(killed, cwd=here, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(0.7)
        process.kill()
        process.wait()
    subprocess.run(killed, cwd=here, check=True, stdout=subprocess.DEVNULL)
    same_bytes("killed", "one")


# Faults: the episode says so, the run goes on.
def numbers(values):
    return msgpack_numpy.packb({"actions": values})


def at_step_5(fault):
    def answer(connection, observation):
        return fault(connection) if observation["step"] == 5 else good(connection, observation)

    return answer


faults = {
    "late": (lambda it: time.sleep(3), "no answer within 1 s"),
    "not_a_number": (lambda it: it.send(numbers(np.full(5, np.nan))), "NaN"),
    "wrong_shape": (lambda it: it.send(numbers(np.zeros((2, 7)))), "shape [2, 7]"),
    "no_rows": (lambda it: it.send(numbers(np.zeros((0, 5)))), "shape [0, 5]"),
    "text": (lambda it: it.send("Traceback: no such policy"), "Traceback: no such policy"),
    "nothing": (lambda it: it.send(b""), "not msgpack"),
    "no_actions": (lambda it: it.send(msgpack_numpy.packb({"action_is": 1})), "without `actions`"),
    "a_gigabyte": (lambda it: it.send(bytes(1 << 30)), "longer than 16 MiB"),
}
few = ["--name", "mine", "--set", "stages.walkers.count=2", "--jobs", "1"]
for name, (fault, words) in faults.items():
    patience = "60" if name == "a_gigabyte" else "1"
    with serving(at_step_5(fault)) as address:
        score = fly(name, "--policy", address, "--timeout-s", patience, *few, clips=int(name == "late"))
    reasons = [row.get("policy_failure") for row in rows(f"{name}/mine")]
    assert all(reason and reason.startswith("at step 5: ") and words in reason for reason in reasons), (name, reasons)
    assert score["mine"]["all"]["policy_failure"]["mean"] == 1.0
    print(f"{name}: {reasons[0]}")

# Goes away in the middle of an episode and comes back: nothing is lost, the bytes are those of a quiet run.
with serving(good) as address:
    quiet = fly("quiet", "--policy", address, *few)
gone = []


def goes_away(connection, observation):
    if observation["step"] == 40 and not gone:
        gone.append(observation["episode"])
        connection.socket.close()
        raise ConnectionClosed(None, None)
    good(connection, observation)


with serving(goes_away) as address:
    assert fly("away", "--policy", address, *few) == quiet
assert gone
same_bytes("away", "quiet")

# Never there: no episode is judged, and the same command flies them later.
refused("absent", "--policy", address, "--wait-s", "0.5", *few, code=1, words="fly-policy-unready")
assert not (work / "absent").exists()
with serving(good) as address:
    assert fly("absent", "--policy", address, *few) == quiet


# Pictures on request, by the real codec; the same bytes again.
def looks(connection, observation):
    shape = (160, 160)
    assert observation["depth"].shape == shape and observation["depth"].dtype == np.float32
    assert observation["instance"].shape == shape and observation["instance"].dtype == np.uint32
    assert observation["mask"].dtype == np.uint8 and ((observation["instance"] == 1) == (observation["mask"] == 1)).all()
    assert 0 < observation["depth"].min() and observation["depth"].max() <= 200
    if observation["step"] == 0:
        assert observation["mask"].any(), "the target is in the first picture"
    good(connection, observation)


with serving(looks) as address:
    pictures = ["--policy", address, "--obs", "depth,instance,mask", "--size-px", "160"]
    fly("pictures", *pictures, *few)
    fly("pictures_again", *pictures, *few[:-1], "2")
same_bytes("pictures", "pictures_again")
assert all(not row.get("policy_failure") for row in rows("pictures/mine"))

# The time that a policy really takes, on request.
with serving(good) as address:
    measured = fly("measured", "--policy", address, "--latency-ms", "measured", *few)["mine"]["all"]["latency_s"]["mean"]
assert 0 < measured < 1, measured

# A function that fails says why: from the start it is no policy, later its episode ends.
broken = ["--policy", "python:broken:act", "--python", sys.executable, *few]
(work / "broken.py").write_text("def act(observation):\n    raise KeyError('no such feature')\n")
refused("broken", *broken, cwd=work, code=1, words="no such feature")
assert not (work / "broken").exists()
# So does one that returns nothing, or something else than numbers.
for said, told in (("None", "returned nothing (`None`)"), ("[None] * 5", "`actions` must be rows of numbers")):
    (work / "broken.py").write_text(f"def act(observation):\n    return {said}\n")
    refused("broken", *broken, cwd=work, code=1, words=told)
(work / "broken.py").write_text("def act(o):\n    return [0] * 5 if o['step'] < 3 else {}['no such feature']\n")
fly("broken", *broken, cwd=work)
assert all("no such feature" in row["policy_failure"] for row in rows("broken/mine"))
# Rows of another text of the module are not kept with them.
(work / "broken.py").write_text("def act(o):\n    return [0] * 5\n")
refused("broken", *broken, cwd=work, code=3, words="policy.source")

# Two results compare.
fly("latency0", "--policy", "follow", "--policy", "random", clips=3)
fly("latency200", "--policy", "follow", "--latency-ms", "200")
compared = json_of(cosfly, "fly", "compare", work / "latency0/follow", work / "latency200/follow", "--json")["metrics"]["tracking_rate"]
low, high = compared["interval_95"]
assert compared["second"] - compared["first"] == compared["difference"] and low <= compared["difference"] <= high
print("follow, 200 ms against 0:", compared)
print("closed loop: all as it should be")
