import { set, svg } from "../shared/svg.ts";
import type { Frame, Point } from "./protocol.ts";
import type { World } from "./world.ts";

/** The number of ticks in a part of the picture. */
const PART = 300;
/** The error (m) from which a tip is drawn as wrong: that of the coverage. */
const WRONG = 1e-3;

/** The recorded contour. Complete parts of the picture stay as they are while it grows. */
export class Dots {
  readonly group = svg("g");
  readonly #world: World;
  #parts: { key: string; paths: SVGPathElement[] }[] = [];

  constructor(world: World) {
    this.#world = world;
  }

  /** Forgets the picture, because its scale has changed. */
  clear(): void {
    this.#parts = [];
    this.group.replaceChildren();
  }

  /** Draws the tips until a tick. */
  show(frames: readonly Frame[], tick: number): void {
    const count = Math.ceil(frames.length / PART);
    for (let part = 0; part < Math.max(count, this.#parts.length); part += 1) {
      const ticks = frames.slice(part * PART, (part + 1) * PART);
      const [first, last] = [ticks[0], ticks.at(-1)];
      const isPartial = first !== undefined && last !== undefined && last.tick > tick;
      const key = first === undefined || last === undefined ? "" : `${first.tick} ${Math.max(first.tick - 1, Math.min(last.tick, tick))} ${ticks.length}`;
      const drawn = (this.#parts[part] ??= this.#added());
      if (drawn.key === key) {
        continue;
      }
      drawn.key = key;
      const tips = (isPartial ? ticks.filter((frame) => frame.tick <= tick) : ticks).flatMap(({ contour }) => contour);
      const points = (isWrong: boolean): Point[] => tips.filter(({ error }) => (error !== null && error > WRONG) === isWrong).map(({ point }) => point);
      drawn.paths.forEach((path, index) => set(path, { d: this.#world.dots(points(index === 1)) }));
    }
  }

  #added(): { key: string; paths: SVGPathElement[] } {
    const paths = ["contour", "contour wrong"].map((name) => svg("path", { class: name }));
    this.group.append(...paths);
    return { key: "", paths };
  }
}
