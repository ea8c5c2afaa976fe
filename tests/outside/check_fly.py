"""`cosfly fly` against policies behind openpi's own codec, against faults, and against itself.

Usage: check_fly.py COSFLY SUITE WORK_FOLDER
The policies are servers with the codec of the package openpi-client and the loop of openpi's server.
"""

import hashlib
import json
import pathlib
import subprocess
import sys
import threading
import time

import follow_policy
import numpy as np
from openpi_client import msgpack_numpy
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import serve

cosfly, suite, work = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
work.mkdir(parents=True, exist_ok=True)
here = pathlib.Path(__file__).parent.resolve()
suite = str(pathlib.Path(suite).resolve())
cosfly = str(pathlib.Path(cosfly).resolve())
seen = []


class Server:
    """A policy server as openpi's: metadata, then an answer for every observation."""

    def __init__(self, answer, port=0):
        self.answer = answer
        self.server = serve(self.handle, "127.0.0.1", port, compression=None, max_size=None)
        self.port = self.server.socket.getsockname()[1]
        self.connections = []
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def handle(self, connection):
        self.connections.append(connection)
        connection.send(msgpack_numpy.packb({"model": "numpy"}))
        try:
            while True:
                self.answer(connection, msgpack_numpy.unpackb(connection.recv()))
        except ConnectionClosed:
            pass

    def stop(self):
        self.server.shutdown()
        for connection in self.connections:
            connection.socket.close()


def fly(out, *arguments, code=0, cwd=here, clips=0):
    command = [cosfly, "fly", suite, "--store", work / "store", "--out", work / out, "--clips", str(clips), "--json", *arguments]
    ended = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=900)
    assert ended.returncode == code, (arguments, ended.returncode, ended.stderr)
    return json.loads(ended.stdout) if code == 0 else ended


