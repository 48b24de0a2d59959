"""Compiled machines: bytes, and the same commands as in a simulation."""

import numpy as np
import pytest
from conftest import ROOT

import vibrissa


@pytest.mark.parametrize("policy", ["vibrissa", "thesis"])
def test_a_machine_repeats_the_commands_of_a_run_bit_for_bit(policy):
    trial = vibrissa.Trial("octagon", policy, world="quasistatic")
    result = trial.run(samples=True)
    samples, ticks = result.samples, result.ticks
    machine = vibrissa.Machine.load(vibrissa.compile(policy).to_bytes())
    control = machine.start(trial.rig)
    names = ["time_s", "position_m", "heading_rad", "base_angle_rad"]
    for tick, (velocity, yaw_rate) in enumerate(zip(ticks["velocity_m_s"], ticks["yaw_rate_rad_s"])):
        rows = samples["tick"] == tick
        command = control.tick(*(samples[name][rows] for name in names))
        assert command.velocity_m_s.tobytes() == velocity.tobytes(), tick
        assert command.yaw_rate_rad_s.hex() == yaw_rate.item().hex(), tick
        perceived = control.perceived()
        assert np.array_equal(perceived["deflection_rad"], ticks["deflection_rad"][tick])
        assert np.array_equal(perceived["touching"], ticks["touching"][tick])
        assert np.array_equal(perceived["recorded"], ticks["recorded"][tick])
        assert np.array_equal(perceived["tangent"], ticks["tangent"][tick], equal_nan=True)
        recorded = perceived["recorded"]
        assert np.array_equal(perceived["tip_m"][recorded], ticks["tip_m"][tick][recorded])
    assert len(ticks["time_s"]) > 1000
    assert control.status == "running"


def test_a_recording_needs_samples_that_were_kept():
    machine = vibrissa.compile("thesis")
    row = (np.array([0.1]), np.zeros(2), np.zeros(1), np.zeros(len(vibrissa.Rig().whiskers)))
    control = machine.start()
    control.tick(*row)
    with pytest.raises(vibrissa.Error, match="record=True"):
        control.recording()
    control = machine.start(record=True)
    with pytest.raises(vibrissa.Error, match="no tick"):
        control.recording()
    control.tick(*row)
    assert control.recording().startswith(b"\x89MCAP0\r\n")


def test_a_closed_loop_is_perceived_in_the_tick_after_the_tip_that_closes_it():
    trial = vibrissa.Trial("disk", "vibrissa", world="quasistatic")
    result = trial.run(samples=True)
    assert result.outcome == "completed"
    control = vibrissa.compile("vibrissa").start(trial.rig)
    names = ["time_s", "position_m", "heading_rad", "base_angle_rad"]
    closed, early, never = [], [], []
    for tick in range(len(result.ticks["time_s"])):
        rows = result.samples["tick"] == tick
        control.tick(*(result.samples[name][rows] for name in names))
        perceived = control.perceived()
        assert perceived["loop_closed"].shape == (len(perceived["whisker"]),) and perceived["loop_closed"].dtype == bool
        closed.append(perceived["loop_closed"].any())
        early.append(control.perceived(closed_within_m=0.05)["loop_closed"].any())
        never.append(control.perceived(closed_after_s=1e6)["loop_closed"].any())
    assert not any(never)
    assert np.argmax(early) < len(closed) - 2
    # The scenario ends at the tip that closes the loop, and perception knows it a tick later.
    rows = result.samples["tick"] == len(closed) - 1
    time, *still = (result.samples[name][rows] for name in names)
    control.tick(time + 1 / 30, *still)
    assert control.perceived()["loop_closed"].any() and not any(closed)


def test_a_map_has_the_recorded_contour_whatever_the_policy():
    trial = vibrissa.Trial("disk", "vibrissa", world="quasistatic")
    result = trial.run(samples=True)
    machine = vibrissa.compile("vibrissa")
    control, without = machine.start(trial.rig, map=True), machine.start(trial.rig)
    names = ["time_s", "position_m", "heading_rad", "base_angle_rad"]
    for tick in range(len(result.ticks["time_s"])):
        rows = result.samples["tick"] == tick
        samples = [result.samples[name][rows] for name in names]
        assert control.tick(*samples) == without.tick(*samples), "a map changes no command"
    assert without.map() is None
    known = control.map()
    away = known["contour_m"] - [0.4, 0.4]
    assert np.abs(np.hypot(*away.T) - 0.3).max() < 1e-3
    assert known["contour_length_m"] == pytest.approx(2 * np.pi * 0.3, rel=0.02)
    assert (np.einsum("ij,ij->i", known["normal"], away) > 0.29).all(), "normals point to the whisker"
    assert len(known["whisker"]) == len(known["piece"]) == len(known["spread_m"]) == len(away)
    assert set(known["whisker"]) <= set(machine.whiskers)
    spans = known["free_m"]
    assert known["free_area_m2"] == pytest.approx(np.prod(spans[:, 2:] - spans[:, :2], axis=1).sum())
    middles = (spans[:, 2:] + spans[:, :2]) / 2
    assert (np.hypot(*(middles - [0.4, 0.4]).T) > 0.3).all(), "no free ground in the disk"
    assert known["blocked_m"].shape[1] == 4 and known["unknown_area_m2"] >= 0 and not known["is_complete"]


