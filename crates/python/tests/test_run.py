"""Runs: the same figures as the program, and arrays that agree with them."""

import importlib.util
import json
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import ROOT, timeless

import vibrissa

BENCH = ROOT / "crates/python/examples/bench.py"


@pytest.mark.parametrize("world, scenarios", [("quasistatic", ["disk", "octagon", "smooth-tunnel"]), ("mujoco", ["disk"])])
def test_the_example_has_the_figures_of_the_program_to_the_last_digit(program, world, scenarios):
    printed = subprocess.run(
        [sys.executable, BENCH, "--json", world, *scenarios], capture_output=True, text=True, check=True
    )
    policies = [ROOT / f"policies/{name}.fsm" for name in vibrissa.policies()]
    files = [f"scenarios/{name}.yaml" for name in scenarios]
    expected = [program("run", *files, "--simulator", world, "--policy", policy) for policy in policies]
    by_scenario = [run for runs in zip(*expected) for run in runs]
    found = json.loads(printed.stdout)
    assert len(found) == 2 * len(scenarios)
    assert [timeless(run) for run in found] == [timeless(run) for run in by_scenario]


def test_options_have_the_effect_that_they_have_in_the_program(program):
    mismatch = "scenarios/mismatch/array.yaml"
    result = vibrissa.run(
        ROOT / "scenarios/disk.yaml",
        "vibrissa",
        world="quasistatic",
        seed=5,
        set={"speed": "40 mm/s"},
        mismatch=ROOT / mismatch,
        mismatch_seed=3,
    )
    options = ["--simulator", "quasistatic", "--seed", "5", "--set", "speed=40 mm/s"]
    options += ["--policy", "policies/vibrissa.fsm"]
    [expected] = program("run", ROOT / "scenarios/disk.yaml", *options, "--mismatch", ROOT / mismatch, "--mismatch-seed", "3")
    assert timeless(result.figures) == timeless(expected)