def bytes_of(folder):
    files = sorted(path for path in (work / folder).rglob("*") if path.is_file())
    return {str(path.relative_to(work / folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def rows(folder):
    return [json.loads(line) for line in (work / folder / "episodes.jsonl").read_text().splitlines()]


def good(connection, observation):
    assert observation["state"].dtype == np.float32 and observation["state"].shape == (16,)
    assert isinstance(observation["prompt"], str) and isinstance(observation["episode"], str)
    seen.append(observation["step"])
    action = follow_policy.act(observation)
    # openpi's server adds its timing to every answer.
    action["server_timing"] = {"infer_ms": time.monotonic()}
    connection.send(msgpack_numpy.packb(action))


# Baselines rank as they should; the expert sees what its certificates say.
names = ["random", "hold", "constant-velocity", "causal", "expert"]
scores = fly("baselines", *[part for name in names for part in ("--policy", name)], clips=3)
rate = {name: scores[name]["all"]["tracking_rate"]["mean"] for name in names}
print("tracking rates:", {name: round(value, 3) for name, value in rate.items()})
assert max(rate["random"], rate["hold"], rate["constant-velocity"]) < rate["causal"] <= rate["expert"] + 1e-9, rate
flown = rows("baselines/expert")
stated = np.mean([row["certified_visibility"] for row in flown])
reached = np.mean([row["score"]["visible_sum"] / row["score"]["steps"] for row in flown])
print(f"visibility of the expert: certified {stated:.4f}, flown {reached:.4f}")
assert abs(stated - reached) < 0.01

# The real codec, and the same policy in a process of its own: the same bytes, for 1 job and 2.
server = Server(good)
address = f"ws://127.0.0.1:{server.port}"
by_socket = fly("one", "--policy", address, "--name", "mine", "--jobs", "1", clips=1)
assert seen, "the server was never asked"
assert fly("two", "--policy", address, "--name", "mine", "--jobs", "2", clips=1) == by_socket
assert bytes_of("one") == bytes_of("two")
by_python = fly("three", "--policy", "python:follow_policy:act", "--python", sys.executable, "--name", "mine")
assert by_python == by_socket, "a function in Python flies as the server does"
print("socket and function: tracking rate", round(by_socket["mine"]["all"]["tracking_rate"]["mean"], 3))

# In four shares, in another order; then killed again and again and resumed: the same bytes.
for share in ("3/4", "1/4", "4/4", "2/4"):
    fly("shares", "--policy", address, "--name", "mine", "--shard", share, clips=1)
assert bytes_of("shares") == bytes_of("one")
command = [cosfly, "fly", suite, "--store", work / "store", "--out", work / "killed", "--clips", "1", "--json", "--quiet"]
command += ["--policy", address, "--name", "mine", "--jobs", "1"]
for _ in range(4):
    process = subprocess.Popen(command, cwd=here, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(0.7)
    process.kill()
    process.wait()
subprocess.run(command, cwd=here, check=True, stdout=subprocess.DEVNULL)
assert bytes_of("killed") == bytes_of("one")
server.stop()


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
few = ["--set", "stages.walkers.count=2", "--jobs", "1"]
for name, (fault, words) in faults.items():
    server = Server(at_step_5(fault))
    patience = "60" if name == "a_gigabyte" else "1"
    score = fly(name, "--policy", f"ws://127.0.0.1:{server.port}", "--name", "mine", "--timeout-s", patience, *few, clips=int(name == "late"))
    reasons = [row.get("policy_failure") for row in rows(f"{name}/mine")]
    assert all(reason and reason.startswith("at step 5: ") and words in reason for reason in reasons), (name, reasons)
    assert score["mine"]["all"]["policy_failure"]["mean"] == 1.0
    server.stop()
    print(f"{name}: {reasons[0]}")

# Goes away in the middle of an episode and comes back: nothing is lost, the bytes are those of a quiet run.
server = Server(good)
quiet = fly("quiet", "--policy", f"ws://127.0.0.1:{server.port}", "--name", "mine", *few)
server.stop()
gone = []


def goes_away(connection, observation):
    if observation["step"] == 40 and not gone:
        gone.append(observation["episode"])
        connection.socket.close()
        raise ConnectionClosed(None, None)
    good(connection, observation)


server = Server(goes_away)
assert fly("away", "--policy", f"ws://127.0.0.1:{server.port}", "--name", "mine", *few) == quiet
assert gone and bytes_of("away") == bytes_of("quiet")
server.stop()

# Never there: no episode is judged, and the same command flies them later.
port = server.port
ended = fly("absent", "--policy", f"ws://127.0.0.1:{port}", "--name", "mine", "--wait-s", "0.5", *few, code=1)
assert "fly-policy-unready" in ended.stderr and not (work / "absent").exists(), ended.stderr
server = Server(good)
assert fly("absent", "--policy", f"ws://127.0.0.1:{server.port}", "--name", "mine", *few) == quiet
server.stop()

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


server = Server(looks)
pictures = ["--policy", f"ws://127.0.0.1:{server.port}", "--name", "mine", "--obs", "depth,instance,mask", "--size-px", "160"]
fly("pictures", *pictures, *few)
fly("pictures_again", *pictures, *few[:-1], "2")
assert bytes_of("pictures") == bytes_of("pictures_again")
assert all(not row.get("policy_failure") for row in rows("pictures/mine"))

# The time that a policy really takes, on request.
server.stop()
server = Server(good)
timed = ["--policy", f"ws://127.0.0.1:{server.port}", "--name", "mine", "--latency-ms", "measured"]
measured = fly("measured", *timed, *few)["mine"]["all"]["latency_s"]["mean"]
assert 0 < measured < 1, measured
server.stop()

# A function that fails says why: from the start it is no policy, later its episode ends.
broken = ["--policy", "python:broken:act", "--python", sys.executable, "--name", "mine", *few]
(work / "broken.py").write_text("def act(observation):\n    raise KeyError('no such feature')\n")
ended = fly("broken", *broken, cwd=work, code=1)
assert "no such feature" in ended.stderr and not (work / "broken").exists(), ended.stderr
(work / "broken.py").write_text("def act(o):\n    return [0] * 5 if o['step'] < 3 else {}['no such feature']\n")
fly("broken", *broken, cwd=work)
assert all("no such feature" in row["policy_failure"] for row in rows("broken/mine"))
# Rows of another text of the module are not kept with them.
(work / "broken.py").write_text("def act(o):\n    return [0] * 5\n")
ended = fly("broken", *broken, cwd=work, code=3)
assert "policy.source" in ended.stderr, ended.stderr

# Latency costs; two results compare.
for latency in ("57", "200"):
    fly(f"latency{latency}", "--policy", "follow", "--latency-ms", latency)
fly("latency0", "--policy", "follow")
compared = subprocess.run(
    [cosfly, "fly", "compare", work / "latency0/follow", work / "latency200/follow", "--json"],
    check=True, capture_output=True, text=True,
)
compared = json.loads(compared.stdout)["metrics"]["tracking_rate"]
low, high = compared["interval_95"]
assert compared["second"] - compared["first"] == compared["difference"] and low <= compared["difference"] <= high
print("follow, 200 ms against 0:", compared)
print("closed loop: all as it should be")
