import type { Chart } from "./statechart.ts";

/** One colour for each outermost state: those of the pictures of a run. A dark text can be read on them. */
const HUES = ["#d9e2ec", "#b8dcf0", "#fde3a7", "#d6c9ec", "#c7e8c9", "#f6cfd8", "#e6d5b8", "#bfe3df", "#fbcfb1", "#dfeba8", "#e8bfe6", "#bdc8f5"];
/** Shares of ink (%) in the colours of the states in one outermost state. */
const INKS = [0, 11, 22, 33, 5, 16, 27];
/** The colour of a state that the chart does not have, such as the end of a run. */
const OTHER = "#f0846a";

/** The colours of states. Those in one outermost state have one hue and differ by their lightness. */
export class Shades {
  readonly #colours = new Map<number, string>();

  constructor(chart: Chart) {
    chart.root.children.forEach((outermost, index) => {
      const hue = HUES[index % HUES.length] ?? OTHER;
      outermost.all().forEach((node, rank) => {
        this.#colours.set(node.index, `color-mix(in srgb, ${hue}, #1f2933 ${INKS[rank % INKS.length] ?? 0}%)`);
      });
    });
  }

  of(state: number): string {
    return this.#colours.get(state) ?? OTHER;
  }
}
