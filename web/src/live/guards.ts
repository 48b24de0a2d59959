import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { svg, set } from "../shared/svg.ts";
import type { GuardFrame, GuardInfo } from "./protocol.ts";
import { quantity } from "./quantity.ts";
import type { Run } from "./run.ts";
import type { Actions, Panel, View } from "./view.ts";

/** The width (px) of the bar of a guard. */
const BAR = 90;

interface Row {
  info: GuardInfo;
  row: HTMLLIElement;
  distance: HTMLElement;
  bar: SVGRectElement;
  breaks: HTMLButtonElement | undefined;
  /** The text of its breakpoint. */
  breakpoint: string;
}

/** The guards with their distances from being enabled. */
export class Guards implements Panel {
  readonly element: HTMLElement;
  readonly #rows: Row[];
  readonly #all: HTMLButtonElement;
  #showsAll = false;

  /** `plot` adds a plot of a guard. */
  constructor(run: Run, actions: Actions, plot: (guard: GuardInfo) => void) {
    const { hello } = run;
    this.#rows = hello.guards.map((info) => rowOf(run, info, actions, plot));
    this.#all = button("all", () => {
      this.#showsAll = !this.#showsAll;
      this.#all.setAttribute("aria-pressed", String(this.#showsAll));
      actions.refresh();
    }, "show the guards of all states");
    this.#all.setAttribute("aria-pressed", "false");
    const head = element("div", "head", element("h2", "", "Guards"), element("div", "tools", this.#all));
    const content = hello.guards.length > 0 ? element("ul", "", ...this.#rows.map(({ row }) => row)) : element("p", "hint", hello.no_guards ?? "The policy has no guards.");
    this.element = element("section", "guards", head, content);
  }

  update({ run, frame }: View): void {
    const tried = new Map(frame?.guards.map((guard) => [guard.guard, guard]));
    const breaks = new Set((run.breakpoints).map(({ text }) => text));
    for (const { info, row, distance, bar, breaks: toggle, breakpoint } of this.#rows) {
      const now = tried.get(info.index);
      const isTaken = frame?.taken.includes(info.index) ?? false;
      row.hidden = now === undefined && !isTaken && !this.#showsAll;
      if (row.hidden) {
        continue;
      }
      distance.textContent = isTaken ? "taken" : now === undefined ? "not evaluated" : describe(info, now);
      row.classList.toggle("idle", now === undefined && !isTaken);
      row.classList.toggle("met", now?.met ?? false);
      row.classList.toggle("taken", isTaken);
      set(bar, { width: isTaken ? BAR : now === undefined ? 0 : BAR * closeness(run, now) });
      toggle?.setAttribute("aria-pressed", String(breaks.has(breakpoint)));
    }
  }
}

function rowOf(run: Run, info: GuardInfo, actions: Actions, plot: (guard: GuardInfo) => void): Row {
  const distance = element("span", "distance");
  const bar = svg("rect", { height: 10, width: 0 });
  const picture = svg("svg", { class: "bar", width: BAR, height: 10, "aria-hidden": "true" }, svg("rect", { class: "ground", width: BAR, height: 10 }), bar);
  const tools = element("div", "tools");
  let breaks: HTMLButtonElement | undefined;
  const state = info.state === null ? undefined : run.chart.nodes[info.state];
  const breakpoint = state === undefined ? info.text : `${state.name}: ${info.text}`;
  if (run.hello.capabilities.breakpoints) {
    const description = state === undefined ? `pause when ${info.text} holds` : `pause when ${info.text} leaves ${state.fullName}`;
    breaks = button("break", () => actions.toggleBreakpoint(breakpoint), description);
    tools.append(breaks);
  }
  if (info.parts.some(({ unit }) => unit !== null)) {
    tools.append(button("plot", () => plot(info), `plot the distance of ${info.text}`));
  }
  const from = state?.fullName ?? "every state";
  const place = `${from} → ${info.target}, ${info.file === null ? "line " : `${info.file}:`}${info.line}`;
  const row = element("li", "", element("code", "", info.text), element("span", "hint", place), picture, distance, tools);
  return { info, row, distance, bar, breaks, breakpoint };
}

/** What a guard lacks. */
function describe(info: GuardInfo, { met, margins, missing, elapsed, needed }: GuardFrame): string {
  const lacks = missing.map((part) => {
    const { text, unit } = info.parts[part] ?? { text: "", unit: null };
    const margin = margins[part];
    const amount = unit === null || margin === null || margin === undefined ? "false" : quantity(Math.abs(margin), unit);
    return info.parts.length > 1 ? `${text}: ${amount}` : amount;
  });
  if (lacks.length === 0 && needed !== null && (elapsed ?? 0) < needed) {
    return `${quantity(elapsed ?? 0, "s")} of ${quantity(needed, "s")} elapsed`;
  }
  return met ? "holds" : lacks.join("\n");
}

/** How close a guard is to being enabled: 1 if it is, 0 at the largest distance that was seen. */
function closeness(run: Run, { guard, met, margins, missing, elapsed, needed }: GuardFrame): number {
  if (missing.length === 0) {
    return needed !== null && needed > 0 ? Math.min(1, (elapsed ?? 0) / needed) : Number(met);
  }
  const parts = missing.map((part) => {
    const [margin, largest] = [margins[part], run.largest(guard, part)];
    return margin === null || margin === undefined || largest === 0 ? 0 : 1 - Math.abs(margin) / largest;
  });
  return Math.min(...parts);
}
