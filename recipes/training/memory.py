"""Memory of `cosfly/Track-v0` by number of environments and content of observations, each in a process of its own.

    python recipes/training/memory.py recipes/suites/street.toml
    python recipes/training/memory.py recipes/busy_street.toml --counts 1 64 256 --size 84

Megabytes of resident memory after a reset and some steps, and at most; `package` is the process after the imports alone. Linux only.
The episodes are made first, in a process that is not measured.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys

import tools

OBSERVATIONS = {
    "state": ("state",),
    "depth": ("depth",),
    "depth+ids": ("depth", "semantic", "instance"),
    "rgb": ("rgb",),
}


def resident_mb() -> tuple[float, float]:
    """Memory now and at most, megabytes."""
    values = {}
    with open("/proc/self/status") as status:
        for line in status:
            name, _, value = line.partition(":")
            values[name] = value
    return int(values["VmRSS"].split()[0]) / 1e3, int(values["VmHWM"].split()[0]) / 1e3


def measure(recipe: str, names: list[str], count: int, size: int, steps: int) -> dict[str, float]:
    import gymnasium as gym

    import cosfly.gym  # noqa: F401 (registers the environments)

    package, _ = resident_mb()
    envs = gym.make_vec(
        "cosfly/Track-v0", num_envs=count, vectorization_mode="vector_entry_point", recipe=recipe, obs=tuple(names), size=size
    )
    envs.reset(seed=1)
    envs.action_space.seed(1)
    for _ in range(steps):
        envs.step(envs.action_space.sample())
    now, most = resident_mb()
    return {"package": package, "now": now, "most": most}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe")
    parser.add_argument("--counts", type=tools.counted, nargs="+", default=[1, 64, 256])
    parser.add_argument("--size", type=tools.counted, default=84)
    parser.add_argument("--steps", type=tools.counted, default=20)
    parser.add_argument("--one", nargs="+", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    tools.need("numpy", "gymnasium", "cosfly")
    if arguments.one:
        found = measure(arguments.recipe, arguments.one, arguments.counts[0], arguments.size, arguments.steps)
        print(json.dumps(found))
        return

    def one(names: tuple[str, ...], count: int) -> dict[str, float]:
        command = [sys.executable, __file__, arguments.recipe, "--counts", str(count), "--size", str(arguments.size)]
        command += ["--steps", str(arguments.steps), "--one", *names]
        done = subprocess.run(command, stdout=subprocess.PIPE)
        if done.returncode:
            raise SystemExit(done.returncode)  # the process has said why
        return json.loads(done.stdout.splitlines()[-1])

    one(("state",), 1)
    print(f"{'obs':<10} {'envs':>5} {'package':>9} {'resident':>9} {'at most':>9} {'added':>9} {'50 + envs':>10}")
    for name, names in OBSERVATIONS.items():
        for count in arguments.counts:
            found = one(names, count)
            added = found["now"] - found["package"]
            print(
                f"{name:<10} {count:>5} {found['package']:>9.1f} {found['now']:>9.1f} {found['most']:>9.1f} {added:>9.1f} "
                f"{50 + count:>10}"
            )


if __name__ == "__main__":
    tools.script(main)
