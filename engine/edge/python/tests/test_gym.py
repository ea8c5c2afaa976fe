"""Environments for gymnasium: the checker, the three modes of autoreset, seeds, the expert's actions."""

import warnings
from pathlib import Path

import numpy as np
import pytest

gym = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import cosfly  # noqa: E402
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


@pytest.mark.parametrize("obs", [("depth",), ("rgb",), ("state", "depth", "mask", "semantic", "instance", "rgb")])
def test_the_checker_finds_nothing_in_pictures(obs):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(minimum|maximum) value.*infinity.*")
        warnings.filterwarnings("ignore", message=".*symmetric and normalized space.*")
        # Depth is in metres, and masks are 0 or 1; pictures are taken by smaller networks than those the checker thinks of.
        warnings.filterwarnings("ignore", message=".*(looks like an image|not an image|box observation space|unconventional).*")
        check_env(gym.make(ID, recipe="small/recipe.toml", obs=obs, size=48).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_pictures_do_not_depend_on_threads_or_on_who_is_beside(mode):
    obs = ("state", "depth", "mask", "semantic", "instance", "rgb")
    many = make_vec(mode, num_envs=5, obs=obs, size=(64, 40), threads=2, expert_action=True)
    few = make_vec(mode, num_envs=2, obs=obs, size=(64, 40), threads=1, expert_action=True)
    (first, info), (other, _) = many.reset(seed=[7, 8, 9, 7, 3]), few.reset(seed=[3, 7])
    assert many.observation_space.contains(first) and first["depth"].shape == (5, 40, 64)
    finals = 0
    for _ in range(150):
        for name in obs:
            assert (first[name][[4, 3]] == other[name]).all() and (first[name][0] == first[name][3]).all()
        actions = info["expert_action"] + np.float32([0.5, 0, -0.3, 0, 0])
        first, _, terminated, truncated, info = many.step(actions)
        other, _, _, _, beside = few.step(actions[[4, 3]])
        if "final_obs" in info:
            number = np.flatnonzero(terminated | truncated)[0]
            assert many.single_observation_space.contains(info["final_obs"][number])
            finals += 1
    assert (finals > 0) == (mode == AutoresetMode.SAME_STEP)


def test_pictures_show_the_target_where_it_is_tracked():
    envs = make_vec(num_envs=2, obs=("depth", "mask"), size=256, expert_action=True)
    observations, info = envs.reset(seed=1)
    seen, tracked = [], []
    for _ in range(60):
        observations, _, _, _, info = envs.step(info["expert_action"])
        seen.append(observations["mask"].any(axis=(1, 2)))
        tracked.append(info["tracked"])
    seen, tracked = np.array(seen), np.array(tracked)
    assert seen[tracked].mean() > 0.95 and observations["depth"].max() <= 200.0


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


def test_colours_show_the_weather_of_the_recipe_unless_another_is_named():
    night, pictures = ['stages.frames.weathers=["HardRainNight"]'], {}
    for name, named in (("own", {}), ("noon", {"weather": "ClearNoon"}), ("full", {"look": "full"})):
        envs = make_vec(num_envs=2, obs=("rgb",), size=48, overrides=night, **named)
        pictures[name] = envs.reset(seed=1)[0].astype(float)
    assert pictures["own"].mean() < pictures["noon"].mean() - 20
    assert np.abs(pictures["own"] - pictures["full"]).mean() > 2


def test_what_is_not_there_is_refused():
    with pytest.raises(ValueError, match="state, depth"):
        make_vec(obs=("thermal",))
    with pytest.raises(ValueError, match="ClearNoon"):
        make_vec(obs=("rgb",), weather="Frogs")
    with pytest.raises(ValueError, match="simple, full"):
        make_vec(obs=("rgb",), look="pretty")
    with pytest.raises(ValueError, match="8 to 2048"):
        make_vec(obs=("depth",), size=4)
    with pytest.raises(ValueError, match="shape"):
        envs = make_vec(num_envs=2)
        envs.reset(seed=1)
        envs.step(np.zeros((3, 5), dtype=np.float32))


def test_the_suite_names_drone_wind_and_latency():
    text = open("small/recipe.toml").read()
    recipe = Path("small/windy.toml")
    recipe.write_text(text + '\n[tool.fly]\ndrone = "pelican"\nwind_mps = 8\ngusts = true\nlatency_ms = 500\n')
    flights = {}
    for name, given, more in [("plain", "small/recipe.toml", {}), ("windy", recipe, {}), ("at once", recipe, {"latency_s": 0.0})]:
        env = gym.make(ID, recipe=given, **more).unwrapped
        env.reset(seed=1)
        flights[name] = np.stack([env.step(np.float32([3, 0, 0, 0, 0]))[0] for _ in range(8)])
    # Entries 6 to 8 are the velocity: a quadrotor in gusts is nowhere exactly what a point mass is.
    assert not np.allclose(flights["plain"][:, 6:9], flights["at once"][:, 6:9], atol=1e-3)
    # An action takes effect half a second after its observation.
    assert np.abs(flights["windy"][:3, 6:9] - flights["at once"][:3, 6:9]).max() > 0.05
    recipe.write_text(text + "\n[tool.fly]\nlatency_ms = 9000\n")
    with pytest.raises(cosfly.Error, match="latency_ms is 9000"):
        gym.make(ID, recipe=recipe)


def test_a_camera_that_sees_nothing_gives_zeros():
    recipe = Path("small/dark.toml")
    recipe.write_text(open("small/recipe.toml").read() + "\n[tool.fly]\nblackouts = 2\n")
    env = gym.make(ID, recipe=recipe, obs=("state", "depth"), size=16, expert_action=True).unwrapped
    _, info = env.reset(seed=1)
    dark, ended = 0, False
    while not ended:
        observation, _, terminated, truncated, info = env.step(info["expert_action"])
        ended = terminated or truncated
        if not observation["depth"].any():
            dark += 1
            assert not info["tracked"]
    assert dark > 5
