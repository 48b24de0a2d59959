"""The programs in the folder of examples."""

import numpy as np
import pytest
from conftest import ROOT

import vibrissa


@pytest.fixture(autouse=True)
def folder(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "crates/python/examples"))


def test_a_figure_has_the_error_of_the_run():
    from figure import FIGURES, distances_m

    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    points = np.array([[0.5, 0.1], [1.3, 1.4], [0.5, -0.2], [0.02, 0.5]])
    assert distances_m(points, [square]) == pytest.approx([0.1, 0.5, 0.2, 0.02])
    assert set(FIGURES) < set(vibrissa.scenarios())

    trial = vibrissa.Trial("box", "thesis", world="quasistatic")
    result = trial.run()
    tips = result.ticks["tip_m"][result.ticks["recorded"]]
    errors = distances_m(tips, trial.outlines()) * 1e3
    assert errors.mean() == pytest.approx(result.figures["error_mm"]["mean"], rel=0.02)


def test_the_rate_of_environments_is_that_of_their_steps():
    import gymnasium
    from vector_rate import rate

    slow, fast = (rate(gymnasium.make_vec("Vibrissa-v0", num_envs=count, time_limit_s=5.0), 60) for count in (1, 2))
    assert slow > 30 and fast > 30, "faster than real time"
