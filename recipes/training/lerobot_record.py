"""Flies the expert through the episodes of a recipe, as a dataset of LeRobot whose states, pictures and actions are those of its environment `cosfly`.

    python recipes/training/lerobot_record.py recipes/suites/street.toml flown [--episodes 4] [--size 64] [--steps 100]

`lerobot-train --dataset.root=flown ...` learns from it, `lerobot-eval --env.type=cosfly --env.discover_packages_path=cosfly.lerobot ...` flies
what was learnt; the book's page on LeRobot has both commands.
"""

import argparse

import tools

tools.need("numpy", "lerobot", "cosfly")
import numpy as np
from cosfly.lerobot import LeRobotTrack
from lerobot.datasets.lerobot_dataset import LeRobotDataset


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("recipe")
    parser.add_argument("out")
    parser.add_argument("--episodes", type=tools.counted, default=4)
    parser.add_argument("--size", type=tools.counted, default=64)
    parser.add_argument("--steps", type=tools.counted, default=100, help="most steps of an episode, ten a second")
    given = parser.parse_args()

    env = LeRobotTrack(given.recipe, size=given.size, expert_action=True)
    features = {
        "observation.state": {"dtype": "float32", "shape": (16,), "names": None},
        "observation.image": {"dtype": "image", "shape": (given.size, given.size, 3), "names": ["height", "width", "channels"]},
        "action": {"dtype": "float32", "shape": (5,), "names": ["ahead", "right", "up", "pitch_rate", "yaw_rate"]},
    }
    data = LeRobotDataset.create("cosfly/flown", fps=env.metadata["render_fps"], features=features, root=given.out, use_videos=False)
    for episode in range(given.episodes):
        observation, info = env.reset(seed=episode)
        for _ in range(given.steps):
            action = np.asarray(info["expert_action"], np.float32)
            data.add_frame({"observation.state": observation["agent_pos"], "observation.image": observation["pixels"], "action": action, "task": env.task})
            observation, _, terminated, truncated, info = env.step(action)
            if terminated or truncated:
                break
        data.save_episode()
    data.finalize()
    print(f"{given.out}: {data.num_episodes} episodes of {data.num_frames} steps")


if __name__ == "__main__":
    tools.script(main)
