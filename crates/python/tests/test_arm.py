"""The example of an arm: its link, its kinematics, and its runs in MuJoCo, driven by a compiled policy over UDP."""

import importlib.util
import math

import numpy as np
import pytest
from conftest import ROOT

mujoco = pytest.importorskip("mujoco", reason="the arm is a model for MuJoCo")
#: The model of the arm is in a package of 150 MB, of which nothing else is used.
needs_arm = pytest.mark.skipif(importlib.util.find_spec("robosuite") is None, reason="pip install --no-deps robosuite==1.5.2")


@pytest.fixture(scope="module", autouse=True)
def folder():
    patch = pytest.MonkeyPatch()
    patch.syspath_prepend(str(ROOT / "examples/arm"))
    yield
    patch.undo()


@pytest.fixture
def link():
    import link

    return link


def command(link, number, sent_s, speed=0.05, is_stop=False):
    return link.Command(number, sent_s, (speed, 0.0), 0.1, is_stop, 0.1).to_bytes()


def test_packets_have_the_documented_bytes(link):
    packet = link.Command(0x0102, 1.5, (1.0, -2.0), 0.5, True, 0.1).to_bytes()
    expected = b"VBC1" + bytes([2, 1]) + bytes(6) + (1_500_000_000).to_bytes(8, "little")
    expected += bytes.fromhex("000000000000f03f 00000000000000c0 000000000000e03f") + b"\x01" + (100).to_bytes(4, "little")
    assert packet == expected
    assert link.acknowledgement(0x0102) == b"VBA1" + bytes([2, 1]) + bytes(6)
    assert link.pose(3, (1.0, -2.0), 0.5) == b"VBP1" + bytes([3]) + bytes(7) + expected[20:44]
    assert link.Command.from_bytes(packet).to_bytes() == packet
    assert link.posed(link.pose(3, (1.0, -2.0), 0.5)) == (3, (1.0, -2.0), 0.5)
    not_finite, no_bool = packet[:20] + b"\xff" * 8 + packet[28:], packet[:44] + b"\x02" + packet[45:]
    for foreign in [b"", packet[:-1], packet + b"\0", b"VBC2" + packet[4:], not_finite, no_bool]:
        assert link.Command.from_bytes(foreign) is None


def test_an_old_a_repeated_or_a_late_command_is_not_executed(link):
    receiver = link.Receiver(braking_s=0.0)
    packets = [(1, 0.00, 7.00), (2, 0.01, 7.01), (2, 0.01, 7.02), (1, 0.00, 7.03)]
    packets += [(4, 0.02, 7.04), (3, 0.03, 7.05), (5, 0.04, 7.10), (6, 0.09, 7.12)]
    taken = [receiver.take(command(link, number, sent), now) is not None for number, sent, now in packets]
    # The fifth is 20 ms late, which may be. The seventh is 60 ms late.
    assert taken == [True, True, False, False, True, False, False, True]
    assert receiver.take(command(link, 7, 0.10, is_stop=True), 9.0) is not None, "a stop is executed at any age"
    assert receiver.wanted(9.0) == (0.0, 0.0, 0.0)


def test_a_sender_that_starts_again_is_followed_after_it_has_sent_for_a_while(link):
    receiver = link.Receiver(braking_s=0.0)
    for step in range(100):
        receiver.take(command(link, 1 + step, 0.01 * step), 0.01 * step)
    taken = [step for step in range(20) if receiver.take(command(link, 1 + step, 0.01 * step), 2 + 0.01 * step) is not None]
    assert taken == list(range(6, 20)), "beyond 50 ms"


def test_a_command_holds_until_the_braking_before_the_time_in_its_packet(link):
    receiver = link.Receiver(braking_s=0.06)
    assert receiver.wanted(0.0) == (0.0, 0.0, 0.0)
    receiver.take(command(link, 1, 0.0), 5.0)
    assert receiver.wanted(5.039) == (0.05, 0.0, 0.1)
    assert receiver.wanted(5.041) == (0.0, 0.0, 0.0)
    receiver.take(command(link, 2, 0.01), 5.03)
    assert receiver.wanted(5.049) != (0.0, 0.0, 0.0)
    assert receiver.wanted(5.051) == (0.0, 0.0, 0.0), "20 ms late, so its time ends as if it had not been"


