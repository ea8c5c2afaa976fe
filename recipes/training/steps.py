"""Steps per second of environments by the number of threads, and the share of a step that is not shared between threads.

    python recipes/training/steps.py [RECIPE] [--obs state] [--envs 4096] [--jobs 1 2] [--seconds 5]

The share is measured with one thread: seconds of `step` outside of stepping, drawing and large copies, of its own seconds. With a share s, N threads
are at most N / (1 + s (N - 1)) times as fast as one.
"""

import argparse
import os
import time

import tools

tools.need("numpy", "gymnasium", "cosfly")
import numpy as np
from cosfly.gym import TrackVector


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("recipe", nargs="?", default="recipes/suites/street.toml")
    parser.add_argument("--obs", nargs="+", default=["state"])
    parser.add_argument("--envs", type=tools.counted, default=4096)
    parser.add_argument("--size", type=tools.counted, default=84)
    parser.add_argument("--jobs", nargs="+", type=tools.counted, default=sorted({1, os.cpu_count() or 1}))
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--copy", action="store_true", help="new arrays at every step")
    given = parser.parse_args()

    print("| threads | steps/s | CPU, us a step | outside of shared work |\n| ---: | ---: | ---: | ---: |")
    for jobs in given.jobs:
        envs = TrackVector(given.recipe, given.envs, obs=given.obs, size=given.size, jobs=jobs, copy=given.copy)
        envs.reset(seed=1)
        actions = np.zeros((given.envs, 5), dtype=np.float32)
        for _ in range(3):
            envs.step(actions)
        steps, began, cpu, shared = 0, time.perf_counter(), time.process_time(), envs.shared_s
        while time.perf_counter() - began < given.seconds:
            envs.step(actions)
            steps += given.envs
        seconds, cpu = time.perf_counter() - began, time.process_time() - cpu
        outside = 1.0 - (envs.shared_s - shared) / seconds
        print(f"| {jobs} | {steps / seconds:,.0f} | {1e6 * cpu / steps:.2f} | {100 * outside:.2f} % |", flush=True)
        envs.close()


if __name__ == "__main__":
    tools.script(main)
