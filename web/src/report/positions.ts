/** A tip estimate: position (px), error (µm), time (s), state, whisker. */
type Tip = [x: number, y: number, error: number, time: number, state: number | null, whisker: number];

/** Where the data of a picture are. */
export interface Positions {
  /** Left and right side of the strips (px), at the time 0 and at the end. */
  sides: [number, number];
  /** Upper and lower side of the strips (px). */
  strips: [number, number];
  end_s: number;
  states: string[];
  whiskers: string[];
  tips: Tip[];
}

/** Largest distance (px) of a pointer from the estimate that it selects. */
const REACH = 14;

/** The index of the estimate at a position of the picture. Within the strips, the time alone counts. */
export function tipAt({ sides, strips, end_s, tips }: Positions, x: number, y: number): number | undefined {
  const isInStrips = y >= strips[0] && y <= strips[1];
  const time = ((x - sides[0]) / (sides[1] - sides[0])) * end_s;
  const distance = (tip: Tip): number => (isInStrips ? Math.abs(tip[3] - time) : Math.hypot(tip[0] - x, tip[1] - y));
  let nearest: number | undefined;
  let least = isInStrips ? end_s / 100 : REACH;
  tips.forEach((tip, index) => {
    const found = distance(tip);
    if (found < least) {
      [nearest, least] = [index, found];
    }
  });
  return nearest;
}

/** The indices of the estimates in the order of their times. */
export function byTime({ tips }: Positions): number[] {
  return tips.map((_, index) => index).sort((a, b) => (tips[a]?.[3] ?? 0) - (tips[b]?.[3] ?? 0));
}

/** The text of an estimate. */
export function describe({ tips, states, whiskers }: Positions, index: number): string {
  const tip = tips[index];
  if (tip === undefined) {
    return "";
  }
  const [, , error, time, state, whisker] = tip;
  const name = state === null ? "Failure" : (states[state] ?? "");
  return `${(error / 1000).toFixed(error < 100 ? 4 : 2)} mm · ${time.toFixed(2)} s · ${name} · ${whiskers[whisker] ?? ""}`;
}