@pytest.fixture(scope="module")
def panda():
    import panda

    return panda.Panda()


@needs_arm
def test_joint_velocities_give_the_wanted_twist_whatever_the_null_space_adds(panda):
    import kinematics
    from panda import NEUTRAL

    def barrier(angles):
        share = (angles - panda.limits.mean(axis=1)) / (np.ptp(panda.limits, axis=1) / 2)
        return (1 / (1 - share**2)).sum()

    draw = np.random.default_rng(1)
    for _ in range(50):
        angles = NEUTRAL + draw.uniform(-0.4, 0.4, 7)
        _, _, jacobian = panda.tool_at(angles)
        wanted = draw.uniform(-1, 1, 6) * [0.1, 0.1, 0.1, 0.7, 0.7, 0.7]
        rates = kinematics.joint_velocities(jacobian, wanted, angles, panda.limits, np.full(7, 100.0))
        assert jacobian @ rates == pytest.approx(wanted, abs=1e-9)
        alone = np.linalg.pinv(jacobian) @ wanted
        assert barrier(angles + 1e-4 * (rates - alone)) <= barrier(angles), "away from the limits"
        fastest = np.full(7, 0.05)
        assert (np.abs(kinematics.joint_velocities(jacobian, wanted, angles, panda.limits, fastest)) <= fastest + 1e-12).all()


@needs_arm
def test_a_tool_out_of_its_plane_returns_to_it(panda):
    from panda import NEUTRAL

    position, _, _ = panda.tool_at(NEUTRAL)
    height = position[2] + 0.02
    angles = NEUTRAL + np.array([0.0, 0.0, 0.1, 0.0, 0.1, 0.0, 0.0])
    for _ in range(200):
        angles = angles + 0.01 * panda.rates(angles, np.array([0.05, 0.0, 0.1]), height)
    position, axes, _ = panda.tool_at(angles)
    assert position[2] == pytest.approx(height, abs=1e-4)
    assert axes[:, 2] == pytest.approx([0, 0, 1], abs=1e-3)


@needs_arm
def test_too_fast_a_motion_is_slowed_down_and_keeps_its_direction(panda):
    from panda import NEUTRAL, VELOCITY

    position, axes, jacobian = panda.tool_at(NEUTRAL)
    assert axes[2, 2] == pytest.approx(1, abs=1e-9), "the tool points down"
    moved = jacobian @ panda.rates(NEUTRAL, np.array([3.0, -4.0, 0.0]), position[2])
    assert np.hypot(moved[0], moved[1]) < 4
    assert moved[1] / moved[0] == pytest.approx(-4 / 3, abs=1e-6)
    assert np.abs(moved[[2, 3, 4, 5]]).max() < 1e-6


def turn(panda, place, heading, step_s=0.01):
    """Turns the tool to the left and to the right of a heading (rad), in one place, until a joint ends it. Gives both angles (rad)."""
    turned = []
    for sign in (1, -1):
        angles, sum_of_turns = panda.planned((*place, heading)), 0.0
        for _ in range(2000):
            before = sum_of_turns
            rates = panda.rates(angles, np.array([0.0, 0.0, sign * 0.5]), place[2])
            _, _, jacobian = panda.tool_at(angles)
            angles, sum_of_turns = angles + step_s * rates, sum_of_turns + step_s * (jacobian @ rates)[5]
            if abs(sum_of_turns - before) < 0.1 * 0.5 * step_s:
                break
        assert (angles >= panda.limits[:, 0] - 1e-3).all() and (angles <= panda.limits[:, 1] + 1e-3).all()
        turned.append(abs(sum_of_turns))
    return turned


