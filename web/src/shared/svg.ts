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

/** Sets attributes of an element. */
export function set(element: Element, attributes: Record<string, Value>): void {
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, String(value));
  }
}
