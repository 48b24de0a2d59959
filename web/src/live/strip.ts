import { set, svg } from "../shared/svg.ts";
import type { Span } from "./history.ts";
import type { Shades } from "./shade.ts";
import type { Chart } from "./statechart.ts";
import type { TimeAxis } from "./time-axis.ts";

/** The height (px) of a strip. */
export const STRIP = 16;

/** The least width (px) of a bar that has a title. A pointer does not find a narrower one. */
const TITLED = 3;

/** Draws the active states over time as coloured bars with their names. */
export function drawStrip(group: SVGGElement, spans: readonly Span[], axis: TimeAxis, chart: Chart, shades: Shades): void {
  const bars: SVGElement[] = [];
  for (const span of visible(spans, axis)) {
    const [left, right] = [axis.x(Math.max(span.from, axis.from)), axis.x(Math.min(span.to, axis.to))];
    const width = Math.max(0.7, right - left);
    const bar = svg("rect", { x: left, y: 0, width, height: STRIP, fill: shades.of(span.state) });
    bars.push(bar);
    if (width >= TITLED) {
      bar.append(svg("title", {}, `${chart.name(span.state)}, ${span.from.toFixed(2)} to ${span.to.toFixed(2)} s`));
    }
    const name = chart.nodes[span.state]?.shortName ?? "ended";
    if (name.length * 6 + 6 < width) {
      bars.push(svg("text", { x: left + 3, y: STRIP - 4.5, class: "state" }, name));
    }
  }
  group.replaceChildren(...bars);
  set(group, { class: "strip" });
}

/** The spans within the axis. Of those that share a pixel, the longest one is kept. */
function visible(spans: readonly Span[], axis: TimeAxis): Span[] {
  const kept: Span[] = [];
  for (const span of spans) {
    if (span.to < axis.from || span.from > axis.to) {
      continue;
    }
    const last = kept.at(-1);
    if (last !== undefined && axis.x(span.to) - axis.x(last.from) < 1) {
      if (span.to - span.from > last.to - last.from) {
        kept[kept.length - 1] = span;
      }
      continue;
    }
    kept.push(span);
  }
  return kept;
}
