"""Pickling: objects pass to other processes and back."""

import copy
import multiprocessing
import pickle
import re
from concurrent.futures import ProcessPoolExecutor

import gymnasium
import numpy as np
import pytest
from conftest import ROOT, timeless

import vibrissa
import vibrissa.gym

QUICK = dict(world="quasistatic", time_limit_s=5.0)


def again(value, protocol=None):
    return pickle.loads(pickle.dumps(value, protocol))


def same_arrays(found, expected):
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert found[name].dtype == values.dtype and found[name].tobytes() == values.tobytes(), name


def same_results(found, expected):
    assert found.figures == expected.figures
    for arrays in ["ticks", "plots", "samples"]:
        if getattr(expected, arrays) is None:
            assert getattr(found, arrays) is None
        else:
            same_arrays(getattr(found, arrays), getattr(expected, arrays))
    for name in ["outcome", "reason", "violations", "whiskers", "states", "messages"]:
        assert getattr(found, name) == getattr(expected, name), name
    assert found.picture() == expected.picture()
    assert repr(found) == repr(expected)


@pytest.mark.parametrize(
    "scenario, policy, options",
    [
        ("disk", "vibrissa", dict(samples=True)),
        # A policy with marks, and a run without samples.
        (ROOT / "scenarios/octagon.yaml", ROOT / "policies/thesis.fsm", {}),
        # A policy that logs and plots, and fails.
        ("disk", vibrissa.Text(
            'machine told\n\nwhisker r0\n\ninitial Told\n\nstate Told {\n  plot bend = r0.base_angle\n  log "told", r0\n  stop\n'
            '  when true for 1 s -> Failure("enough")\n}\n'
        ), {}),
    ],
)
def test_a_result_is_the_same_afterwards(scenario, policy, options):
    result = vibrissa.run(scenario, policy, **QUICK, **options)
    found = again(result)
    same_results(found, result)
    same_results(again(found), result)


def test_a_pool_of_spawned_processes_runs_trials_and_returns_results():
    seeded = dict(seed=4, jitter=(0.01, 0.1), set={"speed": "40 mm/s"})
    trials = [vibrissa.Trial(scenario, "vibrissa", **seeded, **QUICK) for scenario in ["disk", "wall"]]
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        results = list(pool.map(vibrissa.Trial.run, trials))
        failed = pool.submit(vibrissa.run, "nowhere.yaml")
        with pytest.raises(vibrissa.Error, match="cannot read nowhere.yaml"):
            failed.result()
    for trial, result in zip(trials, results):
        assert timeless(result.figures) == timeless(trial.run().figures)
        same_arrays(result.ticks, trial.run().ticks)


@pytest.mark.parametrize(
    "value",
    [
        vibrissa.Text("name: mine", "mine.yaml"),
        vibrissa.Text("text\0 with ümlaut"),
        vibrissa.compile("thesis"),
        vibrissa.compile("vibrissa", set={"speed": "40 mm/s"}),
        vibrissa.compile(vibrissa.Text("machine still\n\ninitial Still\n\nstate Still { stop }\n")),
        *vibrissa.compile("vibrissa").parameters,
        vibrissa.Rig(),
        vibrissa.Rig(ROOT / "scenarios/more/thesis-array-box.yaml"),
        vibrissa.Trial("disk", mismatch=ROOT / "scenarios/mismatch/array.yaml", mismatch_seed=3, uncalibrated=True).rig,
        vibrissa.compile("vibrissa").start().tick(0.1, [0, 0], 0.5, [0, 0]),
    ],
    ids=repr,
)
def test_inputs_are_equal_afterwards(value):
    for found in [copy.deepcopy(value), *(again(value, protocol) for protocol in range(pickle.HIGHEST_PROTOCOL + 1))]:
        assert found == value and hash(found) == hash(value)
        assert repr(found) == repr(value)
    assert value != vibrissa.Text("another one")


def test_machines_and_rigs_are_unequal_if_anything_differs():
    assert vibrissa.compile("vibrissa") != vibrissa.compile("vibrissa", set={"speed": "40 mm/s"})
    assert vibrissa.Rig("disk") == vibrissa.Rig() != vibrissa.Rig.load("thesis_array")
    assert again(vibrissa.compile(vibrissa.Text("machine a\n\ninitial A\n\nstate A { stop }\n"))).warnings != ""


def test_what_an_episode_shows_is_the_same_afterwards():
    episode = vibrissa.Trial("disk", "vibrissa", world="quasistatic", time_limit_s=0.2).begin()
    while True:
        seen = episode.step(0.1, 0.0, 0.1)
        for name in (name for name in dir(seen) if not name.startswith("_")):
            assert np.array_equal(getattr(again(seen), name), getattr(seen, name)), name
        if seen.outcome:
            break
    result = episode.result()
    same_results(again(result), result)


def test_a_trial_whose_file_has_changed_is_refused(tmp_path):
    file = tmp_path / "mine.yaml"
    text = (ROOT / "scenarios/disk.yaml").read_text()
    file.write_text(text)
    trial = vibrissa.Trial(file, "vibrissa", **QUICK)
    pickled = pickle.dumps(trial)
    assert timeless(pickle.loads(pickled).run().figures) == timeless(trial.run().figures)
    file.write_text(text.replace("radius: 300 mm", "radius: 200 mm").replace("radius: 0.3 m", "radius: 0.2 m") + "\n")
    with pytest.raises(vibrissa.Error, match="has changed since the trial was pickled"):
        pickle.loads(pickled)


def test_the_dictionary_of_a_pickled_trial_is_that_of_its_start():
    settings = {"speed": "40 mm/s"}
    trial = vibrissa.Trial("disk", "vibrissa", set=settings, **QUICK)
    settings["speed"] = "10 mm/s"
    assert timeless(again(trial).run().figures) == timeless(trial.run().figures)


@pytest.mark.parametrize(
    "live, advice",
    [
        (lambda: vibrissa.compile("vibrissa").start(), "pickle its `Machine` and its `Rig`"),
        (lambda: vibrissa.Trial("disk", world="quasistatic").begin(), "pickle its `Trial`"),
        (lambda: reset(vibrissa.gym.WhiskerEnv()), "make an environment in the other process"),
        (lambda: reset(gymnasium.make("Vibrissa-v0")), "make an environment in the other process"),
    ],
)
def test_what_is_alive_says_what_to_pickle_instead(live, advice):
    value = live()
    for attempt in (pickle.dumps, copy.deepcopy):
        with pytest.raises(TypeError, match=re.escape(advice)):
            attempt(value)


def reset(environment):
    environment.reset(seed=0)
    return environment


def test_an_environment_without_an_episode_gives_the_same_episodes_afterwards():
    environment = vibrissa.gym.WhiskerEnv("wall", jitter=(0.02, 0.3))
    seen, _ = again(environment).reset(seed=3)
    expected, _ = environment.reset(seed=3)
    assert all(np.array_equal(seen[name], expected[name]) for name in expected)
