"""Rigs without a scenario."""

import math

import pytest
from conftest import ROOT

import vibrissa

KEYS = "platform: {servo: 200 ms, yaw_servo: 0.1 s, speed_limit: 0.2 m/s}\nwhiskers:\n  r0: {length: 120 mm}\n  l0: {length: 120 mm}\n"
SCENE = (
    "objects:\n  - circle: {centre: [0.4 m, 0.4 m], radius: 0.3 m}\nstart: {position: [0 m, 72 mm], heading: 90 deg}\n"
    "stop: {time: 5 s}\n"
)


def indented(text):
    return "".join(f"  {line}\n" for line in text.splitlines())


def scenario(rig):
    return vibrissa.Text(f"name: mine\nrig:\n{indented(rig)}{SCENE}")


def test_a_rig_alone_is_that_of_a_scenario_with_the_same_keys(tmp_path):
    expected = vibrissa.Rig(scenario(KEYS))
    file = tmp_path / "rig.yaml"
    file.write_text(KEYS)
    for source in [vibrissa.Text(KEYS), vibrissa.Text(f"rig:\n{indented(KEYS)}"), file, str(file)]:
        assert vibrissa.Rig.load(source) == expected
    assert expected != vibrissa.Rig()
    assert (expected.speed_limit_m_s, expected.whiskers) == (0.2, ["r0", "l0"])


def test_keywords_are_the_keys_of_a_rig():
    whisker = {"length": "120 mm"}
    platform = {"servo": "200 ms", "yaw_servo": "0.1 s", "speed_limit": "0.2 m/s"}
    assert vibrissa.Rig(platform=platform, whiskers={"r0": whisker, "l0": whisker}) == vibrissa.Rig.load(vibrissa.Text(KEYS))
    assert vibrissa.Rig(preset="thesis_array") == vibrissa.Rig.load("thesis_array")
    with pytest.raises(vibrissa.Error, match="a rig has no key `plattform`"):
        vibrissa.Rig(plattform={})
    with pytest.raises(vibrissa.Error, match="not both"):
        vibrissa.Rig("disk", platform=platform)


def test_the_built_in_rigs_have_their_names():
    assert vibrissa.rigs() == ["reference", "peer_cable", "thesis_array"]
    for name in vibrissa.rigs():
        assert vibrissa.Rig.load(name) == vibrissa.Rig(scenario(f"preset: {name}\n"))
    assert vibrissa.Rig.load("reference") == vibrissa.Rig()
    assert len(vibrissa.Rig.load("thesis_array").whiskers) == 6


def test_a_rig_refers_to_calibrations_beside_its_file(tmp_path):
    (tmp_path / "measured.yaml").write_bytes((ROOT / "tests/fixtures/arrays/3/r0.yaml").read_bytes())
    keys = "whiskers: {r0: {calibration: measured.yaml}}"
    rig = vibrissa.Rig.load(vibrissa.Text(keys, str(tmp_path / "rig.yaml")))
    assert rig != vibrissa.Rig.load(vibrissa.Text("whiskers: {r0: {length: 100 mm}}"))
    with pytest.raises(vibrissa.Error, match="cannot use `measured.yaml`"):
        vibrissa.Rig.load(vibrissa.Text(keys, str(tmp_path / "elsewhere/rig.yaml")))


def test_a_rig_that_cannot_be_used_is_refused_with_its_place():
    with pytest.raises(vibrissa.Error, match=r"a rig has no key `plattform`[^\0]*--> mine.yaml:1:1"):
        vibrissa.Rig.load(vibrissa.Text("plattform: {}", "mine.yaml"))
    with pytest.raises(vibrissa.Error, match="the rig is empty"):
        vibrissa.Rig.load(vibrissa.Text(""))
    with pytest.raises(vibrissa.Error, match="a rig has no key `name`"):
        vibrissa.Rig.load(vibrissa.Text("name: mine\nrig: {}"))
    for name in ["nowhere", "disk"]:
        with pytest.raises(vibrissa.Error, match=f"cannot read {name}"):
            vibrissa.Rig.load(name)
    with pytest.raises(vibrissa.Error, match="yaw_servo"):
        vibrissa.Rig.load(vibrissa.Text("platform: {yaw_servo: 0 s}"))


def test_a_rig_alone_starts_the_control_loop_of_a_run():
    trial = vibrissa.Trial(scenario(KEYS), "vibrissa", world="quasistatic")
    result = trial.run(samples=True)
    control = vibrissa.compile("vibrissa").start(vibrissa.Rig.load(vibrissa.Text(KEYS)))
    names = ["time_s", "position_m", "heading_rad", "base_angle_rad"]
    for tick, expected in enumerate(result.ticks["velocity_m_s"]):
        rows = result.samples["tick"] == tick
        command = control.tick(*(result.samples[name][rows] for name in names))
        assert command.velocity_m_s.tobytes() == expected.tobytes(), tick


