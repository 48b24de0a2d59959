#!/usr/bin/env python3
"""Compares the results of two programs bit by bit, after a change that must not change any.

    xtask/same.py BEFORE AFTER [--rename OLD=NEW]... [--count 50]

Each program runs the bench, scenes of all families, a sweep, and its own policies in a scenario, and compiles its policies.
`--rename` says that BEFORE has another word for a key or a word of the language. Hashes, times, dates and commits are left out.
A compiled policy contains its words. So where these differ, AFTER runs the artifact of BEFORE, and the commands must be equal.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# What says which program ran, on which text, how long and when.
OWN_OF_A_PROGRAM = {"provenance", "inputs", "start_s", "wall_s", "realtime", "tick_us", "hash", "key", "policy_hash", "machine_hash"}
POLICIES = ["thesis", "vibrissa"]
SCENARIO = Path(__file__).resolve().parent.parent / "scenarios" / "disk.yaml"
SWEEP = """name: same
policies: [vibrissa, thesis]
scenes:
  - {family: smooth-curve, trials: 2, seed: 7}
vary:
  policy:
    speed: [2 cm/s, 5 cm/s]
"""


def values(document):
    """The document without what belongs to a program. Numbers are the texts that it printed."""
    if isinstance(document, dict):
        return {key: values(value) for key, value in document.items() if key not in OWN_OF_A_PROGRAM}
    return [values(value) for value in document] if isinstance(document, list) else document


def read(text):
    """A text of JSON or of lines of JSON."""
    numbers = {"parse_float": str, "parse_int": str, "parse_constant": str}
    try:
        return values(json.loads(text, **numbers))
    except json.JSONDecodeError:
        return [values(json.loads(line, **numbers)) for line in text.splitlines()]


def difference(before, after, path=""):
    """The path of the first difference and both values. `None` if there is none."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in sorted(before.keys() | after.keys()):
            if found := difference(before.get(key, "(missing)"), after.get(key, "(missing)"), f"{path}.{key}"):
                return found
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for index, pair in enumerate(zip(before, after)):
            if found := difference(*pair, f"{path}[{index}]"):
                return found
    elif before != after:
        return f"{path}: {str(before)[:200]} is now {str(after)[:200]}"
    return None


def run(program, folder, *arguments):
    """The standard output. 1 says only that an expectation failed."""
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{program} {' '.join(arguments)}: status {done.returncode}\n{done.stderr}")
    return done.stdout


def documents(program, folder, count):
    """Names and texts of all documents."""
    (folder / "same.yaml").write_text(SWEEP)
    yield "bench", run(program, folder, "bench", "--ideal", "--json")
    yield "families", run(program, folder, "families", "--count", str(count), "--json")
    yield "sweep", run(program, folder, "sweep", "same.yaml", "--out", "sweep", "--json")
    lines = (folder / "sweep" / "results.jsonl").read_text().splitlines()
    # Runs end in any order.
    yield "runs of the sweep", "\n".join(sorted(lines, key=lambda line: json.dumps(read(line), sort_keys=True)))
    for policy in POLICIES:
        run(program, folder, "compile", policy, "--out", f"{policy}.machine")
        yield f"run of {policy}", run(program, folder, "run", str(SCENARIO), "--policy", policy, "--ticks", f"{policy}.jsonl", "--json")
        yield f"ticks of {policy}", (folder / f"{policy}.jsonl").read_text()


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("before", type=Path)
    arguments.add_argument("after", type=Path)
    arguments.add_argument("--rename", action="append", default=[], metavar="OLD=NEW")
    arguments.add_argument("--count", type=int, default=50, help="scenes of each family")
    asked = arguments.parse_args()
    renames = [name.split("=", 1) for name in asked.rename]

    def renamed(text):
        for old, new in renames:
            text = re.sub(rf"\b{re.escape(old)}\b", new, text)
        return text

    failed = False

    def report(name, found):
        nonlocal failed
        failed |= found is not None
        print(f"{name}: {found or 'the same'}", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder, "before"), Path(folder, "after")
        before.mkdir()
        after.mkdir()
        programs = asked.before.resolve(), asked.after.resolve()
        pairs = zip(documents(programs[0], before, asked.count), documents(programs[1], after, asked.count))
        for (name, old), (_, new) in pairs:
            report(name, difference(read(renamed(old)), read(new)))
        for policy in POLICIES:
            artifact = before / f"{policy}.machine"
            if artifact.read_bytes() == (after / artifact.name).read_bytes():
                report(f"artifact of {policy}", None)
                continue
            run(programs[1], after, "run", str(SCENARIO), "--policy", str(artifact), "--ticks", "old.jsonl")
            ticks = [read((after / file).read_text()) for file in ["old.jsonl", f"{policy}.jsonl"]]
            report(f"ticks of the former artifact of {policy}", difference(read(renamed(json.dumps(ticks[0]))), ticks[1]))
    sys.exit(failed)


if __name__ == "__main__":
    main()
