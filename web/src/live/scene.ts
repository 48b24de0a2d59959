import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { set, svg } from "../shared/svg.ts";
import { Width } from "../shared/width.ts";
import { Zoom } from "../shared/zoom.ts";
import type { Answer } from "./answer.ts";
import type { Frame, Point, Pose } from "./protocol.ts";
import type { Run } from "./run.ts";
import { thinned, Track } from "./track.ts";
import type { Actions, Panel, View } from "./view.ts";
import { placed, World } from "./world.ts";

/** The width (m) of the part that is shown around the robot. */
const CLOSE = 0.45;
/** The largest height (px). */
const TALLEST = 560;
/** The time (s) of the drawn command. */
const AHEAD = 0.8;

/** The scene from above: objects, robot, whiskers and contour. */
export class Scene implements Panel {
  readonly element: HTMLElement;
  readonly #world = new World();
  /** The largest distance (m) of a part of the robot from its centre. */
  readonly #reach: number;
  readonly #svg = svg("svg", { viewBox: "0 0 100 100", "aria-hidden": "true" });
  readonly #objects = svg("path", { class: "objects" });
  readonly #track: Track;
  readonly #otherTrace = svg("path", { class: "trace other" });
  readonly #otherContour = svg("path", { class: "contour other" });
  readonly #otherPlatform = svg("path", { class: "platform other" });
  readonly #platform = svg("path", { class: "platform" });
  readonly #command = svg("path", { class: "command" });
  readonly #whiskers: SVGPathElement[];
  readonly #tips: SVGPathElement[];
  readonly #zoom: Zoom;
  readonly #drawing = element("div", "drawing");
  readonly #close: HTMLButtonElement;
  readonly #map: HTMLButtonElement;
  readonly #legend = element("p", "hint map-key", element("span", "free", "proved free"), element("span", "blocked", "surface"), element("span", "route", "route, ◇ what is next"), "The rest is unknown.");
  #isClose = false;
  readonly #width: Width;
  #drawnWidth = 0;
  #seen = 0;

