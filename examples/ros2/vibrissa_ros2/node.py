"""Drives a robot with whiskers by a compiled machine."""
import math

import rclpy
import vibrissa
from geometry_msgs.msg import PoseStamped, Twist
from rclpy.node import Node
from sensor_msgs.msg import JointState

class WhiskerNode(Node):
    def __init__(self):
        super().__init__("vibrissa")
        rig = vibrissa.Rig(self.declare_parameter("rig", "disk").value)
        machine = vibrissa.Machine.load(self.declare_parameter("machine", "policy.machine").value)
        self.control, self.whiskers, self.samples = machine.start(rig), rig.whiskers, []
        self.place, self.heading, self.start = None, 0.0, None
        self.commands = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(PoseStamped, "pose", self.on_pose, 10)
        self.create_subscription(JointState, "base_angles", self.on_base_angles, 100)
        self.create_timer(1.0 / rig.control_rate_hz, self.on_timer)
    def on_pose(self, message):
        turn, self.place = message.pose.orientation, (message.pose.position.x, message.pose.position.y)
        yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
        self.heading += math.remainder(yaw - self.heading, math.tau)  # it counts whole rotations
    def on_base_angles(self, message):
        if self.place is not None:
            time, angles = message.header.stamp, dict(zip(message.name, message.position))
            self.start = self.start or time
            seconds = time.sec - self.start.sec + 1e-9 * (time.nanosec - self.start.nanosec)
            self.samples.append((seconds, self.place, self.heading, [angles.get(name, math.nan) for name in self.whiskers]))
    def on_timer(self):
        if self.samples:  # without one, the receiver of the commands stops the robot
            command, twist, self.samples = self.control.tick(*zip(*self.samples)), Twist(), []
            twist.linear.x, twist.linear.y = command.velocity_body_m_s(self.heading)
            twist.angular.z = command.yaw_rate_rad_s
            self.commands.publish(twist)
def main():
    rclpy.init()
    rclpy.spin(WhiskerNode())
