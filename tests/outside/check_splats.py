"""Pictures of splats against the published equations, by a reference of another hand (numpy, double precision).

    cargo build --profile ci -p cosfly-splats --example draw_splats
    python tests/outside/check_splats.py target/ci/examples/draw_splats --files scene.ply scan.spz room.splat

Without files, scenes are made up. Each file (`.ply` of the reference trainer, `.splat`, `.spz` of version 2 or 3) is read by this script alone and
drawn from several places: Kerbl et al. 2023 (equations 3 to 6, harmonics, no early end), and with Mip-Splatting's opacities (Yu et al. 2024).
Fails below 50 dB."""

import gzip
import struct
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from shared import command_line, require, run, said

LEAST_DB, LEAST_ALPHA, MOST_ALPHA, LOW_PASS, NEAR = 50, 1 / 255, 0.99, 0.3, 0.2


def of_ply(data):
    """Middles, logarithms of spreads, turns (w first), opacities and harmonics (splat, harmonic, channel)."""
    head, body = data.split(b"end_header\n", 1)
    words = head.decode().split()
    count = int(words[words.index("vertex") + 1])
    names = [words[at + 2] for at, word in enumerate(words) if word == "property"]
    rows = np.frombuffer(body, "<f4", count * len(names)).reshape(count, -1).astype(float)
    column = {name: rows[:, at] for at, name in enumerate(names)}
    rest = [name for name in names if name.startswith("f_rest_")]
    further = np.stack([column[f"f_rest_{at}"] for at in range(len(rest))], 1).reshape(count, 3, -1) if rest else np.zeros((count, 3, 0))
    harmonics = np.concatenate([np.stack([column[f"f_dc_{at}"] for at in range(3)], 1)[:, :, None], further], 2).transpose(0, 2, 1)
    several = lambda name, number: np.stack([column[f"{name}_{at}"] for at in range(number)], 1)
    middles = np.stack([column[axis] for axis in "xyz"], 1)
    return middles, several("scale", 3), several("rot", 4), 1 / (1 + np.exp(-column["opacity"])), harmonics


def of_splat(data):
    rows = np.frombuffer(data, np.dtype([("middle", "<f4", 3), ("spread", "<f4", 3), ("colour", "u1", 4), ("turn", "u1", 4)]))
    colours = (rows["colour"][:, :3] / 255 - 0.5) / 0.28209479177387814
    with np.errstate(divide="ignore"):
        spreads = np.log(rows["spread"].astype(float))
    return rows["middle"].astype(float), spreads, (rows["turn"].astype(float) - 128) / 128, rows["colour"][:, 3] / 255, colours[:, None, :]


def of_spz(data):
    data = gzip.decompress(data)
    magic, version, count, degree, fraction = struct.unpack_from("<4sIIBB", data)
    require(magic == b"NGSP" and version in (2, 3), f"SPZ of version {version} is not read by this script")
    further, turn = (degree + 1) ** 2 - 1, 3 if version == 2 else 4
    columns, at = [], 16
    for width in (9, 1, 3, 3, turn, 3 * further):
        columns.append(np.frombuffer(data, "u1", width * count, at).reshape(count, width).astype(np.int64))
        at += width * count
    places = columns[0].reshape(count, 3, 3) @ np.array([1, 1 << 8, 1 << 16])
    places = np.where(places >= 1 << 23, places - (1 << 24), places) / (1 << fraction)
    if version == 2:
        vector = columns[4] / 127.5 - 1
        turns = np.concatenate([np.sqrt(np.maximum(0, 1 - (vector**2).sum(1)))[:, None], vector], 1)
    else:
        word, parts = columns[4] @ (1 << np.array([0, 8, 16, 24])), np.zeros((count, 4))
        largest, left = word >> 30, word.copy()
        for axis in (3, 2, 1, 0):
            is_here = largest != axis
            size = (left & 511) / 511 / np.sqrt(2) * np.where(left >> 9 & 1, -1, 1)
            parts[:, axis], left = np.where(is_here, size, 0), np.where(is_here, left >> 10, left)
        parts[np.arange(count), largest] = np.sqrt(np.maximum(0, 1 - (parts**2).sum(1)))
        turns = parts[:, [3, 0, 1, 2]]
    harmonics = np.concatenate([((columns[2] / 255 - 0.5) / 0.15)[:, None], (columns[5].reshape(count, further, 3) - 128) / 128], 1)
    return places, columns[3] / 16 - 10, turns, columns[1][:, 0] / 255, harmonics


