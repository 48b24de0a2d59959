const SVG = "http://www.w3.org/2000/svg";

/** The value of an attribute. */
type Value = string | number;

/** An element of a picture. */
export function svg<Name extends keyof SVGElementTagNameMap>(name: Name, attributes: Record<string, Value> = {}, ...children: (Element | string)[]): SVGElementTagNameMap[Name] {
  const element = document.createElementNS(SVG, name);
  set(element, attributes);
  element.append(...children);
  return element;
}

/** Sets attributes of an element. Those that have their value already are left alone, so that nothing is drawn again. */
export function set(element: Element, attributes: Record<string, Value>): void {
  for (const [name, value] of Object.entries(attributes)) {
    const text = String(value);
    if (element.getAttribute(name) !== text) {
      element.setAttribute(name, text);
    }
  }
}
