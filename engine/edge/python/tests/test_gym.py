"""Environments for gymnasium: the checker, the three modes of autoreset, seeds, the expert's actions."""

import warnings
from pathlib import Path

import numpy as np
import pytest

gym = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import cosfly  # noqa: E402
import cosfly.gym  # noqa: E402, F401 (registers the environments)

ID = "cosfly/Track-v0"
ALL = ("state", *cosfly.gym.CHANNELS, *cosfly.gym.SENSORS)


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


@pytest.mark.parametrize("obs", [("depth",), ("rgb",), ALL])
def test_the_checker_finds_nothing_in_pictures(obs):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(minimum|maximum) value.*infinity.*")
        warnings.filterwarnings("ignore", message=".*symmetric and normalized space.*")
        # Depth is in metres, and masks are 0 or 1; pictures are taken by smaller networks than those the checker thinks of.
        warnings.filterwarnings("ignore", message=".*(looks like an image|not an image|box observation space|unconventional).*")
        check_env(gym.make(ID, recipe="small/recipe.toml", obs=obs, size=48).unwrapped, skip_render_check=True)


def test_channels_are_those_of_datasets():
    dataset = cosfly.Dataset("data", channels=("rgb", "depth", "semantic", "instance"))
    for name, image in dataset.frame(dataset.trajectory_ids[0], 0).items():
        channel = cosfly.gym.CHANNELS[name]
        assert image.dtype == channel.dtype and image.shape[2:] == ((channel.values,) if channel.values > 1 else ())
    space = make_vec(num_envs=1, obs=ALL, size=(16, 8), max_depth_m=50.0).single_observation_space
    assert {name: (box.dtype, box.shape) for name, box in space.items() if name in cosfly.gym.CHANNELS} == {
        name: (np.dtype(it.dtype), (8, 16) if it.values == 1 else (8, 16, it.values))
        for name, it in cosfly.gym.CHANNELS.items()
    }
    assert (space["depth"].high == 50.0).all() and (space["mask"].high == 1).all()
    assert all(channel.doc.endswith(".") for channel in cosfly.gym.CHANNELS.values())
    with pytest.raises(ValueError, match="flow_forward.* channels of films"):
        make_vec(num_envs=1, obs=("flow_forward",))


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_readings_of_sensors_are_observations(mode):
    envs = make_vec(mode, num_envs=2, obs=("state", "laser_altimeter"))
    envs.reset(seed=3)
    for _ in range(20):
        seen, _, _, _, infos = envs.step(np.zeros((2, 5)))
        state, (range_m, is_hit) = seen["state"], seen["laser_altimeter"].T
        # What is below is the ground, or something on it.
        above = state[:, cosfly.gym.STATE.index("above_ground_m")]
        assert ((range_m > 0) & (range_m <= above + 0.1) & (is_hit == 1)).all()
    assert "laser_altimeter" not in infos and "last_laser_altimeter" not in infos
    alone = make_vec(num_envs=2, obs=("laser_altimeter",))
    assert alone.single_observation_space.shape == (2,) and alone.reset(seed=3)[0].dtype == np.float32
    sensor = cosfly.gym.SENSORS["laser_altimeter"]
    assert list(sensor.quantities) == ["range_m", "is_hit"] and sensor.doc.endswith(".")


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_pictures_do_not_depend_on_threads_or_on_who_is_beside(mode):
    obs = ALL
    many = make_vec(mode, num_envs=5, obs=obs, size=(64, 40), jobs=2, expert_action=True)
    few = make_vec(mode, num_envs=2, obs=obs, size=(64, 40), jobs=1, expert_action=True)
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


def test_without_copies_the_same_arrays_have_the_same_values():
    for mode in (AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP):
        apart, kept = (make_vec(mode, 4, obs=("state", "depth"), size=16, expert_action=True, copy=it) for it in (True, False))
        (wanted, _), (first, told) = apart.reset(seed=3), kept.reset(seed=3)
        ended = 0
        for _ in range(150):
            wanted, *rest, info = apart.step(np.zeros((4, 5)))
            given, *other, told = kept.step(np.zeros((4, 5)))
            assert all(given[name] is first[name] and np.array_equal(given[name], wanted[name]) for name in wanted)
            assert all(np.array_equal(one, two) for one, two in zip(rest, other))
            names = [name for name in info if name.startswith("reward_") or name in ("tracked", "expert_action")]
            assert len(names) == 8 and all(np.array_equal(info[name], told[name]) for name in names)
            if "final_obs" in info:
                number = int(np.flatnonzero(info["_final_obs"])[0])
                assert np.array_equal(info["final_obs"][number]["depth"], told["final_obs"][number]["depth"])
                assert not np.shares_memory(told["final_obs"][number]["state"], given["state"])
                ended += 1
        assert ended > 0 or mode == AutoresetMode.NEXT_STEP


