import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { set, svg } from "../shared/svg.ts";
import { Width } from "../shared/width.ts";
import { Answer } from "./answer.ts";
import { ParameterField } from "./parameter-field.ts";
import type { Fault, Kind, Piece } from "./protocol.ts";
import { quantity } from "./quantity.ts";
import type { Run } from "./run.ts";
import { drawStrip, STRIP } from "./strip.ts";
import { TimeAxis } from "./time-axis.ts";
import type { Actions, Panel, View } from "./view.ts";

/** The least time (ms) between two questions while a slider moves. */
const PAUSE = 80;
/** The space (px) before the strips, for their names. */
const LEFT = 62;

/** The number of the next question of this page. */
let next = 1;

/** Changes parameters and thresholds from a tick on, and shows where the machine would have gone. */
export class Counterfactual implements Panel {
  readonly element: HTMLElement;
  readonly #actions: Actions;
  readonly #run: Run;
  readonly #fields: ParameterField[];
  readonly #start = element("output");
  readonly #result = element("div", "result");
  readonly #summary = element("p", "summary");
  readonly #values = element("p", "hint");
  readonly #goTo: HTMLButtonElement;
  readonly #svg = svg("svg", { role: "img", "aria-label": "states of the run, and of the changed policy" });
  readonly #strips = [svg("g"), svg("g")];
  readonly #cursor = svg("line", { class: "cursor", y1: 0, y2: 2 * STRIP + 4 });
  readonly #width: Width;
  readonly #kinds: Record<Kind, HTMLInputElement>;
  #answer: Answer | undefined;
  /** The first tick with the change. Undefined until something is changed. */
  #tick: number | undefined;
  #shown: { tick: number; time: number } = { tick: 0, time: 0 };
  #timer: number | undefined;
  #asked = 0;
  #drawn = "";

