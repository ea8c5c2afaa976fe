"""Environments for gymnasium: the checker, the three modes of autoreset, seeds, the expert's actions."""

import warnings

import numpy as np
import pytest

gym = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import cosfly.gym  # noqa: E402, F401 (registers the environments, as the installed package does by itself)

ID = "cosfly/Track-v0"


def make_vec(mode=AutoresetMode.NEXT_STEP, num_envs=4, **more):
    return gym.make_vec(
        ID, num_envs=num_envs, vectorization_mode="vector_entry_point", recipe="small/recipe.toml",
        autoreset_mode=mode, **more,
    )


def test_the_checker_finds_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(minimum|maximum) value.*infinity.*")
        # Actions are in m/s and degrees/s on purpose; gymnasium's RescaleAction normalises them.
        warnings.filterwarnings("ignore", message=".*symmetric and normalized space.*")
        check_env(gym.make(ID, recipe="small/recipe.toml").unwrapped, skip_render_check=True)


def test_equal_seeds_give_equal_flights():
    flights = []
    for _ in range(2):
        envs = make_vec(num_envs=3)
        first, _ = envs.reset(seed=[7, 8, 7])
        envs.action_space.seed(3)
        steps = [first]
        for _ in range(150):
            actions = envs.action_space.sample()
            actions[2] = actions[0]
            steps.append(envs.step(actions)[0])
        flights.append(np.stack(steps))
        assert (flights[-1][:, 0] == flights[-1][:, 2]).all()
    assert (flights[0] == flights[1]).all()


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_episodes_begin_anew(mode):
    envs = make_vec(mode, num_envs=2, expert_action=True)
    assert envs.metadata["autoreset_mode"] == mode
    observations, info = envs.reset(seed=1)
    ended = np.zeros(2, dtype=bool)
    for _ in range(2000):
        observations, rewards, terminated, truncated, info = envs.step(info["expert_action"])
        assert observations.shape == (2, 16) and np.isfinite(rewards).all()
        ended = terminated | truncated
        if ended.any():
            break
    assert ended.any()
    assert ("final_obs" in info) == (mode == AutoresetMode.SAME_STEP)
    if mode == AutoresetMode.DISABLED:
        again, _ = envs.reset(options={"reset_mask": ended})
        assert (again[~ended] == observations[~ended]).all()
    else:
        _, rewards, terminated, truncated, _ = envs.step(info["expert_action"])
        assert not (terminated | truncated)[ended].any()
        assert mode == AutoresetMode.SAME_STEP or (rewards[ended] == 0).all()


def test_the_expert_tracks_and_the_terms_add_up():
    envs = make_vec(num_envs=2, expert_action=True)
    _, info = envs.reset(seed=1)
    tracked = []
    for _ in range(100):
        _, rewards, _, _, info = envs.step(info["expert_action"])
        tracked.append(info["tracked"])
        weights = {"visibility": 1, "framing": 0.2, "distance": 0.2, "effort": 0.05, "collision": 20, "loss": 0.5}
        total = sum(weight * info[f"reward_{name}"] for name, weight in weights.items())
        assert np.allclose(total, rewards)
    assert np.mean(tracked) > 0.8


def test_what_is_not_there_is_refused():
    with pytest.raises(ValueError, match="state"):
        make_vec(obs=("depth",))
    with pytest.raises(ValueError, match="shape"):
        envs = make_vec(num_envs=2)
        envs.reset(seed=1)
        envs.step(np.zeros((3, 5), dtype=np.float32))
