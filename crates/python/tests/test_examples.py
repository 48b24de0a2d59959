"""The programs in the folder of examples, and its notebook."""

import re

import nbformat
import numpy as np
import pytest
from conftest import ROOT
from nbclient import NotebookClient

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


def test_the_retrievals_of_a_figure_are_those_of_the_run():
    from figure import retrievals

    for scenario, count in [("box", 4), ("octagon", 8), ("disk", 0)]:
        result = vibrissa.run(scenario, "thesis", world="quasistatic")
        edges, found = retrievals(result.ticks)
        assert len(edges) == len(found) == count
        if count:
            radius = np.hypot(*(found - edges).T).mean() * 1e3
            assert radius == pytest.approx(result.figures["retrieval"]["radius_mm"]["mean"], rel=1e-9)


def test_the_notebook_draws_the_figure_and_has_the_numbers_of_the_run(monkeypatch, tmp_path):
    for name in ["HOME", "IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "MPLCONFIGDIR"]:
        monkeypatch.setenv(name, str(tmp_path))
    examples = ROOT / "crates/python/examples"
    notebook = nbformat.read(examples / "figure.ipynb", as_version=nbformat.NO_CONVERT)
    nbformat.validate(notebook)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in cells), "outputs are not stored"

    NotebookClient(notebook, timeout=None, resources={"metadata": {"path": str(examples)}}).execute()
    outputs = [output for cell in cells for output in cell.outputs]
    assert ["image/png" in output.get("data", {}) for output in outputs].count(True) == 1
    [printed] = [output.text for output in outputs if output.get("name") == "stdout"]
    assert not any(output.get("name") == "stderr" for output in outputs)
    numbers = [float(number) for number in re.findall(r"[\d.]+", printed)]
    figures = vibrissa.run("box", "thesis", world="quasistatic").figures
    expected = [figures[key]["radius_mm"] if key == "retrieval" else figures[key] for key in ["error_mm", "retrieval"]]
    assert numbers == pytest.approx([part[key] for part in expected for key in ["mean", "std"]], abs=0.011)


def test_the_rate_of_environments_is_that_of_their_steps():
    import gymnasium
    from vector_rate import rate

    slow, fast = (rate(gymnasium.make_vec("Vibrissa-v0", num_envs=count, time_limit_s=5.0), 60) for count in (1, 2))
    assert slow > 30 and fast > 30, "faster than real time"
