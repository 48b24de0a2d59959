"""A Panda arm in MuJoCo that carries the array at its flange. It is controlled as by the joint velocity interface of a real one."""

import collections
import importlib.util
import math
import pathlib
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

import kinematics

# Limits that Franka publishes for the joints: velocity (rad/s), acceleration (rad/s^2), torque (N m).
VELOCITY = np.array([2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61])
ACCELERATION = np.array([15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0])
TORQUE = np.array([87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0])
# Stiffness (N m/rad) with which the joints follow the commanded angles: libfranka's default impedance.
STIFFNESS = np.array([3000.0, 3000.0, 3000.0, 2500.0, 2500.0, 2000.0, 2000.0])
# The arm keeps this distance (rad) from the ends of its joints.
MARGIN = 0.05
# From the flange down to the plane of the whiskers (m), and the angle from the flange's x axis to that of the array.
DROP, MOUNTED = 0.12, math.radians(140)
# Time (s) between a command and its effect, beyond what the limits of the accelerations cause. It is assumed: measure yours.
DEAD_TIME_S = 0.01
# A faster command (m/s, rad/s) is slowed down. From these speeds the arm comes to rest in this time (s). It turns more slowly than
# the elbow can swing, or joint 7 would reach its end before the elbow has made room.
SPEED_LIMIT, YAW_RATE_LIMIT, BRAKING_S = 0.1, math.radians(25), 0.06
# A posture (rad) with the tool down and all joints far from their limits.
NEUTRAL = np.array([0.0, 0.2, 0.0, -2.2, 0.0, 2.4, math.pi / 4])
# The tool is out of its plane beyond this height (m) and inclination (rad).
HEIGHT_LIMIT, INCLINATION_LIMIT = 2e-3, math.radians(1)