def speed_and_yaw_rate(rig, world, after=0.1, **options):
    """The shares of a commanded velocity and yaw rate that the platform has after a time."""
    trial = vibrissa.Trial(scenario(rig), "vibrissa", world=world, **options)
    episode = trial.begin()
    seen = [episode.step(0.0, 0.0, 0.0)]
    # Backwards, away from the object.
    seen += [episode.step(-0.05, 0.0, 0.5) for _ in range(round(after * 30) + 1)]
    before, last = seen[-2], seen[-1]
    moved, turned = last.position_m - before.position_m, last.heading_rad - before.heading_rad
    return (moved @ moved) ** 0.5 * 30 / 0.05, turned * 30 / 0.5


@pytest.mark.parametrize("world", ["quasistatic", "mujoco"])
def test_translation_and_rotation_have_their_own_servos(world):
    both = speed_and_yaw_rate("platform: {servo: 200 ms}\n", world)
    fast = speed_and_yaw_rate("platform: {servo: 200 ms, yaw_servo: 20 ms}\n", world)
    same = speed_and_yaw_rate("platform: {servo: 200 ms, yaw_servo: 200 ms}\n", world)
    assert same == pytest.approx(both, rel=1e-12)
    # The mean share in the last of four periods is 1 - exp(-t / T), at its middle.
    assert both == pytest.approx((0.44, 0.44), abs=0.03)
    assert fast[0] == pytest.approx(both[0], abs=0.01) and fast[1] > 0.98


def test_a_rig_shows_its_servos():
    rig = vibrissa.Rig.load(vibrissa.Text("platform: {servo: 200 ms}"))
    assert (rig.servo_s, rig.yaw_servo_s) == (0.2, 0.2)
    assert (vibrissa.Rig.load(vibrissa.Text(KEYS)).servo_s, vibrissa.Rig.load(vibrissa.Text(KEYS)).yaw_servo_s) == (0.2, 0.1)


def test_a_rig_shows_the_keys_of_its_text():
    keys = "platform: {mass: 700 g, yaw: {limit: 40 deg/s}}\nsensing: {friction: 0.2, forces: true}\n"
    keys += "whiskers:\n  r0: {length: 120 mm, hinge: {stiffness: 2 N m/rad}}\n  l0: {base: [10 mm, -20 mm]}\n"
    rig = vibrissa.Rig.load(vibrissa.Text(keys))
    assert (rig.mass_kg, rig.friction, rig.forces) == (0.7, 0.2, True)
    assert rig.yaw_limit_rad_s == pytest.approx(math.radians(40))
    assert (rig.whisker_length_m, rig.whisker_hinge_stiffness_n_m_rad) == ([0.12, 0.1], [2.0, 1.0])
    assert rig.whisker_base_m[1] == (0.01, -0.02)
    # No whisker is tapered, so there is no radius of the tips. Those of the simulation are not known.
    for name in ["whisker_tip_radius_m", "step_s", "nothing"]:
        with pytest.raises(AttributeError, match=name):
            getattr(rig, name)


def test_every_listed_name_of_a_rig_is_another_and_has_a_value():
    rig = vibrissa.Rig()
    names = dir(rig)
    assert len(names) == len(set(names)) and {"whiskers", "load", "control_rate_hz", "whisker_links"} <= set(names)
    for name in names:
        getattr(rig, name)


@pytest.mark.parametrize("servos", ["servo: 150 ms, yaw_servo: 50 ms", "servo: 150 ms"])
def test_a_slow_platform_follows_the_disk(servos):
    stop = "120 s, loop_closed: {within: 5 mm, after: 5 s}"
    scene = vibrissa.Text(f"name: slow\nrig: {{platform: {{{servos}}}}}\n" + SCENE.replace("5 s", stop))
    result = vibrissa.run(scene, "vibrissa", world="quasistatic")
    assert result.outcome == "completed" and result.figures["coverage"] > 0.95


def test_the_servo_of_a_mismatch_is_that_of_both():
    slow = vibrissa.Text("{servo: 200 ms}")
    found = speed_and_yaw_rate("platform: {servo: 20 ms, yaw_servo: 30 ms}\n", "quasistatic", mismatch=slow, uncalibrated=True)
    assert found == pytest.approx((0.44, 0.44), abs=0.03)
