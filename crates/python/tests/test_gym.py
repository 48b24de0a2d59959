"""The Gymnasium environment."""

import gymnasium
import numpy as np
import pytest
from conftest import ROOT, timeless
from gymnasium.utils.env_checker import check_env

import vibrissa
import vibrissa.gym


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"world": "mujoco"},
        {"render_mode": "rgb_array"},
        {"scenario": "wall", "jitter": (0.02, 0.3), "mismatch": ROOT / "scenarios/mismatch/plausible.yaml"},
    ],
)
def test_gymnasiums_checker_accepts_the_environment(options):
    environment = gymnasium.make("Vibrissa-v0", time_limit_s=1.0, **options)
    check_env(environment.unwrapped)


def follow(environment, seed=0):
    """Follow the surface on the right by the base angle of the right whisker, as `bang.fsm` does. The sum of the rewards."""
    seen, _ = environment.reset(seed=seed)
    total, over = 0.0, False
    while not over:
        bend = abs(seen["deflection"][0])
        heading = np.deg2rad(-15 if bend < 150e-6 else 25)
        action = [0.5 * np.cos(heading), 0.5 * np.sin(heading), np.deg2rad(-10 if bend < 150e-6 else 3)]
        seen, reward, terminated, truncated, info = environment.step(action)
        total += reward
        over = terminated or truncated
    return total, terminated, info


def test_an_agent_that_follows_the_surface_is_rewarded_with_the_traced_length():
    environment = vibrissa.gym.WhiskerEnv("disk", render_mode="svg")
    environment.reset(seed=0)
    # The platform starts beside the disk, and bang.fsm first drives to it.
    total, terminated, info = follow(environment)
    figures = info["figures"]
    [outline] = vibrissa.Trial("disk").outlines()
    length = np.sum(np.hypot(*np.diff(outline, axis=0).T))
    traced = figures["coverage"] * length
    cost = vibrissa.gym.TOUCH_COST * round(figures["collisions"]["time_s"] * 30)
    assert figures["coverage"] > 0.5
    assert total == pytest.approx(vibrissa.gym.TRACED_PER_M * traced - cost, abs=1.0)
    assert terminated == (figures["outcome"] in ("completed", "ended", "failed"))
    assert info["outcome"] == figures["outcome"]
    assert environment.render().startswith("<svg")


def test_the_same_seed_gives_the_same_episode_and_another_seed_another_one():
    environment = vibrissa.gym.WhiskerEnv("disk", jitter=(0.02, 0.1), time_limit_s=2.0)
    first, again, other = (timeless(follow(environment, seed)[2]["figures"]) for seed in (1, 1, 2))
    assert first == again
    assert first != other


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_several_environments_at_once_do_what_each_does_alone(mode):
    options = dict(jitter=(0.02, 0.1), time_limit_s=2.0)
    alone = [vibrissa.gym.WhiskerEnv("disk", **options) for _ in range(2)]
    together = gymnasium.make_vec("Vibrissa-v0", num_envs=2, vectorization_mode=mode, **options)
    seen, _ = together.reset(seed=[3, 4])
    expected = [environment.reset(seed=seed)[0] for environment, seed in zip(alone, [3, 4])]
    action = np.array([[0.5, 0.1, -0.1], [0.4, -0.2, 0.0]], dtype=np.float32)
    for _ in range(20):
        for name, values in seen.items():
            assert np.array_equal(values, [own[name] for own in expected]), name
        seen, rewards, *_ = together.step(action)
        steps = [environment.step(own) for environment, own in zip(alone, action)]
        expected = [step[0] for step in steps]
        assert np.array_equal(rewards, [step[1] for step in steps])
    together.close()


def test_the_scene_of_an_episode_may_depend_on_its_seed():
    drawn = []

    def scene(seed):
        drawn.append(seed)
        return vibrissa.scenarios()[seed % 3]

    environment = vibrissa.gym.WhiskerEnv(scene)
    for seed in range(6):
        environment.reset(seed=seed)
    assert len({seed % 3 for seed in drawn[1:]}) > 1


def test_a_step_needs_an_episode():
    environment = vibrissa.gym.WhiskerEnv("disk", time_limit_s=0.1)
    with pytest.raises(gymnasium.error.ResetNeeded):
        environment.step([0, 0, 0])
    follow(environment)
    with pytest.raises(vibrissa.Error, match="the episode is over"):
        environment.step([0, 0, 0])


def test_the_commands_of_the_caller_move_the_platform():
    environment = vibrissa.gym.WhiskerEnv("disk", speed_m_s=0.1)
    seen, _ = environment.reset(seed=0)
    start, cos_sin = seen["position_m"], seen["heading"]
    for _ in range(30):
        seen, *_ = environment.step([-1.0, 0.0, 0.0])
    # A second backwards, less the delay of the servos.
    moved = (seen["position_m"] - start) @ cos_sin
    assert moved == pytest.approx(-0.1, abs=0.015)


def test_each_step_has_a_frame_that_shows_where_the_platform_is():
    environment = vibrissa.gym.WhiskerEnv("disk", time_limit_s=1.0, render_mode="rgb_array")
    assert set(environment.metadata["render_modes"]) == {"rgb_array", "svg"}
    with pytest.raises(gymnasium.error.ResetNeeded):
        environment.render()
    environment.reset(seed=0)
    frames, over = [environment.render()], False
    while not over:
        _, _, terminated, truncated, _ = environment.step([0.0, 0.0, 1.0])
        frames.append(environment.render())
        over = terminated or truncated
    assert {(frame.shape, frame.dtype) for frame in frames} == {((600, 800, 3), np.dtype(np.uint8))}
    assert np.array_equal(environment.render(), frames[-1])
    # The platform has turned by a radian, and the disk and the white margin are where they were.
    changed = (frames[0] != frames[-1]).any(axis=2)
    assert 0.001 < changed.mean() < 0.1
    assert (frames[-1][0, 0] == 255).all() and len(np.unique(frames[-1].reshape(-1, 3), axis=0)) > 10
    environment.reset(seed=0)
    assert np.array_equal(environment.render(), frames[0])


def test_a_frame_keeps_its_size_and_follows_a_platform_that_leaves():
    environment = vibrissa.gym.WhiskerEnv("disk", speed_m_s=1.0, time_limit_s=3.0, render_mode="rgb_array")
    environment.reset(seed=0)
    first = environment.render()
    for _ in range(60):
        environment.step([-1.0, 0.0, 0.0])
    last = environment.render()
    inside = [(frame == [0xF1, 0xF3, 0xF5]).all(axis=2).sum() for frame in (first, last)]
    assert last.shape == first.shape and 1000 < inside[1] < 0.5 * inside[0], "the disk is smaller"


def test_gymnasium_records_frames():
    environment = gymnasium.make("Vibrissa-v0", time_limit_s=0.2, render_mode="rgb_array")
    environment = gymnasium.wrappers.RenderCollection(environment)
    follow(environment)
    assert len(environment.render()) >= 6


def test_an_unknown_render_mode_is_refused():
    with pytest.raises(ValueError, match="there are 'rgb_array' and 'svg'"):
        vibrissa.gym.WhiskerEnv(render_mode="human")
