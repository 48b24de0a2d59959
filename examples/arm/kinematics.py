"""Differential kinematics: joint velocities for a motion in the horizontal plane with the tool pointing down."""

import numpy as np

# Feedback (1/s) by which height and inclination of the tool return to their values.
HOLD = 5.0
# A length (m) makes rotations comparable with translations. It is about that of the forearm.
LEVER = 0.3
# Below this singular value of the Jacobian (m) the inverse is damped, so that joints do not race near a singular posture.
NEARLY_SINGULAR, DAMPING = 0.05, 0.05
# Factor (rad^2/s) between the gradient that keeps joints from their limits and the motion in the null space. A small one lets the
# elbow come late at corners, so that a limit or a singularity is near. The largest speed (rad/s) of this motion is that from which
# the joints stop together with the tool.
AVOIDANCE, FASTEST_AVOIDANCE = 1.0, 0.6


def twist(velocity_m_s, yaw_rate_rad_s, height_error_m, down):
    """The twist (m/s, rad/s) of the tool: that of the command, and what corrects its height and the direction `down` of its axis."""
    inclination = np.cross(down, [0.0, 0.0, -1.0])
    return np.array([*velocity_m_s, HOLD * height_error_m, *(HOLD * inclination[:2]), yaw_rate_rad_s])


def joint_velocities(jacobian, wanted, angles, limits, fastest):
    """Joint velocities (rad/s) that give a twist, keep away from the joint limits, and exceed no velocity in `fastest`.

    `jacobian` has the rows of the translation (m) and of the rotation (rad) of the tool, `limits` a row for each joint. A twist that is
    too fast is slowed down as a whole, so that the tool keeps its path. The null space has what the twist leaves.
    """
    scale = np.array([1.0, 1.0, 1.0, LEVER, LEVER, LEVER])
    jacobian, wanted = jacobian * scale[:, None], wanted * scale
    left, singular, right = np.linalg.svd(jacobian, full_matrices=False)
    # Damped least squares with a damping that begins smoothly (Nakamura and Hanafusa, 1986).
    damped = DAMPING**2 * np.clip(1 - (singular[-1] / NEARLY_SINGULAR) ** 2, 0, None)
    task = right.T @ (singular / (singular**2 + damped) * (left.T @ wanted))
    task *= min(1.0, *(fastest / np.maximum(np.abs(task), 1e-12)))
    # Down the gradient of a barrier, the sum of 1 / (1 - u^2), where u is the angle as a share of half the range.
    middle, half = limits.mean(axis=1), np.ptp(limits, axis=1) / 2
    share = np.clip((angles - middle) / half, -0.99, 0.99)
    avoid = -AVOIDANCE * share / (1 - share**2) ** 2 / half
    avoid -= right.T @ (right @ avoid)
    avoid *= min(1.0, FASTEST_AVOIDANCE / max(np.abs(avoid).max(), 1e-12))
    room = np.where(avoid > 0, fastest - task, fastest + task)
    avoid *= min(1.0, *(room / np.maximum(np.abs(avoid), 1e-12)))
    return task + avoid


def fastest_near_limits(angles, limits, velocity, acceleration):
    """The velocity limits (rad/s) of joints that must come to rest before the limits of their angles."""
    distance = np.minimum(angles - limits[:, 0], limits[:, 1] - angles)
    return np.minimum(velocity, np.sqrt(2 * acceleration * np.maximum(distance, 0)))
