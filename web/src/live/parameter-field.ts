import { element } from "../shared/element.ts";
import type { ParameterInfo } from "./protocol.ts";
import { digits, scaleOf } from "./quantity.ts";
import { roundStep } from "./time-axis.ts";

/** The largest number of steps of a slider. */
const STEPS = 200;

/** The fields of a value that a counterfactual may change. */
export class ParameterField {
  readonly info: ParameterInfo;
  readonly row: HTMLTableRowElement;
  readonly #number = element("input");
  readonly #slider = element("input");
  readonly #choice = element("select");
  readonly #factor: number;
  readonly #change: () => void;
  /** The value (SI), if it is another one than that of the run. */
  changed: number | undefined;

  constructor(info: ParameterInfo, change: () => void) {
    [this.info, this.#change] = [info, change];
    const scale = scaleOf(info.value, info.unit);
    this.#factor = scale.factor;
    const label = `${info.name}${info.meaning === "" ? "" : `, ${info.meaning}`}`;
    const name = element("td", "name", element("code", "", info.guard === null ? info.name : info.meaning), element("div", "hint", info.guard === null ? info.meaning : info.name));
    const fields = element("td", "fields");
    if (info.choices.length > 0) {
      this.#choice.append(...info.choices.map((choice, value) => new Option(choice, String(value))));
      this.#choice.setAttribute("aria-label", label);
      this.#choice.addEventListener("change", () => this.#set(Number(this.#choice.value)));
      fields.append(this.#choice);
    } else {
      this.#number.type = "number";
      this.#number.step = "any";
      this.#number.setAttribute("aria-label", `${label} (${scale.unit || "number"})`);
      this.#number.addEventListener("input", () => {
        if (this.#number.value !== "" && this.#number.validity.valid) {
          this.#set(this.#number.valueAsNumber * this.#factor);
        }
      });
      const [low, high] = [info.low ?? Math.min(0, 2 * info.value), info.high ?? Math.max(0, 2 * info.value)];
      if (info.low !== null) {
        this.#number.min = String(info.low / this.#factor);
      }
      if (info.high !== null) {
        this.#number.max = String(info.high / this.#factor);
      }
      this.#slider.type = "range";
      this.#slider.min = String(low);
      this.#slider.max = String(high);
      const steps = (high - low) / this.#factor / STEPS;
      this.#slider.step = String(steps > 0 ? roundStep(steps) * this.#factor : 1);
      this.#slider.setAttribute("aria-label", label);
      this.#slider.addEventListener("input", () => this.#set(Number(this.#slider.value)));
      fields.append(this.#number, element("span", "unit", scale.unit), this.#slider);
    }
    this.row = element("tr", "", name, fields);
    this.#show(info.value);
  }

  /** Restores the value of the run. */
  reset(): void {
    this.changed = undefined;
    this.row.classList.remove("changed");
    this.#show(this.info.value);
  }

  /** True if the text occurs in the name or the meaning. */
  matches(text: string): boolean {
    return `${this.info.name} ${this.info.meaning}`.toLowerCase().includes(text.toLowerCase());
  }

  #set(value: number): void {
    this.changed = value === this.info.value ? undefined : value;
    this.row.classList.toggle("changed", this.changed !== undefined);
    this.#show(value);
    this.#change();
  }

  #show(value: number): void {
    this.#choice.value = String(value);
    this.#slider.value = String(value);
    if (document.activeElement !== this.#number) {
      this.#number.value = digits(value / this.#factor);
    }
  }
}
