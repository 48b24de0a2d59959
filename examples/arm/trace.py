"""A compiled machine drives a Panda arm, over the packets that a real arm receives.

    pip install 'crates/python[mujoco]'
    pip install --no-deps robosuite==1.5.2
    python examples/arm/trace.py --out tips.csv
"""

import argparse
import csv
import math
import socket
import sys
from dataclasses import dataclass, field

import mujoco
import numpy as np
import vibrissa

import link
import whiskers
from panda import Panda
from platform_carrier import Platform

STEPS_PER_SAMPLE = 10
# The robot's program sends commands at 100 Hz, each valid for 0.1 s.
SAMPLES_PER_COMMAND, VALID_S = 3, 0.1
# The centre of mass at the start (m), and the heading (rad): beside the box, on the side of the arm's base.
START = (0.333, -0.1, math.pi / 2)


def connected():
    """Two UDP sockets on the loopback interface, each of which sends to the other."""
    ends = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
    for end in ends:
        end.bind(("127.0.0.1", 0))
        end.settimeout(5.0)
    ends[0].connect(ends[1].getsockname())
    ends[1].connect(ends[0].getsockname())
    return ends


class Adapter:
    """The arm's side of the link: it executes commands and sends poses. A real arm runs this with its own clock and controller."""

    def __init__(self, carrier, commands, poses):
        self.carrier, self.commands, self.poses = carrier, commands, poses
        self.receiver, self.sent = link.Receiver(carrier.braking_s), 0

    def receive(self, now_s):
        """Takes one packet, and acknowledges it unless the arm has a fault. So the robot's program learns that it is not followed."""
        answer = self.receiver.take(self.commands.recv(64), now_s)
        if answer is not None and self.carrier.fault() is None:
            self.commands.send(answer)

    def control(self, now_s, period_s):
        """One period of the arm's controller."""
        wanted = (0.0, 0.0, 0.0) if self.carrier.fault() else self.receiver.wanted(now_s)
        self.carrier.control(wanted, period_s)

    def send_pose(self, position_m, heading_rad):
        """Sends the pose of the array's centre of mass."""
        self.sent += 1
        self.poses.send(link.pose(self.sent, position_m, heading_rad))


@dataclass
class Run:
    """What happened: recorded tips (m), their standard deviations (m), and one row for each sample in the other lists."""

    tips: list = field(default_factory=list)
    deviations: list = field(default_factory=list)
    end: str = "the time limit"
    time_s: list = field(default_factory=list)
    pose: list = field(default_factory=list)
    joints_rad: list = field(default_factory=list)
    fault: str | None = None

    def speeds(self):
        """Time (s), speed of the tool (m/s) and yaw rate (rad/s) between samples."""
        time, pose = np.array(self.time_s), np.array(self.pose)
        moved = np.diff(pose, axis=0) / np.diff(time)[:, None]
        return time[1:], np.hypot(moved[:, 0], moved[:, 1]), np.abs(moved[:, 2])


class Simulation:
    """The scene in MuJoCo, in steps of one sample."""

    def __init__(self, carrier, start, sample_period_s):
        step_s = sample_period_s / STEPS_PER_SAMPLE
        # A controller of about 1 kHz.
        self.carrier, self.steps_per_control = carrier, max(1, round(1e-3 / step_s))
        self.model = mujoco.MjModel.from_xml_string(whiskers.scene(carrier, start, step_s))
        self.data = mujoco.MjData(self.model)
        carrier.begin(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)
        self.hinges = [self.model.joint(name).qposadr[0] for name in whiskers.SIDES]
        self.tool = self.model.geom("hull").bodyid[0]
        self.heading, self.steps = start[2], 0

    def sample(self, control):
        """Simulates one sample period, and calls `control` with the time and the period (s) of the carrier's controller."""
        period_s = self.steps_per_control * self.model.opt.timestep
        for _ in range(STEPS_PER_SAMPLE):
            if self.steps % self.steps_per_control == 0:
                control(self.data.time, period_s)
            mujoco.mj_step(self.model, self.data)
            self.steps += 1
        mujoco.mj_kinematics(self.model, self.data)
        axes = self.data.xmat[self.tool].reshape(3, 3)
        # Headings count whole rotations.
        self.heading += math.remainder(math.atan2(axes[1, 0], axes[0, 0]) - self.heading, math.tau)
        return self.data.xpos[self.tool][:2].copy(), self.heading, self.data.qpos[self.hinges].copy()