  constructor(run: Run, actions: Actions) {
    const { hello } = run;
    const { platform, whiskers } = hello.rig;
    this.#reach = Math.max(0.05, ...platform.map(([x, y]) => Math.hypot(x, y)), ...whiskers.map(({ base: [x, y], length }) => Math.hypot(x, y) + length));
    this.#track = new Track(this.#world);
    this.#whiskers = hello.whiskers.map((name, index) => svg("path", { class: `whisker s${index % 8}` }, svg("title", {}, name)));
    this.#tips = hello.whiskers.map((_, index) => svg("path", { class: `tip s${index % 8}` }));
    this.#svg.append(
      this.#objects, this.#track.group, this.#otherTrace, this.#otherContour, this.#otherPlatform, this.#platform,
      this.#command, ...this.#whiskers, ...this.#tips,
    );
    this.#drawing.append(this.#svg);
    this.#zoom = new Zoom(this.#drawing, this.#svg);
    this.#width = new Width(this.#drawing, () => actions.refresh());
    this.#drawing.tabIndex = 0;
    this.#drawing.setAttribute("role", "group");
    this.#drawing.setAttribute("aria-label", "scene from above. Keys: plus and minus zoom, 0 shows everything, arrows move");
    this.#drawing.addEventListener("keydown", (event) => {
      if (!event.ctrlKey && !event.altKey && !event.metaKey && this.#zoom.key(event)) {
        this.#watch(false);
        event.preventDefault();
        event.stopPropagation();
      }
    });
    this.#drawing.addEventListener("pointerdown", () => this.#watch(false));
    this.#close = button("robot", () => this.#watch(!this.#isClose), "show the surroundings of the robot");
    this.#close.setAttribute("aria-pressed", "false");
    this.#map = button("map", () => this.#showMap(!this.#isMapShown), "show what the robot knows by touch: free ground, surfaces, route and next target");
    this.#showMap(true);
    [this.#map.hidden, this.#legend.hidden] = [true, true];
    const free = (action: () => void) => () => {
      this.#watch(false);
      action();
    };
    const tools = element("div", "tools");
    tools.append(
      this.#map,
      this.#close,
      button("+", free(() => this.#zoom.by(1.5)), "zoom into the scene"),
      button("−", free(() => this.#zoom.by(1 / 1.5)), "zoom out of the scene"),
      button("whole", free(() => this.#zoom.reset()), "show the whole scene"),
    );
    const note = hello.scene === null ? element("p", "hint", "The scene is not known, because no `--scenario` has it. Only what the robot has felt is shown.") : "";
    this.element = element("section", "scene", element("div", "head", element("h2", "", "Scene"), tools), this.#drawing, this.#legend, note);
    for (const outline of hello.scene ?? []) {
      outline.points.forEach((point) => this.#world.include(point, 0.05));
    }
    if (hello.start) {
      this.#world.include([hello.start[0], hello.start[1]], this.#reach);
    }
  }

  update({ run, frame, answer }: View): void {
    const { scene, start } = run.hello;
    if (frame === undefined && scene === null && start === null) {
      return;
    }
    const hasGrown = this.#include(run, answer);
    const width = this.#width.value;
    if (hasGrown || width !== this.#drawnWidth) {
      this.#drawnWidth = width;
      const height = this.#world.fit(width, TALLEST);
      this.#zoom.resize(width, height);
      set(this.#objects, { d: (scene ?? []).map(({ points, closed }) => this.#world.line(points, closed)).join("") });
      this.#track.clear();
    }
    const pose = frame?.pose ?? start;
    if (pose === null) {
      return;
    }
    set(this.#platform, { d: this.#outline(run.hello.rig.platform, pose) });
    if (this.#isClose) {
      this.#zoom.look(...this.#world.px([pose[0], pose[1]]), this.#world.enlargement(CLOSE));
    }
    if (frame === undefined) {
      this.#undeflected(run, pose);
      return;
    }
    this.#track.show(run.history.frames, frame.tick);
    this.#map.hidden = !this.#track.hasMap;
    this.#legend.hidden = !this.#track.hasMap || !this.#isMapShown;
    this.#robot(frame);
    this.#other(run, frame, answer);
  }

  /** Includes everything that the page has received since the last call. True if the drawn part grows. */
  #include(run: Run, answer: Answer | undefined): boolean {
    const { frames } = run.history;
    const points: Point[] = [];
    const fresh = frames.length < this.#seen ? frames : frames.slice(this.#seen);
    this.#seen = frames.length;
    for (const { pose, contour } of fresh) {
      points.push([pose[0], pose[1]], ...contour.map(({ point }) => point));
    }
    const [first] = frames;
    if (first) {
      points.push([first.pose[0], first.pose[1]]);
    }
    for (const { pose } of answer?.frames ?? []) {
      if (pose) {
        points.push([pose[0], pose[1]]);
      }
    }
    return points.map((point) => this.#world.include(point, this.#reach)).some((grows) => grows);
  }

  /** The whiskers before the first tick. */
  #undeflected({ hello: { rig } }: Run, pose: Pose): void {
    rig.whiskers.forEach(({ base: [x, y], direction, length }, index) => {
      const tip: Point = [x + length * Math.cos(direction), y + length * Math.sin(direction)];
      const shaft = this.#whiskers[index];
      if (shaft) {
        set(shaft, { d: this.#world.line([placed(pose, [x, y]), placed(pose, tip)]) });
      }
    });
  }

  /** The command, the whiskers and the tips of a tick. */
  #robot(frame: Frame): void {
    const [x, y] = frame.pose;
    const [vx, vy] = frame.command;
    set(this.#command, { d: Math.hypot(vx, vy) > 1e-4 ? this.#arrow([x, y], [x + vx * AHEAD, y + vy * AHEAD]) : "" });
    frame.whiskers.forEach((whisker, index) => {
      const [shaft, tip] = [this.#whiskers[index], this.#tips[index]];
      if (shaft && tip) {
        set(shaft, { d: this.#world.line(whisker.shaft) });
        shaft.classList.toggle("touching", whisker.touching);
        set(tip, { d: whisker.tip === null ? "" : this.#world.dots([whisker.tip]) });
      }
    });
  }

  /** The robot of a counterfactual in closed loop. */
  #other(run: Run, frame: Frame, answer: Answer | undefined): void {
    const moved = (answer?.frames ?? []).filter(({ tick }) => tick <= frame.tick);
    const pose = moved.at(-1)?.pose ?? null;
    set(this.#otherPlatform, { d: pose === null ? "" : this.#outline(run.hello.rig.platform, pose) });
    set(this.#otherTrace, { d: this.#world.line(thinned((answer?.frames ?? []).flatMap(({ pose }) => (pose === null ? [] : [pose])))) });
    set(this.#otherContour, { d: this.#world.dots(moved.flatMap(({ contour }) => contour)) });
  }

  #outline(corners: readonly Point[], pose: Pose): string {
    return this.#world.line(corners.map((corner) => placed(pose, corner)), true);
  }

  #arrow(from: Point, to: Point): string {
    const [[x1, y1], [x2, y2]] = [this.#world.px(from), this.#world.px(to)];
    const angle = Math.atan2(y2 - y1, x2 - x1);
    const barb = (turn: number): string => `M${x2} ${y2}l${-5 * Math.cos(angle + turn)} ${-5 * Math.sin(angle + turn)}`;
    return `M${x1} ${y1}L${x2} ${y2}${barb(0.5)}${barb(-0.5)}`;
  }

  /** Shows the map by touch, or not. */
  #showMap(isShown: boolean): void {
    this.#isMapShown = isShown;
    this.#map.setAttribute("aria-pressed", String(isShown));
    this.#legend.hidden = !isShown;
    this.#drawing.classList.toggle("mapless", !isShown);
  }
  #isMapShown = true;

  /** Keeps the robot in the middle, or not. */
  #watch(isClose: boolean): void {
    this.#isClose = isClose;
    this.#close.setAttribute("aria-pressed", String(isClose));
  }
}
