"""Harnesses of others: vla-eval's orchestrator with a model server of its own, and the environment for LeRobot."""

import threading

import numpy as np
import pytest

gym = pytest.importorskip("gymnasium")
import cosfly.gym  # noqa: E402

RECIPE = "small/recipe.toml"


def test_an_episode_is_begun_by_its_name():
    track = cosfly.gym.Track(RECIPE)
    for name in track.episodes():
        _, info = track.reset(options={"episode": name})
        assert info["episode"] == name and track.planned_steps > 0
    with pytest.raises(ValueError, match="no episode 'nowhere'; there are"):
        track.reset(options={"episode": "nowhere"})


def test_vla_eval_flies_all_episodes_with_its_own_orchestrator(tmp_path):
    pytest.importorskip("vla_eval")
    import anyio
    from vla_eval.model_servers.predict import PredictModelServer
    from vla_eval.model_servers.serve import serve_async
    from vla_eval.orchestrator import Orchestrator

    class Hover(PredictModelServer):
        """Turns the camera to the target and stays."""

        def predict(self, obs, ctx):
            assert obs["state"].shape == (16,) and "target" in obs["task_description"]
            assert obs["images"]["depth"].shape == (32, 32)
            ahead, right = obs["state"][:2]
            return {"actions": np.array([0, 0, 0, 0, np.degrees(np.arctan2(right, ahead))], dtype=np.float32)}

        def get_action_spec(self):
            return {}

        def get_observation_spec(self):
            return {}

    async def run():
        async with anyio.create_task_group() as group:
            port = await group.start(lambda task_status: serve_async(Hover(), "127.0.0.1", 0, task_status=task_status))
            config = {
                "server": {"url": f"ws://127.0.0.1:{port}"},
                "output_dir": str(tmp_path),
                "render": "cpu",
                "benchmarks": [
                    {
                        "benchmark": "cosfly.vla_eval:TrackBenchmark",
                        "mode": "sync",
                        "episodes_per_task": 1,
                        "params": {"recipe": RECIPE, "pictures": ["depth"], "size": 32},
                    }
                ],
            }
            results = await Orchestrator(config).run()
            group.cancel_scope.cancel()
            return results

    (result,) = anyio.run(run)
    episodes = [episode for task in result["tasks"] for episode in task["episodes"]]
    assert len(episodes) == len(cosfly.gym.Track(RECIPE).episodes())
    for episode in episodes:
        assert 0.0 <= episode["metrics"]["tracking_rate"] <= 1.0, episode
    assert threading.active_count() < 50


def test_the_environment_of_lerobot_has_its_names():
    import cosfly.lerobot

    env = gym.make(cosfly.lerobot.ID, recipe=RECIPE, disable_env_checker=False)
    observation, info = env.reset(seed=1)
    assert observation["agent_pos"].shape == (16,) and not info["is_success"]
    for _ in range(10):
        observation, reward, terminated, truncated, info = env.step(np.zeros(5, np.float32))
    assert env.observation_space.contains(observation) and 0 <= info["tracking_rate"] <= 1
    assert env.unwrapped._max_episode_steps > 0 and env.unwrapped.task_description

    with_pictures = gym.make(cosfly.lerobot.ID, recipe=RECIPE, size=64, look="full", disable_env_checker=False)
    observation, _ = with_pictures.reset(seed=1)
    assert with_pictures.observation_space.contains(observation)
    assert observation["pixels"].shape == (64, 64, 3) and observation["pixels"].std() > 5


def test_lerobot_makes_the_environment_from_its_configuration():
    pytest.importorskip("lerobot.envs.factory")
    from cosfly.lerobot import CosflyEnv
    from lerobot.envs.factory import make_env

    made = make_env(CosflyEnv(recipe=RECIPE), n_envs=2)
    observation, _ = made["cosfly"][0].reset(seed=[1, 2])
    assert observation["agent_pos"].shape == (2, 16)

    from lerobot.envs.utils import env_to_policy_features, preprocess_observation

    config = CosflyEnv(recipe=RECIPE, size=48)
    observation, _ = make_env(config, n_envs=2)["cosfly"][0].reset(seed=[1, 2])
    told = preprocess_observation(observation)
    features = env_to_policy_features(config)
    for name, shape in (("observation.state", (16,)), ("observation.image", (3, 48, 48))):
        assert features[name].shape == shape and tuple(told[name].shape) == (2, *shape)


def test_lerobot_makes_the_environment_from_a_folder_of_its_hub(tmp_path, monkeypatch):
    pytest.importorskip("lerobot.envs.factory")
    import shutil
    from pathlib import Path

    import huggingface_hub.constants
    from lerobot.configs.parser import load_plugin
    from lerobot.envs.factory import make_env

    load_plugin("cosfly.lerobot")  # as `--env.discover_packages_path=cosfly.lerobot` does
    # What the hub's client keeps of a repository that it has fetched.
    monkeypatch.setattr(huggingface_hub.constants, "HF_HUB_OFFLINE", True)
    repository, revision = tmp_path / "models--someone--drones", "0123456789" * 4
    folder = Path(__file__).resolve().parents[4] / "recipes/training/lerobot_env"
    shutil.copytree(folder, repository / "snapshots" / revision)
    (repository / "refs").mkdir()
    (repository / "refs/main").write_text(revision)
    with pytest.raises(RuntimeError, match="trust_remote_code"):
        make_env("someone/drones")
    for options in ({}, {"use_async_envs": True}):
        ((envs,),) = (made.values() for made in make_env("someone/drones", 2, hub_cache_dir=tmp_path, trust_remote_code=True, **options).values())
        observation, _ = envs.reset(seed=[1, 2])
        assert observation["agent_pos"].shape == (2, 16)
        observation, *_ = envs.step(np.zeros((2, 5), np.float32))
        pictures = np.stack(envs.call("render"))
        assert pictures.shape == (2, 128, 128, 3) and pictures.std() > 5
        assert envs.call("_max_episode_steps")[0] > 0
        envs.close()
