import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { set, svg } from "../shared/svg.ts";
import { Width } from "../shared/width.ts";
import type { Frame } from "./protocol.ts";
import { quantity } from "./quantity.ts";
import { drawStrip, STRIP } from "./strip.ts";
import { TimeAxis, ticksOf } from "./time-axis.ts";
import type { Actions, Panel, View } from "./view.ts";

/** A curve of a plot. */
export interface Series {
  name: string;
  value: (frame: Frame) => number | null | undefined;
}

/** What a plot shows. */
export interface Subject {
  title: string;
  /** SI unit. */
  unit: string;
  /** The names of the values 0, 1, 2 and so on, if these are no quantities. */
  choices?: string[];
  series: Series[];
  /** Ticks that are marked. */
  marked?: { name: string; holds: (frame: Frame) => boolean };
  /** Values with a line. */
  levels?: { name: string; value: number }[];
  /** False in a tick of a run that has no such values. Then there is no plot. */
  isKnown?: (frame: Frame) => boolean;
  /** Removes the plot. */
  close?: () => void;
}

const HEIGHT = 118;
const TOP = 2 * STRIP + 8;
const BOTTOM = 18;
const LEFT = 62;
const RIGHT = 14;
/** The largest number of names beside the axis, and of letters of one. */
const ROWS = 8;
const LETTERS = 9;

/** A plot over time. The strip above it shows the active states, and under them those of a counterfactual. */
export class Plot implements Panel {
  readonly element: HTMLElement;
  readonly subject: Subject;
  readonly #actions: Actions;
  readonly #svg = svg("svg", { role: "img" });
  readonly #strip = svg("g");
  readonly #second = svg("g", { transform: `translate(0 ${STRIP + 2})` });
  readonly #content = svg("g");
  readonly #cursor = svg("line", { class: "cursor", y1: 0, y2: TOP + HEIGHT });
  readonly #values: HTMLElement[];
  readonly #width: Width;
  #axis = new TimeAxis(0, 1, 0, 1);
  #drawn = "";

