import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import type { Fault } from "./protocol.ts";
import type { Run } from "./run.ts";
import type { Actions, Panel, View } from "./view.ts";

/** The list of breakpoints, and a field for a new one. */
export class BreakpointList implements Panel {
  readonly element: HTMLElement;
  readonly #list = element("ul", "breakpoints");
  readonly #actions: Actions;
  readonly #field = element("input");
  readonly #fault = element("p", "hint");
  #isAsked = false;
  #drawn = "";

  constructor(run: Run, actions: Actions) {
    this.#actions = actions;
    const field = this.#field;
    this.#fault.setAttribute("role", "alert");
    field.setAttribute("aria-label", "state or condition of a new breakpoint");
    field.setAttribute("list", "states");
    field.placeholder = "state or condition";
    field.spellcheck = false;
    field.autocomplete = "off";
    const names = element("datalist");
    names.id = "states";
    names.append(...[...new Set(run.chart.nodes.map(({ name }) => name))].map((name) => new Option(name)));
    const form = element("form", "add", field, names, button("add", () => form.requestSubmit(), "add the breakpoint"));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const text = field.value.trim();
      this.#fault.textContent = "";
      if (text !== "") {
        this.#isAsked = true;
        actions.send({ type: "break", add: text, remove: null });
      }
    });
    const isPossible = run.hello.capabilities.breakpoints;
    this.element = element("section", "", element("h2", "", "Breakpoints"), ...(isPossible ? [this.#list, form, this.#fault] : [element("p", "hint", "This run has no breakpoints.")]));
  }

  /** Shows a fault beside the field. False if it is not of a breakpoint that was asked for here. */
  fault({ message, id }: Fault): boolean {
    const isOfField = this.#isAsked && id === null;
    if (isOfField) {
      [this.#isAsked, this.#fault.textContent] = [false, message];
    }
    return isOfField;
  }

  update({ run }: View): void {
    const breakpoints = run.breakpoints;
    const hit = run.status?.state === "paused" ? run.status.breakpoint : null;
    const key = JSON.stringify([breakpoints, hit]);
    if (key === this.#drawn) {
      return;
    }
    this.#drawn = key;
    this.#isAsked = false;
    // A text that cannot be a breakpoint stays in the field.
    if (breakpoints.some(({ text }) => text === this.#field.value.trim())) {
      this.#field.value = "";
    }
    const items = breakpoints.map(({ text, state }) => {
      const item = element("li", text === hit ? "hit" : "", element("code", "", text), state === null ? "" : " (state)");
      item.append(" ", button("remove", () => this.#actions.send({ type: "break", add: null, remove: text }), `remove the breakpoint ${text}`));
      return item;
    });
    this.#list.replaceChildren(...(items.length > 0 ? items : [element("li", "hint", "None.")]));
  }
}
