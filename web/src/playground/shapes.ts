import type { Hello, Point } from "../live/protocol.ts";
import { placed, World } from "../live/world.ts";
import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { set, svg } from "../shared/svg.ts";
import { Width } from "../shared/width.ts";
import type { Change, Shape } from "./messages.ts";

/** The largest height (px). */
const TALLEST = 480;
/** The space (m) around what is drawn. */
const ROOM = 0.1;
/** The step (m) of an arrow key, and that with the key Shift. */
const STEPS = [0.01, 0.001] as const;
/** The size (m) of a shape that is added without a size: the radius of a disk, half the side of a square. */
const SIZE = 0.05;
/** The least distance (px) of a drag. A shorter one is a click. */
const CLICK = 5;
/** The radius (px) of a handle. */
const HANDLE = 7;

type Mode = "move" | "disk" | "polygon";

const HINTS: Record<Mode, string> = {
  move: "Drag a handle, or focus it and use the arrow keys (with Shift, a tenth of the step). Delete removes its object.",
  disk: "Drag from the centre of a new disk to its rim. Enter adds one in the middle.",
  polygon: "Click the corners of a new polygon, then its first one or Enter. Enter alone adds a square in the middle. Escape ends.",
};

/** A handle: a point of an object, or the rim of a disk. */
interface Handle {
  object: number;
  /** Undefined for the rim. */
  point: number | undefined;
  at: Point;
}

/** A drawing of the scene in which objects are moved, added and removed. Each change is one of the scenario's text. */
export class Shapes {
  readonly element = element("details", "shapes");
  readonly #change: (change: Change) => Promise<void>;
  readonly #undo: (isAgain: boolean) => void;
  readonly #svg = svg("svg", { role: "group", "aria-label": "objects of the scene, from above", tabindex: 0 });
  readonly #outlines = svg("path", { class: "objects" });
  readonly #robot = svg("path", { class: "platform" });
  readonly #draft = svg("path", { class: "draft" });
  readonly #handles = svg("g");
  readonly #hint = element("p", "hint");
  readonly #modes: Record<Mode, HTMLButtonElement>;
  readonly #width: Width;
  #world = new World();
  #hello: Hello | undefined;
  #shapes: readonly Shape[] = [];
  #mode: Mode = "move";
  #corners: Point[] = [];
  /** Changes are made one after the other, each in the text that the one before has left. */
  #queue: Promise<void> = Promise.resolve();