def test_steps_do_not_depend_on_threads():
    alone, beside = (make_vec(num_envs=200, jobs=jobs) for jobs in (1, 3))
    assert np.array_equal(alone.reset(seed=3)[0], beside.reset(seed=3)[0])
    for step in range(60):
        actions = np.full((200, 5), 0.1 * step)
        one, two = alone.step(actions), beside.step(actions)
        assert all(np.array_equal(a, b) for a, b in zip(one[:4], two[:4]))


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
    night, pictures = {"stages.frames.weathers": ["HardRainNight"]}, {}
    for name, named in (("own", {}), ("noon", {"weather": "ClearNoon"}), ("full", {"look": "full"})):
        envs = make_vec(num_envs=2, obs=("rgb",), size=48, set=night, **named)
        pictures[name] = envs.reset(seed=1)[0].astype(float)
    assert pictures["own"].mean() < pictures["noon"].mean() - 20
    assert np.abs(pictures["own"] - pictures["full"]).mean() > 2


def test_what_is_not_there_is_refused():
    with pytest.raises(ValueError, match="state, rgb, depth"):
        make_vec(obs=("thermal",))
    with pytest.raises(ValueError, match="ClearNoon"):
        make_vec(obs=("rgb",), weather="Frogs")
    with pytest.raises(cosfly.WrongType, match="recipe of environments"):
        gym.make(ID, recipe={"name": "a"})
    with pytest.raises(ValueError, match="simple, full"):
        make_vec(obs=("rgb",), look="pretty")
    with pytest.raises(ValueError, match="8 to 2048"):
        make_vec(obs=("depth",), size=4)
    with pytest.raises(ValueError, match="shape"):
        envs = make_vec(num_envs=2)
        envs.reset(seed=1)
        envs.step(np.zeros((3, 5), dtype=np.float32))


def test_one_observation_may_be_named_without_a_list():
    named, listed = (make_vec(num_envs=2, obs=obs, size=16).reset(seed=1)[0] for obs in ("depth", ("depth",)))
    assert named.shape == (2, 16, 16) and (named == listed).all()


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
    with pytest.raises(cosfly.Error, match="latency_ms"):
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


@pytest.mark.parametrize("vectorization", ["sync", "vector_entry_point"])
def test_environments_without_a_seed_differ_and_their_seeds_repeat_them(vectorization):
    def names(envs, **given):
        # The start tells episodes apart where an environment does not tell its name.
        return [tuple(np.asarray(envs.reset(**(given if number == 0 else {}))[0])[:, :3].ravel().round(3)) for number in range(6)]

    made = [gym.make_vec(ID, num_envs=4, vectorization_mode=vectorization, recipe="small/recipe.toml") for _ in range(3)]
    first, second = names(made[0]), names(made[1])
    assert first != second, "two processes or calls are no copies of each other"
    rows = np.array(first).reshape(6, 4, 3)
    assert any((rows[:, 0] != rows[:, number]).any() for number in range(1, 4)), "nor are environments side by side"
    _, info = made[2].reset()
    seeds = [int(seed) for seed in info["seed"]]
    assert len(set(seeds)) == 4 and info["_seed"].all()
    again = names(made[0], seed=seeds)
    assert names(made[1], seed=seeds) == again, "seeded environments are equal"


def test_the_seed_that_was_drawn_repeats_a_run():
    def flown(env, seed=None):
        starts = [env.reset(seed=seed)[0]] + [env.reset()[0] for _ in range(5)]
        return np.array(starts)

    for make in (lambda: gym.make(ID, recipe="small/recipe.toml"), lambda: make_vec(num_envs=3)):
        env = make()
        first = flown(env)
        seed = env.unwrapped.np_random_seed
        assert (flown(make(), seed) == first).all()
        assert isinstance(seed, int) and seed >= 0
    assert not (gym.make(ID, recipe="small/recipe.toml").action_space.sample() == gym.make(ID, recipe="small/recipe.toml").action_space.sample()).all()


@pytest.mark.parametrize(
    "wrong, words",
    [
        (np.nan, "NaN at row 1, column 2"),
        (-np.inf, "-inf at row 1, column 2"),
        (1e23, "at row 1, column 2; it must be a number within 1000000"),
    ],
)
def test_numbers_that_no_action_has_are_refused_with_their_place(wrong, words):
    envs = make_vec(num_envs=2)
    before, _ = envs.reset(seed=1)
    for dtype in (np.float32, np.float64):
        actions = np.zeros((2, 5), dtype=dtype)
        actions[1, 2] = wrong
        with pytest.raises(ValueError, match=words.replace("+", ".")):
            envs.step(actions)
    env = gym.make(ID, recipe="small/recipe.toml").unwrapped
    env.reset(seed=1)
    with pytest.raises(ValueError, match="row 0, column 2"):
        env.step([0, 0, wrong, 0, 0])


