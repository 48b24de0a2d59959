import type { Frame, MapFrame } from "./protocol.ts";
import { ENDED } from "./statechart.ts";

/** A time for which one state was active. */
export interface Span {
  /** Index of the innermost state, or `ENDED`. */
  state: number;
  /** The times (s). */
  from: number;
  to: number;
}

/** The largest number of ticks that are kept. The oldest ones are thinned. The program keeps fewer, `FRAME_LIMIT` in `src/live/log.rs`. */
const LIMIT = 40_000;

/** The ticks that the page has received, in the order of their numbers. */
export class History {
  #frames: Frame[] = [];
  #spans: Span[] | undefined;

  get frames(): readonly Frame[] {
    return this.#frames;
  }

  get last(): Frame | undefined {
    return this.#frames.at(-1);
  }

  /** Adds ticks in the order of their numbers. One that is known already is replaced. */
  add(frames: readonly Frame[]): void {
    const last = this.#frames.at(-1);
    if (last === undefined || (frames[0] !== undefined && frames[0].tick > last.tick)) {
      this.#frames.push(...frames);
      frames.forEach((frame) => this.#extend(frame));
    } else {
      const all = new Map([...this.#frames, ...frames].map((frame) => [frame.tick, frame]));
      this.#frames = [...all.values()].sort((a, b) => a.tick - b.tick);
      this.#spans = undefined;
    }
    if (this.#frames.length > LIMIT) {
      this.#thin();
    }
  }

  /** Removes every second one of the older ticks. The next one gets their recorded tips, the cells of their maps, and the plots that it has not set. */
  #thin(): void {
    const isRemoved = (index: number): boolean => index < this.#frames.length / 2 && index % 2 === 1;
    this.#frames = this.#frames.flatMap((frame, index, frames) => {
      const before = isRemoved(index - 1) ? frames[index - 1] : undefined;
      if (isRemoved(index)) {
        return [];
      }
      return [before === undefined ? frame : {
        ...frame,
        contour: [...before.contour, ...frame.contour],
        plots: frame.plots.map((value, plot) => value ?? before.plots[plot] ?? null),
        map: joined(before.map, frame.map),
      }];
    });
    this.#spans = undefined;
  }

  /** The index of the last tick up to this number, or -1. */
  indexAt(tick: number): number {
    return lastIndex(this.#frames, (frame) => frame.tick <= tick);
  }

  /** The index of the last tick up to this time (s), or -1. */
  indexAtTime(time: number): number {
    return lastIndex(this.#frames, (frame) => frame.time <= time);
  }

  /** The last tick up to this number. Before the first tick, the first one. */
  at(tick: number): Frame | undefined {
    return this.#frames[Math.max(0, this.indexAt(tick))];
  }

  /** The tick that is nearest to a time (s). */
  nearest(time: number): Frame | undefined {
    const index = this.indexAtTime(time);
    const [before, after] = [this.#frames[Math.max(0, index)], this.#frames[index + 1]];
    return before && after && after.time - time < time - before.time ? after : before;
  }

  /** The active states over time. */
  get spans(): readonly Span[] {
    if (this.#spans === undefined) {
      this.#spans = [];
      this.#frames.forEach((frame) => this.#extend(frame));
    }
    return this.#spans;
  }

  #extend(frame: Frame): void {
    if (this.#spans !== undefined) {
      extend(this.#spans, frame);
    }
  }
}

/** Two frames of the map as one. */
function joined(before: MapFrame | null, now: MapFrame | null): MapFrame | null {
  return before && now ? { ...now, free: [...before.free, ...now.free], blocked: [...before.blocked, ...now.blocked] } : (now ?? before);
}

/** Adds a tick to the spans. */
export function extend(spans: Span[], { states, time }: { states: readonly number[]; time: number }): void {
  const state = states.at(-1) ?? ENDED;
  const last = spans.at(-1);
  if (last !== undefined) {
    last.to = time;
  }
  if (last?.state !== state) {
    spans.push({ state, from: time, to: time });
  }
}

/** The index of the last item for which the condition holds, or -1. It holds for all items before that one. */
export function lastIndex<Item>(items: readonly Item[], holds: (item: Item) => boolean): number {
  let [low, high] = [0, items.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    const item = items[middle];
    if (item !== undefined && holds(item)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low - 1;
}
