import { Node, type Arrow, type Target } from "./statechart.ts";

/** A box of the drawn level. */
export interface Box {
  item: Target;
  /** True for a target outside of the level. */
  isOutside: boolean;
  x: number;
  y: number;
  width: number;
  height: number;
}

/** A drawn level. */
export interface Layout {
  boxes: Box[];
  curves: { arrow: Arrow; path: string }[];
  width: number;
  height: number;
}

const HEIGHT = 30;
const GAP = 16;
const ROW = 66;
const MARGIN = 14;
/** The width (px) of a letter. */
const LETTER = 7.3;

/**
 * Places the states of a level in rows: the initial state first, then those that it leads to, and so on. A row that is too wide is
 * continued below. Targets outside of the level are last.
 */
export function layOut(level: Node, arrows: readonly Arrow[], width: number): Layout {
  const ranks = ranked(level, arrows);
  const outside = [...new Set(arrows.map((arrow) => arrow.to))].filter((to) => !isChild(to, level));
  const places = new Map<Target, Box>();
  let y = MARGIN;
  for (const rank of [...ranks, outside] as Target[][]) {
    const ordered = byNeighbours(rank, arrows, places);
    for (const row of wrapped(ordered, width - 2 * MARGIN)) {
      const total = row.reduce((sum, item) => sum + boxWidth(item) + GAP, -GAP);
      let x = Math.max(MARGIN, (width - total) / 2);
      for (const item of row) {
        places.set(item, { item, isOutside: !isChild(item, level), x, y, width: boxWidth(item), height: HEIGHT });
        x += boxWidth(item) + GAP;
      }
      y += ROW;
    }
  }
  const boxes = [...places.values()];
  return { boxes, curves: curves(arrows, places), width, height: y - ROW + HEIGHT + MARGIN };
}

/** The text of a box. */
export function label(item: Target): string {
  return typeof item === "string" ? item : item.children.length > 0 ? `${item.shortName} ▸` : item.shortName;
}

function boxWidth(item: Target): number {
  return label(item).length * LETTER + 20;
}

function isChild(item: Target, level: Node): boolean {
  return item instanceof Node && item.parent === level;
}

/** The states by the number of arrows from the initial state to them. */
function ranked(level: Node, arrows: readonly Arrow[]): Node[][] {
  const rest = new Set(level.children);
  const first = level.children.find((child) => child.isInitial) ?? level.children[0];
  const ranks: Node[][] = [];
  let rank = first === undefined ? [] : [first];
  while (rest.size > 0) {
    if (rank.length === 0) {
      // These states are entered only from outside.
      rank = [...rest];
    }
    rank.forEach((node) => rest.delete(node));
    ranks.push(rank);
    const next = new Set(arrows.filter((arrow) => rank.includes(arrow.from)).map((arrow) => arrow.to));
    rank = [...rest].filter((node) => next.has(node));
  }
  return ranks;
}

/** The items in the order of the mean position of what leads to them. */
function byNeighbours(items: Target[], arrows: readonly Arrow[], places: ReadonlyMap<Target, Box>): Target[] {
  const mean = (item: Target, index: number): number => {
    const centres = arrows.filter((arrow) => arrow.to === item).flatMap(({ from }) => places.get(from) ?? []).map((box) => box.x + box.width / 2);
    return centres.length === 0 ? index : centres.reduce((sum, x) => sum + x, 0) / centres.length;
  };
  const keys = new Map(items.map((item, index) => [item, mean(item, index)]));
  return [...items].sort((a, b) => (keys.get(a) ?? 0) - (keys.get(b) ?? 0));
}

function wrapped(items: Target[], width: number): Target[][] {
  const rows: Target[][] = [];
  let used = Infinity;
  for (const item of items) {
    if (used + boxWidth(item) > width) {
      rows.push([]);
      used = 0;
    }
    rows.at(-1)?.push(item);
    used += boxWidth(item) + GAP;
  }
  return rows;
}

function curves(arrows: readonly Arrow[], places: ReadonlyMap<Target, Box>): Layout["curves"] {
  return arrows.flatMap((arrow) => {
    const [from, to] = [places.get(arrow.from), places.get(arrow.to)];
    return from && to ? [{ arrow, path: curve(from, to) }] : [];
  });
}

/** A curve from one box to another. Those that go up are right of those that go down. */
function curve(from: Box, to: Box): string {
  const centre = (box: Box): number => box.x + box.width / 2;
  if (from === to) {
    const [x, y] = [from.x + from.width, from.y + from.height / 2];
    return `M${x} ${y - 7}c18 -8 18 22 2 14`;
  }
  const shift = Math.sign(centre(to) - centre(from)) * Math.min(24, from.width / 4);
  if (from.y === to.y) {
    const [x1, x2, y] = [centre(from) + shift, centre(to) - shift, from.y];
    const rise = Math.min(28, 12 + Math.abs(x2 - x1) / 12);
    return `M${x1} ${y}C${x1} ${y - rise} ${x2} ${y - rise} ${x2} ${y - 1}`;
  }
  const isDown = to.y > from.y;
  const [x1, x2] = [centre(from) + (isDown ? shift - 5 : shift + 7), centre(to) + (isDown ? -5 : 7)];
  const [y1, y2] = isDown ? [from.y + from.height, to.y - 1] : [from.y, to.y + to.height + 1];
  const bend = (isDown ? 1 : -1) * Math.min(70, Math.abs(y2 - y1) / 2);
  return `M${x1} ${y1}C${x1} ${y1 + bend} ${x2} ${y2 - bend} ${x2} ${y2}`;
}
