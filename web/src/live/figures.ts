import { element } from "../shared/element.ts";
import type { Frame } from "./protocol.ts";
import { digits, quantity } from "./quantity.ts";
import type { Run } from "./run.ts";
import type { Panel, View } from "./view.ts";

/** A figure: its name, what it means, and its text. */
interface Figure {
  name: string;
  meaning: string;
  text: (frame: Frame, run: Run) => string;
  /** False in a tick of a run that has no such figure. Then it is not shown. */
  isKnown?: (frame: Frame) => boolean;
}

const amount = (value: number | null | undefined, unit: string): string => (value === null || value === undefined ? "–" : quantity(value, unit));

const isTimed = ({ loop }: Frame): boolean => loop !== null;

const FIGURES: readonly Figure[] = [
  { name: "error", meaning: "mean distance of the recorded tips from the nearest outline", text: ({ metrics }) => amount(metrics.error, "m") },
  { name: "coverage", meaning: "share of the reference that was traced", text: ({ metrics }) => (metrics.coverage === null ? "–" : `${digits(metrics.coverage * 100)} %`) },
  { name: "standard deviation", meaning: "mean standard deviation of the recorded tips", text: ({ metrics }) => amount(metrics.spread, "m") },
  { name: "period", meaning: "wall time since the tick before. Pauses do not count", text: ({ loop }) => amount(loop?.period, "s"), isKnown: isTimed },
  { name: "used", meaning: "wall time of perception, machine and motion", text: ({ loop }) => amount(loop?.used, "s"), isKnown: isTimed },
  { name: "speed", meaning: "commanded speed", text: ({ command }) => quantity(Math.hypot(command[0], command[1]), "m/s") },
];

/** The number of shown messages. */
const MESSAGES = 6;

/** Figures of the shown tick, and the last messages of the policy. */
export class Figures implements Panel {
  readonly element: HTMLElement;
  readonly #values = FIGURES.map(() => element("dd"));
  readonly #rows: HTMLElement[];
  readonly #overload = element("p", "overload");
  readonly #messages = element("ul", "messages");
  #known = "";

  constructor() {
    const list = element("dl", "figures");
    this.#rows = FIGURES.map(({ name, meaning }, index) => {
      const term = element("dt", "", name);
      term.title = meaning;
      return element("div", "", term, this.#values[index] ?? "");
    });
    list.append(...this.#rows);
    this.element = element("section", "", element("h2", "", "Figures"), list, this.#overload, this.#messages);
  }

  update({ run, frame }: View): void {
    if (frame === undefined) {
      return;
    }
    FIGURES.forEach(({ text, isKnown }, index) => {
      const [value, row] = [this.#values[index], this.#rows[index]];
      if (value && row) {
        value.textContent = text(frame, run);
        row.hidden = isKnown?.(frame) === false;
      }
    });
    const { frames, last } = run.history;
    const key = `${frame.tick} ${frames.length} ${last?.tick}`;
    if (key === this.#known) {
      return;
    }
    this.#known = key;
    const until = frames.slice(0, run.history.indexAt(frame.tick) + 1);
    const late = until.filter(({ loop }) => loop?.overload === true).length;
    this.#overload.textContent = late === 0 ? "" : `${late} ${late === 1 ? "tick" : "ticks"} took longer than the control period.`;
    const messages = until.flatMap(({ time, messages }) => messages.map((text) => `${time.toFixed(2)} s: ${text}`)).slice(-MESSAGES);
    this.#messages.replaceChildren(...messages.map((text) => element("li", "", text)));
  }
}
