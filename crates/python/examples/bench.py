"""Prints the figures of the bench: the built-in scenarios under the built-in policies, as `vibrissa bench` has them.

    python bench.py                     # all scenarios in MuJoCo
    python bench.py quasistatic disk    # one scenario in the other simulator
    python bench.py --json quasistatic  # the whole results
"""

import json
import sys
from concurrent.futures import ThreadPoolExecutor

import vibrissa


def bench(world, scenarios):
    """The figures of every scenario under every built-in policy, in the order of the bench."""
    pairs = [(scenario, policy) for scenario in scenarios for policy in vibrissa.policies()]
    # A run releases Python's lock, so that runs on threads go on at the same time.
    with ThreadPoolExecutor() as pool:
        return list(pool.map(lambda pair: vibrissa.run(*pair, world=world).figures, pairs))


def main(arguments):
    as_json = "--json" in arguments
    world, *scenarios = [argument for argument in arguments if argument != "--json"] or ["mujoco"]
    figures = bench(world, scenarios or vibrissa.scenarios())
    if as_json:
        print(json.dumps(figures, indent=2))
        return
    for run in figures:
        error, coverage = run["error_mm"]["mean"], 100 * run["coverage"]
        print(f"{run['scenario']:18} {run['policy']:9} {run['outcome']:10} {error:6.3f} mm {coverage:6.1f} %")


if __name__ == "__main__":
    main(sys.argv[1:])
