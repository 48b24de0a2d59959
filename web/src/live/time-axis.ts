/** The times (s) that the plots show, and their positions (px). */
export class TimeAxis {
  readonly from: number;
  readonly to: number;
  readonly left: number;
  readonly right: number;

  constructor(from: number, to: number, left: number, right: number) {
    [this.from, this.to, this.left, this.right] = [from, Math.max(to, from + 1e-3), left, right];
  }

  x(time: number): number {
    return this.left + ((time - this.from) / (this.to - this.from)) * (this.right - this.left);
  }

  time(x: number): number {
    return this.from + ((x - this.left) / (this.right - this.left)) * (this.to - this.from);
  }
}

/** The smallest of 1, 2 and 5 times a power of ten that is at least a positive number. */
export function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((factor) => factor * power >= least * 0.999) ?? 10);
}

/** Round numbers within a range, about `count` of them. */
export function ticksOf(low: number, high: number, count: number): number[] {
  const raw = (high - low) / count;
  if (!(raw > 0) || !Number.isFinite(raw)) {
    return [];
  }
  const step = roundStep(raw);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step);
}
