"""The quadrotor against `drone-models` step for step; gust spectra and Allan deviations by numpy and scipy.

Usage: `check_drone.py FLIGHT_OF_STDIN`."""

import sys

import numpy as np
from drone_models.core import load_params
from drone_models.first_principles import dynamics
from scipy.signal import welch
from scipy.spatial.transform import Rotation
from shared import allan, run


def numbers_of(*arguments, **options):
    return np.array([[float(word) for word in line.split()] for line in run(sys.argv[1], *arguments, **options).splitlines()])


# The quadrotor: Runge and Kutta's steps over the derivatives of drone-models. Attitudes turn by q' = q * (rates, 0) / 2.
parameters = load_params("first_principles", "cf2x_L250")
names = "mass L prop_inertia gravity_vec J J_inv rpm2thrust rpm2torque mixing_matrix drag_matrix rotor_dyn_coef"
parameters = {name: np.asarray(parameters[name], dtype=float) for name in names.split()}


def slope(state, command):
    position, attitude, velocity, rates, rotors = np.split(state, [3, 7, 10, 13])
    x, y, z, w = attitude
    turn = 0.5 * np.array([[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, -z]]) @ rates
    _, _, acceleration, turning, spin = dynamics(position, attitude, velocity, rates, command, rotors, **parameters)
    return np.concatenate([velocity, turn, acceleration, turning, spin])


def stepped(state, command, step):
    slopes = [slope(state, command)]
    for share in (0.5, 0.5, 1.0):
        slopes.append(slope(state + share * step * slopes[-1], command))
    state = state + step / 6 * (np.array([1, 2, 2, 1]) @ slopes)
    state[3:7] /= np.linalg.norm(state[3:7])
    return state


def distance(ours, theirs):
    parts = zip(np.split(ours, [3, 7, 10, 13]), np.split(theirs, [3, 7, 10, 13]))
    return max(np.linalg.norm(a - b) / max(np.linalg.norm(b), 1e-3) for a, b in parts)


random = np.random.default_rng(5)
step, count = 0.002, 500
worst_step = worst_second = 0.0
for _ in range(10):
    attitude = Rotation.from_rotvec(random.normal(0, 0.4, 3)).as_quat()
    rotors = random.uniform(12_000, 18_000, 4)
    state = np.concatenate([random.normal(0, 2, 3), attitude, random.normal(0, 2, 3), random.normal(0, 1, 3), rotors])
    mean = random.uniform(13_500, 16_500)
    commands = mean + random.normal(0, 150, (count, 4))
    lines = [" ".join(repr(float(value)) for value in state)]
    lines += [" ".join(repr(float(value)) for value in [*command, 0, 0, 0, step]) for command in commands]
    flown = numbers_of("quadrotor", input="\n".join(lines) + "\n")
    before = state
    for command, ours in zip(commands, flown):
        worst_step = max(worst_step, distance(ours, stepped(before, command, step)))
        before = ours
        state = stepped(state, command, step)
    worst_second = max(worst_second, distance(flown[-1], state))
print(f"quadrotor against drone-models: {worst_step:.1e} over a step, {worst_second:.1e} over a second")
assert worst_step < 1e-9 and worst_second < 1e-6

# Gusts: one-sided densities of Dryden's spectra, in eight bands from a thousandth to a tenth of the sampling rate.
step, speed, deviation, length = 0.02, 8.0, 1.5, 12.0
gusts = numbers_of("gusts", step, speed, deviation, length, 1_000_000)
for axis, name in enumerate(["along", "across", "upwards"]):
    frequency, density = welch(gusts[:, axis], fs=1 / step, nperseg=8192)
    place = 2 * np.pi * frequency * length / speed
    level = 4 * deviation**2 * length / speed
    wanted = level / (1 + place**2) if axis == 0 else 0.5 * level * (1 + 3 * place**2) / (1 + place**2) ** 2
    bands = np.geomspace(0.05, 5.0, 9)
    inside = [(frequency >= low) & (frequency < high) for low, high in zip(bands, bands[1:])]
    ratios = [density[band].mean() / wanted[band].mean() for band in inside]
    print(f"gusts {name}: measured / Dryden {min(ratios):.3f} to {max(ratios):.3f}")
    assert 0.9 < min(ratios) and max(ratios) < 1.1, ratios

# The inertial unit: Allan deviation falls with the root of time by the noise's density, and rises by that of the walk.
rate = 200.0
samples = numbers_of("inertial", rate, 4_000_000)
for first, name, noise, walk, times in [(0, "gyroscope", 1.6968e-4, 1.9393e-5, (0.1, 1.0)), (3, "accelerometer", 2.0e-3, 3.0e-3, (0.02, 0.1))]:
    for seconds, most in [*((it, 0.05) for it in times), (300.0, 0.3)]:
        wanted = np.sqrt(noise**2 / seconds + walk**2 * seconds / 3)
        found = np.sqrt(np.mean(allan(samples[:, first : first + 3], 1 / rate, seconds)))
        print(f"{name}: Allan deviation at {seconds} s {found:.3e}, by its densities {wanted:.3e}")
        assert abs(found / wanted - 1) < most