  constructor(run: Run, actions: Actions) {
    [this.#run, this.#actions] = [run, actions];
    const { capabilities, parameters } = run.hello;
    this.#fields = parameters.map((info) => new ParameterField(info, () => this.#ask()));
    const kind = (value: Kind, text: string, isPossible: boolean): [HTMLInputElement, HTMLLabelElement] => {
      const input = element("input");
      [input.type, input.name, input.value, input.disabled] = ["radio", "kind", value, !isPossible];
      input.addEventListener("change", () => this.#ask());
      return [input, element("label", "", input, ` ${text}`)];
    };
    const [recorded, recordedLabel] = kind("recorded", "over the recorded samples", capabilities.counterfactual);
    const [closed, closedLabel] = kind("closed_loop", "in simulation, in closed loop", capabilities.closed_loop);
    this.#kinds = { recorded, closed_loop: closed };
    (capabilities.counterfactual ? recorded : closed).checked = true;
    this.#goTo = button("go there", () => this.#answer?.difference && this.#actions.select(this.#answer.difference.tick), "show the first tick that differs");
    const from = button("from the shown tick", () => {
      this.#tick = this.#shown.tick;
      this.#ask();
    }, "begin the change at the shown tick");
    const tools = element("div", "tools", from, button("reset", () => this.#reset(), "restore all values of the run"));
    const heading = element("div", "head", element("h2", "", "Counterfactual"), tools);
    this.#svg.append(...this.#strips, this.#cursor);
    set(this.#strips[1] ?? this.#svg, { transform: `translate(0 ${STRIP + 4})` });
    this.#svg.addEventListener("click", (event) => this.#seek(event));
    this.#result.append(this.#values, this.#svg, this.#summary, this.#goTo);
    this.#result.hidden = true;
    this.#width = new Width(this.#result, () => actions.refresh());
    this.#summary.setAttribute("aria-live", "polite");
    const isPossible = (capabilities.counterfactual || capabilities.closed_loop) && parameters.length > 0;
    this.element = element("section", "counterfactual", ...(isPossible ? [heading, element("div", "kinds", recordedLabel, closedLabel, this.#start), this.#result, this.#table()] : [element("h2", "", "Counterfactual"), element("p", "hint", "Nothing can be changed in this run.")]));
  }

  receive(piece: Piece): void {
    if (piece.id === this.#answer?.id) {
      this.#answer.add(piece);
    }
  }

  /** True if the fault belongs to a question of this panel. */
  fault({ id, message }: Fault): boolean {
    if (id === null) {
      return false;
    }
    if (id === this.#answer?.id) {
      this.#answer.fault = message;
    }
    return true;
  }

  update({ run, frame, answer }: View): void {
    if (frame !== undefined) {
      this.#shown = { tick: frame.tick, time: frame.time };
    }
    const tick = this.#tick ?? this.#first();
    this.#start.textContent = `from tick ${tick} (${(run.history.at(tick)?.time ?? 0).toFixed(2)} s)`;
    this.#result.hidden = answer === undefined;
    if (answer !== undefined) {
      this.#show(answer);
    }
  }

  #table(): HTMLElement {
    const rows = (isThreshold: boolean): HTMLTableRowElement[] => this.#fields.filter(({ info }) => (info.guard !== null) === isThreshold).map(({ row }) => row);
    const filter = element("input");
    filter.type = "search";
    filter.placeholder = "find a parameter or threshold";
    filter.setAttribute("aria-label", filter.placeholder);
    filter.addEventListener("input", () => {
      for (const field of this.#fields) {
        field.row.hidden = !field.matches(filter.value);
      }
    });
    const tables = [["Parameters", rows(false)], ["Thresholds of guards", rows(true)]] as const;
    const content = tables.filter(([, rows]) => rows.length > 0).map(([title, rows]) => element("div", "table", element("table", "", element("caption", "", title), element("tbody", "", ...rows))));
    return element("div", "parameters", filter, ...content);
  }

  #reset(): void {
    this.#fields.forEach((field) => field.reset());
    this.#tick = undefined;
    this.#ask();
  }

  /** The tick at which a change begins by itself: the shown one. At the end of a run a change would have no time, so it begins at the start. */
  #first(): number {
    const { history, status } = this.#run;
    const isOver = status?.state === "finished" && this.#shown.tick === history.last?.tick;
    return isOver ? (history.frames[0]?.tick ?? 0) : this.#shown.tick;
  }

  /** Asks again after a change, with a pause between two questions. */
  #ask(): void {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#send(), Math.max(0, this.#asked + PAUSE - performance.now()));
  }

  #send(): void {
    this.#asked = performance.now();
    if (this.#answer && !this.#answer.isDone) {
      this.#actions.send({ type: "cancel", id: this.#answer.id });
    }
    const changed = this.#fields.flatMap(({ info, changed }) => (changed === undefined ? [] : [[info.name, changed] as const]));
    if (changed.length === 0) {
      this.#answer = undefined;
    } else {
      const tick = (this.#tick ??= this.#first());
      const kind: Kind = this.#kinds.closed_loop.checked ? "closed_loop" : "recorded";
      const set = Object.fromEntries(changed);
      this.#answer = new Answer(next, kind, tick, this.#run.history.at(tick)?.time ?? 0, set);
      next += 1;
      this.#actions.send({ type: "counterfactual", id: this.#answer.id, tick, kind, set });
    }
    this.#actions.compare(this.#answer);
  }

  #show(answer: Answer): void {
    const { chart, shades, history, hello } = this.#run;
    const width = this.#width.value;
    const end = Math.max(history.last?.time ?? 0, answer.frames.at(-1)?.time ?? 0);
    const axis = new TimeAxis(answer.time, end, LEFT, Math.max(LEFT + 10, width));
    const x = axis.x(Math.max(axis.from, Math.min(axis.to, this.#shown.time)));
    set(this.#cursor, { x1: x, x2: x });
    const key = [width, answer.id, answer.frames.length, answer.isDone, history.frames.length, end].join();
    if (key === this.#drawn) {
      return;
    }
    this.#drawn = key;
    set(this.#svg, { width, height: 2 * STRIP + 4, viewBox: `0 0 ${width} ${2 * STRIP + 4}` });
    [history.spans, answer.spans].forEach((spans, index) => {
      const strip = this.#strips[index];
      if (strip) {
        drawStrip(strip, spans, axis, chart, shades);
        strip.append(svg("text", { class: "tick", x: 0, y: STRIP - 4 }, index === 0 ? "run" : "changed"));
      }
    });
    const unit = (name: string): string => hello.parameters.find((info) => info.name === name)?.unit ?? "";
    const values = Object.entries(answer.set).map(([name, value]) => `${name} = ${quantity(value, unit(name))}`);
    this.#values.textContent = `${answer.kind === "recorded" ? "Recorded samples" : "Closed loop"}, ${values.join(", ")}`;
    const text = summary(answer);
    if (this.#summary.textContent !== text) {
      this.#summary.textContent = text;
    }
    this.#goTo.hidden = answer.difference === undefined;
  }

  /** Shows the tick under the pointer. */
  #seek(event: MouseEvent): void {
    const answer = this.#answer;
    if (answer) {
      const end = Math.max(this.#run.history.last?.time ?? 0, answer.frames.at(-1)?.time ?? 0);
      const box = this.#svg.getBoundingClientRect();
      this.#actions.seek(new TimeAxis(answer.time, end, LEFT, box.width).time(event.clientX - box.left));
    }
  }
}

/** The answer in a sentence. */
function summary({ fault, difference, end, isDone, frames }: Answer): string {
  if (fault !== undefined) {
    return fault;
  }
  const last = frames.at(-1);
  const progress = isDone ? `End at ${(last?.time ?? 0).toFixed(2)} s: ${end ?? ""}.` : last === undefined ? "Computing." : `Computed until ${last.time.toFixed(2)} s.`;
  if (difference === undefined) {
    return `${isDone ? "No tick differs." : "No tick differs until now."} ${progress}`;
  }
  const place = `at ${difference.time.toFixed(2)} s (tick ${difference.tick})`;
  const what = difference.states_differ ? `The first difference is ${place}` : `The first difference is ${place}, in the command only`;
  return `${what}. Run: ${difference.before}. Changed: ${difference.after}. ${progress}`;
}