class Panda:
    """The arm: its model, its differential kinematics and its controller."""

    # Mean delays (s) of the tool behind commands of a policy, as a rig states them.
    servo_s, yaw_servo_s = 0.012, 0.018
    speed_limit_m_s, yaw_rate_limit_rad_s, braking_s = SPEED_LIMIT, YAW_RATE_LIMIT, BRAKING_S + DEAD_TIME_S

    def __init__(self):
        self.awaited = collections.deque()
        spec = importlib.util.find_spec("robosuite")
        if spec is None:
            raise SystemExit("the model of the arm is missing: pip install --no-deps robosuite==1.5.2")
        folder = pathlib.Path(spec.submodule_search_locations[0]) / "models/assets/robots/panda"
        self.robot = ET.parse(folder / "robot.xml").getroot()
        for mesh in self.robot.iterfind("asset/mesh"):
            mesh.set("file", str(folder / mesh.get("file")))
        for geom in self.robot.iter("geom"):
            if geom.get("contype") is None:  # A shape for collisions: with the arm itself and with objects, not with whiskers.
                geom.set("contype", "4")
                geom.set("conaffinity", "6")
        for motor, torque in zip(self.robot.iterfind("actuator/motor"), TORQUE):
            motor.set("ctrlrange", f"{-torque} {torque}")
        flange = next(body for body in self.robot.iter("body") if body.get("name") == "right_hand")
        mount = f'<geom type="cylinder" fromto="0 0 0 0 0 {DROP - 0.02}" size="0.02" contype="4" conaffinity="6" rgba=".3 .3 .3 1"/>'
        # The z axis of the flange points down, and that of the array up.
        turned = f"0 {math.cos(MOUNTED / 2)} {math.sin(MOUNTED / 2)} 0"
        flange.append(ET.fromstring(mount))
        self.tool = ET.SubElement(flange, "body", name="tool", pos=f"0 0 {DROP}", quat=turned)
        # What the controller knows: the arm without whiskers.
        self.known = mujoco.MjModel.from_xml_string(ET.tostring(self.robot, encoding="unicode"))
        self.posture = mujoco.MjData(self.known)
        self.limits = self.known.jnt_range + [MARGIN, -MARGIN]

    def mjcf(self, array, start):
        """The arm with the array, whose tool begins at `start` (x, y, z in m, heading in rad)."""
        self.height = start[2]
        self.angles, self.velocities = self.planned(start), np.zeros(7)
        self.tool.extend(ET.fromstring(f"<array>{array}</array>"))
        return "".join(ET.tostring(part, encoding="unicode") for part in self.robot if part.tag != "compiler")

    def begin(self, model, data):
        """Connects to a model with this MJCF, and takes the planned posture."""
        self.model, self.data = model, data
        joints = [model.joint(f"joint{number}") for number in range(1, 8)]
        self.places = [joint.qposadr[0] for joint in joints]
        self.speeds = [joint.dofadr[0] for joint in joints]
        self.motors = [model.actuator(f"torq_j{number}").id for number in range(1, 8)]
        data.qpos[self.places] = self.angles
        mujoco.mj_forward(model, data)
        inertia = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, inertia)
        # Critically damped in the posture of the start.
        self.damping = 2 * np.sqrt(STIFFNESS * np.diag(inertia)[self.speeds])

    def tool_at(self, angles):
        """Position (m), axes (columns) and Jacobian (6 x 7) of the tool at these joint angles."""
        self.posture.qpos[:] = angles
        mujoco.mj_kinematics(self.known, self.posture)
        mujoco.mj_comPos(self.known, self.posture)
        tool, jacobian = self.known.body("tool").id, np.zeros((6, 7))
        mujoco.mj_jacBody(self.known, self.posture, jacobian[:3], jacobian[3:], tool)
        return self.posture.xpos[tool].copy(), self.posture.xmat[tool].reshape(3, 3).copy(), jacobian

    def rates(self, angles, wanted, height):
        """Joint velocities (rad/s) for a wanted velocity x and y (m/s) and yaw rate (rad/s) of a tool at this height (m)."""
        position, axes, jacobian = self.tool_at(angles)
        twist = kinematics.twist(wanted[:2], wanted[2], height - position[2], -axes[:, 2])
        fastest = kinematics.fastest_near_limits(angles, self.limits, VELOCITY, ACCELERATION)
        return kinematics.joint_velocities(jacobian, twist, angles, self.limits, fastest)

    def planned(self, start, step_s=0.01, duration_s=30.0):
        """Joint angles (rad) with the tool at `start`. The tool turns there from the neutral posture, while the null space adapts.

        So the heading counts rotations: the arm begins at the end of its range from which a policy can turn.
        """
        angles = NEUTRAL.copy()
        _, axes, _ = self.tool_at(angles)
        heading = math.atan2(axes[1, 0], axes[0, 0])
        for _ in range(round(duration_s / step_s)):
            position, axes, _ = self.tool_at(angles)
            measured = math.atan2(axes[1, 0], axes[0, 0])
            heading += math.remainder(measured - heading, math.tau)
            error = np.array([*(np.array(start[:2]) - position[:2]), start[3] - heading])
            wanted = np.clip(2 * error, -0.3, 0.3)
            angles = angles + step_s * self.rates(angles, wanted, start[2])
        return angles

    def control(self, wanted, period_s):
        """One control period: the commanded angles move with a wanted velocity x and y (m/s) and yaw rate (rad/s), and torques follow."""
        self.awaited.append(wanted)
        wanted = np.zeros(3)
        if len(self.awaited) * period_s > DEAD_TIME_S:
            wanted += self.awaited.popleft()
        wanted *= min(1.0, SPEED_LIMIT / max(math.hypot(*wanted[:2]), 1e-12), YAW_RATE_LIMIT / max(abs(wanted[2]), 1e-12))
        rates = self.rates(self.angles, wanted, self.height) if wanted.any() else np.zeros(7)
        change = rates - self.velocities
        # All joints change together, so that the tool also keeps its path while it brakes.
        change *= min(1.0, *(ACCELERATION * period_s / np.maximum(np.abs(change), 1e-12)))
        self.velocities = self.velocities + change
        self.angles = self.angles + period_s * self.velocities
        acceleration, inertial = np.zeros(self.model.nv), np.zeros(self.model.nv)
        acceleration[self.speeds] = change / period_s
        mujoco.mj_mulM(self.model, self.data, inertial, acceleration)
        error = self.angles - self.data.qpos[self.places]
        rate_error = self.velocities - self.data.qvel[self.speeds]
        torque = (inertial + self.data.qfrc_bias)[self.speeds] + STIFFNESS * error + self.damping * rate_error
        self.data.ctrl[self.motors] = np.clip(torque, -TORQUE, TORQUE)

    def fault(self):
        """Why the arm must not be moved by a policy any more, or `None`."""
        angles = self.data.qpos[self.places]
        position, axes, _ = self.tool_at(angles)
        beyond = np.nonzero((angles < self.limits[:, 0]) | (angles > self.limits[:, 1]))[0]
        if len(beyond):
            return f"joint {beyond[0] + 1} is at its limit"
        if abs(position[2] - self.height) > HEIGHT_LIMIT or axes[2, 2] < math.cos(INCLINATION_LIMIT):
            return "the tool has left its plane"
        return None
