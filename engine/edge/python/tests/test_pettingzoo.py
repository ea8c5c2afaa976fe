"""Several drones for pettingzoo: its own test of the interface, seeds, collisions between drones."""

import numpy as np
import pytest

pytest.importorskip("pettingzoo", reason="the package pettingzoo is not installed: pip install .[pettingzoo]")
from pettingzoo.test import parallel_api_test, parallel_seed_test  # noqa: E402

import cosfly  # noqa: E402

RECIPE = "small/recipe.toml"


@pytest.mark.parametrize("obs", [("state",), ("state", "depth", "mask")])
def test_the_interface_is_that_of_pettingzoo(obs):
    parallel_api_test(cosfly.parallel_env(RECIPE, num_drones=3, obs=obs, size=32), num_cycles=400)


def test_equal_seeds_give_equal_flights():
    parallel_seed_test(lambda: cosfly.parallel_env(RECIPE, num_drones=2), num_cycles=100)


def test_options_of_a_reset_are_named():
    env = cosfly.parallel_env(RECIPE)
    with pytest.raises(cosfly.InvalidValue, match="no key 'episodes'; did you mean `episode`"):
        env.reset(options={"episodes": "x"})
    with pytest.raises(cosfly.WrongType, match="it is a dictionary with `episode`"):
        env.reset(options="x")
    with pytest.warns(UserWarning, match="no key 'wind', which does nothing; there is `episode`"):
        env.reset(options={"wind": 1})


def test_drones_start_apart_and_know_of_each_other():
    env = cosfly.parallel_env(RECIPE, num_drones=3)
    observations, infos = env.reset(seed=4)
    assert len({info["episode"] for info in infos.values()}) == 1
    for observation in observations.values():
        assert observation.shape == (16 + 2 * 7,)
        for other in observation[16:].reshape(2, 7):
            assert other[0] == 1 and np.linalg.norm(other[1:4]) > 3.9


def test_drones_that_meet_leave_and_the_third_flies_on():
    env = cosfly.parallel_env(RECIPE, num_drones=3)
    # Where houses stand between the drones, another episode is tried.
    for episode in env.episodes():
        observations, _ = env.reset(options={"episode": episode})
        for _ in range(200):
            still = np.zeros(5, dtype=np.float32)
            actions = dict.fromkeys(env.agents, still)
            for agent, other in [("drone_0", 0), ("drone_1", 0)]:
                if agent in env.agents:
                    # A little above the houses, then at each other.
                    toward = observations[agent][16 + 7 * other + 1 : 16 + 7 * other + 4]
                    actions[agent] = np.float32([*(12 * toward / max(1.0, np.linalg.norm(toward))), 0, 0])
            observations, rewards, terminated, _, infos = env.step(actions)
            if terminated.get("drone_0") or terminated.get("drone_1"):
                break
        if terminated["drone_0"] and terminated["drone_1"] and "drone_2" in env.agents:
            assert rewards["drone_0"] < -10 and infos["drone_1"]["reward_collision"] == -1
            assert env.agents == ["drone_2"] and not observations["drone_2"][[16, 23]].any()
            return
    pytest.fail("no two drones met")


def test_what_is_not_there_is_refused():
    with pytest.raises(ValueError, match="1 to 64"):
        cosfly.parallel_env(RECIPE, num_drones=0)


def test_drones_without_a_seed_fly_other_episodes_each_time_and_the_seed_is_told():
    flown, seeds = [], []
    for _ in range(3):
        env = cosfly.parallel_env(RECIPE, num_drones=2)
        flown.append([env.reset()[1]["drone_0"]["episode"] for _ in range(8)])
        seeds.append(env.np_random_seed)
    assert len(set(seeds)) == 3
    env = cosfly.parallel_env(RECIPE, num_drones=2)
    first = env.reset(seed=seeds[0])[1]["drone_1"]
    assert first["seed"] == seeds[0]
    assert [first["episode"]] + [env.reset()[1]["drone_0"]["episode"] for _ in range(7)] == flown[0]
    spaces = [cosfly.parallel_env(RECIPE, num_drones=2).action_space("drone_0").sample() for _ in range(2)]
    assert (spaces[0] != spaces[1]).any()


def test_actions_that_no_drone_can_fly_are_refused_by_the_drones_name():
    env = cosfly.parallel_env(RECIPE, num_drones=2)
    still = np.zeros(5, dtype=np.float32)
    with pytest.raises(Exception, match="reset"):
        env.step({"drone_0": still, "drone_1": still})
    env.reset(seed=1)
    for wrong, words in [
        (np.full(5, np.nan), "NaN at row 1, column 0"),
        (np.full(5, 1e23), "row 1, column 0"),
        (np.zeros(4), "drone_1: actions have the shape"),
        (None, "drone_1: actions are of type object"),
    ]:
        with pytest.raises(ValueError, match=words):
            env.step({"drone_0": still, "drone_1": wrong})
    with pytest.raises(ValueError, match="the drones that fly"):
        env.step({"drone_0": still})
    with pytest.raises(ValueError, match="the drones that fly"):
        env.step({"drone_0": still, "drone_1": still, "drone_7": still})