def test_the_bytes_are_those_that_the_program_compiles(tmp_path):
    file = tmp_path / "bang.machine"
    file.write_bytes(vibrissa.compile(ROOT / "policies/bang.fsm").to_bytes())
    machine = vibrissa.Machine.load(file)
    assert (machine.name, machine.whiskers, machine.states) == ("bang", ["r0"], ["Exploring", "Following"])
    speed, _ = machine.parameters
    assert (speed.name, speed.value, speed.range) == ("speed", "30 mm/s", ("1 mm/s", "50 mm/s"))
    slower = vibrissa.compile(ROOT / "policies/bang.fsm", set={"speed": "20 mm/s"})
    assert slower.parameters[0].value == "20 mm/s"
    assert slower.parameters[0].default == "30 mm/s"


def test_a_command_is_given_in_the_frame_of_the_body_too():
    control = vibrissa.compile(ROOT / "policies/bang.fsm").start()
    command = control.tick(1 / 30, [0.0, 0.0], 1.0, [0.0, 0.0])
    forward, left = command.velocity_body_m_s(1.0)
    assert np.hypot(forward, left) == pytest.approx(0.03)
    assert np.allclose(command.velocity_m_s, [forward * np.cos(1) - left * np.sin(1), forward * np.sin(1) + left * np.cos(1)])


def test_unusable_machines_and_samples_are_refused():
    with pytest.raises(vibrissa.Error, match="does not begin as compiled machines do"):
        vibrissa.Machine.load(b"machine a")
    with pytest.raises(vibrissa.Error, match="use `vibrissa.compile`"):
        vibrissa.Machine.load(ROOT / "policies/bang.fsm")
    control = vibrissa.compile("vibrissa").start()
    with pytest.raises(vibrissa.Error, match="`base_angle_rad` has 3 numbers, and the samples need 2"):
        control.tick(0.1, [0, 0], 0, [0, 0, 0])
    single = vibrissa.Text("machine single\n\nwhisker nose\n\ninitial A\n\nstate A { record nose stop }\n")
    with pytest.raises(vibrissa.Error, match="the rig has no whisker `nose`"):
        vibrissa.compile(single).start()
    ideal = vibrissa.Text("machine ideal\n\nwhisker r0 by truth\n\ninitial A\n\nstate A { record r0 stop }\n")
    with pytest.raises(vibrissa.Error, match="truth"):
        vibrissa.compile(ideal).start()


def test_a_tick_accepts_missing_readings():
    control = vibrissa.compile("vibrissa").start()
    for tick in range(1, 40):
        angle = np.nan if tick % 3 == 0 else 0.0
        command = control.tick(tick / 30, [0.0, 0.0], 0.0, [angle, 0.0])
        assert np.isfinite(command.velocity_m_s).all()
    control.tick([], np.empty((0, 2)), [], np.empty((0, 2)))


def test_the_time_of_samples_never_decreases():
    rig = vibrissa.Rig.load("reference")
    control = vibrissa.compile(ROOT / "policies/bang.fsm").start(rig)
    control.tick(0.1, [0.0, 0.0], 0.0, [0.0, 0.0])
    control.tick(0.1, [0.0, 0.0], 0.0, [0.0, 0.0])  # An equal time is no earlier one.
    with pytest.raises(vibrissa.Error, match="0.05 s comes after 0.1 s"):
        control.tick(0.05, [0.0, 0.0], 0.0, [0.0, 0.0])
    with pytest.raises(vibrissa.Error, match="0.2 s comes after 0.3 s"):
        control.tick([0.3, 0.2], np.zeros((2, 2)), [0.0, 0.0], np.zeros((2, 2)))
    control.tick(0.2, [0.0, 0.0], 0.0, [0.0, 0.0])