@needs_arm
def test_a_whole_turn_fits_near_the_base_but_not_far_from_it(panda):
    near, far = sum(turn(panda, (0.33, 0.0, 0.2), -1.0)), sum(turn(panda, (0.8, 0.0, 0.2), -1.0))
    joint = np.ptp(panda.limits[6])
    assert near > math.tau + 0.2 > joint + 0.2, "more than joint 7 alone: the elbow swings from one side to the other"
    assert far < math.tau


@needs_arm
@pytest.mark.parametrize("axis, speed", [(0, 0.05), (1, -0.05), (2, 0.4)])
def test_the_tool_follows_a_command_with_the_delay_that_the_rig_states(axis, speed):
    from panda import Panda
    from trace import START, Simulation

    arm = Panda()
    simulation = Simulation(arm, START, 1 / 300)
    wanted = np.zeros(3)
    poses = []
    for index in range(150):
        wanted[axis] = speed if index >= 30 else 0.0
        position, heading, _ = simulation.sample(lambda _, period_s: arm.control(tuple(wanted), period_s))
        poses.append((*position, heading))
    moved = np.array(poses)[-1] - np.array(poses)[29]
    # What is missing of the way, as a time.
    delay = 120 / 300 - moved[axis] / speed
    assert delay == pytest.approx(arm.yaw_servo_s if axis == 2 else arm.servo_s, abs=4e-3)
    assert np.abs(np.delete(moved, axis)).max() < 2e-4, "it moves in no other direction"


@pytest.fixture(scope="module")
def runs():
    """The whole box, traced with each carrier."""
    from panda import Panda
    from platform_carrier import Platform
    from trace import trace

    arm, platform = Panda(), Platform()
    return {"arm": (arm, trace(arm)), "platform": (platform, trace(platform))}


@needs_arm
def test_the_arm_traces_the_whole_box_almost_like_a_platform(runs):
    import whiskers

    errors = {}
    for name, (_, run) in runs.items():
        assert (run.fault, run.end) == (None, "closed the loop"), name
        errors[name] = whiskers.distance_to_box(np.array(run.tips))
        # Each side is traced but for 5 mm at its ends, where a tip leaves it.
        cos, sin = math.cos(whiskers.BOX_YAW), math.sin(whiskers.BOX_YAW)
        local = (np.array(run.tips) - whiskers.BOX_CENTRE) @ np.array([[cos, -sin], [sin, cos]])
        assert np.ptp(local, axis=0) == pytest.approx([whiskers.BOX_SIDE] * 2, abs=5e-3)
        assert np.mean(errors[name] <= 1.96 * np.array(run.deviations)) > 0.95
    assert errors["arm"].mean() <= 2 * errors["platform"].mean()
    assert np.percentile(errors["arm"], 95) <= 2 * np.percentile(errors["platform"], 95)


@needs_arm
def test_no_joint_reaches_its_limit_on_the_way_round_the_box(runs):
    arm, run = runs["arm"]
    angles, ranges = np.array(run.joints_rad), arm.known.jnt_range
    left = np.minimum(angles - ranges[:, 0], ranges[:, 1] - angles).min()
    assert left > math.radians(5), "more than the margin at which the arm has a fault"
    heading = np.array(run.pose)[:, 2]
    assert np.ptp(heading) > math.tau, "it turned by a whole rotation meanwhile"


@needs_arm
@pytest.mark.parametrize("cut_at_s", [1.5, 8.5])
def test_the_arm_stands_100_ms_after_its_link_is_cut(cut_at_s):
    from panda import Panda
    from trace import trace

    run = trace(Panda(), time_limit_s=cut_at_s + 0.5, cut_at_s=cut_at_s)
    time, speed, yaw_rate = run.speeds()
    before, after = (time > cut_at_s - 0.05) & (time < cut_at_s), time > cut_at_s + 0.1
    assert speed[before].max() > 0.02, "it moves before"
    # It may creep by a hundredth of a millimetre in a tenth of a second.
    assert speed[after].max() < 1e-3
    assert yaw_rate[after].max() < 0.01
    standing = np.array(run.pose)[1:][after]
    assert np.ptp(standing[:, :2], axis=0).max() < 1e-4
