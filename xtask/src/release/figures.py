"""Runs the bench by the installed package, and compares with what the program printed, to the last digit."""

import json
import sys

import vibrissa

# Measured times and the origin differ between any two runs. Only a bench has conditions and verdicts.
OWN = {"provenance", "wall_s", "start_s", "realtime", "tick_us", "format", "version", "baseline", "conditions", "passed", "verdicts"}

with open(sys.argv[1]) as file:
    rows = json.load(file)
differing = []
for row in rows:
    figures = vibrissa.run(row["scenario"], row["policy"]).figures
    keys = (row.keys() | figures.keys()) - OWN
    differing += [(row["scenario"], row["policy"], key) for key in sorted(keys) if row.get(key) != figures.get(key)]
if differing or not rows:
    sys.exit(f"of {len(rows)} runs these figures differ: {differing}")
print(f"      {len(rows)} runs have the figures of the program")
