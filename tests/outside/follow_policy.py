"""A policy in numpy for `cosfly fly`: keeps the person 20 m ahead and 20 m below, and aims the camera."""

import numpy as np


def act(observation):
    state = np.asarray(observation["state"], dtype=np.float64)
    person, walk, pitch = state[0:3], state[3:6], np.radians(state[12])
    distance = np.hypot(person[0], person[1])
    velocity = walk + 0.6 * np.array([person[0] - 20.0, person[1], person[2] + 20.0])
    yaw_rate = np.degrees(np.arctan2(person[1], person[0])) / 0.3
    pitch_rate = np.degrees(np.arctan2(person[2] + 0.9, distance) - pitch) / 0.3
    return {"actions": np.array([*velocity, pitch_rate, yaw_rate], dtype=np.float32)}
