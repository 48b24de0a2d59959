/** The visible part of a picture, by its view box. */
export class Zoom {
  readonly #drawing: HTMLElement;
  readonly #svg: SVGSVGElement;
  #size: [number, number];
  #scale = 1;
  #left = 0;
  #top = 0;

  constructor(drawing: HTMLElement, svg: SVGSVGElement) {
    this.#drawing = drawing;
    this.#svg = svg;
    const { width, height } = svg.viewBox.baseVal;
    this.#size = [width, height];
    drawing.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    drawing.addEventListener("dblclick", (event) => this.by(2, ...this.position(event)));
    drawing.addEventListener("pointerdown", (event) => this.#drag(event));
  }

  /** The view box of the whole picture. */
  get whole(): string {
    return `0 0 ${this.#size[0]} ${this.#size[1]}`;
  }

  /** Gives the picture another size (px). */
  resize(width: number, height: number): void {
    this.#size = [width, height];
    this.#show();
  }

  /** Shows a position (px of the picture) in the middle, enlarged by a factor. */
  look(x: number, y: number, scale: number): void {
    this.#scale = scale;
    const [width, height] = this.#visible();
    [this.#left, this.#top] = [x - width / 2, y - height / 2];
    this.#show();
  }

  /** The position (px of the picture) of a pointer. */
  position(event: MouseEvent): [number, number] {
    // The picture may be narrower than its element.
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.#svg.getScreenCTM()?.inverse());
    return [x, y];
  }

  /** Zooms by a factor. The position (px of the picture) stays where it is. */
  by(factor: number, x = this.#left + 0.5 * this.#visible()[0], y = this.#top + 0.5 * this.#visible()[1]): void {
    const scale = Math.min(40, Math.max(1, this.#scale * factor));
    const kept = this.#scale / scale;
    [this.#left, this.#top, this.#scale] = [x - (x - this.#left) * kept, y - (y - this.#top) * kept, scale];
    this.#show();
  }

  reset(): void {
    [this.#scale, this.#left, this.#top] = [1, 0, 0];
    this.#show();
  }

  /** Acts on a key. True if the key belongs to the zoom. */
  key(event: KeyboardEvent): boolean {
    const step = (x: number, y: number): boolean => {
      if (this.#scale === 1) {
        return false;
      }
      const [width, height] = this.#visible();
      this.#left += 0.1 * x * width;
      this.#top += 0.1 * y * height;
      this.#show();
      return true;
    };
    switch (event.key) {
      case "+": case "=": this.by(1.5); return true;
      case "-": this.by(1 / 1.5); return true;
      case "0": this.reset(); return true;
      case "ArrowLeft": return step(-1, 0);
      case "ArrowRight": return step(1, 0);
      case "ArrowUp": return step(0, -1);
      case "ArrowDown": return step(0, 1);
      default: return false;
    }
  }

  #visible(): [number, number] {
    return [this.#size[0] / this.#scale, this.#size[1] / this.#scale];
  }

  #wheel(event: WheelEvent): void {
    // A wheel alone scrolls the page.
    if (event.ctrlKey || event.metaKey) {
      event.preventDefault();
      this.by(1.002 ** -event.deltaY, ...this.position(event));
    }
  }

  #drag(event: PointerEvent): void {
    if (this.#scale === 1 || event.button !== 0) {
      return;
    }
    this.#drawing.setPointerCapture(event.pointerId);
    const [startX, startY] = this.position(event);
    const move = (moved: PointerEvent): void => {
      const [x, y] = this.position(moved);
      this.#left -= x - startX;
      this.#top -= y - startY;
      this.#show();
    };
    this.#drawing.addEventListener("pointermove", move);
    const end = (): void => this.#drawing.removeEventListener("pointermove", move);
    this.#drawing.addEventListener("pointerup", end, { once: true });
    this.#drawing.addEventListener("pointercancel", end, { once: true });
  }

  #show(): void {
    const [width, height] = this.#visible();
    this.#left = Math.min(this.#size[0] - width, Math.max(0, this.#left));
    this.#top = Math.min(this.#size[1] - height, Math.max(0, this.#top));
    this.#svg.setAttribute("viewBox", `${this.#left} ${this.#top} ${width} ${height}`);
    this.#drawing.classList.toggle("zoomed", this.#scale > 1);
  }
}
