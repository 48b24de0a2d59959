"""The array of the thesis in MuJoCo, its rig as control knows it, and the box that it traces."""

import math

import numpy as np

# The body (m): length, widths at tail and nose, distance of the centre of mass from the tail, height.
LENGTH, TAIL, NOSE, CENTRE, HEIGHT = 0.09, 0.06, 0.0118, 0.035, 0.035
# The foremost whiskers, those that a policy for two needs: bases ahead and beside (m), and the direction of the shafts (rad).
AHEAD, BESIDE, DIRECTION = 0.025, 0.0149, math.radians(75)
# A shaft: length, radius (m), Young's modulus (Pa), density (kg/m^3). The hinge: N m/rad, N m s/rad, kg m^2.
SHAFT, RADIUS, YOUNG, DENSITY = 0.075, 0.125e-3, 100e9, 6450.0
STIFFNESS, DAMPING, ARMATURE = 1.0, 0.01, 1e-5
LINKS = 20
SIDES = {"r0": -1, "l0": 1}

# The box: centre, height of its middle, side (m), and how it is turned (rad). It is in the middle of the arm's reach.
BOX_CENTRE, BOX_LEVEL, BOX_SIDE, BOX_YAW = np.array([0.52, 0.0]), 0.2, 0.2, math.radians(10)

# MuJoCo's default contact gives way by millimetres for links that weigh micrograms.
CONTACT = 'solref="-5e7 -1.4e4" solimp="0.9999 0.9999 0.0001"'


def rig(carrier):
    """The rig as a text, with the time constants and the limits of what carries the array."""
    whisker = (
        f"length: {SHAFT * 1e3} mm, radius: {RADIUS * 1e6} um, young_modulus: {YOUNG / 1e9} GPa, density: {DENSITY} kg/m^3, links: {LINKS}"
    )
    places = "\n".join(
        f"  {name}: {{base: [{AHEAD * 1e3} mm, {side * BESIDE * 1e3} mm], direction: {side * math.degrees(DIRECTION)} deg, {whisker}}}"
        for name, side in SIDES.items()
    )
    body = f"tail_width: {TAIL} m, nose_width: {NOSE} m, length: {LENGTH} m, centre_of_mass: {CENTRE} m"
    servos = f"servo: {carrier.servo_s * 1e3} ms, yaw_servo: {carrier.yaw_servo_s * 1e3} ms"
    limits = f"speed_limit: {carrier.speed_limit_m_s} m/s, yaw_rate_limit: {carrier.yaw_rate_limit_rad_s} rad/s"
    return f"platform: {{{body}, {servos}, {limits}}}\nwhiskers:\n{places}\n"


def whisker(name, side):
    """MJCF of a whisker: rigid links with springs between them."""
    link = SHAFT / LINKS
    mass = DENSITY * math.pi * RADIUS**2 * link
    moment = mass * link**2 / 12
    spring = YOUNG * math.pi * RADIUS**4 / 4 / link
    chain = "".join(
        f'<body pos="{link if index else 0} 0 0">'
        f'<inertial pos="{link / 2} 0 0" mass="{mass}" diaginertia="{moment} {moment} {moment}"/>'
        # Half a link bends before the first joint, and a whole one between two others.
        f'<joint type="hinge" axis="0 0 1" stiffness="{spring * (1 if index else 2)}" damping="{1e-3 * spring}"/>'
        f'<geom type="capsule" fromto="0 0 0 {link} 0 0" size="{RADIUS}" contype="1" conaffinity="2" condim="1" {CONTACT}/>'
        for index in range(LINKS)
    )
    direction = side * DIRECTION / 2
    return (
        f'<body pos="{AHEAD} {side * BESIDE} 0" quat="{math.cos(direction)} 0 0 {math.sin(direction)}">'
        '<inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
        f'<joint name="{name}" type="hinge" axis="0 0 1" stiffness="{STIFFNESS}" damping="{DAMPING}" armature="{ARMATURE}"/>'
        f"{chain}{'</body>' * (LINKS + 1)}"
    )


def array():
    """MJCF of the array, whose origin is the centre of mass: a body with a sensor site, and two whiskers."""
    shape = '<geom name="hull" type="mesh" mesh="hull" mass="0.05" contype="0" conaffinity="2" rgba=".8 .5 .2 1"/>'
    return f"{shape}{''.join(whisker(name, side) for name, side in SIDES.items())}"


def hull():
    """The asset of the body: a trapezoid whose narrow end is ahead."""
    corners = [(x, side * y, z) for x, y in [(-CENTRE, TAIL / 2), (LENGTH - CENTRE, NOSE / 2)] for side in (1, -1) for z in (-1, 1)]
    return " ".join(f"{x} {y} {z * HEIGHT / 2}" for x, y, z in corners)


def scene(carrier, start, step_s):
    """MJCF of the carrier with the array at `start` (x, y in m, heading in rad), and of the box on its column."""
    body = carrier.mjcf(array(), (start[0], start[1], BOX_LEVEL, start[2]))
    half, column = BOX_SIDE / 2, (BOX_LEVEL - 0.02) / 2
    turned = f"{math.cos(BOX_YAW / 2)} 0 0 {math.sin(BOX_YAW / 2)}"
    return f"""
<mujoco>
  <compiler angle="radian"/>
  <option timestep="{step_s}" integrator="implicitfast" cone="elliptic"/>
  <visual><global offwidth="1280" offheight="960"/><map znear="0.01"/></visual>
  <asset>
    <mesh name="hull" vertex="{hull()}"/>
    <texture name="sky" type="skybox" builtin="gradient" rgb1=".9 .95 1" rgb2=".6 .7 .8" width="64" height="64"/>
  </asset>
  <worldbody>
    <light pos="1 -1 2.5" dir="-.3 .4 -1"/>
    <geom type="plane" size="2 2 .1" rgba=".75 .75 .75 1" contype="0" conaffinity="0"/>
    <body pos="{BOX_CENTRE[0]} {BOX_CENTRE[1]} 0" quat="{turned}">
      <geom name="box" type="box" pos="0 0 {BOX_LEVEL}" size="{half} {half} 0.02" contype="2" conaffinity="5" condim="1" rgba=".3 .5 .8 1"
            {CONTACT}/>
      <geom type="box" pos="0 0 {column}" size="{half / 2} {half / 2} {column}" contype="0" conaffinity="0" rgba=".5 .5 .5 1"/>
    </body>
  </worldbody>
  {body}
</mujoco>"""


def distance_to_box(points):
    """Distances (m) of points (N x 2) from the contour of the box."""
    cos, sin = math.cos(BOX_YAW), math.sin(BOX_YAW)
    local = np.abs((points - BOX_CENTRE) @ np.array([[cos, -sin], [sin, cos]])) - BOX_SIDE / 2
    outside = np.hypot(*np.maximum(local, 0).T)
    return np.abs(outside + np.minimum(local.max(axis=1), 0))
