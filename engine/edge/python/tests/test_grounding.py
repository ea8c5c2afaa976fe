"""The reward for saying where the target is: true answers get all of it, and nothing else of an environment changes."""

import warnings

import numpy as np
import pytest

gym = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import cosfly.gym  # noqa: E402, F401 (registers the environments)
from cosfly.grounding import GROUNDING, Grounded, GroundedVector, boxes_of, grounding_rewards, overlaps  # noqa: E402

ID = "cosfly/Track-v0"


def make_vec(mode=AutoresetMode.NEXT_STEP, obs=("state", "mask"), **more):
    return gym.make_vec(
        ID, num_envs=3, vectorization_mode="vector_entry_point", recipe="small/recipe.toml", autoreset_mode=mode, size=32,
        expert_action=True, obs=obs, **more,
    )


def test_boxes_hold_the_pixels_of_their_masks():
    drawn = np.random.default_rng(1).random((50, 7, 9)) > 0.97
    for mask, box in zip(drawn, boxes_of(drawn)):
        rows, columns = np.nonzero(mask)
        if len(rows) == 0:
            assert np.isnan(box).all()
        else:
            assert np.allclose(box, [columns.min() / 9, rows.min() / 7, (columns.max() + 1) / 9, (rows.max() + 1) / 7])
    assert boxes_of(np.ones((4, 6))).tolist() == [0, 0, 1, 1]


def test_rewards_are_those_of_the_page():
    box, seen = np.array([0.2, 0.2, 0.6, 0.4]), lambda *edges: np.array([*edges, 1.0])
    assert overlaps(box, [0.4, 0.2, 0.8, 0.4]) == pytest.approx(1 / 3) and overlaps(box, [0.7, 0.7, 0.6, 0.6]) == 0
    assert grounding_rewards(seen(*box), box) == pytest.approx(1.0)
    assert grounding_rewards(np.array([*box, 0.25]), box) == pytest.approx(0.25)
    assert grounding_rewards(seen(*box), np.full(4, np.nan)) == 0
    assert grounding_rewards(np.array([*box, 0.0]), np.full(4, np.nan)) == 1


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize("copy", [True, False])
def test_true_answers_get_the_whole_reward_and_change_nothing_else(mode, copy):
    plain, grounded = make_vec(mode, copy=copy), GroundedVector(make_vec(mode, copy=copy), weight=0.5)
    assert grounded.action_space.shape == (3, 5 + len(GROUNDING)) and grounded.single_observation_space.shape == (16,)
    (seen, told), (state, info) = plain.reset(seed=7), grounded.reset(seed=7)
    begins, ends, unseen = np.zeros(3, bool), 0, 0
    for step in range(180):
        assert np.array_equal(seen["state"], state)
        box = info["target_box"].copy()
        assert np.array_equal(np.isnan(box[:, 0]), ~seen["mask"].any((1, 2)))
        unseen += np.isnan(box).any()
        actions = told["expert_action"].copy() * (step < 80)  # later it stands still, and loses its targets
        answers = np.column_stack([np.nan_to_num(box), ~np.isnan(box[:, 0])])
        seen, rewards, terminated, truncated, told = plain.step(actions)
        rewards, terminated, truncated = rewards.copy(), terminated.copy(), truncated.copy()
        state, sums, *ended, info = grounded.step(np.column_stack([actions, answers]))
        assert np.allclose(info["reward_grounding"], np.where(begins, 0.0, 1.0))
        assert np.allclose(sums, rewards + 0.5 * info["reward_grounding"])
        assert np.array_equal(ended, [terminated, truncated])
        if mode == AutoresetMode.SAME_STEP and (terminated | truncated).any():
            assert all(one is None or one.shape == (16,) for one in info["final_obs"])
        begins = (terminated | truncated) & (mode == AutoresetMode.NEXT_STEP)
        ends += (terminated | truncated).sum()
    assert ends > 2 and unseen > 2


def test_one_environment_passes_the_checker_and_is_rewarded():
    env = Grounded(gym.make(ID, recipe="small/recipe.toml", obs=("state", "mask"), size=192, disable_env_checker=True))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(infinity|symmetric and normalized|is not within|different from the unwrapped).*")
        check_env(env, skip_render_check=True)
    _, info = env.reset(seed=2)
    box = info["target_box"]
    assert not np.isnan(box).any()
    _, reward, _, _, info = env.step(np.array([0, 0, 0, 0, 0, *box, 1.0]))
    assert info["reward_grounding"] == pytest.approx(1.0) and reward > 0.5
    assert not np.isnan(info["target_box"]).any()
    _, _, _, _, info = env.step(np.zeros(10))
    assert info["reward_grounding"] == 0.0


def test_what_cannot_be_grounded_is_refused():
    with pytest.raises(ValueError, match="needs the observation `mask`"):
        GroundedVector(make_vec(obs=("state",)))
    with pytest.raises(ValueError, match="needs the observation `mask` beside another"):
        GroundedVector(make_vec(obs=("mask",)))
    with pytest.raises(ValueError, match="weight"):
        GroundedVector(make_vec(), weight=float("nan"))
    envs = GroundedVector(make_vec(), shows_mask=True)
    assert set(envs.single_observation_space.spaces) == {"state", "mask"}
    one = Grounded(gym.make(ID, recipe="small/recipe.toml", obs=("state", "mask"), disable_env_checker=True))
    for begun_by_none in (envs, one):
        with pytest.raises(gym.error.ResetNeeded):
            begun_by_none.step(begun_by_none.action_space.sample())
    envs.reset(seed=1)
    with pytest.raises(ValueError, match=r"shape \(3, 5\); it is \(3, 10\)"):
        envs.step(np.zeros((3, 5)))
    with pytest.raises(ValueError, match="no finite number"):
        envs.step(np.full((3, 10), np.nan))
