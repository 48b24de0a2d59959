"""How many steps per second environments make: one alone, several in turn, and several in processes.

    python crates/python/examples/vector_rate.py --environments 4
"""

import argparse
import os
import time

import gymnasium
import vibrissa.gym  # noqa: F401, registers the environment


def rate(environments, steps):
    """Steps of all environments per second. Each begins a new episode when its own has ended."""
    environments.reset(seed=1)
    environments.action_space.seed(1)
    environments.step(environments.action_space.sample())
    began = time.perf_counter()
    for _ in range(steps):
        environments.step(environments.action_space.sample())
    rate = steps * environments.num_envs / (time.perf_counter() - began)
    environments.close()
    return rate


def main():
    """Prints a row for each kind."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--environments", type=int, default=os.cpu_count())
    parser.add_argument("--steps", type=int, default=1000, help="steps of each environment")
    parser.add_argument("--world", choices=["quasistatic", "mujoco"], default="quasistatic")
    options = parser.parse_args()
    for name, count, mode in [("one", 1, "sync"), ("in turn", options.environments, "sync"), ("in processes", options.environments, "async")]:
        made = gymnasium.make_vec("Vibrissa-v0", num_envs=count, vectorization_mode=mode, world=options.world, jitter=(0.02, 0.2))
        print(f"{count:3d} {name:12s} {rate(made, options.steps):8.0f} steps/s")


if __name__ == "__main__":
    main()