  /** `change` changes the text of the scenario. `undo` takes the last change of that text back, or makes it again. */
  constructor(change: (change: Change) => Promise<void>, undo: (isAgain: boolean) => void) {
    [this.#change, this.#undo] = [change, undo];
    const mode = (mode: Mode, text: string, description: string): HTMLButtonElement => button(text, () => this.#choose(mode), description);
    this.#modes = { move: mode("move", "move", "move objects and corners"), disk: mode("disk", "add disk", "add a disk"), polygon: mode("polygon", "add polygon", "add a polygon") };
    this.#svg.append(this.#outlines, this.#robot, this.#draft, this.#handles);
    const drawing = element("div", "drawing");
    drawing.append(this.#svg);
    this.element.append(element("summary", "", "Shapes"), element("div", "tools", ...Object.values(this.#modes)), this.#hint, drawing);
    this.#width = new Width(drawing, () => this.#draw());
    this.#svg.addEventListener("pointerdown", (event) => this.#press(event));
    this.#svg.addEventListener("keydown", (event) => this.#key(event));
    this.#choose("move");
  }

  /** Shows the exact outlines of a run that begins. */
  begin(hello: Hello): void {
    if (this.#hello?.scenario !== hello.scenario) {
      this.#world = new World();
    }
    this.#hello = hello;
    this.#draw();
  }

  /** Shows the handles of the objects of a text. */
  show(shapes: readonly Shape[]): void {
    this.#shapes = shapes;
    this.#draw();
  }

  #choose(mode: Mode): void {
    [this.#mode, this.#corners] = [mode, []];
    for (const [name, chosen] of Object.entries(this.#modes)) {
      chosen.setAttribute("aria-pressed", String(name === mode));
    }
    this.#hint.textContent = HINTS[mode];
    this.#svg.classList.toggle("adding", mode !== "move");
    set(this.#draft, { d: "" });
  }

  #draw(): void {
    const width = this.#width.value;
    if (width === 0) {
      return;
    }
    const { scene, start, rig } = this.#hello ?? {};
    const handles = this.#shapes.flatMap(handlesOf);
    [...(scene ?? []).flatMap(({ points }) => points), ...handles.map(({ at }) => at)].forEach((point) => this.#world.include(point, ROOM));
    if (start) {
      this.#world.include([start[0], start[1]], ROOM);
    }
    const height = this.#world.fit(width, TALLEST);
    set(this.#svg, { width, height, viewBox: `0 0 ${width} ${height}` });
    set(this.#outlines, { d: (scene ?? []).map(({ points, closed }) => this.#world.line(points, closed)).join("") });
    set(this.#robot, { d: start && rig ? this.#world.line(rig.platform.map((corner) => placed(start, corner)), true) : "" });
    // Handles that stay keep the focus.
    while (this.#handles.children.length > handles.length) {
      this.#handles.lastElementChild?.remove();
    }
    handles.forEach((handle, index) => this.#place(handle, index));
  }

  #place(handle: Handle, index: number): void {
    let mark = this.#handles.children[index];
    if (mark === undefined) {
      mark = svg("circle", { r: HANDLE, tabindex: 0, role: "button" });
      this.#handles.append(mark);
    }
    const [x, y] = this.#world.px(handle.at);
    const shape = this.#shapes[handle.object];
    const what = handle.point === undefined ? "rim" : shape?.kind === "polygon" ? `corner ${handle.point + 1}` : "place";
    const place = handle.at.map((value) => `${Math.round(value * 1e3)} mm`).join(", ");
    set(mark, { class: handle.point === undefined ? "handle rim" : "handle", cx: x, cy: y, "data-index": index, "aria-label": `${what} of object ${handle.object + 1}, ${shape?.kind ?? ""}: ${place}` });
  }

  /** The handle of an element. */
  #handle(target: EventTarget | null): Handle | undefined {
    const index = target instanceof Element ? target.getAttribute("data-index") : null;
    return index === null ? undefined : this.#shapes.flatMap(handlesOf)[Number(index)];
  }

  /** The position (m) of a pointer, in whole millimetres. */
  #at(event: PointerEvent): Point {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.#svg.getScreenCTM()?.inverse());
    return rounded(this.#world.point([x, y]));
  }

  #press(event: PointerEvent): void {
    if (event.button !== 0) {
      return;
    }
    const from = this.#at(event);
    const handle = this.#mode === "move" ? this.#handle(event.target) : undefined;
    if (this.#mode === "polygon") {
      this.#corner(from);
      return;
    }
    if (handle === undefined && this.#mode === "move") {
      return;
    }
    this.#svg.setPointerCapture(event.pointerId);
    const start = [event.clientX, event.clientY] as const;
    const isClick = (moved: PointerEvent): boolean => Math.hypot(moved.clientX - start[0], moved.clientY - start[1]) < CLICK;
    const move = (moved: PointerEvent): void => {
      const to = this.#at(moved);
      set(this.#draft, { d: handle === undefined ? this.#disk(from, distance(from, to)) : this.#moved(handle, to) });
    };
    const end = (moved: PointerEvent): void => {
      this.#svg.removeEventListener("pointermove", move);
      set(this.#draft, { d: "" });
      if (moved.type === "pointercancel") {
        return;
      }
      const to = this.#at(moved);
      if (handle === undefined) {
        this.#make({ what: "disk", centre: from, radius: isClick(moved) ? SIZE : distance(from, to) });
        this.#choose("move");
      } else if (!isClick(moved)) {
        this.#move(handle, to);
      }
    };
    this.#svg.addEventListener("pointermove", move);
    this.#svg.addEventListener("pointerup", end, { once: true });
    this.#svg.addEventListener("pointercancel", end, { once: true });
  }

  /** Adds a corner to the new polygon, or ends it at its first corner. */
  #corner(at: Point): void {
    const [first] = this.#corners;
    if (first !== undefined && this.#corners.length > 2 && distance(first, at) * this.#world.scale < 2 * HANDLE) {
      this.#close();
      return;
    }
    this.#corners.push(at);
    set(this.#draft, { d: this.#world.line(this.#corners) + (first === undefined ? this.#disk(at, CLICK / this.#world.scale) : "") });
  }

  #close(): void {
    const corners = this.#corners;
    this.#choose("move");
    this.#make({ what: "polygon", corners });
  }

  #key(event: KeyboardEvent): void {
    const key = event.key.toLowerCase();
    if ((event.ctrlKey || event.metaKey) && (key === "z" || key === "y")) {
      // The browser would take back a change of another editor.
      event.preventDefault();
      this.#queue = this.#queue.then(() => this.#undo(key === "y" || event.shiftKey));
      return;
    }
    if (event.ctrlKey || event.altKey || event.metaKey) {
      return;
    }
    const handle = this.#handle(event.target);
    const step = STEPS[event.shiftKey ? 1 : 0];
    const directions: Record<string, Point> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
    const direction = directions[event.key];
    if (handle !== undefined && direction !== undefined) {
      this.#move(handle, rounded([handle.at[0] + direction[0], handle.at[1] + direction[1]]));
    } else if (handle !== undefined && (event.key === "Delete" || event.key === "Backspace")) {
      this.#make({ what: "remove", object: handle.object });
    } else if (event.key === "Enter" && this.#mode !== "move") {
      this.#add();
    } else if (event.key === "Escape" && this.#mode !== "move") {
      this.#choose("move");
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  /** Adds the begun polygon, or a shape in the middle of the drawing. */
  #add(): void {
    if (this.#mode === "polygon" && this.#corners.length > 2) {
      this.#close();
      return;
    }
    const { width, height } = this.#svg.viewBox.baseVal;
    const [x, y] = rounded(this.#world.point([width / 2, height / 2]));
    const corners: Point[] = [[x - SIZE, y - SIZE], [x + SIZE, y - SIZE], [x + SIZE, y + SIZE], [x - SIZE, y + SIZE]];
    this.#make(this.#mode === "disk" ? { what: "disk", centre: [x, y], radius: SIZE } : { what: "polygon", corners });
    this.#choose("move");
  }

  #move({ object, point }: Handle, to: Point): void {
    const centre = this.#shapes[object]?.points[0];
    if (point !== undefined) {
      this.#make({ what: "move", object, point, to });
    } else if (centre !== undefined) {
      this.#make({ what: "resize", object, radius: distance(centre, to) });
    }
  }

  #make(change: Change): void {
    this.#queue = this.#queue.then(() => this.#change(change));
  }

  /** The path of an object with a moved handle. */
  #moved({ object, point }: Handle, to: Point): string {
    const shape = this.#shapes[object];
    const [centre] = shape?.points ?? [];
    if (shape === undefined || centre === undefined) {
      return "";
    }
    if (shape.kind === "polygon") {
      return this.#world.line(shape.points.map((corner, index) => (index === point ? to : corner)), true);
    }
    return shape.radius === null ? this.#world.line([centre, to]) : point === undefined ? this.#disk(centre, distance(centre, to)) : this.#disk(to, shape.radius);
  }

  #disk(centre: Point, radius: number): string {
    const [x, y] = this.#world.px(centre);
    const r = radius * this.#world.scale;
    return `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
  }
}

function handlesOf({ points, radius }: Shape, object: number): Handle[] {
  const handles: Handle[] = points.map((at, point) => ({ object, point, at }));
  const [centre] = points;
  return radius === null || centre === undefined ? handles : [...handles, { object, point: undefined, at: [centre[0] + radius, centre[1]] }];
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

function rounded([x, y]: Point): Point {
  return [Math.round(x * 1e3) / 1e3, Math.round(y * 1e3) / 1e3];
}
