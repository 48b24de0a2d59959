import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import type { Status } from "./protocol.ts";
import { digits, quantity } from "./quantity.ts";
import type { Run } from "./run.ts";
import type { Actions, Panel, View } from "./view.ts";

/** The durations (s) of the plots. */
const DURATIONS: readonly [number, string][] = [[5, "5 s"], [20, "20 s"], [60, "1 min"], [Infinity, "whole run"]];

const KEYS = "P pause or run · S step · L newest tick · , and . one tick · [ and ] one state · U outer state";

/** The bar with the state of the run, its controls and the history slider. */
export class Controls implements Panel {
  readonly element: HTMLElement;
  readonly #actions: Actions;
  readonly #up: () => void;
  readonly #title: HTMLElement;
  readonly #status = element("p", "status");
  readonly #fault = element("p", "fault");
  readonly #pause: HTMLButtonElement;
  readonly #step: HTMLButtonElement;
  readonly #steps: HTMLButtonElement;
  readonly #newest: HTMLButtonElement;
  readonly #slider = element("input", "slider");
  readonly #time = element("output", "time");
  readonly #gaps = element("p", "hint");
  #view: View | undefined;

  /** `up` goes to the outer state in the chart. `heading` is the element of the title. */
  constructor(actions: Actions, up: () => void, heading: "h1" | "h2") {
    [this.#actions, this.#up] = [actions, up];
    this.#title = element(heading, "", "vibrissa");
    this.#pause = button("pause", () => this.#toggle(), "pause or continue the run (key P)");
    this.#step = button("step", () => this.#advance(1), "execute one tick (key S)");
    this.#steps = button("30 ticks", () => this.#advance(30), "execute 30 ticks (key Shift S)");
    this.#newest = button("newest", () => actions.select(undefined), "show the newest tick (key L)");
    this.#slider.type = "range";
    this.#slider.min = "0";
    this.#slider.max = "0";
    this.#slider.setAttribute("aria-label", "shown tick");
    this.#slider.addEventListener("input", () => actions.select(Number(this.#slider.value)));
    const duration = element("select");
    duration.setAttribute("aria-label", "duration of the plots");
    duration.append(...DURATIONS.map(([value, text]) => new Option(text, String(value))));
    duration.value = "20";
    duration.addEventListener("change", () => actions.zoomTime(Number(duration.value)));
    this.#status.setAttribute("role", "status");
    this.#fault.setAttribute("role", "alert");
    const back = button("◂", () => this.#move(-1), "one tick back (key ,)");
    const on = button("▸", () => this.#move(1), "one tick on (key .)");
    const before = button("◂◂", () => this.#change(-1), "to the change of state before (key [)");
    const after = button("▸▸", () => this.#change(1), "to the next change of state (key ])");
    const tools = element("div", "tools", this.#pause, this.#step, this.#steps, before, back, on, after, this.#newest, duration);
    this.element = element("header", "controls", element("div", "title", this.#title, this.#status), tools, element("div", "history", this.#slider, this.#time), this.#gaps, this.#fault, element("p", "hint keys", KEYS));
    addEventListener("keydown", (event) => this.#key(event));
  }

  /** Shows a message about a request, or about the connection. */
  report(message: string): void {
    this.#fault.textContent = message;
  }

  update(view: View): void {
    this.#view = view;
    const { run, frame, isFollowing } = view;
    const { hello, status } = run;
    const title = [hello.scenario, hello.policy, hello.world ?? hello.command].filter((text) => text !== "").join(" · ");
    if (this.#title.textContent !== title) {
      this.#title.textContent = title;
      document.title = `${title} – vibrissa`;
    }
    const text = status === undefined ? "waiting" : statusText(status, run.past);
    if (this.#status.textContent !== text) {
      this.#status.textContent = text;
      this.#status.dataset["state"] = status?.state ?? "";
    }
    const canStep = hello.capabilities.step && status?.state !== "finished";
    this.#pause.disabled = !canStep;
    this.#pause.textContent = status?.state === "paused" ? "run" : "pause";
    this.#step.disabled = this.#steps.disabled = !canStep || status?.state !== "paused";
    this.#newest.setAttribute("aria-pressed", String(isFollowing));
    this.#slider.max = String(run.history.last?.tick ?? 0);
    this.#slider.value = String(frame?.tick ?? 0);
    const place = frame === undefined ? "" : `${frame.time.toFixed(2)} s, tick ${frame.tick}`;
    this.#time.textContent = place;
    this.#slider.setAttribute("aria-valuetext", place);
    const kept = status === undefined || status.kept_every <= 1 ? "" : `Of the older ticks, the program keeps one in ${status.kept_every}.`;
    const lost = run.lost === 0 ? "" : `This page was too slow for ${run.lost} ticks, and asked for them later.`;
    this.#gaps.textContent = `${kept} ${lost}`.trim();
  }

  #toggle(): void {
    const status = this.#view?.run.status;
    if (this.#view?.run.hello.capabilities.step && status?.state !== "finished") {
      this.#actions.send({ type: status?.state === "paused" ? "run" : "pause" });
    }
  }

  #advance(ticks: number): void {
    if (this.#view?.run.hello.capabilities.step && this.#view.run.status?.state === "paused") {
      this.#actions.select(undefined);
      this.#actions.send({ type: "step", ticks });
    }
  }

  /** Shows a tick before or after the shown one. */
  #move(count: number): void {
    const { run, frame } = this.#view ?? {};
    if (run && frame) {
      const next = run.history.frames[Math.max(0, run.history.indexAt(frame.tick) + count)];
      this.#actions.select((next ?? frame).tick);
    }
  }

  /** Shows the next tick with another state, or the one before. */
  #change(direction: 1 | -1): void {
    const { run, frame } = this.#view ?? {};
    if (run && frame) {
      const starts = run.history.spans.map(({ from }) => from);
      const next = direction === 1 ? starts.find((time) => time > frame.time) : starts.findLast((time) => time < frame.time);
      if (next !== undefined) {
        this.#actions.seek(next);
      }
    }
  }

  #key(event: KeyboardEvent): void {
    const target = event.target as Element | null;
    if (event.ctrlKey || event.altKey || event.metaKey || target?.matches("input:not([type=range], [type=radio]), select, [contenteditable=true]")) {
      return;
    }
    const actions: Record<string, () => void> = {
      p: () => this.#toggle(),
      s: () => this.#advance(1),
      S: () => this.#advance(30),
      u: this.#up,
      l: () => this.#actions.select(undefined),
      ",": () => this.#move(-1),
      ".": () => this.#move(1),
      "[": () => this.#change(-1),
      "]": () => this.#change(1),
    };
    const action = actions[event.key];
    if (action) {
      action();
      event.preventDefault();
    }
  }
}

/** What the run does, in words. After its end, the page may still be loading ticks. */
export function statusText({ state, reason, breakpoint, verdict, metrics }: Status, { count, missing }: Run["past"]): string {
  if (state === "finished" && missing > 0) {
    return `loading the past: ${count - missing} of ${count} ticks`;
  }
  switch (state) {
    case "running": return "running";
    case "paused": return breakpoint === null ? (reason === "start" ? "paused at the start" : "paused") : `paused at ${breakpoint}`;
    case "finished": {
      const error = metrics?.error ?? null;
      const coverage = metrics?.coverage ?? null;
      const figures = [error === null ? null : `error ${quantity(error, "m")}`, coverage === null ? null : `coverage ${digits(coverage * 100)} %`];
      return `finished: ${[verdict, reason, ...figures].filter((text) => text !== null).join(", ") || "ended"}`;
    }
  }
}
