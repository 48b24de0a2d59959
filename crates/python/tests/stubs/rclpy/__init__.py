"""The part of ROS 2's `rclpy` that the example uses, without a middleware."""


def init():
    """Nothing has to be started."""


def spin(node):
    """A test calls the callbacks itself."""