def basis_of(directions):
    """Real spherical harmonics to degree 3 with the signs of the reference trainer."""
    x, y, z = directions.T
    one = np.ones_like(x)
    return np.stack([
        0.28209479177387814 * one, -0.4886025119029199 * y, 0.4886025119029199 * z, -0.4886025119029199 * x,
        1.0925484305920792 * x * y, -1.0925484305920792 * y * z, 0.31539156525252005 * (2 * z * z - x * x - y * y),
        -1.0925484305920792 * x * z, 0.5462742152960396 * (x * x - y * y),
        -0.5900435899266435 * y * (3 * x * x - y * y), 2.890611442640554 * x * y * z, -0.4570457994644658 * y * (4 * z * z - x * x - y * y),
        0.3731763325901154 * z * (2 * z * z - 3 * x * x - 3 * y * y), -0.4570457994644658 * x * (4 * z * z - x * x - y * y),
        1.445305721320277 * z * (x * x - y * y), -0.5900435899266435 * x * (x * x - 3 * y * y),
    ], 1)  # fmt: skip


def picture(splats, start, towards, size, fov_deg, is_antialiased):
    """Red, green, blue, and the share of the light that comes through, of each pixel."""
    middles, spreads, turns, opacities, harmonics = splats
    width, height = size
    ahead = (towards - start) / np.linalg.norm(towards - start)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    camera = np.stack([right, np.cross(ahead, right), ahead])
    focal = width / 2 / np.tan(np.radians(fov_deg) / 2)
    away = middles - start
    seen = away @ camera.T
    half = camera @ Rotation.from_quat(turns[:, [1, 2, 3, 0]]).as_matrix() * np.exp(spreads)[:, None, :]
    covariances = half @ half.transpose(0, 2, 1)
    depth = seen[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        held = [np.clip(seen[:, axis] / depth, -1.3 * side / 2 / focal, 1.3 * side / 2 / focal) for axis, side in enumerate(size)]
        jacobian = np.zeros((len(depth), 2, 3))
        for axis in range(2):
            jacobian[:, axis, axis], jacobian[:, axis, 2] = focal / depth, -focal * held[axis] / depth
        flat = jacobian @ covariances @ jacobian.transpose(0, 2, 1)
        bare = flat[:, 0, 0] * flat[:, 1, 1] - flat[:, 0, 1] ** 2
        flat[:, 0, 0] += LOW_PASS
        flat[:, 1, 1] += LOW_PASS
        whole = flat[:, 0, 0] * flat[:, 1, 1] - flat[:, 0, 1] ** 2
        alphas = opacities * (np.sqrt(np.maximum(bare / whole, 0.000025)) if is_antialiased else 1)
        conics = np.stack([flat[:, 1, 1], -flat[:, 0, 1], flat[:, 0, 0]], 1) / whole[:, None]
        places = focal * seen[:, :2] / depth[:, None] + np.array(size) / 2
        reach = np.sqrt(2 * np.log(np.maximum(255 * alphas, 1)))[:, None] * np.sqrt(np.stack([flat[:, 0, 0], flat[:, 1, 1]], 1))
    directions = away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
    basis = basis_of(directions)[:, : harmonics.shape[1], None]
    colours = np.maximum((basis * harmonics).sum(1) + 0.5, 0)
    first = np.floor(places - reach - 1)
    last = np.ceil(places + reach + 1)
    is_seen = (depth > NEAR) & (alphas >= LEAST_ALPHA) & (last > 0).all(1) & (first < np.array(size)).all(1)
    colour, light = np.zeros((height, width, 3)), np.ones((height, width))
    for number in np.flatnonzero(is_seen)[np.argsort(depth[is_seen], kind="stable")]:
        left, top = np.maximum(first[number], 0).astype(int)
        end, low = np.minimum(last[number], size).astype(int)
        u, v = np.arange(left, end) + 0.5 - places[number, 0], (np.arange(top, low) + 0.5 - places[number, 1])[:, None]
        a, b, c = conics[number]
        alpha = np.minimum(alphas[number] * np.exp(-0.5 * (a * u * u + 2 * b * u * v + c * v * v)), MOST_ALPHA)
        part = light[top:low, left:end]
        share = np.where(alpha >= LEAST_ALPHA, alpha, 0) * part
        colour[top:low, left:end] += share[:, :, None] * colours[number]
        part -= share
    return np.concatenate([colour, light[:, :, None]], 2)


def made_up(folder):
    """Scenes of thin, small, large and faint splats, as files of the reference trainer with colours of each degree."""
    rng, paths = np.random.default_rng(20), []
    for degree, count in ((0, 4000), (1, 2500), (2, 2500), (3, 6000)):
        further = 3 * ((degree + 1) ** 2 - 1)
        names = [*"xyz", *(f"f_dc_{at}" for at in range(3)), *(f"f_rest_{at}" for at in range(further)), "opacity",
                 *(f"scale_{at}" for at in range(3)), *(f"rot_{at}" for at in range(4))]  # fmt: skip
        rows = np.concatenate([rng.normal(0, 2, (count, 3)), rng.normal(0, 1, (count, 3)), rng.normal(0, 0.2, (count, further)),
                               rng.normal(0, 2, (count, 1)), rng.uniform(-5, -1, (count, 3)), rng.normal(0, 1, (count, 4))], 1)  # fmt: skip
        head = "\n".join(["ply", "format binary_little_endian 1.0", f"element vertex {count}", *(f"property float {name}" for name in names), "end_header\n"])
        paths.append(folder / f"degree_{degree}.ply")
        paths[-1].write_bytes(head.encode() + rows.astype("<f4").tobytes())
    return paths


def compare(program, path, views, size, scratch):
    """The least ratio of peak to noise of a file's pictures, decibels."""
    data = path.read_bytes()
    splats = of_ply(data) if data[:3] == b"ply" else of_spz(data) if data[:2] == b"\x1f\x8b" else of_splat(data)
    low, middle, high = np.percentile(splats[0], [10, 50, 90], axis=0)
    extent, worst, covered = max(np.linalg.norm(high - low), 1e-3), np.inf, 0.0
    rng = np.random.default_rng(7)
    for number in range(views):
        # From outside, and from among the splats.
        aside = rng.normal(size=3)
        start = middle + aside / np.linalg.norm(aside) * extent * (0.9 if number % 2 else 0.3)
        towards = middle + rng.normal(size=3) * 0.05 * extent
        is_antialiased, fov_deg = number % 3 == 1, (70, 45, 100)[number % 3]
        words = [",".join(f"{value!r}" for value in place.tolist()) for place in (start, towards)]
        run(program, path, scratch / "picture", *size, fov_deg, "true" if is_antialiased else "false", *words)
        ours = np.fromfile(scratch / "picture", "<f4").reshape(size[1], size[0], 5)[:, :, :4]
        off = ours - picture(splats, start, towards, size, fov_deg, is_antialiased)
        worst = min(worst, -10 * np.log10(max((off**2).mean(), 1e-20)))
        covered += (1 - ours[:, :, 3]).mean() / views
    said(path.name, f"{len(splats[0])} splats, {views} pictures of {size[0]} x {size[1]}, {covered:.0%} covered: at least {worst:.1f} dB")
    require(covered > 0.01, f"{path}: nothing is seen")
    return worst


def main():
    options = command_line("program", files=[Path], views=6, width=160, height=90)
    with tempfile.TemporaryDirectory() as scratch:
        files = options.files or made_up(Path(scratch))
        worst = min(compare(options.program, path, options.views, (options.width, options.height), Path(scratch)) for path in files)
    require(worst >= LEAST_DB, f"{worst:.1f} dB are less than {LEAST_DB}")


if __name__ == "__main__":
    main()
