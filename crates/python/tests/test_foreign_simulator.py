"""The example of a model that is not Vibrissa's: a compiled policy traces a box in it."""

import numpy as np
import pytest
from conftest import ROOT

pytest.importorskip("mujoco", reason="the example has its own model for MuJoCo")


@pytest.fixture
def example(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "examples/foreign_simulator"))
    import foreign_simulator

    return foreign_simulator


def test_distances_are_those_of_a_turned_square(example):
    half, yaw = example.BOX_SIDE / 2, example.BOX_YAW
    rotation = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    local = np.array([[half, 0.1], [half + 0.01, 0], [0, -half + 0.02], [half + 0.03, half + 0.04], [0, 0]])
    distances = example.distance_to_box(local @ rotation.T + example.BOX_CENTRE)
    assert distances == pytest.approx([0, 0.01, 0.02, 0.05, half], abs=1e-12)


def test_a_compiled_policy_traces_a_side_in_a_model_of_its_user(example, tmp_path):
    recording = tmp_path / "run.mcap"
    tips, deviations, end = example.trace("thesis", friction=0.0, time_limit_s=20.0, recording=recording)
    assert end == "running after 20.0 s"
    assert np.ptp(tips, axis=0).max() > 0.2, "more than half a side"
    errors = example.distance_to_box(tips)
    assert errors.mean() < 0.7e-3, "the mean error that the baseline reports for a box"
    assert np.mean(errors < 1.96 * deviations) > 0.9
    assert recording.read_bytes().startswith(b"\x89MCAP0\r\n")
