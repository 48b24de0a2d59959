"""The Gymnasium environment `Vibrissa-v0`: a platform with whiskers that traces an outline."""

import math

import gymnasium
import numpy as np

from . import Rig, Text, Trial

#: Points of the reward for a metre of outline that is traced for the first time.
TRACED_PER_M = 100.0
#: Cost of each step in which the body of the platform touches something.
TOUCH_COST = 0.1
#: Cost of an episode that ends because the body was driven into something.
CRASH_COST = 10.0


class WhiskerEnv(gymnasium.Env):
    """Steer a platform with whiskers so that it traces the outline of an object.

    A step is one control period. The action has three numbers from -1 to 1: velocity forward, velocity to the left, and yaw
    rate, as shares of the limits `speed_m_s` and `yaw_rate_rad_s`.

    The observation is a dictionary: `deflection` (base angles, rad), `touching` (0 or 1), `tip_m` (estimated tips of touching
    whiskers in the frame of the body), `position_m`, and `heading` (cosine and sine).

    The reward of a step is `TRACED_PER_M` for each metre of outline that it traces for the first time, minus `TOUCH_COST` if
    the body touches something. A crash costs `CRASH_COST`. An outline is traced where the estimated tips come within 1 mm,
    as for the coverage of a run.

    An episode is terminated when the scenario completes, for instance when the loop closes, and when it fails, for instance by a crash.
    It is truncated after the time limit of the scenario.
    """

    metadata = {"render_modes": ["rgb_array", "svg"], "render_fps": 30}

    def __init__(
        self,
        scenario="disk",
        *,
        world="quasistatic",
        mismatch=None,
        uncalibrated=False,
        jitter=None,
        time_limit_s=None,
        speed_m_s=0.1,
        yaw_rate_rad_s=1.0,
        render_mode=None,
    ):
        """Make an environment of a scenario.

        `scenario` is a path, the name of a built-in scenario, or a `Text`. It may also be a function that receives a seed and
        returns one of these, for another scene in each episode. `mismatch` is drawn anew in each episode. The array
        then calibrates itself, unless `uncalibrated`. `jitter` is the largest displacement of the start (m) and its largest rotation (rad).
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            known = " and ".join(repr(mode) for mode in self.metadata["render_modes"])
            raise ValueError(f"there is no render mode {render_mode!r}; there are {known}")
        self.render_mode = render_mode
        self._scenario = scenario
        self._options = dict(world=world, mismatch=mismatch, uncalibrated=uncalibrated, jitter=jitter, time_limit_s=time_limit_s)
        rig = Rig(self._scene(0))
        self._whiskers = rig.whiskers
        self._limits = np.array([speed_m_s, speed_m_s, yaw_rate_rad_s])
        self._policy = _recording(rig)
        self._trial = self._episode = self._result = self._frame = None
        self.metadata = {**self.metadata, "render_fps": rig.control_rate_hz}
        count = len(rig.whiskers)
        box = gymnasium.spaces.Box
        self.action_space = box(-1.0, 1.0, (3,), np.float32)
        self.observation_space = gymnasium.spaces.Dict(
            {
                "deflection": box(-math.pi, math.pi, (count,), np.float64),
                "touching": gymnasium.spaces.MultiBinary(count),
                "tip_m": box(-np.inf, np.inf, (count, 2), np.float64),
                "position_m": box(-np.inf, np.inf, (2,), np.float64),
                "heading": box(-1.0, 1.0, (2,), np.float64),
            }
        )

    def reset(self, *, seed=None, options=None):
        """Begin an episode. The seed determines the scene, the start, the mismatch and the noise of the sensors."""
        super().reset(seed=seed)
        scene, noise, mismatch = (int(drawn) for drawn in self.np_random.integers(2**63, size=3))
        if self._options["mismatch"] is not None:
            self._options["mismatch_seed"] = mismatch
        self._trial = Trial(self._scene(scene), self._policy, seed=noise, unused_seeds=True, **self._options)
        self._episode, self._result, self._frame = self._trial.begin(), None, None
        seen = self._episode.step(0.0, 0.0, 0.0)
        return self._observation(seen), self._info(seen)

    def step(self, action):
        """Simulate one control period."""
        if self._episode is None:
            raise gymnasium.error.ResetNeeded("call `reset` before `step`")
        forward, left, yaw_rate = np.clip(np.asarray(action, dtype=np.float64), -1.0, 1.0) * self._limits
        scale = min(1.0, self._limits[0] / max(math.hypot(forward, left), 1e-300))
        seen = self._episode.step(forward * scale, left * scale, yaw_rate)
        reward = TRACED_PER_M * seen.traced_m - TOUCH_COST * seen.body_touches - CRASH_COST * seen.crashed
        terminated = seen.outcome in ("completed", "failed")
        truncated = seen.outcome in ("timeout", "diverged")
        info = self._info(seen)
        if terminated or truncated:
            self._frame = self._episode.frame() if self.render_mode == "rgb_array" else None
            self._result = self._episode.result()
            info["figures"] = self._result.figures
            info["outcome"] = self._result.outcome
        return self._observation(seen), reward, terminated, truncated, info

    def render(self):
        """What the render mode asks for.

        `rgb_array`: the scene from above after the newest step, an array of 600 x 800 x 3 numbers (uint8).
        `svg`: the picture of the finished episode. An episode that goes on has none.
        """
        if self.render_mode == "rgb_array":
            if self._episode is None:
                raise gymnasium.error.ResetNeeded("call `reset` before `render`")
            return self._episode.frame() if self._frame is None else self._frame.copy()
        return self._result.picture() if self.render_mode == "svg" and self._result else None

    @property
    def result(self):
        """The `Result` of the finished episode. `None` while it goes on."""
        return self._result

    def __getstate__(self):
        if self._episode is not None:
            raise TypeError(
                "an environment with an episode cannot be pickled, because its simulation goes on; make an environment in the "
                "other process and reset it there with the same seed, or pickle `environment.unwrapped.result` at the end"
            )
        return self.__dict__

    def _scene(self, seed):
        return self._scenario(seed) if callable(self._scenario) else self._scenario

    def _observation(self, seen):
        touching = seen.touching.astype(np.int8)
        return {
            "deflection": np.clip(np.nan_to_num(seen.deflection_rad), -math.pi, math.pi),
            "touching": touching,
            "tip_m": np.where(touching[:, None] == 1, np.nan_to_num(seen.tip_body_m), 0.0),
            "position_m": seen.position_m,
            "heading": np.array([math.cos(seen.heading_rad), math.sin(seen.heading_rad)]),
        }

    @staticmethod
    def _info(seen):
        info = {"time_s": seen.time_s, "traced_m": seen.traced_m, "body_touches": seen.body_touches}
        return info if seen.outcome is None else {**info, "outcome": seen.outcome, "reason": seen.reason}


def _recording(rig):
    """A policy that records the tips of all whiskers and gives no command of its own."""
    whiskers = "\n".join(f"whisker {name}" for name in rig.whiskers)
    records = "\n".join(f"  record {name}" for name in rig.whiskers)
    text = f"machine recording\n\n{whiskers}\n\ninitial Recording\n\nstate Recording {{\n{records}\n  stop\n}}\n"
    return Text(text, "recording.fsm")


gymnasium.register("Vibrissa-v0", entry_point="vibrissa.gym:WhiskerEnv")
