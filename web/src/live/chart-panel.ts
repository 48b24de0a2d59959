import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { set, svg } from "../shared/svg.ts";
import { Width } from "../shared/width.ts";
import { label, layOut, type Box } from "./layout.ts";
import type { Run } from "./run.ts";
import { Node, type Arrow } from "./statechart.ts";
import type { Actions, Panel, View } from "./view.ts";

/** The statechart, one level at a time. */
export class ChartPanel implements Panel {
  readonly element: HTMLElement;
  readonly #actions: Actions;
  readonly #path = element("nav", "path");
  readonly #drawing = element("div", "chart");
  readonly #svg = svg("svg", { role: "group" });
  readonly #list = element("div", "transitions");
  readonly #follow: HTMLButtonElement;
  readonly #width: Width;
  readonly #boxes = new Map<Node, SVGGElement>();
  readonly #arrows: { arrow: Arrow; path: SVGPathElement }[] = [];
  #level: Node;
  #chosen: Node | undefined;
  #isFollowing = true;
  #drawn = "";
  #marked = "";

  constructor(run: Run, actions: Actions) {
    this.#actions = actions;
    this.#level = run.chart.root;
    this.#path.setAttribute("aria-label", "outer states");
    this.#follow = button("follow", () => this.#setFollowing(!this.#isFollowing), "show the level of the active state");
    this.#follow.setAttribute("aria-pressed", "true");
    const up = button("up", () => this.up(), "go to the outer state (key U)");
    this.#drawing.append(this.#svg);
    this.#width = new Width(this.#drawing, () => actions.refresh());
    this.element = element("section", "statechart", element("div", "head", element("h2", "", "Statechart"), element("div", "tools", up, this.#follow)), this.#path, this.#drawing, this.#list);
  }

  /** Goes to the outer state of the shown level. */
  up(): void {
    this.#enter(this.#level.parent);
  }

  update(view: View): void {
    const { run, frame } = view;
    const active = frame?.states.map((index) => run.chart.nodes[index]).filter((node) => node !== undefined) ?? [];
    if (this.#isFollowing) {
      const level = active.at(-1)?.parent ?? run.chart.root;
      if (level !== this.#level) {
        [this.#level, this.#chosen] = [level, undefined];
      }
    }
    const width = this.#width.value;
    const key = `${width} ${this.#level.index}`;
    if (key !== this.#drawn && width > 0) {
      this.#drawn = key;
      this.#draw(run, width);
    }
    this.#mark(view, active);
  }

  #draw(run: Run, width: number): void {
    const arrows = run.chart.arrows(this.#level);
    const layout = layOut(this.#level, arrows, width);
    const focused = [this.#svg, this.#path].find((part) => part.contains(document.activeElement));
    set(this.#svg, { viewBox: `0 0 ${layout.width} ${layout.height}`, width: layout.width, height: layout.height, "aria-label": `states in ${this.#level.name}` });
    this.#boxes.clear();
    this.#arrows.length = 0;
    const head = svg("marker", { id: "head", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto-start-reverse" }, svg("path", { d: "M0 0.5L8 4L0 7.5z" }));
    this.#svg.replaceChildren(svg("defs", {}, head));
    for (const { arrow, path } of layout.curves) {
      const curve = svg("path", { class: "arrow", d: path, "marker-end": "url(#head)" }, svg("title", {}, arrow.transitions.map(({ text }) => text).join("\n")));
      this.#arrows.push({ arrow, path: curve });
      this.#svg.append(curve);
    }
    this.#svg.append(...layout.boxes.map((box) => this.#box(run, box)));
    const names = [run.chart.root, ...this.#level.path];
    this.#path.replaceChildren(
      ...names.flatMap((node, index) => {
        const crumb = button(node.shortName, () => this.#enter(node), `show the states in ${node.name}`);
        if (index === names.length - 1) {
          crumb.setAttribute("aria-current", "true");
        }
        return index === 0 ? [crumb] : [" / ", crumb];
      }),
    );
    if (this.#level.behaviour !== undefined) {
      this.#path.append(element("code", "", ` is ${this.#level.behaviour}`));
    }
    if (focused === this.#svg) {
      const first = this.#boxes.values().next().value;
      (this.#chosen === undefined ? first : this.#boxes.get(this.#chosen))?.focus();
    } else if (focused === this.#path) {
      this.#path.querySelector<HTMLElement>("[aria-current]")?.focus();
    }
    this.#marked = "";
  }

  #box(run: Run, { item, isOutside, x, y, width, height }: Box): SVGGElement {
    const node = item instanceof Node ? item : undefined;
    const fill = isOutside || node === undefined ? "none" : run.shades.of(node.index);
    const group = svg("g", { class: isOutside ? "box outside" : "box", transform: `translate(${x} ${y})` }, svg("rect", { width, height, rx: 6, fill }), svg("text", { x: width / 2, y: height / 2 + 4.5, "text-anchor": "middle" }, label(item)));
    if (node === undefined) {
      group.append(svg("title", {}, `end of the run: ${String(item)}`));
      return group;
    }
    set(group, { tabindex: 0, role: "button" });
    if (isOutside) {
      set(group, { "aria-label": `${node.fullName}, outside of ${this.#level.name}; go there` });
      group.append(svg("title", {}, `go to ${node.fullName}`));
      const go = (): void => this.#enter(node.parent, node);
      group.addEventListener("click", go);
      group.addEventListener("keydown", (event) => {
        if (event.key === "Enter") {
          event.preventDefault();
          event.stopPropagation();
          go();
        }
      });
      return group;
    }
    if (node.isInitial) {
      group.prepend(svg("path", { class: "arrow", d: `M-10 ${height / 2}h9`, "marker-end": "url(#head)" }), svg("circle", { class: "initial", cx: -11, cy: height / 2, r: 3 }));
    }
    group.append(svg("circle", { class: "break", cx: width - 3, cy: 3, r: 5 }));
    group.addEventListener("click", () => this.#choose(node));
    group.addEventListener("dblclick", () => this.#open(node));
    group.addEventListener("focus", () => this.#choose(node));
    group.addEventListener("keydown", (event) => {
      if (event.key === "Enter") {
        this.#open(node);
      } else if (event.key === "b" || event.key === "B") {
        this.#actions.toggleBreakpoint(node.name);
      } else {
        return;
      }
      event.preventDefault();
      event.stopPropagation();
    });
    this.#boxes.set(node, group);
    return group;
  }

  #mark({ run, frame, answer }: View, active: readonly Node[]): void {
    const breaks = run.breakpoints;
    const others = (frame === undefined ? undefined : answer?.at(frame.tick))?.states ?? [];
    const key = [this.#level.index, this.#chosen?.index, active.map(({ index }) => index), others, frame?.taken, breaks.map(({ state }) => state)].join("|");
    if (key === this.#marked) {
      return;
    }
    this.#marked = key;
    for (const [node, group] of this.#boxes) {
      const isBroken = breaks.some(({ state }) => state === node.index);
      const isActive = active.includes(node);
      group.classList.toggle("active", isActive);
      group.classList.toggle("alternative", others.includes(node.index));
      group.classList.toggle("chosen", node === this.#chosen);
      group.classList.toggle("broken", isBroken);
      set(group, { "aria-label": `${node.shortName}${isActive ? ", active" : ""}${isBroken ? ", breakpoint" : ""}${node.children.length > 0 ? `, ${node.children.length} inner states` : ""}`, "aria-pressed": String(node === this.#chosen) });
    }
    const seen = this.#chosen ?? active.find((node) => node.parent === this.#level);
    for (const { arrow, path } of this.#arrows) {
      path.classList.toggle("lit", arrow.from === seen);
      path.classList.toggle("taken", arrow.transitions.some(({ guard }) => guard !== null && (frame?.taken.includes(guard) ?? false)));
    }
    this.#describe(run, this.#chosen, breaks.some(({ state }) => state === this.#chosen?.index));
  }

  /** Lists the transitions of a state. */
  #describe(run: Run, node: Node | undefined, isBroken: boolean): void {
    if (node === undefined) {
      this.#list.replaceChildren();
      return;
    }
    const title = element("h3", "", node.shortName);
    const tools = element("div", "tools");
    if (node.children.length > 0) {
      tools.append(button("open", () => this.#open(node), `show the states in ${node.name} (key Enter)`));
    }
    if (run.hello.capabilities.breakpoints) {
      const toggle = button("break", () => this.#actions.toggleBreakpoint(node.name), `pause when ${node.name} is entered (key B)`);
      toggle.setAttribute("aria-pressed", String(isBroken));
      tools.append(toggle);
    }
    const items = node.transitions.map((transition) => {
      const target = run.chart.target(transition);
      // The guards of a compiled machine have no text.
      return element("li", "", element("code", "", transition.text), ` → ${typeof target === "string" ? target : target.fullName}`);
    });
    this.#list.replaceChildren(element("div", "head", title, tools), node.behaviour === undefined ? "" : element("p", "hint", element("code", "", `is ${node.behaviour}`)), element("ul", "", ...items));
  }

  #choose(node: Node): void {
    this.#chosen = node;
    this.#actions.refresh();
  }

  /** Shows the inner states of a state. */
  #open(node: Node): void {
    if (node.children.length > 0) {
      this.#enter(node);
    }
  }

  #enter(level: Node | undefined, chosen?: Node): void {
    if (level !== undefined) {
      [this.#level, this.#chosen] = [level, chosen];
      this.#setFollowing(false);
    }
  }

  #setFollowing(isFollowing: boolean): void {
    this.#isFollowing = isFollowing;
    this.#follow.setAttribute("aria-pressed", String(isFollowing));
    this.#actions.refresh();
  }
}
