/** The width (px) of an element's content. Reading it does not make the browser lay out the page, as `clientWidth` does. */
export class Width {
  #value = 0;

  /** `changed` is called after every change. */
  constructor(element: Element, changed: () => void) {
    new ResizeObserver((entries) => {
      this.#value = entries.at(-1)?.contentRect.width ?? 0;
      changed();
    }).observe(element);
  }

  get value(): number {
    return this.#value;
  }
}