@pytest.mark.parametrize(
    "actions, words",
    [
        (np.zeros((2, 4)), "shape"),
        (np.zeros(5), "shape"),
        (np.zeros((2, 5), dtype=bool), "type bool"),
        (np.zeros((2, 5), dtype=complex), "type complex"),
        (np.full((2, 5), None), "type object"),
        ([["a"] * 5] * 2, "type <U1"),
        ([[0] * 5, [0]], "no array of numbers"),
    ],
)
def test_actions_of_other_types_and_shapes_are_refused(actions, words):
    envs = make_vec(num_envs=2)
    envs.reset(seed=1)
    with pytest.raises(ValueError, match=words):
        envs.step(actions)
    # Whole numbers and every size of floats are numbers.
    for dtype in (np.float16, np.int64, np.uint8, np.longdouble, ">f8"):
        envs.step(np.ones((2, 5), dtype=dtype))
    envs.step(np.asfortranarray(np.ones((2, 5))))


def test_calls_that_make_no_sense_are_refused():
    for number in (0, -1, 1 << 40):
        with pytest.raises(ValueError, match="num_envs"):
            cosfly.gym.TrackVector("small/recipe.toml", number)
    with pytest.raises(TypeError):
        cosfly.gym.TrackVector("small/recipe.toml", 1.5)
    with pytest.raises(ValueError, match="jobs"):
        cosfly.gym.TrackVector("small/recipe.toml", 1, jobs=0)
    with pytest.raises(TypeError, match="a dictionary"):
        cosfly.gym.TrackVector("small/recipe.toml", 1, set="a=b")
    envs = cosfly.gym.TrackVector("small/recipe.toml", 3)
    with pytest.raises(gym.error.ResetNeeded):
        envs.step(np.zeros((3, 5)))
    with pytest.raises(gym.error.ResetNeeded):
        envs.reset(options={"reset_mask": np.array([True, False, False])})
    envs.reset(seed=1)
    for mask in ([True], [True] * 4, np.ones((3, 1), dtype=bool), [1, 0, 0], [False] * 3, "yes"):
        with pytest.raises(ValueError, match="reset_mask"):
            envs.reset(options={"reset_mask": mask})
    for seed in (-1, [1, 2], [1, 2, 3.5], [1, 2, -3]):
        with pytest.raises(ValueError, match="seed"):
            envs.reset(seed=seed)
    with pytest.raises(gym.error.ResetNeeded):
        cosfly.gym.Track("small/recipe.toml").step(np.zeros(5))


def test_options_of_a_reset_are_named():
    one, many = gym.make(ID, recipe="small/recipe.toml"), make_vec(num_envs=2)
    with pytest.raises(cosfly.InvalidValue, match="no key 'epsode'; did you mean `episode`"):
        one.reset(options={"epsode": "x"})
    with pytest.raises(cosfly.InvalidValue, match="no key 'episode'; there is `reset_mask`"):
        many.reset(options={"episode": "x"})
    with pytest.raises(cosfly.WrongType):
        one.reset(options=[("episode", "x")])
    name = one.unwrapped.episodes()[0]
    assert one.reset(options={"episode": name})[1]["episode"] == name
    one.reset(options={}), many.reset(options={})
    for environment in (one, many):  # LeRobot gives a key of its own
        with pytest.warns(UserWarning, match="has no key 'lerobot_new_rollout', which does nothing"):
            environment.reset(options={"lerobot_new_rollout": True})
    with pytest.raises(cosfly.WrongType, match="it is a name, such as"):
        one.reset(options={"episode": 3})
    with pytest.raises(cosfly.InvalidValue, match=f"no episode 'nobody'; there are {name}"):
        one.reset(options={"episode": "nobody"})


@pytest.mark.parametrize(
    "options", [{"look": "ful"}, {"weather": "Sunny"}, {"size": "x"}, {"size": (8, 8, 8)}, {"step_s": "x"}, {"latency_s": -1}, {"jobs": "x"}, {"max_depth_m": "x"}]
)
def test_settings_are_refused_by_name_whether_they_are_used_or_not(options):
    with pytest.raises(cosfly.Error, match=next(iter(options))):
        gym.make(ID, recipe="small/recipe.toml", **options)
