"""Scenarios, compiled policies and a Gymnasium environment for whisker-based active touch.

`docs/python.md` of the repository describes the package. Lengths are in metres, angles in radians, times in seconds.
"""

import warnings as _warnings

from . import _mujoco
from ._native import (
    Command,
    Control,
    Episode,
    Error,
    Machine,
    Observation,
    Parameter,
    Result,
    Rig,
    Text,
    Trial,
    compile,
    policies,
    rigs,
    scenarios,
)

__all__ = [
    "Command",
    "Control",
    "Episode",
    "Error",
    "Machine",
    "Observation",
    "Parameter",
    "PolicyWarning",
    "Result",
    "Rig",
    "Text",
    "Trial",
    "compile",
    "policies",
    "rigs",
    "run",
    "scenarios",
]

_mujoco.find()


class PolicyWarning(UserWarning):
    """A probable mistake in the text of a policy."""


def run(scenario, policy=None, *, samples=False, **options):
    """Run and score a trial, and return its `Result`.

    `scenario` is a path, the name of a built-in scenario, or a `Text`. `policy` is a path, the name of a built-in policy,
    a `Text` or a `Machine`. The other options are those of `Trial`. With `samples=True`, the result has the samples of
    the sensors.
    """
    trial = Trial(scenario, policy, **options)
    if trial.warnings:
        _warnings.warn(trial.warnings, PolicyWarning, stacklevel=2)
    return trial.run(samples=samples)
