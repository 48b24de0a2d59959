"""What the tests share."""

import json
import os
import pathlib
import subprocess

import pytest

#: The repository.
ROOT = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def program():
    """The program, which has been built from the same code. It returns what it prints as JSON."""
    path = pathlib.Path(os.environ["VIBRISSA_PROGRAM"])

    def run(*arguments):
        ended = subprocess.run([path, *arguments, "--json"], cwd=ROOT, capture_output=True, text=True)
        assert ended.returncode in (0, 1), ended.stderr
        return json.loads(ended.stdout)

    return run


def timeless(figures):
    """Figures without the origin, those that depend on the clock, and without those of the bench alone."""
    clock = {"format", "version", "provenance", "start_s", "wall_s", "realtime", "tick_us"}
    bench = {"conditions", "baseline", "verdicts", "passed"}
    figures = {key: value for key, value in figures.items() if key not in clock | bench}
    if figures["calibration"]:
        figures["calibration"] = {key: value for key, value in figures["calibration"].items() if key != "cached"}
    return figures
