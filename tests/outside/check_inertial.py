"""A filter on the sensors of motion of a dataset: strapdown integration of the inertial unit, aided by satellite receiver and barometer, with an
error state of 15 (place, velocity, attitude, both biases). For the last OUTAGE_S seconds of a flight the receiver is taken away. The place must
stay within BOUND_M there. Axes, signs and time stamps are held by that: everything is computed here anew, right-handed, without a line of cosfly,
and the truth is the pose of the frames.

Usage: `check_inertial.py DATASET`."""

import sys

import numpy as np
from scipy.spatial.transform import Rotation
from shared import readings

OUTAGE_S, AIDED_S, BOUND_M, BOUND_OF_AIDED_M = 60.0, 30.0, 100.0, 15.0
GRAVITY = np.array([0, 0, -9.81])
MIRROR = np.array([1.0, -1, 1])
PLACE, VELOCITY = ["east_m", "north_m", "up_m"], ["velocity_east_mps", "velocity_north_mps", "velocity_up_mps"]
# Densities of noise and of the walks that the biases are taken for, deviations at the beginning: gyroscope, accelerometer.
NOISE, WALK, FIRST = np.array([1.92e-4, 1.83e-3]), np.array([6e-6, 2e-4]), np.array([9e-4, 2e-2])


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rotation(v):
    return Rotation.from_rotvec(v).as_matrix()


class Filter:
    """Place, velocity and attitude in `map`: x east, y north, z up."""

    def __init__(self, fix, force, field):
        self.place, self.velocity = fix[PLACE].to_numpy(float), fix[VELOCITY].to_numpy(float)
        # Level by the force, which is up where nothing accelerates; north by the magnetic field.
        up = force / np.linalg.norm(force)
        east = np.cross(field, up)
        east /= np.linalg.norm(east)
        self.attitude = np.array([east, np.cross(up, east), up])
        self.biases = np.zeros(6)
        self.covariance = np.diag(np.repeat([25.0, 0.04, 2e-3, FIRST[0] ** 2, FIRST[1] ** 2], 3))

    def move(self, rates, force, step_s):
        rates, force = rates - self.biases[:3], force - self.biases[3:]
        middle = self.attitude @ rotation(0.5 * step_s * rates)
        acceleration = middle @ force + GRAVITY
        self.place = self.place + step_s * (self.velocity + 0.5 * step_s * acceleration)
        self.velocity = self.velocity + step_s * acceleration
        self.attitude = self.attitude @ rotation(step_s * rates)
        return middle @ force

    def spread(self, felt, time_s):
        """The covariance after a time in which the body felt a mean force, along the world's axes."""
        change = np.eye(15)
        change[0:3, 3:6] = time_s * np.eye(3)
        change[3:6, 6:9] = -time_s * cross(felt)
        change[3:6, 12:15] = change[6:9, 9:12] = -time_s * self.attitude
        noise = np.concatenate([np.zeros(3), np.full(3, NOISE[1]), np.full(3, NOISE[0]), np.full(3, WALK[0]), np.full(3, WALK[1])])
        self.covariance = change @ self.covariance @ change.T + np.diag(noise**2 * time_s)

    def correct(self, seen, residual, deviations):
        spread = self.covariance @ seen.T
        gain = spread @ np.linalg.inv(seen @ spread + np.diag(np.square(deviations)))
        error = gain @ residual
        self.covariance = (np.eye(15) - gain @ seen) @ self.covariance
        self.place, self.velocity = self.place + error[0:3], self.velocity + error[3:6]
        self.attitude = rotation(error[6:9]) @ self.attitude
        self.biases = self.biases + error[9:15]


def errors(flight, unit, receiver, barometer, magnetometer, frames):
    """Times and distances of the filter's place from that of each frame."""
    times = unit.time_s.to_numpy()
    ends_s = times[-1] - OUTAGE_S
    rates = unit[[f"rate_{axis}_rad_s" for axis in "xyz"]].to_numpy() * -MIRROR
    force = unit[[f"force_{axis}_mps2" for axis in "xyz"]].to_numpy() * MIRROR
    field = magnetometer[[f"field_{axis}_ut" for axis in "xyz"]].to_numpy()[0] * MIRROR
    fixes = receiver[receiver.is_fix == 1]
    first = fixes.iloc[0]
    assert first.time_s == 0, f"{flight}: it begins without a fix"
    run = Filter(first, force[:20].mean(axis=0), field)
    fixes = [row for _, row in fixes.iloc[1:].iterrows() if row.time_s < ends_s]
    heights = list(zip(barometer.time_s, barometer.altitude_m))[1:]
    dt_s = times[-1] / (len(frames) - 1)
    places = frames[["drone_x_m", "drone_y_m", "drone_z_m"]].to_numpy() * MIRROR
    seen = np.eye(6, 15)
    found, felt, due = [], np.zeros(3), 0
    for index in range(1, len(times)):
        mean = 0.5 * (rates[index - 1] + rates[index]), 0.5 * (force[index - 1] + force[index])
        felt = felt + run.move(*mean, times[index] - times[index - 1])
        if index % 10 == 0:
            run.spread(felt / 10, times[index] - times[index - 10])
            felt = np.zeros(3)
            while fixes and fixes[0].time_s <= times[index] + 1e-6:
                fix = fixes.pop(0)
                away = fix[PLACE + VELOCITY].to_numpy(float) - np.concatenate([run.place, run.velocity])
                wide = np.array([fix.horizontal_dilution, fix.horizontal_dilution, fix.vertical_dilution])
                run.correct(seen, away, np.concatenate([8.0 * wide, 0.06 * wide]))
            while heights and heights[0][0] <= times[index] + 1e-6:
                run.correct(seen[2:3], np.array([heights.pop(0)[1] - run.place[2]]), [1.5])
        while due < len(places) and due * dt_s <= times[index] + 1e-6:
            found.append((due * dt_s, np.linalg.norm(run.place - places[due])))
            due += 1
    return np.array(found), ends_s


tables = [readings(sys.argv[1], name) for name in ("inertial_unit", "satellite_receiver", "barometer", "magnetometer", "frames")]
checked = 0
for flight in sorted(tables[0]):
    rows = [of_flight[flight] for of_flight in tables]
    if rows[0].time_s.iloc[-1] < AIDED_S + OUTAGE_S:
        continue
    found, ends_s = errors(flight, *rows)
    aided = found[(found[:, 0] > AIDED_S / 2) & (found[:, 0] < ends_s), 1]
    last = found[-1, 1]
    print(f"{flight}: {np.sqrt(np.mean(aided**2)):.1f} m with receiver, {last:.1f} m after {OUTAGE_S:.0f} s without")
    assert np.sqrt(np.mean(aided**2)) < BOUND_OF_AIDED_M and found[:, 1].max() < BOUND_M, (flight, found)
    checked += 1
assert checked, f"no flight is {AIDED_S + OUTAGE_S:.0f} s long"
