"""Scripts of recipes/training with wrong input: one line says what is wrong, and nothing is written.

    python tests/outside/check_training_scripts.py COSFLY SCRATCH

Packages that are not installed are told in a line, too, and so no reason to leave a script out.
"""

import pathlib
import subprocess
import sys

cosfly, work = sys.argv[1], pathlib.Path(sys.argv[2])
scripts = pathlib.Path(__file__).resolve().parents[2] / "recipes/training"
work.mkdir(parents=True, exist_ok=True)
none, full = work / "nothing", work / "full"
full.mkdir(exist_ok=True)
(full / "file").touch()
out = work / "out"

# Script and words, and what the last lines name, each with the package that may be missing instead.
WRONG = [
    ("paper/run.py", ["--out", out, "--data", none], "no dataset with windows"),
    ("paper/run.py", ["--out", out, "--cosfly", none], "--cosfly"),
    ("paper/run.py", ["--out", out, "--steps", "0"], "--steps"),
    ("paper/run.py", ["--out", out, "--seeds", "none"], "--seeds"),
    ("paper/kinds.py", ["--out", out, "--kinds", "grid"], "two or more different kinds"),
    ("paper/kind_distances.py", [none, "--pack", out], str(none)),
    ("footage/run.py", ["--out", out, "--people", none, none], str(none)),
    ("footage/run.py", ["--out", out, "--people", none], "FRAMES BOXES"),
    ("footage/run.py", ["--out", out, "--without", "roads"], "weathers"),
    ("follow_state.py", [out, full], "not empty"),
    ("follow_state.py", [out, work / "1", "--cosfly", none], "--cosfly"),
    ("follow_state.py", [out, work / "2", "--cosfly", cosfly, "--suites", "nowhere"], "nowhere.toml"),
    ("follow_law.py", [full / "file" / "law.onnx"], "file"),
    ("follow_depth.py", [out, full], "not empty"),
    ("dagger.py", [none, work / "3", "--cosfly", cosfly], str(none)),
    ("student.py", ["train", none, out], "states.npy"),
    ("small_networks.py", [none], "no windows"),
    ("steps.py", [none], str(none)),
    ("memory.py", [none], str(none)),
    ("track_ppo.py", [none], str(none)),
    ("lerobot_record.py", [none, out], str(none)),
]  # fmt: skip

for script, words, named in WRONG:
    done = subprocess.run([sys.executable, scripts / script, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    told = done.stdout
    assert done.returncode in (1, 2, 3, 4), (script, words, done.returncode, told)
    assert "Traceback" not in told and (named in told or " is missing: " in told), (script, words, told)
    print(f"{script}: {told.strip().splitlines()[-1]}")
assert not out.exists() or not any(out.rglob("report.md")), out
tested = {script for script, _, _ in WRONG}
helpers = {"tools.py", "boxes.py", "env.py", "report.py", "pictures.py", "pretrained.py", "jobs.py", "networks.py", "rows.py", "crops.py", "objects.py", "follower.py", "scores.py"}
left = {str(file.relative_to(scripts)) for file in scripts.rglob("*.py")} - tested
assert {pathlib.Path(it).name for it in left} <= helpers, left

# The law's command writes the file that is shipped, whatever the version of numpy.
try:
    import onnx  # noqa: F401
except ImportError:
    print("NOT CHECKED: the file of follow_law.py, because onnx is missing")
else:
    subprocess.run([sys.executable, scripts / "follow_law.py", work / "law.onnx"], check=True)
    assert (work / "law.onnx").read_bytes() == (scripts.parent / "policies/follow_law.onnx").read_bytes()
