"""A laboratory's own MuJoCo model, driven by a compiled policy of Vibrissa.

Nothing of Vibrissa's simulators is used: the model below gives samples and takes commands, as any other model or a robot would.

    pip install vibrissa mujoco
    python foreign_simulator.py --policy thesis --out tips.csv
"""

import argparse
import csv
import math
import pathlib
import sys

import mujoco
import numpy as np
import vibrissa

# The scene: a box, and where the platform starts (m, rad).
BOX_CENTRE, BOX_SIDE, BOX_YAW = np.array([0.32, 0.2]), 0.4, math.radians(10)
START, START_HEADING = [0.0, 0.072], math.pi / 2

# The whiskers are round wires: length and radius (m), Young's modulus (Pa), density (kg/m^3).
LENGTH, RADIUS, YOUNG, DENSITY = 0.075, 0.125e-3, 100e9, 6450.0
# Their bases: ahead of the centre of mass and beside it (m), and the angle to the heading (rad).
AHEAD, BESIDE, DIRECTION = 0.053, 0.030, math.radians(105)
# The hinge of a base: stiffness (N m/rad), damping (N m s/rad), inertia (kg m^2).
STIFFNESS, DAMPING, ARMATURE = 1.0, 0.01, 1e-5
LINKS = 40
# The platform: mass (kg), moment of inertia (kg m^2), time constant of its servos (s).
MASS, INERTIA, SERVO = 0.51, 1.5e-3, 0.05

# The same array as control knows it. What is not named is as in the reference rig of Vibrissa.
WHISKER = f"length: {LENGTH * 1e3} mm, radius: {RADIUS * 1e6} um, young_modulus: {YOUNG / 1e9} GPa, density: {DENSITY} kg/m^3"
RIG = f"""
platform: {{servo: {SERVO * 1e3} ms}}
whiskers: {{r0: {{{WHISKER}}}, l0: {{{WHISKER}}}}}
"""

STEPS_PER_SAMPLE = 10
# A link weighs so little that MuJoCo's default contact gives way by millimetres. With this stiffness (1/s^2) and damping (1/s), which
# a step of a third of a millisecond still holds, it is some hundredths of a millimetre.
CONTACT = 'solref="-5e7 -1.4e4" solimp="0.9999 0.9999 0.0001"'


def whisker(name, side):
    """MJCF of a whisker at the left (side 1) or right (side -1): rigid links with springs between them."""
    link = LENGTH / LINKS
    mass = DENSITY * math.pi * RADIUS**2 * link
    moment = mass * link**2 / 12
    spring = YOUNG * math.pi * RADIUS**4 / 4 / link
    chain = [
        f'<body pos="{link if index else 0} 0 0">'
        f'<inertial pos="{link / 2} 0 0" mass="{mass}" diaginertia="{moment} {moment} {moment}"/>'
        # Half a link bends before the first joint, and a whole one between two others.
        f'<joint type="hinge" axis="0 0 1" stiffness="{spring * (1 if index else 2)}" damping="{1e-3 * spring}"/>'
        f'<geom type="capsule" fromto="0 0 0 {link} 0 0" size="{RADIUS}" contype="1" conaffinity="2"/>'
        for index in range(LINKS)
    ]
    return (
        f'<body pos="{AHEAD} {side * BESIDE} 0" euler="0 0 {side * DIRECTION}">'
        '<inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
        f'<joint name="{name}" type="hinge" axis="0 0 1" stiffness="{STIFFNESS}" damping="{DAMPING}" armature="{ARMATURE}"/>'
        f"{''.join(chain)}{'</body>' * (LINKS + 1)}"
    )


def model(sample_period_s, friction):
    """The MuJoCo model of the box, the platform and its whiskers."""
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <option timestep="{sample_period_s / STEPS_PER_SAMPLE}" gravity="0 0 0" integrator="implicitfast" cone="elliptic"/>
  <default><geom friction="{friction} 0 0" condim="{3 if friction else 1}" {CONTACT}/></default>
  <worldbody>
    <geom type="box" pos="{BOX_CENTRE[0]} {BOX_CENTRE[1]} 0" euler="0 0 {BOX_YAW}" size="{BOX_SIDE / 2} {BOX_SIDE / 2} 0.02"
          contype="2" conaffinity="1"/>
    <body>
      <inertial pos="0 0 0" mass="{MASS}" diaginertia="{INERTIA} {INERTIA} {INERTIA}"/>
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="y" type="slide" axis="0 1 0"/>
      <joint name="yaw" type="hinge" axis="0 0 1"/>
      {whisker("r0", -1)}
      {whisker("l0", 1)}
    </body>
  </worldbody>
  <actuator>
    <velocity joint="x" kv="{MASS / SERVO}"/>
    <velocity joint="y" kv="{MASS / SERVO}"/>
    <velocity joint="yaw" kv="{INERTIA / SERVO}"/>
  </actuator>