def trace(carrier, policy="thesis", time_limit_s=120.0, start=START, cut_at_s=math.inf, each_sample=None):
    """Drives the carrier by a policy. From `cut_at_s` on, no command reaches it. `each_sample` is called with the simulation."""
    rig = vibrissa.Rig.load(vibrissa.Text(whiskers.rig(carrier), "rig.yaml"))
    control = vibrissa.compile(policy).start(rig)
    simulation = Simulation(carrier, start, 1 / rig.sample_rate_hz)
    samples_per_tick = round(rig.sample_rate_hz / rig.control_rate_hz)
    (commands, arm_commands), (poses, arm_poses) = connected(), connected()
    adapter = Adapter(carrier, arm_commands, arm_poses)

    run, rows, sent, newest = Run(), [], 0, ((0.0, 0.0), 0.0)
    for index in range(1, round(time_limit_s * rig.sample_rate_hz) + 1):
        position, heading, angles = simulation.sample(adapter.control)
        now = simulation.data.time
        adapter.send_pose(position, heading)
        _, position, heading = link.posed(poses.recv(64))
        rows.append((now, position, heading, angles))
        run.time_s.append(now)
        run.pose.append((*position, heading))
        run.joints_rad.append(simulation.data.qpos[getattr(carrier, "places", [])].copy())
        if each_sample:
            each_sample(simulation, run)
        if index % samples_per_tick == 0:
            command = control.tick(*(np.array(column) for column in zip(*rows)))
            rows, newest = [], (tuple(command.velocity_m_s), command.yaw_rate_rad_s)
            seen = control.perceived(closed_within_m=5e-3, closed_after_s=5.0)
            run.tips.extend(seen["tip_m"][seen["recorded"]])
            run.deviations.extend(seen["tip_spread_m"][seen["recorded"]])
            if seen["loop_closed"].any() or control.status != "running":
                run.end = "closed the loop" if seen["loop_closed"].any() else f"{control.status}: {control.reason}"
                break
        if index % SAMPLES_PER_COMMAND == 0 and now < cut_at_s:
            sent += 1
            commands.send(link.Command(sent, now, *newest, False, VALID_S).to_bytes())
            adapter.receive(now)
            if carrier.fault():
                run.fault = run.fault or f"{carrier.fault()} after {now:.1f} s"
                break
            assert link.acknowledged(commands.recv(64)) == sent
    for end in (commands, arm_commands, poses, arm_poses):
        end.close()
    return run


def main():
    """Prints the errors of a run, and writes its tips if asked to. Exits with 1 unless the loop was closed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carrier", choices=["panda", "platform"], default="panda", help="what carries the array")
    parser.add_argument("--policy", default="thesis", help="a built-in policy, or the path of one")
    parser.add_argument("--time-limit", type=float, default=120.0, metavar="S", help="simulated seconds")
    parser.add_argument("--out", metavar="CSV", help="where to write the recorded tips")
    options = parser.parse_args()
    carrier = Panda() if options.carrier == "panda" else Platform()
    run = trace(carrier, options.policy, options.time_limit)
    print(f"{options.policy}: {run.fault or run.end}, {run.time_s[-1]:.1f} s, {len(run.tips)} tips")
    if run.tips:
        errors = whiskers.distance_to_box(np.array(run.tips))
        within = np.mean(errors <= 1.96 * np.array(run.deviations))
        print(f"error: mean {errors.mean() * 1e3:.3f} mm, largest {errors.max() * 1e3:.3f} mm, {within:.0%} in the 95 % interval")
    if isinstance(carrier, Panda):
        angles = np.array(run.joints_rad)
        left = np.degrees(np.minimum(angles - carrier.known.jnt_range[:, 0], carrier.known.jnt_range[:, 1] - angles).min(axis=0))
        print("least distance from the joint limits:", ", ".join(f"{angle:.0f}" for angle in left), "degrees")
    if options.out:
        with open(options.out, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["x_m", "y_m", "deviation_m"])
            rows.writerows([*tip, deviation] for tip, deviation in zip(run.tips, run.deviations))
    return 0 if run.end == "closed the loop" else 1


if __name__ == "__main__":
    sys.exit(main())
