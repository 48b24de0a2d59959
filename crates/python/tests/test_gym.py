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
