import { set, svg } from "../shared/svg.ts";
import type { Frame, Point, Pose } from "./protocol.ts";
import type { World } from "./world.ts";

/** The number of ticks in a part of the picture. */
const PART = 300;
/** The error (m) from which a tip is drawn as wrong: that of the coverage. */
const WRONG = 1e-3;
/** The least distance (m) of two points of a path. */
const STEP = 0.004;

interface Part {
  /** What is drawn. */
  key: string;
  path: SVGPathElement;
  contour: SVGPathElement;
  wrong: SVGPathElement;
}

/** The path of the robot and the recorded contour. Complete parts of the picture stay as they are while it grows. */
export class Track {
  readonly group = svg("g");
  readonly #world: World;
  #parts: Part[] = [];

  constructor(world: World) {
    this.#world = world;
  }

  /** Forgets the picture, because its scale has changed. */
  clear(): void {
    this.#parts = [];
    this.group.replaceChildren();
  }

  /** Draws the past until a tick. */
  show(frames: readonly Frame[], tick: number): void {
    const count = Math.ceil(frames.length / PART);
    for (let index = 0; index < Math.max(count, this.#parts.length); index += 1) {
      // A path goes on to the first tick of the next part.
      const ticks = frames.slice(index * PART, (index + 1) * PART + 1);
      const [first, last] = [ticks[0], ticks.at(-1)];
      const key = first === undefined || last === undefined ? "" : `${first.tick} ${Math.max(first.tick - 1, Math.min(last.tick, tick))} ${ticks.length}`;
      const part = (this.#parts[index] ??= this.#added());
      if (part.key !== key) {
        part.key = key;
        this.#draw(part, ticks.filter((frame) => frame.tick <= tick));
      }
    }
  }

  #draw({ path, contour, wrong }: Part, ticks: readonly Frame[]): void {
    const tips = ticks.slice(0, PART).flatMap(({ contour }) => contour);
    const points = (isWrong: boolean): Point[] => tips.filter(({ error }) => (error !== null && error > WRONG) === isWrong).map(({ point }) => point);
    set(path, { d: this.#world.line(thinned(ticks.map(({ pose }) => pose))) });
    set(contour, { d: this.#world.dots(points(false)) });
    set(wrong, { d: this.#world.dots(points(true)) });
  }

  #added(): Part {
    const [path, contour, wrong] = [svg("path", { class: "trace" }), svg("path", { class: "contour" }), svg("path", { class: "contour wrong" })];
    this.group.append(path, contour, wrong);
    return { key: "", path, contour, wrong };
  }
}

/** The positions without those that are too close to the one before. The last one stays. */
export function thinned(poses: readonly Pose[]): Point[] {
  const points: Point[] = [];
  poses.forEach(([x, y], index) => {
    const last = points.at(-1);
    if (last === undefined || index === poses.length - 1 || Math.hypot(x - last[0], y - last[1]) > STEP) {
      points.push([x, y]);
    }
  });
  return points;
}