def test_a_built_in_scenario_needs_no_file(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    trial = vibrissa.Trial("disk")
    assert (trial.scenario, trial.policy) == ("disk", "thesis")


def test_the_arrays_of_ticks_are_those_that_the_program_writes(program, tmp_path):
    file = tmp_path / "ticks.jsonl"
    program("run", "scenarios/disk.yaml", "--simulator", "quasistatic", "--ticks", file)
    lines = [json.loads(line) for line in file.read_text().splitlines()]
    result = vibrissa.run("disk", world="quasistatic")
    ticks = result.ticks
    for key in ["time_s", "position_m", "heading_rad", "velocity_m_s", "yaw_rate_rad_s", "body_touches"]:
        assert np.array_equal(ticks[key], [line[key] for line in lines]), key
    assert [result.states[state] for state in ticks["state"]] == [line["state"] for line in lines]
    whiskers = [[whisker["whisker"] for whisker in line["whiskers"]] for line in lines]
    assert whiskers[0] == result.whiskers
    for key in ["deflection_rad", "touching", "springs", "inclination_rad", "tip_m", "tip_spread_m", "tangent", "recorded"]:
        nothing = [np.nan] * 2 if ticks[key].ndim == 3 else np.nan
        values = [[nothing if whisker[key] is None else whisker[key] for whisker in line["whiskers"]] for line in lines]
        assert np.array_equal(ticks[key], values, equal_nan=ticks[key].dtype == float), key


def test_the_arrays_of_marks_are_those_that_the_program_writes(program, tmp_path):
    file = tmp_path / "ticks.jsonl"
    program("run", "scenarios/box.yaml", "--simulator", "quasistatic", "--ticks", file)
    lines = [json.loads(line) for line in file.read_text().splitlines()]
    ticks = vibrissa.run("box", world="quasistatic").ticks
    for mark in ["lost", "found"]:
        made = [[mark in whisker["marks"] for whisker in line["whiskers"]] for line in lines]
        assert np.array_equal(ticks[mark], made) and ticks[mark].sum() >= 4


def test_recorded_tips_are_as_near_to_the_outline_as_the_figures_say():
    trial = vibrissa.Trial("disk", world="quasistatic")
    result = trial.run()
    tips = result.ticks["tip_m"][result.ticks["recorded"]]
    errors = np.abs(np.hypot(*(tips - [0.4, 0.4]).T) - 0.3)
    assert np.mean(errors) * 1e3 == pytest.approx(result.figures["error_mm"]["mean"], rel=1e-9)
    assert len(tips) == result.figures["error_mm"]["n"]
    [outline] = trial.outlines(1e-2)
    assert np.hypot(*(outline - [0.4, 0.4]).T) == pytest.approx(0.3, abs=1e-9)


def test_tips_from_elsewhere_have_the_score_of_a_run():
    trial = vibrissa.Trial("box", world="quasistatic")
    result = trial.run()
    tips = np.where(result.ticks["recorded"][..., None], result.ticks["tip_m"], np.nan)
    errors = trial.errors(tips)
    assert np.array_equal(np.isfinite(errors), result.ticks["recorded"])
    assert np.nanmean(errors) * 1e3 == pytest.approx(result.figures["error_mm"]["mean"], rel=1e-12)
    assert np.nanmax(errors) * 1e3 == result.figures["error_mm"]["max"]
    assert trial.coverage(tips) == result.figures["coverage"]
    assert trial.coverage(np.empty((0, 2, 2))) == 0
    assert vibrissa.Trial("disk").errors([0.4, 0.8]) == pytest.approx(0.1, abs=1e-9)
    with pytest.raises(vibrissa.Error, match="must be 2"):
        trial.errors(np.zeros((4, 3)))
    with pytest.raises(vibrissa.Error, match="needs three dimensions"):
        trial.coverage(np.zeros((4, 2)))


def test_errors_have_the_text_that_the_program_prints():
    with pytest.raises(vibrissa.Error, match=r"error\[P\d+\][^\0]*--> bad.fsm:1:"):
        vibrissa.run("disk", vibrissa.Text("machine bad  initial Nowhere", "bad.fsm"), world="quasistatic")
    with pytest.raises(vibrissa.Error, match="cannot read nowhere.yaml"):
        vibrissa.run("nowhere.yaml")
    with pytest.raises(vibrissa.Error, match="`speed` must lie between"):
        vibrissa.run("disk", set={"speed": "5 m/s"})
    with pytest.raises(vibrissa.Error, match="there are `mujoco` and `quasistatic`"):
        vibrissa.run("disk", world="earth")


def test_a_probable_mistake_is_a_warning():
    still = vibrissa.Text("machine still\n\ninitial Still\n\nstate Still { stop }\n", "still.fsm")
    with pytest.warns(vibrissa.PolicyWarning, match="cannot be left"):
        vibrissa.run("disk", still, world="quasistatic", time_limit_s=0.1)


def test_other_threads_go_on_during_a_run():
    count, done = 0, threading.Event()

    def run():
        vibrissa.run("disk", world="quasistatic")
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    while not done.is_set():
        count += 1
        time.sleep(0.001)
    thread.join()
    assert count > 10


def test_ctrl_c_ends_a_run():
    timer = threading.Timer(0.1, signal.raise_signal, [signal.SIGINT])
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        while time.monotonic() - start < 20:
            vibrissa.run("disk", world="quasistatic")
    timer.join()


def test_the_library_is_that_of_the_package_mujoco():
    if importlib.util.find_spec("mujoco") is None:
        pytest.skip("the package mujoco is not installed")
    with open("/proc/self/maps") as maps:
        vibrissa.run("disk", world="mujoco", time_limit_s=0.1)
        maps.seek(0)
        assert any("mujoco/libmujoco.so" in line for line in maps)


def test_without_a_library_the_error_says_what_to_do(tmp_path):
    code = "import vibrissa; vibrissa.run('disk', world='mujoco')"
    environment = {"VIBRISSA_MUJOCO": str(tmp_path / "none.so"), "PATH": ""}
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert "pip install mujoco==" in ended.stderr and "quasistatic" in ended.stderr, ended.stderr


def test_another_version_of_the_library_is_refused_before_the_first_model(tmp_path):
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler")
    source, library = tmp_path / "other.c", tmp_path / "libmujoco.so.4.0.0"
    source.write_text("int mj_version(void) { return 4000000; }\n")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source], check=True)
    code = "import vibrissa\ntry: vibrissa.run('disk', world='mujoco')\nexcept vibrissa.Error as error: print(error)"
    environment = {"VIBRISSA_MUJOCO": str(library), "PATH": ""}
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    for wanted in ["MuJoCo 3.17.0 is needed", f"{library} is MuJoCo 4.0.0", "pip install mujoco==3.17.0", "VIBRISSA_MUJOCO"]:
        assert wanted in ended.stdout, ended.stdout + ended.stderr
