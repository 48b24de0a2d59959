import { digits, quantity } from "../live/quantity.ts";
import { element } from "../shared/element.ts";
import type { Result } from "./messages.ts";

/** A figure of a run: its path in the JSON document, its name, its factor to SI units and its unit. */
const FIGURES: readonly [key: string, name: string, factor: number, unit: string][] = [
  ["error_mm.mean", "mean error", 1e-3, "m"],
  ["error_mm.max", "largest error", 1e-3, "m"],
  ["coverage", "coverage", 100, "%"],
  ["sim_s", "time", 1, "s"],
];

/** The figures of the run beside those of the policies of the program in the same scene. */
export class Score {
  readonly element = element("section", "score");
  readonly #body = element("tbody");
  readonly #verdict = element("p", "verdict");
  readonly #others = new Map<string, Result | undefined>();
  #own: Result | undefined;

  constructor() {
    const heads = ["policy", "outcome", ...FIGURES.map(([, name]) => name)].map((name) => {
      const head = element("th", name === "policy" ? "name" : "", name);
      head.scope = "col";
      return head;
    });
    this.#verdict.setAttribute("role", "status");
    const table = element("table", "", element("thead", "", element("tr", "", ...heads)), this.#body);
    this.element.append(element("h2", "", "Score"), this.#verdict, element("div", "table", table));
    this.#show();
  }

  /** Forgets all figures of the scene before. */
  clear(): void {
    [this.#own] = [undefined];
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
    const why = [...result.violations, ...(result.reason === null ? [] : [result.reason])].join("; ");
    this.#verdict.textContent = `${result.outcome}${why === "" ? "" : `: ${why}`}. Simulated ${digits(realtime)} times as fast as reality.`;
    this.#show();
  }

  /** Shows the figures of a policy of the program. */
  other(policy: string, result: Result | undefined): void {
    this.#others.set(policy, result);
    this.#show();
  }

  #show(): void {
    const row = (name: string, result: Result | undefined, className: string): HTMLTableRowElement => {
      const cells = FIGURES.map(([key, , factor, unit]) => {
        const value = figure(result, key);
        return element("td", "", typeof value !== "number" ? "–" : unit === "%" ? `${digits(value * factor)} %` : quantity(value * factor, unit));
      });
      return element("tr", className, element("td", "name", name), element("td", "", result?.outcome ?? "–"), ...cells);
    };
    const others = [...this.#others].map(([policy, result]) => row(policy, result, ""));
    this.#body.replaceChildren(row("this policy", this.#own, "own"), ...others);
  }
}

/** The figure at a path of a result. */
export function figure(result: Result | undefined, path: string): unknown {
  return path.split(".").reduce<unknown>((value, key) => (typeof value === "object" && value !== null ? (value as Record<string, unknown>)[key] : undefined), result);
}
