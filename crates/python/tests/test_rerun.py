"""The layout for Rerun, which is installed separately: `pip install rerun-sdk`."""

import subprocess
import sys

import pytest
from conftest import ROOT

pytest.importorskip("rerun", reason="rerun-sdk is not installed")
chunk = pytest.importorskip("rerun.chunk", reason="rerun-sdk is older than 0.41")

SCRIPT = ROOT / "deploy/viewers/rerun_view.py"


def test_a_recording_opens_in_rerun_and_every_view_has_its_data(program, tmp_path):
    recording, shown = tmp_path / "box.mcap", tmp_path / "box.rrd"
    program("run", "scenarios/box.yaml", "--simulator", "quasistatic", "--record", recording)
    opened = subprocess.run([sys.executable, SCRIPT, recording, "--save", shown], capture_output=True, text=True)
    assert opened.returncode == 0 and "rror" not in opened.stderr, opened.stderr
    verified = subprocess.run([sys.executable, "-m", "rerun", "rrd", "verify", shown], capture_output=True, text=True)
    assert verified.returncode == 0 and "verified without error" in verified.stdout + verified.stderr, verified.stderr

    reader = chunk.RrdReader(shown)
    assert [len(reader.recordings()), len(reader.blueprints())] == [1, 1]
    columns, rows = {}, {}
    for part in reader.stream():
        batch = part.to_record_batch()
        columns.setdefault(part.entity_path, set()).update(batch.schema.names)
        rows[part.entity_path] = rows.get(part.entity_path, 0) + batch.num_rows
    expected = {
        "Points3D:positions": ["/objects", "/contour", "/tips"],
        "Transform3D:translation": ["/transform"],
        "LineStrips3D:strips": ["/drawn/scene", "/drawn/platform", "/drawn/whiskers"],
        "StateChange:state": ["/states/outermost", "/states/innermost"],
        "Scalars:scalars": ["/base_angles/r0", "/base_angles/l0"],
    }
    missing = [path for column, paths in expected.items() for path in paths if column not in columns.get(path, ())]
    assert missing == []
    # Whiskers are drawn in every second tick.
    assert rows["/drawn/whiskers"] > 500 and abs(2 * rows["/drawn/whiskers"] - rows["/base_angles/r0"]) <= 1
