import { ParameterField } from "../live/parameter-field.ts";
import type { ParameterInfo } from "../live/protocol.ts";
import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";

/** The parameters of the policy as sliders. */
export class Parameters {
  readonly element = element("details", "parameters");
  readonly #changed: () => void;
  readonly #body = element("tbody");
  #fields: ParameterField[] = [];
  #values: Record<string, number> = {};
  #known = "";

  /** `changed` is called after a value has changed. */
  constructor(changed: () => void) {
    this.#changed = changed;
    const reset = button("values of the text", () => this.clear(), "restore all values of the text");
    // In a narrow window, they would be between the policy and its run.
    this.element.open = matchMedia("(min-width: 761px)").matches;
    this.element.append(element("summary", "", "Parameters"), element("div", "table", element("table", "", element("caption", "", "Moving a slider runs at once."), this.#body)), element("div", "tools", reset));
    this.element.hidden = true;
  }

  /** The values (SI) that differ from those of the text. */
  readonly set: Record<string, number> = {};

  /** Shows the parameters of a run that has begun with the values of `set`. */
  show(parameters: readonly ParameterInfo[]): void {
    // The values of the text. Those that a slider has set are not told again.
    this.#values = Object.fromEntries(parameters.map(({ name, value }) => [name, name in this.set ? (this.#values[name] ?? value) : value]));
    const known = JSON.stringify(parameters.map((info) => ({ ...info, value: this.#values[info.name] })));
    this.element.hidden = parameters.length === 0;
    if (known === this.#known) {
      return;
    }
    this.#known = known;
    this.#fields = parameters.map((info) => {
      const field: ParameterField = new ParameterField(info, () => {
        this.set[info.name] = field.changed ?? info.value;
        this.#changed();
      });
      return field;
    });
    this.#body.replaceChildren(...this.#fields.map(({ row }) => row));
  }

  /** True if the policy that ran last has a parameter with this name. */
  has(name: string): boolean {
    return name in this.#values || this.#fields.some(({ info }) => info.name === name);
  }

  /** Restores the values of the text. */
  clear(): void {
    const had = Object.keys(this.set);
    had.forEach((name) => delete this.set[name]);
    [this.#known, this.#values] = ["", {}];
    if (had.length > 0) {
      this.#changed();
    }
  }

  /** Takes the values of a link. */
  take(values: Record<string, number>): void {
    this.clear();
    Object.assign(this.set, values);
  }
}
