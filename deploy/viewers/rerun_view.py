"""Opens a recording of a run in Rerun, with what Rerun draws of the file and with a layout.

Rerun decodes transforms, poses and points of the file. This script adds the lines of the scene, of the platform and of the whiskers, the base
angles as curves and the states as a strip.

    pip install 'rerun-sdk>=0.41'
    python deploy/viewers/rerun_view.py box.mcap                   # opens the viewer
    python deploy/viewers/rerun_view.py box.mcap --save box.rrd    # writes a file that has all of it
"""

import argparse
import json

import rerun as rr
import rerun.blueprint as rrb
from rerun.chunk import McapReader

# The timeline that Rerun makes from the times of the messages.
TIMELINE = "message_log_time"
# Topics with `foxglove.SceneUpdate`: radius of the lines (m) and colour. Rerun decodes these messages, but it does not draw them.
LINES = {"scene": (1e-3, 0x73808FFF), "platform": (1e-3, 0x335999FF), "whiskers": (7.5e-4, 0xD9731AFF)}


def messages(path, topic, column):
    """The messages of a topic with their times."""
    for chunk in McapReader(path, include_topic_regex=[f"^{topic}$"]).stream():
        batch = chunk.to_record_batch()
        if column in batch.schema.names:
            times = batch.column(TIMELINE).to_numpy(zero_copy_only=False)
            yield from zip(times, (cell[0] for cell in batch.column(column).to_pylist()))


def values(path, topic):
    """The messages of a topic with JSON."""
    for time, message in messages(path, topic, "McapMessage:data"):
        yield time, json.loads(bytes(message))


def layout():
    """The scene from above on the left, states and base angles beside it."""
    above = rrb.EyeControls3D(position=(0.4, 0.4, 2.0), look_target=(0.4, 0.4, 0.0), eye_up=(0.0, 1.0, 0.0))
    scene = rrb.Spatial3DView(
        name="scene",
        contents=["/objects", "/contour", "/tips", "/transform", "/drawn/**"],
        spatial_information=rrb.SpatialInformation("world"),
        eye_controls=above,
    )
    states = rrb.StateTimelineView(name="states", contents="/states/**")
    angles = rrb.TimeSeriesView(name="base angles (rad)", contents="/base_angles/**")
    beside = rrb.Vertical(states, angles, row_shares=[1, 2])
    return rrb.Blueprint(rrb.Horizontal(scene, beside, column_shares=[3, 2]), rrb.TimePanel(timeline=TIMELINE))


def show(recording, path):
    """Logs a recorded run and its layout."""
    recording.log_file_from_path(path)
    for topic, (radius, colour) in LINES.items():
        for time, message in messages(path, topic, "foxglove.SceneUpdate:message"):
            recording.set_time(TIMELINE, timestamp=time)
            for entity in message["entities"]:
                strips = [[(p["x"], p["y"], p["z"]) for p in line["points"]] for line in entity["lines"]]
                drawn = rr.LineStrips3D(strips, radii=radius, colors=colour)
                recording.log(f"drawn/{topic}", rr.CoordinateFrame(entity["frame_id"]), drawn)
    shown = {}
    for time, state in values(path, "state"):
        recording.set_time(TIMELINE, timestamp=time)
        for level, name in [("outermost", state["outer"]), ("innermost", state["state"])]:
            if shown.get(level) != name:
                recording.log(f"states/{level}", rr.StateChange(state=name or None))
                shown[level] = name
    angles = {}
    for time, tick in values(path, "ticks"):
        for whisker in tick["whiskers"]:
            if whisker["deflection_rad"] is not None:
                angles.setdefault(whisker["whisker"], []).append((time, whisker["deflection_rad"]))
    for name, curve in angles.items():
        times, readings = zip(*curve)
        columns = rr.Scalars.columns(scalars=readings)
        recording.send_columns(f"base_angles/{name}", [rr.TimeColumn(TIMELINE, timestamp=times)], columns)
    # Last, because the viewer warns about a timeline that it has not yet received.
    recording.send_blueprint(layout())


def main():
    """Opens the viewer, or writes a file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", help="a file of `vibrissa run --record`")
    parser.add_argument("--save", metavar="FILE", help="write a file of Rerun in place of opening the viewer")
    options = parser.parse_args()
    recording = rr.RecordingStream("vibrissa")
    if options.save:
        recording.save(options.save)
    else:
        recording.spawn()
    show(recording, options.recording)
    recording.flush()


if __name__ == "__main__":
    main()
