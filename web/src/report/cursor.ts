import { byTime, describe, tipAt, type Positions } from "./positions.ts";

const SVG = "http://www.w3.org/2000/svg";

/** The selected tip estimate of a picture: a ring on the map, a line across the strips, and a note. */
export class Cursor {
  readonly #drawing: HTMLElement;
  readonly #svg: SVGSVGElement;
  readonly #positions: Positions;
  readonly #order: number[];
  readonly #overlay = document.createElementNS(SVG, "g");
  readonly #ring = document.createElementNS(SVG, "circle");
  readonly #line = document.createElementNS(SVG, "line");
  readonly #note = document.createElement("div");
  /** Position of the selected estimate in the order of times. */
  #selected: number | undefined;

  constructor(drawing: HTMLElement, svg: SVGSVGElement, positions: Positions) {
    [this.#drawing, this.#svg, this.#positions] = [drawing, svg, positions];
    this.#order = byTime(positions);
    this.#overlay.setAttribute("class", "overlay");
    for (const part of [this.#ring, this.#line]) {
      part.setAttribute("fill", "none");
      part.setAttribute("stroke", "#1f2933");
      part.setAttribute("stroke-width", "1.5");
    }
    this.#ring.setAttribute("r", "7");
    this.#note.className = "note";
    this.#note.setAttribute("role", "status");
    drawing.addEventListener("pointermove", (event) => this.#point(event));
    drawing.addEventListener("pointerleave", () => this.#select(undefined));
    drawing.addEventListener("blur", () => this.#select(undefined));
  }

  /** Acts on a key. True if the key belongs to the cursor. */
  key(event: KeyboardEvent): boolean {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step === undefined || this.#order.length === 0) {
      return false;
    }
    const next = (this.#selected ?? (step > 0 ? -1 : this.#order.length)) + step * (event.shiftKey ? 30 : 1);
    this.#select(Math.min(this.#order.length - 1, Math.max(0, next)));
    return true;
  }

  #point(event: PointerEvent): void {
    const matrix = this.#svg.getScreenCTM()?.inverse();
    if (matrix) {
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
      const index = tipAt(this.#positions, x, y);
      this.#select(index === undefined ? undefined : this.#order.indexOf(index));
    }
  }

  #select(selected: number | undefined): void {
    if (selected === this.#selected) {
      return;
    }
    this.#selected = selected;
    const index = selected === undefined ? undefined : this.#order[selected];
    const tip = index === undefined ? undefined : this.#positions.tips[index];
    if (index === undefined || tip === undefined) {
      this.#overlay.remove();
      this.#note.remove();
      return;
    }
    const { sides, strips, end_s } = this.#positions;
    const x = sides[0] + (tip[3] / end_s) * (sides[1] - sides[0]);
    const places: [SVGElement, Record<string, number>][] = [
      [this.#ring, { cx: tip[0], cy: tip[1] }],
      [this.#line, { x1: x, x2: x, y1: strips[0], y2: strips[1] }],
    ];
    for (const [part, place] of places) {
      Object.entries(place).forEach(([name, value]) => part.setAttribute(name, String(value)));
    }
    this.#overlay.replaceChildren(this.#ring, this.#line);
    this.#svg.append(this.#overlay);
    this.#note.textContent = describe(this.#positions, index);
    this.#drawing.append(this.#note);
    this.#place(tip[0], tip[1]);
  }

  /** Places the note beside a position of the picture, within the figure. */
  #place(x: number, y: number): void {
    const matrix = this.#svg.getScreenCTM();
    const frame = this.#drawing.getBoundingClientRect();
    if (matrix) {
      const point = new DOMPoint(x, y).matrixTransform(matrix);
      const left = Math.min(point.x - frame.left + 14, frame.width - this.#note.offsetWidth - 4);
      const top = Math.min(Math.max(point.y - frame.top - 34, 4), frame.height - this.#note.offsetHeight - 4);
      this.#note.style.left = `${Math.max(4, left)}px`;
      this.#note.style.top = `${top}px`;
    }
  }
}
