import { set, svg } from "../shared/svg.ts";
import type { CellSpan, Frame, MapFrame, Point, Pose } from "./protocol.ts";
import type { World } from "./world.ts";

/** The number of ticks in a part of the picture. */
const PART = 300;
/** The error (m) from which a tip is drawn as wrong: that of the coverage. */
const WRONG = 1e-3;
/** The least distance (m) of two points of a path. */
const STEP = 0.004;
/** The width (px) by which cells overlap. */
const OVERLAP = 0.3;
/** Half the width (px) of the diamond of a target. */
const TARGET = 6;

/** The kinds of lines, those below first. What was proved free is no longer blocked. */
const KINDS = ["blocked", "free", "trace", "contour", "contour wrong"] as const;
type Kind = (typeof KINDS)[number];

interface Part {
  /** What is drawn. */
  key: string;
  paths: Record<Kind, SVGPathElement>;
}

/** The map by touch, the path of the robot and the recorded contour. Complete parts of the picture stay as they are while it grows. */
export class Track {
  readonly group: SVGGElement;
  readonly #world: World;
  readonly #layers = KINDS.map((kind) => svg("g", { class: kind === "free" || kind === "blocked" ? "map" : "" }));
  readonly #route = svg("path", { class: "route" });
  readonly #target = svg("path", { class: "route" });
  #parts: Part[] = [];

  constructor(world: World) {
    this.#world = world;
    const route = svg("g", { class: "map" }, this.#route, this.#target);
    this.group = svg("g", {}, ...this.#layers, route);
  }

  /** True if the run has a map by touch. */
  hasMap = false;

  /** Forgets the picture, because its scale has changed. */
  clear(): void {
    this.#parts = [];
    this.#layers.forEach((layer) => layer.replaceChildren());
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
    const map = frames.findLast((frame) => frame.tick <= tick && frame.map !== null)?.map ?? null;
    this.hasMap ||= map !== null;
    this.#wanted(map);
  }

  #draw({ paths }: Part, ticks: readonly Frame[]): void {
    const own = ticks.slice(0, PART);
    const tips = own.flatMap(({ contour }) => contour);
    const maps = own.flatMap(({ map }) => map ?? []);
    const points = (isWrong: boolean): Point[] => tips.filter(({ error }) => (error !== null && error > WRONG) === isWrong).map(({ point }) => point);
    set(paths.trace, { d: this.#world.line(thinned(ticks.map(({ pose }) => pose))) });
    set(paths.contour, { d: this.#world.dots(points(false)) });
    set(paths["contour wrong"], { d: this.#world.dots(points(true)) });
    set(paths.free, { d: maps.map((map) => this.#ground(map, map.free)).join("") });
    set(paths.blocked, { d: maps.map((map) => this.#ground(map, map.blocked)).join("") });
  }

  /** Cells as rectangles. They overlap a little, so that no seams are seen between them. */
  #ground({ cell, origin: [x, y] }: MapFrame, spans: readonly CellSpan[]): string {
    const size = cell * this.#world.scale;
    return spans.map(([row, from, to]) => {
      const [left, top] = this.#world.px([x + from * cell, y + (row + 1) * cell]);
      const width = ((to - from + 1) * size + OVERLAP).toFixed(2);
      return `M${left.toFixed(2)} ${top.toFixed(2)}h${width}v${(size + OVERLAP).toFixed(2)}h-${width}z`;
    }).join("");
  }

  /** The route and the next target of the last map up to a tick. */
  #wanted(map: MapFrame | null): void {
    const { route, target } = map ?? { route: [], target: null };
    set(this.#route, { d: this.#world.line(route) });
    const [x, y] = target === null ? [0, 0] : this.#world.px(target);
    set(this.#target, { d: target === null ? "" : `M${x} ${y - TARGET}l${TARGET} ${TARGET}l${-TARGET} ${TARGET}l${-TARGET} ${-TARGET}z` });
  }

  #added(): Part {
    const paths = Object.fromEntries(KINDS.map((kind) => [kind, svg("path", { class: kind })])) as Record<Kind, SVGPathElement>;
    this.#layers.forEach((layer, index) => layer.append(paths[KINDS[index] ?? "trace"]));
    return { key: "", paths };
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
