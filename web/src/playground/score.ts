import { digits } from "../live/quantity.ts";
import { element } from "../shared/element.ts";
import { figure, FIGURES, shown, unmet } from "./figures.ts";
import type { Result } from "./messages.ts";

/** The figures of the run beside those of the policies of the program in the same scene. */
export class Score {
  readonly element = element("section", "score");
  readonly #body = element("tbody");
  readonly #verdict = element("p", "verdict");
  readonly #others = new Map<string, Result | undefined>();
  #own: Result | undefined;
  #isPast = false;

  constructor() {
    const heads = ["policy", "outcome", ...FIGURES.map(({ name }) => name)].map((name) => {
      const head = element("th", name === "policy" ? "name" : "", name);
      head.scope = "col";
      return head;
    });
    this.#verdict.setAttribute("role", "status");
    const caption = element("caption", "", "This policy beside the built-in ones in the same scene");
    const table = element("table", "", caption, element("thead", "", element("tr", "", ...heads)), this.#body);
    this.element.append(element("h2", "", "Score"), this.#verdict, element("div", "table", table));
    this.#show();
  }

  /** Forgets all figures of the scene before. */
  clear(): void {
    this.#own = undefined;
    this.#others.clear();
    this.#verdict.textContent = "";
    this.#show();
  }

  /** True if the figures of a policy of the program are there. */
  has(policy: string): boolean {
    return this.#others.has(policy);
  }

  /** Shows the figures of the run. */
  own(result: Result, realtime: number): void {
    this.#own = result;
    const missing = unmet(result);
    this.#verdict.textContent = `${result.outcome}${result.reason === null ? "" : `: ${result.reason}`}. ${missing.length === 0 ? "" : `Not met: ${missing.join("; ")}. `}Simulated ${digits(realtime)} times as fast as reality.`;
    this.#show();
  }

  /** Says whether the shown figures are those of a text that has been changed since. */
  date(isPast: boolean): void {
    if (this.#isPast !== isPast) {
      this.#isPast = isPast;
      this.#show();
    }
  }

  /** Shows the figures of a policy of the program. */
  other(policy: string, result: Result | undefined): void {
    this.#others.set(policy, result);
    this.#show();
  }

  #show(): void {
    const row = (name: string, result: Result | undefined, className: string): HTMLTableRowElement => {
      const cells = FIGURES.map((known) => element("td", "", shown(known, figure(result, known.key))));
      return element("tr", className, element("td", "name", name), element("td", "", result?.outcome ?? "–"), ...cells);
    };
    const others = [...this.#others].map(([policy, result]) => row(policy, result, ""));
    this.element.classList.toggle("past", this.#isPast);
    this.#body.replaceChildren(row(this.#isPast ? "this policy (from the previous text)" : "this policy", this.#own, "own"), ...others);
  }
}
