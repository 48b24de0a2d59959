import type { Point, Pose } from "./protocol.ts";

/** The drawn part of the world and its scale. The second axis of the world points up. */
export class World {
  #low: [number, number] = [Infinity, Infinity];
  #high: [number, number] = [-Infinity, -Infinity];
  #scale = 1;
  #width = 1;
  #shift: [number, number] = [0, 0];

  /** Includes a position and the space (m) around it. True if the drawn part grows. */
  include([x, y]: Readonly<Point>, room: number): boolean {
    if (x - room / 2 >= this.#low[0] && x + room / 2 <= this.#high[0] && y - room / 2 >= this.#low[1] && y + room / 2 <= this.#high[1]) {
      return false;
    }
    this.#low = [Math.min(this.#low[0], x - room), Math.min(this.#low[1], y - room)];
    this.#high = [Math.max(this.#high[0], x + room), Math.max(this.#high[1], y + room)];
    return true;
  }

  /** Fits the part into a width (px) and a largest height (px). The result is its height. */
  fit(width: number, tallest: number): number {
    const [across, up] = [this.#high[0] - this.#low[0], this.#high[1] - this.#low[1]];
    const height = Math.min(tallest, Math.max(200, (width * up) / across));
    this.#scale = Math.min(width / across, height / up);
    this.#width = width;
    this.#shift = [(width - across * this.#scale) / 2, (height + up * this.#scale) / 2];
    return height;
  }

  /** The size (px) of a metre. */
  get scale(): number {
    return this.#scale;
  }

  /** The factor that enlarges a length (m) to the whole width. */
  enlargement(length: number): number {
    return Math.max(1, this.#width / (length * this.#scale));
  }

  /** The position (px) of a point. */
  px([x, y]: Readonly<Point>): Point {
    return [this.#shift[0] + (x - this.#low[0]) * this.#scale, this.#shift[1] - (y - this.#low[1]) * this.#scale];
  }

  /** The point at a position (px). */
  point([x, y]: Readonly<Point>): Point {
    return [this.#low[0] + (x - this.#shift[0]) / this.#scale, this.#low[1] + (this.#shift[1] - y) / this.#scale];
  }

  /** The path of a line through points. */
  line(points: readonly Readonly<Point>[], isClosed = false): string {
    return points.map((point, index) => `${index === 0 ? "M" : "L"}${text(this.px(point))}`).join("") + (isClosed ? "Z" : "");
  }

  /** The path of dots. */
  dots(points: readonly Readonly<Point>[]): string {
    return points.map((point) => `M${text(this.px(point))}h0`).join("");
  }
}

/** The position in the world of a point of the body. */
export function placed([x, y, heading]: Pose, [ahead, left]: Point): Point {
  const [sin, cos] = [Math.sin(heading), Math.cos(heading)];
  return [x + ahead * cos - left * sin, y + ahead * sin + left * cos];
}

function text([x, y]: Point): string {
  return `${x.toFixed(2)} ${y.toFixed(2)}`;
}
