"""A figure of the thesis, drawn anew: the estimated contour of an object.

Figures 5.1 to 5.7 of the thesis have one object each. Points are green if their error is within one standard deviation of the mean, and red
otherwise. Crosses are the edge points (red) and the retrieved points (black). This is the figure of the box:

    pip install matplotlib
    python crates/python/examples/figure.py box --out box.png

The notebook `figure.ipynb` draws it step by step, with the functions of this file.
"""

import argparse

import numpy as np
import vibrissa

# Objects of the figures, by their number.
FIGURES = {"disk": "5.1", "rounded-rectangle": "5.2", "complex": "5.3", "octagon": "5.4", "box": "5.5", "prism": "5.6", "wall": "5.7"}


def distances_m(points, outlines):
    """Distances of points (N x 2) from closed polylines."""
    nearest = np.full(len(points), np.inf)
    for outline in outlines:
        starts, ways = outline, np.roll(outline, -1, axis=0) - outline
        for start, way in zip(starts, ways):
            share = np.clip((points - start) @ way / max(way @ way, 1e-30), 0, 1)
            nearest = np.minimum(nearest, np.hypot(*(points - start - share[:, None] * way).T))
    return nearest


def retrievals(ticks):
    """Edge points and retrieved points (m, N x 2 each): the last recorded tip before a whisker is lost, and the tip at which it is found again."""
    pairs = []
    for whisker in range(ticks["recorded"].shape[1]):
        tips, recorded = ticks["tip_m"][:, whisker], ticks["recorded"][:, whisker]
        edge = None
        for tick in np.flatnonzero(ticks["lost"][:, whisker] | ticks["found"][:, whisker]):
            if ticks["found"][tick, whisker] and edge is not None:
                pairs.append((edge, tips[tick]))
                edge = None
            elif ticks["lost"][tick, whisker] and edge is None and recorded[: tick + 1].any():
                edge = tips[: tick + 1][recorded[: tick + 1]][-1]
    return np.array(pairs).reshape(-1, 2, 2).swapaxes(0, 1)


def draw(axes, trial, result):
    """Draws the object, the way of the platform, the recorded tips and the retrievals. Gives the errors of the tips (m)."""
    ticks = result.ticks
    tips = ticks["tip_m"][ticks["recorded"]]
    outlines = trial.outlines()
    errors = distances_m(tips, outlines)
    for outline in outlines:
        axes.fill(*outline.T, facecolor="0.92", edgecolor="0.6", linewidth=0.5)
    axes.plot(*ticks["position_m"].T, color="tab:blue", linewidth=0.6, label="centre of mass")
    axes.plot(*ticks["position_m"][0], "k.", label="start")
    usual = np.abs(errors - errors.mean()) < errors.std(ddof=1)
    for among, colour, label in [(usual, "tab:green", "estimated contour"), (~usual, "tab:red", "its largest errors")]:
        axes.scatter(*tips[among].T, c=colour, s=2, label=label, zorder=3)
    for points, colour, label in zip(retrievals(ticks), ["tab:red", "black"], ["edge points", "retrieved points"]):
        if len(points):
            axes.scatter(*points.T, c=colour, marker="x", s=25, linewidths=1, label=label, zorder=4)
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m")
    axes.legend(loc="center", fontsize="x-small")
    return errors


def main():
    """Runs a scenario and draws it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", nargs="?", choices=list(FIGURES), default="box")
    parser.add_argument("--policy", default="thesis", help="a built-in policy, or the path of one")
    parser.add_argument("--world", choices=["quasistatic", "mujoco"], default="quasistatic")
    parser.add_argument("--out", default="figure.png", help="a picture: PNG, PDF or SVG")
    options = parser.parse_args()
    # Whoever uses only the functions above needs no matplotlib.
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    trial = vibrissa.Trial(options.scenario, options.policy, world=options.world)
    figure, axes = pyplot.subplots(figsize=(6, 5), layout="constrained")
    errors = draw(axes, trial, trial.run()) * 1e3
    said = f"error {errors.mean():.2f} mm, standard deviation {errors.std():.2f} mm, largest {errors.max():.1f} mm"
    axes.set_title(f"Figure {FIGURES[options.scenario]} with {options.policy}\n{said}", fontsize="medium")
    figure.savefig(options.out, dpi=200)
    print(f"{options.out}: {said}")


if __name__ == "__main__":
    main()
