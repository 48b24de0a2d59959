import { History } from "./history.ts";
import type { BreakpointInfo, Frame, Hello, Status } from "./protocol.ts";
import { Shades } from "./shade.ts";
import { Chart } from "./statechart.ts";

/** A range of ticks: the first one, and the one after the last. */
export type Range = [from: number, to: number];

/** The largest number of ticks in a request. */
const PORTION = 1500;

/** A run: what is fixed, and what the page has received until now. */
export class Run {
  readonly hello: Hello;
  readonly chart: Chart;
  readonly shades: Shades;
  readonly history = new History();
  status: Status | undefined;
  /** The number of ticks that the page was too slow for. It asks for them later. */
  lost = 0;
  readonly #missing: Range[] = [];
  readonly #largest = new Map<string, number>();
  #requested: Range | undefined;
  /** The number of the tick after the newest one. */
  #next = 0;

  constructor(hello: Hello) {
    this.hello = hello;
    this.chart = new Chart(hello);
    this.shades = new Shades(this.chart);
  }

  get breakpoints(): readonly BreakpointInfo[] {
    return (this.status ?? this.hello).breakpoints;
  }

  /** Adds new ticks and notes those that were left out before them. */
  add(frames: readonly Frame[]): void {
    const [first, last] = [frames[0], frames.at(-1)];
    if (first === undefined || last === undefined) {
      return;
    }
    if (first.tick > this.#next) {
      this.#missing.push([this.#next, first.tick]);
    }
    this.#next = Math.max(this.#next, last.tick + 1);
    this.#add(frames);
  }

  /** Notes that there are ticks until this number, also if the page does not receive them by itself. */
  expect(count: number): void {
    if (count > this.#next) {
      this.#missing.push([this.#next, count]);
      this.#next = count;
    }
  }

  /** Adds requested ticks. */
  fill(frames: readonly Frame[]): void {
    this.#requested = undefined;
    this.#add(frames);
  }

  #add(frames: readonly Frame[]): void {
    this.history.add(frames);
    for (const { guards } of frames) {
      for (const { guard, margins } of guards) {
        margins.forEach((margin, part) => {
          if (margin !== null) {
            const key = `${guard} ${part}`;
            this.#largest.set(key, Math.max(this.#largest.get(key) ?? 0, Math.abs(margin)));
          }
        });
      }
    }
  }

  /** The number of ticks until now, and how many of them the page does not have and asks for. */
  get past(): { count: number; missing: number } {
    const open = [...this.#missing, ...(this.#requested === undefined ? [] : [this.#requested])];
    return { count: this.#next, missing: open.reduce((sum, [from, to]) => sum + to - from, 0) };
  }

  /** The largest distance of a part of a guard that was seen. */
  largest(guard: number, part: number): number {
    return this.#largest.get(`${guard} ${part}`) ?? 0;
  }

  /** The next range of ticks to ask for, newest first. None while an answer is expected. */
  request(): Range | undefined {
    const range = this.#requested === undefined ? this.#missing.pop() : undefined;
    if (range === undefined) {
      return undefined;
    }
    const [from, to] = range;
    const start = Math.max(from, to - PORTION);
    if (start > from) {
      this.#missing.push([from, start]);
    }
    this.#requested = [start, to];
    return this.#requested;
  }
}
