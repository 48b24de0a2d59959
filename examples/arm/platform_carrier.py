"""A platform that moves freely in the plane and carries the array. Its errors are what those of an arm are compared with."""

import math

# The servos, the mass and the inertia of Vibrissa's reference rig (s, kg, kg m^2).
SERVO_S, MASS, INERTIA = 0.05, 0.51, 1.5e-3


class Platform:
    """Three joints with velocity servos."""

    servo_s, yaw_servo_s = SERVO_S, SERVO_S
    speed_limit_m_s, yaw_rate_limit_rad_s = 0.1, math.radians(45)
    # Time (s) in which it comes to rest. A servo of first order never does; within this time it has lost 63 % of its speed.
    braking_s = SERVO_S

    def mjcf(self, array, start):
        """The body with the array, which begins at `start` (x, y, z in m, heading in rad), and its actuators."""
        axes = [("x", "slide", "1 0 0"), ("y", "slide", "0 1 0"), ("yaw", "hinge", "0 0 1")]
        # The joints have the axes of the world, and the heading is the angle of the last one.
        joints = "".join(f'<joint name="{name}" type="{kind}" axis="{axis}"/>' for name, kind, axis in axes)
        inertial = f'<inertial pos="0 0 0" mass="{MASS}" diaginertia="{INERTIA} {INERTIA} {INERTIA}"/>'
        gains = [("x", MASS), ("y", MASS), ("yaw", INERTIA)]
        servos = "".join(f'<velocity joint="{name}" kv="{inertia / SERVO_S}"/>' for name, inertia in gains)
        self.start = start
        return f"""
            <worldbody><body pos="0 0 {start[2]}">{inertial}{joints}{array}</body></worldbody>
            <actuator>{servos}</actuator>"""

    def begin(self, model, data):
        """Connects to a model with this MJCF, and moves to the start."""
        self.data = data
        data.qpos[:3] = [*self.start[:2], self.start[3]]

    def control(self, wanted, period_s):
        """One control period with a wanted velocity x and y (m/s) and yaw rate (rad/s)."""
        self.data.ctrl[:3] = wanted

    def fault(self):
        """A platform has no joint limits."""
        return None