</mujoco>""")


def distance_to_box(points):
    """Distances (m) of points (N x 2) from the contour of the box."""
    cos, sin = math.cos(BOX_YAW), math.sin(BOX_YAW)
    local = np.abs((points - BOX_CENTRE) @ np.array([[cos, -sin], [sin, cos]])) - BOX_SIDE / 2
    outside = np.hypot(*np.maximum(local, 0).T)
    return np.abs(outside + np.minimum(local.max(axis=1), 0))


# ANCHOR: loop
def trace(policy, friction, time_limit_s, recording=None):
    """Drives the model by a policy. Gives the recorded tips (N x 2) and their standard deviations (m), and how the run ended.

    Writes a recording to the path `recording`, if there is one.
    """
    rig = vibrissa.Rig.load(vibrissa.Text(RIG, "rig.yaml"))
    control = vibrissa.compile(policy).start(rig, record=recording is not None)
    engine = model(1 / rig.sample_rate_hz, friction)
    state = mujoco.MjData(engine)
    state.qpos[:3] = [*START, START_HEADING]
    hinges = [engine.joint(name).qposadr[0] for name in rig.whiskers]
    samples_per_tick = round(rig.sample_rate_hz / rig.control_rate_hz)

    tips, deviations = [], []
    while control.status == "running" and state.time < time_limit_s:
        times, positions, headings, angles = [], [], [], []
        for _ in range(samples_per_tick):
            mujoco.mj_step(engine, state, STEPS_PER_SAMPLE)
            times.append(state.time)
            positions.append(state.qpos[:2].copy())
            headings.append(state.qpos[2])
            angles.append(state.qpos[hinges])
        command = control.tick(np.array(times), np.array(positions), np.array(headings), np.array(angles))
        state.ctrl[:] = [*command.velocity_m_s, command.yaw_rate_rad_s]
        seen = control.perceived(closed_within_m=5e-3, closed_after_s=5.0)
        tips.extend(seen["tip_m"][seen["recorded"]])
        deviations.extend(seen["tip_spread_m"][seen["recorded"]])
        if seen["loop_closed"].any():
            end = f"closed the loop after {state.time:.1f} s"
            break
    else:
        end = f"{control.status}: {control.reason}" if control.reason else f"{control.status} after {state.time:.1f} s"
    if recording is not None:
        pathlib.Path(recording).write_bytes(control.recording())
    return np.array(tips).reshape(-1, 2), np.array(deviations), end
# ANCHOR_END: loop


def main():
    """Prints the errors of a run, and writes its tips if asked to. Exits with 1 unless the loop was closed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--policy", default="thesis", help="a built-in policy, or the path of one")
    parser.add_argument("--friction", type=float, default=0.0, help="coefficient of friction of the box")
    parser.add_argument("--time-limit", type=float, default=240.0, metavar="S", help="simulated seconds")
    parser.add_argument("--out", metavar="CSV", help="where to write the recorded tips")
    parser.add_argument("--record", metavar="MCAP", help="where to write the recording, for `vibrissa replay`")
    options = parser.parse_args()
    tips, deviations, end = trace(options.policy, options.friction, options.time_limit, options.record)
    print(f"{options.policy}: {end}, {len(tips)} tips")
    if len(tips):
        errors = distance_to_box(tips)
        within = np.mean(errors <= 1.96 * deviations)
        print(f"error: mean {errors.mean() * 1e3:.3f} mm, largest {errors.max() * 1e3:.3f} mm, {within:.0%} in the 95 % interval")
    if options.out:
        with open(options.out, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["x_m", "y_m", "deviation_m"])
            rows.writerows([*tip, deviation] for tip, deviation in zip(tips, deviations))
    return 0 if end.startswith("closed") else 1


if __name__ == "__main__":
    sys.exit(main())