  constructor(subject: Subject, actions: Actions) {
    [this.subject, this.#actions] = [subject, actions];
    this.#values = subject.series.map(() => element("output"));
    const legend = element("div", "legend");
    subject.series.forEach(({ name }, index) => {
      legend.append(element("span", `key s${index % 8}`, name, " ", this.#values[index] ?? ""));
    });
    if (subject.marked) {
      legend.append(element("span", "key marked", subject.marked.name));
    }
    const heading = element("h3", "", subject.title);
    const head = element("div", "plot-head", heading, legend);
    if (subject.close) {
      head.append(button("×", subject.close, `remove the plot of ${subject.title}`));
    }
    this.#svg.append(this.#strip, this.#second, this.#content, this.#cursor);
    const body = element("div", "", this.#svg);
    this.element = element("section", "plot", head, body);
    this.#width = new Width(body, () => actions.refresh());
    this.#svg.setAttribute("aria-label", `${subject.title} over time`);
    this.#svg.addEventListener("pointerdown", (event) => this.#drag(event));
  }

  update(view: View): void {
    const { last } = view.run.history;
    this.element.hidden = last !== undefined && this.subject.isKnown?.(last) === false;
    const width = this.#width.value;
    if (width === 0 || this.element.hidden) {
      return;
    }
    this.#axis = new TimeAxis(view.from, view.to, LEFT, width - RIGHT);
    const { frames } = view.run.history;
    const key = [width, view.from, view.to, frames.length, frames.at(-1)?.tick, view.answer?.id, view.answer?.frames.length].join();
    if (key !== this.#drawn) {
      this.#drawn = key;
      this.#draw(view, width);
    }
    const x = this.#axis.x(view.frame?.time ?? 0);
    set(this.#cursor, { x1: x, x2: x });
    this.subject.series.forEach(({ value }, index) => {
      const shown = view.frame === undefined ? undefined : value(view.frame);
      const output = this.#values[index];
      if (output) {
        output.textContent = shown === null || shown === undefined ? "–" : this.#text(shown);
      }
    });
  }

  #draw({ run, answer }: View, width: number): void {
    const top = answer === undefined ? TOP - STRIP - 2 : TOP;
    const height = top + HEIGHT + BOTTOM;
    set(this.#svg, { viewBox: `0 0 ${width} ${height}`, width, height });
    set(this.#cursor, { y2: top + HEIGHT });
    drawStrip(this.#strip, run.history.spans, this.#axis, run.chart, run.shades);
    drawStrip(this.#second, answer?.spans ?? [], this.#axis, run.chart, run.shades);
    const first = Math.max(0, run.history.indexAtTime(this.#axis.from));
    const frames = run.history.frames.slice(first, run.history.indexAtTime(this.#axis.to) + 2);
    const curves = this.subject.series.map(({ value }) => this.#reduced(frames, value));
    const { levels = [], choices = [] } = this.subject;
    const values = [...curves.flat().filter((point) => point !== null).map(([, y]) => y)];
    const [low, high] = choices.length > 0 ? [0, Math.max(1, choices.length - 1)] : extent(values, levels.map(({ value }) => value));
    const y = (value: number): number => top + HEIGHT - 3 - ((value - low) / (high - low)) * (HEIGHT - 6);
    const parts: SVGElement[] = [];
    for (const time of ticksOf(this.#axis.from, this.#axis.to, Math.max(2, (width - LEFT) / 110))) {
      const x = this.#axis.x(time);
      parts.push(svg("line", { class: "grid", x1: x, x2: x, y1: top, y2: top + HEIGHT }), svg("text", { class: "tick", x, y: height - 4, "text-anchor": "middle" }, `${Number(time.toPrecision(6))} s`));
    }
    for (const value of choices.length > 0 ? rowsOf(choices.length) : ticksOf(low, high, 4)) {
      parts.push(svg("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: y(value), y2: y(value) }), svg("text", { class: "tick", x: LEFT - 4, y: y(value) + 4, "text-anchor": "end" }, short(this.#text(value))));
    }
    for (const { name, value } of levels) {
      parts.push(svg("line", { class: "level", x1: LEFT, x2: width - RIGHT, y1: y(value), y2: y(value) }, svg("title", {}, name)));
    }
    curves.forEach((curve, index) => parts.push(svg("path", { class: `curve s${index % 8}`, d: pathOf(curve, y) })));
    const { marked } = this.subject;
    if (marked) {
      const marks = frames.filter(marked.holds).map((frame) => `M${this.#axis.x(frame.time).toFixed(1)} ${top}v7`);
      parts.push(svg("path", { class: "marks", d: marks.join("") }));
    }
    this.#content.replaceChildren(...parts);
  }

  /** The text of a value. */
  #text(value: number): string {
    return this.subject.choices?.[value] ?? quantity(value, this.subject.unit);
  }

  /** The curve of a value with at most two points for each pixel: the least and the greatest value. `null` is a gap. */
  #reduced(frames: readonly Frame[], value: Series["value"]): ([x: number, y: number] | null)[] {
    const points: ([number, number] | null)[] = [];
    let column = NaN;
    let [least, greatest] = [0, 0];
    const finish = (): void => {
      if (!Number.isNaN(column)) {
        points.push([column, least]);
        if (greatest !== least) {
          points.push([column, greatest]);
        }
      }
    };
    const isDense = frames.length > 2 * (this.#axis.right - this.#axis.left);
    for (const frame of frames) {
      const y = value(frame);
      if (y === null || y === undefined || !Number.isFinite(y)) {
        if (points.at(-1) !== null || !Number.isNaN(column)) {
          finish();
          points.push(null);
          column = NaN;
        }
        continue;
      }
      const exact = this.#axis.x(frame.time);
      const x = isDense ? Math.round(exact) : exact;
      if (x === column) {
        [least, greatest] = [Math.min(least, y), Math.max(greatest, y)];
      } else {
        finish();
        [column, least, greatest] = [x, y, y];
      }
    }
    finish();
    return points;
  }

  /** Selects the tick under the pointer until it is released. */
  #drag(event: PointerEvent): void {
    const choose = (moved: PointerEvent): void => {
      const x = moved.clientX - this.#svg.getBoundingClientRect().left;
      this.#actions.seek(Math.min(this.#axis.to, Math.max(this.#axis.from, this.#axis.time(x))));
    };
    choose(event);
    this.#svg.setPointerCapture(event.pointerId);
    this.#svg.addEventListener("pointermove", choose);
    const end = (): void => this.#svg.removeEventListener("pointermove", choose);
    this.#svg.addEventListener("pointerup", end, { once: true });
    this.#svg.addEventListener("pointercancel", end, { once: true });
  }
}

/** The numbers of choices that have room beside the axis. */
function rowsOf(count: number): number[] {
  const step = Math.ceil(count / ROWS);
  return Array.from({ length: Math.ceil(count / step) }, (_, row) => row * step);
}

/** A text that fits beside the axis. */
function short(text: string): string {
  return text.length > LETTERS ? `${text.slice(0, LETTERS - 1)}…` : text;
}

/** A range with all values. Levels far outside of the values are left out. */
function extent(values: readonly number[], levels: readonly number[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  const include = (value: number): void => {
    [low, high] = [Math.min(low, value), Math.max(high, value)];
  };
  values.forEach(include);
  const reach = 3 * Math.max(Math.abs(low), Math.abs(high));
  levels.filter((level) => !(Math.abs(level) > reach)).forEach(include);
  if (low < high) {
    return [low, high];
  }
  // A constant is seen beside zero.
  return low === high && low !== 0 ? [Math.min(0, low), Math.max(0, low)] : [0, 1];
}

function pathOf(curve: readonly ([number, number] | null)[], y: (value: number) => number): string {
  let isDown = false;
  let path = "";
  for (const point of curve) {
    if (point === null) {
      isDown = false;
      continue;
    }
    path += `${isDown ? "L" : "M"}${point[0].toFixed(1)} ${y(point[1]).toFixed(1)}`;
    // A single point is seen as a dot.
    path += isDown ? "" : "h0";
    isDown = true;
  }
  return path;
}
