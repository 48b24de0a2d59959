"""The ROS 2 node, with a stub of `rclpy`: its loop gives the commands of a simulated run."""

import math
import pathlib
import sys

import numpy as np
import pytest
from conftest import ROOT

import vibrissa

STUBS = pathlib.Path(__file__).with_name("stubs")


@pytest.fixture
def node(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(STUBS))
    monkeypatch.syspath_prepend(str(ROOT / "examples/ros2"))
    from rclpy.node import Node
    from vibrissa_ros2.node import WhiskerNode

    machine = tmp_path / "policy.machine"
    machine.write_bytes(vibrissa.compile("vibrissa").to_bytes())
    monkeypatch.setattr(Node, "given", {"machine": str(machine), "rig": "disk"})
    yield WhiskerNode()
    for name in [name for name in sys.modules if name.split(".")[0] in ("rclpy", "vibrissa_ros2", "geometry_msgs", "sensor_msgs")]:
        del sys.modules[name]


def test_the_node_publishes_the_commands_of_a_run(node):
    from geometry_msgs.msg import Pose, PoseStamped, Quaternion, Vector3
    from sensor_msgs.msg import Header, JointState, Time

    result = vibrissa.run("disk", "vibrissa", world="quasistatic", time_limit_s=20.0, samples=True)
    samples, ticks = result.samples, result.ticks
    [on_timer] = node.timers_by_period.values()
    on_timer()
    assert node.published["cmd_vel"] == [], "before the first pose, nothing is known"
    for tick in range(len(ticks["time_s"])):
        for row in np.flatnonzero(samples["tick"] == tick):
            (x, y), heading = samples["position_m"][row], samples["heading_rad"][row]
            turn = Quaternion(z=math.sin(heading / 2), w=math.cos(heading / 2))
            node.subscriptions_by_topic["pose"](PoseStamped(Pose(Vector3(x, y), turn)))
            # Clocks of robots do not begin at zero.
            sec, rest = divmod(samples["time_s"][row] - samples["time_s"][0], 1)
            stamp = Time(1_700_000_000 + int(sec), round(1e9 * rest))
            names = ["l0", "r0"]
            angles = samples["base_angle_rad"][row][::-1]
            node.subscriptions_by_topic["base_angles"](JointState(Header(stamp), names, list(angles)))
        on_timer()
    twists = node.published["cmd_vel"]
    assert len(twists) == len(ticks["time_s"])
    cos, sin = np.cos(ticks["heading_rad"]), np.sin(ticks["heading_rad"])
    (vx, vy) = ticks["velocity_m_s"].T
    expected = np.stack([vx * cos + vy * sin, vy * cos - vx * sin, ticks["yaw_rate_rad_s"]], axis=1)
    found = np.array([[twist.linear.x, twist.linear.y, twist.angular.z] for twist in twists])
    # Time stamps are whole nanoseconds, and a heading passes through a quaternion.
    assert np.abs(found - expected).max() < 1e-6
    on_timer()
    assert len(twists) == len(ticks["time_s"]), "without samples, nothing is published"


def test_the_node_has_at_most_forty_lines():
    assert len((ROOT / "examples/ros2/vibrissa_ros2/node.py").read_text().splitlines()) <= 40
