"""What each sensor costs: `sensor_costs.py COSFLY FOLDER [--width N] [--height N] [--frames N] [--only WORD]`.

Runs `sensors.toml` beside this script with one thread, without and with each sensor; prints a table of user CPU time and bytes of the dataset that the
sensor adds: to a picture, or to a second of flight. Flights are planned before. What is within the noise of the machine may be below 0."""

import re
import resource
import shutil
from pathlib import Path

from shared import command_line, run

FRAME = ["rgb", "depth", "semantic", "instance"]
PAIR = "[stages.frames.cameras.front]\nbase_line_m = 0.25\n"
CHANNELS = {
    "`normals`": ["normals"],
    "`mask`, `mask_amodal`": ["mask", "mask_amodal"],
    "`flow_forward`, `flow_forward_valid`": ["flow_forward", "flow_forward_valid"],
    "`flow_back`, `flow_back_valid`": ["flow_back", "flow_back_valid"],
    "`depth_sensor`": ["depth_sensor"],
}
OF_PAIRS = {"`disparity`": ["disparity"], "`depth_stereo`": ["depth_stereo"]}
LENSES = {
    "fisheye, 115 degrees wide": 'fov_deg = 90.0\nlens = { model = "fisheye" }\n',
    "fisheye, 180 degrees wide": 'width = HEIGHT\nfov_deg = 115.0\nlens = { model = "fisheye" }\n',
    "equirectangular": 'width = TWICE\nlens = { model = "equirectangular" }\n',
}
SENSORS = {"inertial_unit": 200, "barometer": 20, "magnetometer": 20, "satellite_receiver": 10, "laser_altimeter": 20, "odometry": 20}
LIDARS = ["vlp16", "os1_64", "hdl64e", "mid360"]


def timed(*command):
    """Seconds of processor time that a command takes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    run(*command)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    given = command_line("cosfly folder", width=640, height=360, frames=24, only=str)
    folder = given.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    text = (Path(__file__).with_name("sensors.toml")).read_text().replace("../../recipes", str(Path(__file__).resolve().parents[2] / "recipes"))
    head, rest = text.split("[stages.frames]\n")
    tail = "[stages.captions]" + rest.split("[stages.captions]")[1]
    # One flight.
    head = re.sub(r"follow = \{ count = 2", "follow = { count = 1", re.sub(r"frames = \d+", f"frames = {given.frames}", head))
    tail = re.sub(r"extras = \[.*?\]\n", "EXTRAS", tail, flags=re.S)

    def measured(name, channels=(), more="", extra="", bodies=False):
        """Seconds of processor time and bytes of a dataset."""
        list_ = ", ".join(f'"{it}"' for it in [*FRAME, *channels])
        more = more.replace("HEIGHT", str(given.height)).replace("TWICE", str(2 * given.height))
        stage = f'[stages.frames]\nuse = "render"\ninputs = {{ town = "town", trajectories = "expert", others = "street" }}\nbodies_3d = {str(bodies).lower()}\n'
        if "width" not in more or more.startswith("["):
            stage += f"width = {given.width}\n"
        stage += f"height = {given.height}\nchannels = [{list_}]\n{more}\n{extra}"
        recipe, out = folder / "recipe.toml", folder / "out"
        recipe.write_text(head + stage + tail.replace("EXTRAS", 'extras = "more"\n' if extra else ""))
        shutil.rmtree(out, ignore_errors=True)
        made = lambda *more: timed(given.cosfly, "run", recipe, "--store", folder / "store", "--quiet", "-j1", *more)
        made("--stage", "expert")
        if extra.startswith("[stages.more]"):  # its stage alone, of pictures that are there
            made("--stage", "frames")
            used = made("--stage", "more") - made("--stage", "frames")
            made("--out", out)
        else:
            used = made("--out", out)
        return used, sum(path.stat().st_size for path in out.rglob("*") if path.is_file())

    def row(name, measure, base, count, of_pictures=True):
        if given.only and given.only not in name:
            return
        (used, size), (used_before, size_before) = measure(), base
        used_before = used_before if of_pictures else 0
        print(f"| {name} | {1e3 * (used - used_before) / count:.1f} | {(size - size_before) / 1e3 / count:.1f} |", flush=True)

    base = measured("base")
    print(f"{given.frames} pictures of {given.width} x {given.height}\n\n| added to a picture | core-milliseconds | kilobytes |\n| --- | ---: | ---: |", flush=True)
    for name, channels in CHANNELS.items():
        row(name, lambda: measured(name, channels), base, given.frames)
    row("boxes and key points (`bodies_3d`)", lambda: measured("bodies", bodies=True), base, given.frames)
    pair = measured("pair", more=PAIR)
    row("the second picture of a pair", lambda: pair, base, given.frames)
    for name, channels in OF_PAIRS.items():
        row(f"{name}, of a pair", lambda: measured(name, channels, PAIR), pair, 2 * given.frames)
    for name, lens in LENSES.items():
        row(f"{name}, in the place of the picture", lambda: measured(name, more=lens), base, given.frames)
    seconds = 0.5 * (given.frames - 1)
    print("\n| added to a second of flight | core-milliseconds | kilobytes |\n| --- | ---: | ---: |", flush=True)
    inputs = 'inputs = { town = "town", frames = "frames", others = "street" }\n\n'
    for name, rate_hz in SENSORS.items():
        stage = f'[stages.more]\nuse = "sense"\nsensor = "{name}"\nrate_hz = {rate_hz}\n{inputs}'
        row(f"`{name}`, {rate_hz} readings", lambda: measured(name, extra=stage), base, seconds, False)
    for name in LIDARS:
        stage = f'[stages.more]\nuse = "scan"\nlidar = "{name}"\npitch_deg = -30\n{inputs}'
        row(f"`{name}`, 10 sweeps", lambda: measured(name, extra=stage), base, seconds, False)


main()
