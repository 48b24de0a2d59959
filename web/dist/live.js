"use strict";
(() => {
  // src/shared/element.ts
  function element(name, className = "", ...children) {
    const element2 = document.createElement(name);
    if (className !== "") {
      element2.className = className;
    }
    element2.append(...children);
    return element2;
  }

  // src/shared/button.ts
  function button(label2, action, description) {
    const button2 = document.createElement("button");
    button2.type = "button";
    button2.textContent = label2;
    if (description !== void 0) {
      button2.title = description;
      button2.setAttribute("aria-label", description.startsWith(label2) || !/[\p{L}\p{N}]/u.test(label2) ? description : `${label2}: ${description}`);
    }
    button2.addEventListener("click", () => action(button2));
    return button2;
  }

  // src/live/breakpoints.ts
  var BreakpointList = class {
    element;
    #list = element("ul", "breakpoints");
    #actions;
    #field = element("input");
    #fault = element("p", "hint");
    #isAsked = false;
    #drawn = "";
    constructor(run, actions) {
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
        const text2 = field.value.trim();
        this.#fault.textContent = "";
        if (text2 !== "") {
          this.#isAsked = true;
          actions.send({ type: "break", add: text2, remove: null });
        }
      });
      const isPossible = run.hello.capabilities.breakpoints;
      this.element = element("section", "", element("h2", "", "Breakpoints"), ...isPossible ? [this.#list, form, this.#fault] : [element("p", "hint", "This run has no breakpoints.")]);
    }
    /** Shows a fault beside the field. False if it is not of a breakpoint that was asked for here. */
    fault({ message, id }) {
      const isOfField = this.#isAsked && id === null;
      if (isOfField) {
        [this.#isAsked, this.#fault.textContent] = [false, message];
      }
      return isOfField;
    }
    update({ run }) {
      const breakpoints = run.breakpoints;
      const hit = run.status?.state === "paused" ? run.status.breakpoint : null;
      const key = JSON.stringify([breakpoints, hit]);
      if (key === this.#drawn) {
        return;
      }
      this.#drawn = key;
      this.#isAsked = false;
      if (breakpoints.some(({ text: text2 }) => text2 === this.#field.value.trim())) {
        this.#field.value = "";
      }
      const items = breakpoints.map(({ text: text2, state }) => {
        const item = element("li", text2 === hit ? "hit" : "", element("code", "", text2), state === null ? "" : " (state)");
        item.append(" ", button("remove", () => this.#actions.send({ type: "break", add: null, remove: text2 }), `remove the breakpoint ${text2}`));
        return item;
      });
      this.#list.replaceChildren(...items.length > 0 ? items : [element("li", "hint", "None.")]);
    }
  };

  // src/shared/svg.ts
  var SVG = "http://www.w3.org/2000/svg";
  function svg(name, attributes = {}, ...children) {
    const element2 = document.createElementNS(SVG, name);
    set(element2, attributes);
    element2.append(...children);
    return element2;
  }
  function set(element2, attributes) {
    for (const [name, value] of Object.entries(attributes)) {
      const text2 = String(value);
      if (element2.getAttribute(name) !== text2) {
        element2.setAttribute(name, text2);
      }
    }
  }

  // src/shared/width.ts
  var Width = class {
    #value = 0;
    /** `changed` is called after every change. */
    constructor(element2, changed) {
      new ResizeObserver((entries) => {
        this.#value = entries.at(-1)?.contentRect.width ?? 0;
        changed();
      }).observe(element2);
    }
    get value() {
      return this.#value;
    }
  };

  // src/live/statechart.ts
  var ENDED = -1;
  var Node = class {
    index;
    name;
    /** Its name without that of an outer state, which precedes it in the content of a behaviour. */
    shortName;
    /** The state and its outer states, the outermost one first. The machine is not among them. */
    path;
    /** The names of its path. */
    fullName;
    behaviour;
    parent;
    isInitial;
    children = [];
    /** The transitions that belong to it, not those of its inner states. */
    transitions = [];
    constructor(index, name, behaviour, parent, isInitial) {
      [this.index, this.name, this.behaviour, this.parent, this.isInitial] = [index, name, behaviour, parent, isInitial];
      parent?.children.push(this);
      this.path = parent === void 0 ? [] : [...parent.path, this];
      const outer = parent?.path.find((node) => name.startsWith(`${node.name}.`));
      this.shortName = outer === void 0 ? name : name.slice(outer.name.length + 1);
      this.fullName = this.path.map(({ shortName }) => shortName).join(" / ");
    }
    /** This state and all inner states, outer ones first. */
    all() {
      return [this, ...this.children.flatMap((child) => child.all())];
    }
  };
  var Chart = class {
    root;
    nodes;
    constructor(hello) {
      this.root = new Node(ENDED, hello.policy, void 0, void 0, true);
      const nodes = [];
      hello.chart.states.forEach((state, index) => {
        const parent = (state.parent === null ? void 0 : nodes[state.parent]) ?? this.root;
        nodes.push(new Node(index, state.name, state.behaviour ?? void 0, parent, state.initial));
      });
      for (const transition of hello.chart.transitions) {
        this.#owner(transition, nodes).transitions.push(transition);
      }
      this.nodes = nodes;
    }
    #owner({ state }, nodes) {
      return (state === null ? void 0 : nodes[state]) ?? this.root;
    }
    /** The name of a state with those of its outer states. */
    name(state) {
      return this.nodes[state]?.fullName ?? "ended";
    }
    target({ target, end }) {
      return (target === null ? void 0 : this.nodes[target]) ?? (end === "success" ? "Success" : "Failure");
    }
    /**
     * The arrows between the inner states of a state, and from them to targets outside. A transition from the inside of one of them is one
     * of that state, unless it stays inside.
     */
    arrows(level) {
      const arrows = /* @__PURE__ */ new Map();
      for (const from of level.children) {
        for (const source of from.all()) {
          for (const transition of source.transitions) {
            const target = this.target(transition);
            const to = typeof target === "string" ? target : level.children.find((child) => target.path.includes(child)) ?? target;
            if (to === from && source !== from) {
              continue;
            }
            const key = `${from.index} ${typeof to === "string" ? to : to.index}`;
            const arrow = arrows.get(key) ?? { from, to, transitions: [] };
            arrow.transitions.push(transition);
            arrows.set(key, arrow);
          }
        }
      }
      return [...arrows.values()];
    }
  };

  // src/live/layout.ts
  var HEIGHT = 30;
  var GAP = 16;
  var ROW = 66;
  var MARGIN = 14;
  var LETTER = 7.3;
  function layOut(level, arrows, width) {
    const ranks = ranked(level, arrows);
    const outside = [...new Set(arrows.map((arrow) => arrow.to))].filter((to) => !isChild(to, level));
    const places = /* @__PURE__ */ new Map();
    let y = MARGIN;
    for (const rank of [...ranks, outside]) {
      const ordered = byNeighbours(rank, arrows, places);
      for (const row of wrapped(ordered, width - 2 * MARGIN)) {
        const total = row.reduce((sum, item) => sum + boxWidth(item) + GAP, -GAP);
        let x = Math.max(MARGIN, (width - total) / 2);
        for (const item of row) {
          places.set(item, { item, isOutside: !isChild(item, level), x, y, width: boxWidth(item), height: HEIGHT });
          x += boxWidth(item) + GAP;
        }
        y += ROW;
      }
    }
    const boxes = [...places.values()];
    return { boxes, curves: curves(arrows, places), width, height: y - ROW + HEIGHT + MARGIN };
  }
  function label(item) {
    return typeof item === "string" ? item : item.children.length > 0 ? `${item.shortName} ▸` : item.shortName;
  }
  function boxWidth(item) {
    return label(item).length * LETTER + 20;
  }
  function isChild(item, level) {
    return item instanceof Node && item.parent === level;
  }
  function ranked(level, arrows) {
    const rest = new Set(level.children);
    const first = level.children.find((child) => child.isInitial) ?? level.children[0];
    const ranks = [];
    let rank = first === void 0 ? [] : [first];
    while (rest.size > 0) {
      if (rank.length === 0) {
        rank = [...rest];
      }
      rank.forEach((node) => rest.delete(node));
      ranks.push(rank);
      const next2 = new Set(arrows.filter((arrow) => rank.includes(arrow.from)).map((arrow) => arrow.to));
      rank = [...rest].filter((node) => next2.has(node));
    }
    return ranks;
  }
  function byNeighbours(items, arrows, places) {
    const mean = (item, index) => {
      const centres = arrows.filter((arrow) => arrow.to === item).flatMap(({ from }) => places.get(from) ?? []).map((box) => box.x + box.width / 2);
      return centres.length === 0 ? index : centres.reduce((sum, x) => sum + x, 0) / centres.length;
    };
    const keys = new Map(items.map((item, index) => [item, mean(item, index)]));
    return [...items].sort((a, b) => (keys.get(a) ?? 0) - (keys.get(b) ?? 0));
  }
  function wrapped(items, width) {
    const rows = [];
    let used = Infinity;
    for (const item of items) {
      if (used + boxWidth(item) > width) {
        rows.push([]);
        used = 0;
      }
      rows.at(-1)?.push(item);
      used += boxWidth(item) + GAP;
    }
    return rows;
  }
  function curves(arrows, places) {
    return arrows.flatMap((arrow) => {
      const [from, to] = [places.get(arrow.from), places.get(arrow.to)];
      return from && to ? [{ arrow, path: curve(from, to) }] : [];
    });
  }
  function curve(from, to) {
    const centre = (box) => box.x + box.width / 2;
    if (from === to) {
      const [x, y] = [from.x + from.width, from.y + from.height / 2];
      return `M${x} ${y - 7}c18 -8 18 22 2 14`;
    }
    const shift = Math.sign(centre(to) - centre(from)) * Math.min(24, from.width / 4);
    if (from.y === to.y) {
      const [x12, x22, y] = [centre(from) + shift, centre(to) - shift, from.y];
      const rise = Math.min(28, 12 + Math.abs(x22 - x12) / 12);
      return `M${x12} ${y}C${x12} ${y - rise} ${x22} ${y - rise} ${x22} ${y - 1}`;
    }
    const isDown = to.y > from.y;
    const [x1, x2] = [centre(from) + (isDown ? shift - 5 : shift + 7), centre(to) + (isDown ? -5 : 7)];
    const [y1, y2] = isDown ? [from.y + from.height, to.y - 1] : [from.y, to.y + to.height + 1];
    const bend = (isDown ? 1 : -1) * Math.min(70, Math.abs(y2 - y1) / 2);
    return `M${x1} ${y1}C${x1} ${y1 + bend} ${x2} ${y2 - bend} ${x2} ${y2}`;
  }

  // src/live/chart-panel.ts
  var ChartPanel = class {
    element;
    #actions;
    #path = element("nav", "path");
    #drawing = element("div", "chart");
    #svg = svg("svg", { role: "group" });
    #list = element("div", "transitions");
    #follow;
    #width;
    #boxes = /* @__PURE__ */ new Map();
    #arrows = [];
    #level;
    #chosen;
    #isFollowing = true;
    #drawn = "";
    #marked = "";
    constructor(run, actions) {
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
    up() {
      this.#enter(this.#level.parent);
    }
    update(view) {
      const { run, frame } = view;
      const active = frame?.states.map((index) => run.chart.nodes[index]).filter((node) => node !== void 0) ?? [];
      if (this.#isFollowing) {
        const level = active.at(-1)?.parent ?? run.chart.root;
        if (level !== this.#level) {
          [this.#level, this.#chosen] = [level, void 0];
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
    #draw(run, width) {
      const arrows = run.chart.arrows(this.#level);
      const layout = layOut(this.#level, arrows, width);
      const focused = [this.#svg, this.#path].find((part) => part.contains(document.activeElement));
      set(this.#svg, { viewBox: `0 0 ${layout.width} ${layout.height}`, width: layout.width, height: layout.height, "aria-label": `states in ${this.#level.name}` });
      this.#boxes.clear();
      this.#arrows.length = 0;
      const head = svg("marker", { id: "head", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto-start-reverse" }, svg("path", { d: "M0 0.5L8 4L0 7.5z" }));
      this.#svg.replaceChildren(svg("defs", {}, head));
      for (const { arrow, path } of layout.curves) {
        const curve2 = svg("path", { class: "arrow", d: path, "marker-end": "url(#head)" }, svg("title", {}, arrow.transitions.map(({ text: text2 }) => text2).join("\n")));
        this.#arrows.push({ arrow, path: curve2 });
        this.#svg.append(curve2);
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
        })
      );
      if (this.#level.behaviour !== void 0) {
        this.#path.append(element("code", "", ` is ${this.#level.behaviour}`));
      }
      if (focused === this.#svg) {
        const first = this.#boxes.values().next().value;
        (this.#chosen === void 0 ? first : this.#boxes.get(this.#chosen))?.focus();
      } else if (focused === this.#path) {
        this.#path.querySelector("[aria-current]")?.focus();
      }
      this.#marked = "";
    }
    #box(run, { item, isOutside, x, y, width, height }) {
      const node = item instanceof Node ? item : void 0;
      const fill = isOutside || node === void 0 ? "none" : run.shades.of(node.index);
      const group = svg("g", { class: isOutside ? "box outside" : "box", transform: `translate(${x} ${y})` }, svg("rect", { width, height, rx: 6, fill }), svg("text", { x: width / 2, y: height / 2 + 4.5, "text-anchor": "middle" }, label(item)));
      if (node === void 0) {
        group.append(svg("title", {}, `end of the run: ${String(item)}`));
        return group;
      }
      set(group, { tabindex: 0, role: "button" });
      if (isOutside) {
        set(group, { "aria-label": `${node.fullName}, outside of ${this.#level.name}; go there` });
        group.append(svg("title", {}, `go to ${node.fullName}`));
        const go = () => this.#enter(node.parent, node);
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
    #mark({ run, frame, answer }, active) {
      const breaks = run.breakpoints;
      const others = (frame === void 0 ? void 0 : answer?.at(frame.tick))?.states ?? [];
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
    #describe(run, node, isBroken) {
      if (node === void 0) {
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
        return element("li", "", element("code", "", transition.text), ` → ${typeof target === "string" ? target : target.fullName}`);
      });
      this.#list.replaceChildren(element("div", "head", title, tools), node.behaviour === void 0 ? "" : element("p", "hint", element("code", "", `is ${node.behaviour}`)), element("ul", "", ...items));
    }
    #choose(node) {
      this.#chosen = node;
      this.#actions.refresh();
    }
    /** Shows the inner states of a state. */
    #open(node) {
      if (node.children.length > 0) {
        this.#enter(node);
      }
    }
    #enter(level, chosen) {
      if (level !== void 0) {
        [this.#level, this.#chosen] = [level, chosen];
        this.#setFollowing(false);
      }
    }
    #setFollowing(isFollowing) {
      this.#isFollowing = isFollowing;
      this.#follow.setAttribute("aria-pressed", String(isFollowing));
      this.#actions.refresh();
    }
  };

  // src/live/connection.ts
  var PAUSE = 1e3;
  var Connection = class {
    #receive;
    #change;
    #socket;
    constructor(receive, change) {
      [this.#receive, this.#change] = [receive, change];
      this.#open();
    }
    send(message) {
      if (this.#socket?.readyState === WebSocket.OPEN) {
        this.#socket.send(JSON.stringify(message));
      }
    }
    #open() {
      const socket = new WebSocket(`ws${location.protocol.slice(4)}//${location.host}/live${location.search}`, "vibrissa.live.v1");
      socket.addEventListener("message", (event) => this.#receive(JSON.parse(String(event.data))));
      socket.addEventListener("open", () => this.#change(true));
      socket.addEventListener("close", () => {
        this.#change(false);
        setTimeout(() => this.#open(), PAUSE);
      });
      this.#socket = socket;
    }
  };

  // src/live/quantity.ts
  var DEGREE = Math.PI / 180;
  var ANGLES = {
    rad: [{ factor: DEGREE, unit: "deg" }, { factor: 1e-3, unit: "mrad" }, { factor: 1e-6, unit: "urad" }],
    "rad/s": [{ factor: DEGREE, unit: "deg/s" }]
  };
  var PREFIXED = /^(?!kg)[A-Za-z]+(?!\^)\b/;
  function scaleOf(value, unit) {
    const prefixed = () => ["", "m", "u"].map((prefix, index) => ({ factor: 1e-3 ** index, unit: `${prefix}${unit}` }));
    const scales = ANGLES[unit] ?? (PREFIXED.test(unit) ? prefixed() : []);
    const smallest = scales.at(-1) ?? { factor: 1, unit };
    return value === 0 ? { factor: 1, unit } : scales.find(({ factor }) => Math.abs(value) >= factor * 0.9995) ?? smallest;
  }
  var ROUNDING = 8 * Number.EPSILON;
  function quantity(value, unit) {
    const shown = unit !== "" && Math.abs(value) < ROUNDING ? 0 : value;
    const scale = scaleOf(shown, unit);
    return `${digits(shown / scale.factor)} ${scale.unit}`.trim();
  }
  function digits(value) {
    const size = Math.abs(value);
    if (size >= 1e5 || size > 0 && size < 1e-4) {
      return value.toExponential(2);
    }
    return String(Number(value.toPrecision(size >= 100 ? 4 : 3)));
  }

  // src/live/controls.ts
  var DURATIONS = [[5, "5 s"], [20, "20 s"], [60, "1 min"], [Infinity, "whole run"]];
  var KEYS = "P pause or run · S step · L newest tick · , and . one tick · [ and ] one state · U outer state";
  var Controls = class {
    element;
    #actions;
    #up;
    #title;
    #status = element("p", "status");
    #fault = element("p", "fault");
    #pause;
    #step;
    #steps;
    #newest;
    #slider = element("input", "slider");
    #time = element("output", "time");
    #gaps = element("p", "hint");
    #view;
    /** `up` goes to the outer state in the chart. `heading` is the element of the title. */
    constructor(actions, up, heading) {
      [this.#actions, this.#up] = [actions, up];
      this.#title = element(heading, "", "vibrissa");
      this.#pause = button("pause", () => this.#toggle(), "pause or continue the run (key P)");
      this.#step = button("step", () => this.#advance(1), "execute one tick (key S)");
      this.#steps = button("30 ticks", () => this.#advance(30), "execute 30 ticks (key Shift S)");
      this.#newest = button("newest", () => actions.select(void 0), "show the newest tick (key L)");
      this.#slider.type = "range";
      this.#slider.min = "0";
      this.#slider.max = "0";
      this.#slider.setAttribute("aria-label", "shown tick");
      this.#slider.addEventListener("input", () => actions.select(Number(this.#slider.value)));
      const duration = element("select");
      duration.setAttribute("aria-label", "duration of the plots");
      duration.append(...DURATIONS.map(([value, text2]) => new Option(text2, String(value))));
      duration.value = "20";
      duration.addEventListener("change", () => actions.zoomTime(Number(duration.value)));
      this.#status.setAttribute("role", "status");
      this.#fault.setAttribute("role", "alert");
      const back = button("◂", () => this.#move(-1), "one tick back (key ,)");
      const on = button("▸", () => this.#move(1), "one tick on (key .)");
      const before = button("◂◂", () => this.#change(-1), "to the change of state before (key [)");
      const after = button("▸▸", () => this.#change(1), "to the next change of state (key ])");
      const tools = element("div", "tools", this.#pause, this.#step, this.#steps, before, back, on, after, this.#newest, duration);
      this.element = element("header", "controls", element("div", "title", this.#title, this.#status), tools, element("div", "history", this.#slider, this.#time), this.#gaps, this.#fault, element("p", "hint keys", KEYS));
      addEventListener("keydown", (event) => this.#key(event));
    }
    /** Shows a message about a request, or about the connection. */
    report(message) {
      this.#fault.textContent = message;
    }
    update(view) {
      this.#view = view;
      const { run, frame, isFollowing } = view;
      const { hello, status } = run;
      const title = [hello.scenario, hello.policy, hello.world ?? hello.command].filter((text3) => text3 !== "").join(" · ");
      if (this.#title.textContent !== title) {
        this.#title.textContent = title;
        document.title = `${title} – vibrissa`;
      }
      const text2 = status === void 0 ? "waiting" : statusText(status, run.past);
      if (this.#status.textContent !== text2) {
        this.#status.textContent = text2;
        this.#status.dataset["state"] = status?.state ?? "";
      }
      const canStep = hello.capabilities.step && status?.state !== "finished";
      this.#pause.disabled = !canStep;
      this.#pause.textContent = status?.state === "paused" ? "run" : "pause";
      this.#step.disabled = this.#steps.disabled = !canStep || status?.state !== "paused";
      this.#newest.setAttribute("aria-pressed", String(isFollowing));
      this.#slider.max = String(run.history.last?.tick ?? 0);
      this.#slider.value = String(frame?.tick ?? 0);
      const place = frame === void 0 ? "" : `${frame.time.toFixed(2)} s, tick ${frame.tick}`;
      this.#time.textContent = place;
      this.#slider.setAttribute("aria-valuetext", place);
      const kept = status === void 0 || status.kept_every <= 1 ? "" : `Of the older ticks, the program keeps one in ${status.kept_every}.`;
      const lost = run.lost === 0 ? "" : `This page was too slow for ${run.lost} ticks, and asked for them later.`;
      this.#gaps.textContent = `${kept} ${lost}`.trim();
    }
    #toggle() {
      const status = this.#view?.run.status;
      if (this.#view?.run.hello.capabilities.step && status?.state !== "finished") {
        this.#actions.send({ type: status?.state === "paused" ? "run" : "pause" });
      }
    }
    #advance(ticks) {
      if (this.#view?.run.hello.capabilities.step && this.#view.run.status?.state === "paused") {
        this.#actions.select(void 0);
        this.#actions.send({ type: "step", ticks });
      }
    }
    /** Shows a tick before or after the shown one. */
    #move(count) {
      const { run, frame } = this.#view ?? {};
      if (run && frame) {
        const next2 = run.history.frames[Math.max(0, run.history.indexAt(frame.tick) + count)];
        this.#actions.select((next2 ?? frame).tick);
      }
    }
    /** Shows the next tick with another state, or the one before. */
    #change(direction) {
      const { run, frame } = this.#view ?? {};
      if (run && frame) {
        const starts = run.history.spans.map(({ from }) => from);
        const next2 = direction === 1 ? starts.find((time) => time > frame.time) : starts.findLast((time) => time < frame.time);
        if (next2 !== void 0) {
          this.#actions.seek(next2);
        }
      }
    }
    #key(event) {
      const target = event.target;
      if (event.ctrlKey || event.altKey || event.metaKey || target?.matches("input:not([type=range], [type=radio]), select, [contenteditable=true]")) {
        return;
      }
      const actions = {
        p: () => this.#toggle(),
        s: () => this.#advance(1),
        S: () => this.#advance(30),
        u: this.#up,
        l: () => this.#actions.select(void 0),
        ",": () => this.#move(-1),
        ".": () => this.#move(1),
        "[": () => this.#change(-1),
        "]": () => this.#change(1)
      };
      const action = actions[event.key];
      if (action) {
        action();
        event.preventDefault();
      }
    }
  };
  function statusText({ state, reason, breakpoint, verdict, metrics }, { count, missing }) {
    if (state === "finished" && missing > 0) {
      return `loading the past: ${count - missing} of ${count} ticks`;
    }
    switch (state) {
      case "running":
        return "running";
      case "paused":
        return breakpoint === null ? reason === "start" ? "paused at the start" : "paused" : `paused at ${breakpoint}`;
      case "finished": {
        const error = metrics?.error ?? null;
        const coverage = metrics?.coverage ?? null;
        const figures = [error === null ? null : `error ${quantity(error, "m")}`, coverage === null ? null : `coverage ${digits(coverage * 100)} %`];
        return `finished: ${[verdict, reason, ...figures].filter((text2) => text2 !== null).join(", ") || "ended"}`;
      }
    }
  }

  // src/live/history.ts
  var LIMIT = 4e4;
  var History = class {
    #frames = [];
    #spans;
    get frames() {
      return this.#frames;
    }
    get last() {
      return this.#frames.at(-1);
    }
    /** Adds ticks in the order of their numbers. One that is known already is replaced. */
    add(frames) {
      const last = this.#frames.at(-1);
      if (last === void 0 || frames[0] !== void 0 && frames[0].tick > last.tick) {
        this.#frames.push(...frames);
        frames.forEach((frame) => this.#extend(frame));
      } else {
        const all = new Map([...this.#frames, ...frames].map((frame) => [frame.tick, frame]));
        this.#frames = [...all.values()].sort((a, b) => a.tick - b.tick);
        this.#spans = void 0;
      }
      if (this.#frames.length > LIMIT) {
        this.#thin();
      }
    }
    /** Removes every second one of the older ticks. The next one gets their recorded tips, the cells of their maps, and the plots that it has not set. */
    #thin() {
      const isRemoved = (index) => index < this.#frames.length / 2 && index % 2 === 1;
      this.#frames = this.#frames.flatMap((frame, index, frames) => {
        const before = isRemoved(index - 1) ? frames[index - 1] : void 0;
        if (isRemoved(index)) {
          return [];
        }
        return [before === void 0 ? frame : {
          ...frame,
          contour: [...before.contour, ...frame.contour],
          plots: frame.plots.map((value, plot) => value ?? before.plots[plot] ?? null),
          map: joined(before.map, frame.map)
        }];
      });
      this.#spans = void 0;
    }
    /** The index of the last tick up to this number, or -1. */
    indexAt(tick) {
      return lastIndex(this.#frames, (frame) => frame.tick <= tick);
    }
    /** The index of the last tick up to this time (s), or -1. */
    indexAtTime(time) {
      return lastIndex(this.#frames, (frame) => frame.time <= time);
    }
    /** The last tick up to this number. Before the first tick, the first one. */
    at(tick) {
      return this.#frames[Math.max(0, this.indexAt(tick))];
    }
    /** The tick that is nearest to a time (s). */
    nearest(time) {
      const index = this.indexAtTime(time);
      const [before, after] = [this.#frames[Math.max(0, index)], this.#frames[index + 1]];
      return before && after && after.time - time < time - before.time ? after : before;
    }
    /** The active states over time. */
    get spans() {
      if (this.#spans === void 0) {
        this.#spans = [];
        this.#frames.forEach((frame) => this.#extend(frame));
      }
      return this.#spans;
    }
    #extend(frame) {
      if (this.#spans !== void 0) {
        extend(this.#spans, frame);
      }
    }
  };
  function joined(before, now) {
    return before && now ? { ...now, free: [...before.free, ...now.free], blocked: [...before.blocked, ...now.blocked] } : now ?? before;
  }
  function extend(spans, { states, time }) {
    const state = states.at(-1) ?? ENDED;
    const last = spans.at(-1);
    if (last !== void 0) {
      last.to = time;
    }
    if (last?.state !== state) {
      spans.push({ state, from: time, to: time });
    }
  }
  function lastIndex(items, holds) {
    let [low, high] = [0, items.length];
    while (low < high) {
      const middle = low + high >> 1;
      const item = items[middle];
      if (item !== void 0 && holds(item)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low - 1;
  }

  // src/live/answer.ts
  var Answer = class {
    id;
    kind;
    /** The first tick with the change, and its time (s). */
    tick;
    time;
    set;
    frames = [];
    spans = [];
    difference;
    /** Why it ended. */
    end;
    fault;
    constructor(id, kind, tick, time, set2) {
      [this.id, this.kind, this.tick, this.time, this.set] = [id, kind, tick, time, set2];
    }
    get isDone() {
      return this.end !== void 0 || this.fault !== void 0;
    }
    add(piece) {
      for (const frame of piece.frames) {
        this.frames.push(frame);
        extend(this.spans, frame);
      }
      this.difference = piece.first_difference ?? this.difference;
      if (piece.done) {
        this.end = piece.end ?? "done";
      }
    }
    /** The last tick up to this number. */
    at(tick) {
      return this.frames[lastIndex(this.frames, (frame) => frame.tick <= tick)];
    }
  };

  // src/live/time-axis.ts
  var TimeAxis = class {
    from;
    to;
    left;
    right;
    constructor(from, to, left, right) {
      [this.from, this.to, this.left, this.right] = [from, Math.max(to, from + 1e-3), left, right];
    }
    x(time) {
      return this.left + (time - this.from) / (this.to - this.from) * (this.right - this.left);
    }
    time(x) {
      return this.from + (x - this.left) / (this.right - this.left) * (this.to - this.from);
    }
  };
  function roundStep(least) {
    const power = 10 ** Math.floor(Math.log10(least));
    return power * ([1, 2, 5, 10].find((factor) => factor * power >= least * 0.999) ?? 10);
  }
  function ticksOf(low, high, count) {
    const raw = (high - low) / count;
    if (!(raw > 0) || !Number.isFinite(raw)) {
      return [];
    }
    const step = roundStep(raw);
    const first = Math.ceil(low / step - 1e-9);
    const last = Math.floor(high / step + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step);
  }

  // src/live/parameter-field.ts
  var STEPS = 200;
  var ParameterField = class {
    info;
    row;
    #number = element("input");
    #slider = element("input");
    #choice = element("select");
    #factor;
    #change;
    /** The value (SI), if it is another one than that of the run. */
    changed;
    constructor(info, change) {
      [this.info, this.#change] = [info, change];
      const scale = scaleOf(info.value, info.unit);
      this.#factor = scale.factor;
      const label2 = `${info.name}${info.meaning === "" ? "" : `, ${info.meaning}`}`;
      const name = element("td", "name", element("code", "", info.guard === null ? info.name : info.meaning), element("div", "hint", info.guard === null ? info.meaning : info.name));
      const fields = element("td", "fields");
      if (info.choices.length > 0) {
        this.#choice.append(...info.choices.map((choice, value) => new Option(choice, String(value))));
        this.#choice.setAttribute("aria-label", label2);
        this.#choice.addEventListener("change", () => this.#set(Number(this.#choice.value)));
        fields.append(this.#choice);
      } else {
        this.#number.type = "number";
        this.#number.step = "any";
        this.#number.setAttribute("aria-label", `${label2} (${scale.unit || "number"})`);
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
        this.#slider.setAttribute("aria-label", label2);
        this.#slider.addEventListener("input", () => this.#set(Number(this.#slider.value)));
        fields.append(this.#number, element("span", "unit", scale.unit), this.#slider);
      }
      this.row = element("tr", "", name, fields);
      this.#show(info.value);
    }
    /** Restores the value of the run. */
    reset() {
      this.changed = void 0;
      this.row.classList.remove("changed");
      this.#show(this.info.value);
    }
    /** True if the text occurs in the name or the meaning. */
    matches(text2) {
      return `${this.info.name} ${this.info.meaning}`.toLowerCase().includes(text2.toLowerCase());
    }
    #set(value) {
      this.changed = value === this.info.value ? void 0 : value;
      this.row.classList.toggle("changed", this.changed !== void 0);
      this.#show(value);
      this.#change();
    }
    #show(value) {
      this.#choice.value = String(value);
      this.#slider.value = String(value);
      if (document.activeElement !== this.#number) {
        this.#number.value = digits(value / this.#factor);
      }
    }
  };

  // src/live/strip.ts
  var STRIP = 16;
  var TITLED = 3;
  function drawStrip(group, spans, axis, chart, shades) {
    const bars = [];
    for (const span of visible(spans, axis)) {
      const [left, right] = [axis.x(Math.max(span.from, axis.from)), axis.x(Math.min(span.to, axis.to))];
      const width = Math.max(0.7, right - left);
      const bar = svg("rect", { x: left, y: 0, width, height: STRIP, fill: shades.of(span.state) });
      bars.push(bar);
      if (width >= TITLED) {
        bar.append(svg("title", {}, `${chart.name(span.state)}, ${span.from.toFixed(2)} to ${span.to.toFixed(2)} s`));
      }
      const name = chart.nodes[span.state]?.shortName ?? "ended";
      if (name.length * 6 + 6 < width) {
        bars.push(svg("text", { x: left + 3, y: STRIP - 4.5, class: "state" }, name));
      }
    }
    group.replaceChildren(...bars);
    set(group, { class: "strip" });
  }
  function visible(spans, axis) {
    const kept = [];
    for (const span of spans) {
      if (span.to < axis.from || span.from > axis.to) {
        continue;
      }
      const last = kept.at(-1);
      if (last !== void 0 && axis.x(span.to) - axis.x(last.from) < 1) {
        if (span.to - span.from > last.to - last.from) {
          kept[kept.length - 1] = span;
        }
        continue;
      }
      kept.push(span);
    }
    return kept;
  }

  // src/live/counterfactual.ts
  var PAUSE2 = 80;
  var LEFT = 62;
  var next = 1;
  var Counterfactual = class {
    element;
    #actions;
    #run;
    #fields;
    #start = element("output");
    #result = element("div", "result");
    #summary = element("p", "summary");
    #values = element("p", "hint");
    #goTo;
    #svg = svg("svg", { role: "img", "aria-label": "states of the run, and of the changed policy" });
    #strips = [svg("g"), svg("g")];
    #cursor = svg("line", { class: "cursor", y1: 0, y2: 2 * STRIP + 4 });
    #width;
    #kinds;
    #answer;
    /** The first tick with the change. Undefined until something is changed. */
    #tick;
    #shown = { tick: 0, time: 0 };
    #timer;
    #asked = 0;
    #drawn = "";
    constructor(run, actions) {
      [this.#run, this.#actions] = [run, actions];
      const { capabilities, parameters } = run.hello;
      this.#fields = parameters.map((info) => new ParameterField(info, () => this.#ask()));
      const kind = (value, text2, isPossible2) => {
        const input = element("input");
        [input.type, input.name, input.value, input.disabled] = ["radio", "kind", value, !isPossible2];
        input.addEventListener("change", () => this.#ask());
        return [input, element("label", "", input, ` ${text2}`)];
      };
      const [recorded, recordedLabel] = kind("recorded", "over the recorded samples", capabilities.counterfactual);
      const [closed, closedLabel] = kind("closed_loop", "in simulation, in closed loop", capabilities.closed_loop);
      this.#kinds = { recorded, closed_loop: closed };
      (capabilities.counterfactual ? recorded : closed).checked = true;
      this.#goTo = button("go there", () => this.#answer?.difference && this.#actions.select(this.#answer.difference.tick), "show the first tick that differs");
      const from = button("from the shown tick", () => {
        this.#tick = this.#shown.tick;
        this.#ask();
      }, "begin the change at the shown tick");
      const tools = element("div", "tools", from, button("reset", () => this.#reset(), "restore all values of the run"));
      const heading = element("div", "head", element("h2", "", "Counterfactual"), tools);
      this.#svg.append(...this.#strips, this.#cursor);
      set(this.#strips[1] ?? this.#svg, { transform: `translate(0 ${STRIP + 4})` });
      this.#svg.addEventListener("click", (event) => this.#seek(event));
      this.#result.append(this.#values, this.#svg, this.#summary, this.#goTo);
      this.#result.hidden = true;
      this.#width = new Width(this.#result, () => actions.refresh());
      this.#summary.setAttribute("aria-live", "polite");
      const isPossible = (capabilities.counterfactual || capabilities.closed_loop) && parameters.length > 0;
      this.element = element("section", "counterfactual", ...isPossible ? [heading, element("div", "kinds", recordedLabel, closedLabel, this.#start), this.#result, this.#table()] : [element("h2", "", "Counterfactual"), element("p", "hint", "Nothing can be changed in this run.")]);
    }
    receive(piece) {
      if (piece.id === this.#answer?.id) {
        this.#answer.add(piece);
      }
    }
    /** True if the fault belongs to a question of this panel. */
    fault({ id, message }) {
      if (id === null) {
        return false;
      }
      if (id === this.#answer?.id) {
        this.#answer.fault = message;
      }
      return true;
    }
    update({ run, frame, answer }) {
      if (frame !== void 0) {
        this.#shown = { tick: frame.tick, time: frame.time };
      }
      const tick = this.#tick ?? this.#first();
      this.#start.textContent = `from tick ${tick} (${(run.history.at(tick)?.time ?? 0).toFixed(2)} s)`;
      this.#result.hidden = answer === void 0;
      if (answer !== void 0) {
        this.#show(answer);
      }
    }
    #table() {
      const rows = (isThreshold) => this.#fields.filter(({ info }) => info.guard !== null === isThreshold).map(({ row }) => row);
      const filter = element("input");
      filter.type = "search";
      filter.placeholder = "find a parameter or threshold";
      filter.setAttribute("aria-label", filter.placeholder);
      filter.addEventListener("input", () => {
        for (const field of this.#fields) {
          field.row.hidden = !field.matches(filter.value);
        }
      });
      const tables = [["Parameters", rows(false)], ["Thresholds of guards", rows(true)]];
      const content = tables.filter(([, rows2]) => rows2.length > 0).map(([title, rows2]) => element("div", "table", element("table", "", element("caption", "", title), element("tbody", "", ...rows2))));
      return element("div", "parameters", filter, ...content);
    }
    #reset() {
      this.#fields.forEach((field) => field.reset());
      this.#tick = void 0;
      this.#ask();
    }
    /** The tick at which a change begins by itself: the shown one. At the end of a run a change would have no time, so it begins at the start. */
    #first() {
      const { history, status } = this.#run;
      const isOver = status?.state === "finished" && this.#shown.tick === history.last?.tick;
      return isOver ? history.frames[0]?.tick ?? 0 : this.#shown.tick;
    }
    /** Asks again after a change, with a pause between two questions. */
    #ask() {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#send(), Math.max(0, this.#asked + PAUSE2 - performance.now()));
    }
    #send() {
      this.#asked = performance.now();
      if (this.#answer && !this.#answer.isDone) {
        this.#actions.send({ type: "cancel", id: this.#answer.id });
      }
      const changed = this.#fields.flatMap(({ info, changed: changed2 }) => changed2 === void 0 ? [] : [[info.name, changed2]]);
      if (changed.length === 0) {
        this.#answer = void 0;
      } else {
        const tick = this.#tick ??= this.#first();
        const kind = this.#kinds.closed_loop.checked ? "closed_loop" : "recorded";
        const set2 = Object.fromEntries(changed);
        this.#answer = new Answer(next, kind, tick, this.#run.history.at(tick)?.time ?? 0, set2);
        next += 1;
        this.#actions.send({ type: "counterfactual", id: this.#answer.id, tick, kind, set: set2 });
      }
      this.#actions.compare(this.#answer);
    }
    #show(answer) {
      const { chart, shades, history, hello } = this.#run;
      const width = this.#width.value;
      const end = Math.max(history.last?.time ?? 0, answer.frames.at(-1)?.time ?? 0);
      const axis = new TimeAxis(answer.time, end, LEFT, Math.max(LEFT + 10, width));
      const x = axis.x(Math.max(axis.from, Math.min(axis.to, this.#shown.time)));
      set(this.#cursor, { x1: x, x2: x });
      const key = [width, answer.id, answer.frames.length, answer.isDone, history.frames.length, end].join();
      if (key === this.#drawn) {
        return;
      }
      this.#drawn = key;
      set(this.#svg, { width, height: 2 * STRIP + 4, viewBox: `0 0 ${width} ${2 * STRIP + 4}` });
      [history.spans, answer.spans].forEach((spans, index) => {
        const strip = this.#strips[index];
        if (strip) {
          drawStrip(strip, spans, axis, chart, shades);
          strip.append(svg("text", { class: "tick", x: 0, y: STRIP - 4 }, index === 0 ? "run" : "changed"));
        }
      });
      const unit = (name) => hello.parameters.find((info) => info.name === name)?.unit ?? "";
      const values = Object.entries(answer.set).map(([name, value]) => `${name} = ${quantity(value, unit(name))}`);
      this.#values.textContent = `${answer.kind === "recorded" ? "Recorded samples" : "Closed loop"}, ${values.join(", ")}`;
      const text2 = summary(answer);
      if (this.#summary.textContent !== text2) {
        this.#summary.textContent = text2;
      }
      this.#goTo.hidden = answer.difference === void 0;
    }
    /** Shows the tick under the pointer. */
    #seek(event) {
      const answer = this.#answer;
      if (answer) {
        const end = Math.max(this.#run.history.last?.time ?? 0, answer.frames.at(-1)?.time ?? 0);
        const box = this.#svg.getBoundingClientRect();
        this.#actions.seek(new TimeAxis(answer.time, end, LEFT, box.width).time(event.clientX - box.left));
      }
    }
  };
  function summary({ fault, difference, end, isDone, frames }) {
    if (fault !== void 0) {
      return fault;
    }
    const last = frames.at(-1);
    const progress = isDone ? `End at ${(last?.time ?? 0).toFixed(2)} s: ${end ?? ""}.` : last === void 0 ? "Computing." : `Computed until ${last.time.toFixed(2)} s.`;
    if (difference === void 0) {
      return `${isDone ? "No tick differs." : "No tick differs until now."} ${progress}`;
    }
    const place = `at ${difference.time.toFixed(2)} s (tick ${difference.tick})`;
    const what = difference.states_differ ? `The first difference is ${place}` : `The first difference is ${place}, in the command only`;
    return `${what}. Run: ${difference.before}. Changed: ${difference.after}. ${progress}`;
  }

  // src/live/figures.ts
  var amount = (value, unit) => value === null || value === void 0 ? "–" : quantity(value, unit);
  var isTimed = ({ loop }) => loop !== null;
  var FIGURES = [
    { name: "error", meaning: "mean distance of the recorded tips from the nearest outline", text: ({ metrics }) => amount(metrics.error, "m") },
    { name: "coverage", meaning: "share of the reference that was traced", text: ({ metrics }) => metrics.coverage === null ? "–" : `${digits(metrics.coverage * 100)} %` },
    { name: "standard deviation", meaning: "mean standard deviation of the recorded tips", text: ({ metrics }) => amount(metrics.spread, "m") },
    { name: "period", meaning: "wall time since the tick before. Pauses do not count", text: ({ loop }) => amount(loop?.period, "s"), isKnown: isTimed },
    { name: "used", meaning: "wall time of perception, machine and motion", text: ({ loop }) => amount(loop?.used, "s"), isKnown: isTimed },
    { name: "speed", meaning: "commanded speed", text: ({ command }) => quantity(Math.hypot(command[0], command[1]), "m/s") }
  ];
  var MESSAGES = 6;
  var Figures = class {
    element;
    #values = FIGURES.map(() => element("dd"));
    #rows;
    #overload = element("p", "overload");
    #messages = element("ul", "messages");
    #known = "";
    constructor() {
      const list = element("dl", "figures");
      this.#rows = FIGURES.map(({ name, meaning }, index) => {
        const term = element("dt", "", name);
        term.title = meaning;
        return element("div", "", term, this.#values[index] ?? "");
      });
      list.append(...this.#rows);
      this.element = element("section", "", element("h2", "", "Figures"), list, this.#overload, this.#messages);
    }
    update({ run, frame }) {
      if (frame === void 0) {
        return;
      }
      FIGURES.forEach(({ text: text2, isKnown }, index) => {
        const [value, row] = [this.#values[index], this.#rows[index]];
        if (value && row) {
          value.textContent = text2(frame, run);
          row.hidden = isKnown?.(frame) === false;
        }
      });
      const { frames, last } = run.history;
      const key = `${frame.tick} ${frames.length} ${last?.tick}`;
      if (key === this.#known) {
        return;
      }
      this.#known = key;
      const until = frames.slice(0, run.history.indexAt(frame.tick) + 1);
      const late = until.filter(({ loop }) => loop?.overload === true).length;
      this.#overload.textContent = late === 0 ? "" : `${late} ${late === 1 ? "tick" : "ticks"} took longer than the control period.`;
      const messages = until.flatMap(({ time, messages: messages2 }) => messages2.map((text2) => `${time.toFixed(2)} s: ${text2}`)).slice(-MESSAGES);
      this.#messages.replaceChildren(...messages.map((text2) => element("li", "", text2)));
    }
  };

  // src/live/guards.ts
  var BAR = 90;
  var Guards = class {
    element;
    #rows;
    #all;
    #showsAll = false;
    /** `plot` adds a plot of a guard. */
    constructor(run, actions, plot) {
      const { hello } = run;
      this.#rows = hello.guards.map((info) => rowOf(run, info, actions, plot));
      this.#all = button("all", () => {
        this.#showsAll = !this.#showsAll;
        this.#all.setAttribute("aria-pressed", String(this.#showsAll));
        actions.refresh();
      }, "show the guards of all states");
      this.#all.setAttribute("aria-pressed", "false");
      const head = element("div", "head", element("h2", "", "Guards"), element("div", "tools", this.#all));
      const content = hello.guards.length > 0 ? element("ul", "", ...this.#rows.map(({ row }) => row)) : element("p", "hint", hello.no_guards ?? "The policy has no guards.");
      this.element = element("section", "guards", head, content);
    }
    update({ run, frame }) {
      const tried = new Map(frame?.guards.map((guard) => [guard.guard, guard]));
      const breaks = new Set(run.breakpoints.map(({ text: text2 }) => text2));
      for (const { info, row, distance, bar, breaks: toggle, breakpoint } of this.#rows) {
        const now = tried.get(info.index);
        const isTaken = frame?.taken.includes(info.index) ?? false;
        row.hidden = now === void 0 && !isTaken && !this.#showsAll;
        if (row.hidden) {
          continue;
        }
        distance.textContent = isTaken ? "taken" : now === void 0 ? "not evaluated" : describe(info, now);
        row.classList.toggle("idle", now === void 0 && !isTaken);
        row.classList.toggle("met", now?.met ?? false);
        row.classList.toggle("taken", isTaken);
        set(bar, { width: isTaken ? BAR : now === void 0 ? 0 : BAR * closeness(run, now) });
        toggle?.setAttribute("aria-pressed", String(breaks.has(breakpoint)));
      }
    }
  };
  function rowOf(run, info, actions, plot) {
    const distance = element("span", "distance");
    const bar = svg("rect", { height: 10, width: 0 });
    const picture = svg("svg", { class: "bar", width: BAR, height: 10, "aria-hidden": "true" }, svg("rect", { class: "ground", width: BAR, height: 10 }), bar);
    const tools = element("div", "tools");
    let breaks;
    const state = info.state === null ? void 0 : run.chart.nodes[info.state];
    const breakpoint = state === void 0 ? info.text : `${state.name}: ${info.text}`;
    if (run.hello.capabilities.breakpoints) {
      const description = state === void 0 ? `pause when ${info.text} holds` : `pause when ${info.text} leaves ${state.fullName}`;
      breaks = button("break", () => actions.toggleBreakpoint(breakpoint), description);
      tools.append(breaks);
    }
    if (info.parts.some(({ unit }) => unit !== null)) {
      tools.append(button("plot", () => plot(info), `plot the distance of ${info.text}`));
    }
    const from = state?.fullName ?? "every state";
    const place = `${from} → ${info.target}, ${info.file === null ? "line " : `${info.file}:`}${info.line}`;
    const row = element("li", "", element("code", "", info.text), element("span", "hint", place), picture, distance, tools);
    return { info, row, distance, bar, breaks, breakpoint };
  }
  function describe(info, { met, margins, missing, elapsed, needed }) {
    const lacks = missing.map((part) => {
      const { text: text2, unit } = info.parts[part] ?? { text: "", unit: null };
      const margin = margins[part];
      const amount2 = unit === null || margin === null || margin === void 0 ? "false" : quantity(Math.abs(margin), unit);
      return info.parts.length > 1 ? `${text2}: ${amount2}` : amount2;
    });
    if (lacks.length === 0 && needed !== null && (elapsed ?? 0) < needed) {
      return `${quantity(elapsed ?? 0, "s")} of ${quantity(needed, "s")} elapsed`;
    }
    return met ? "holds" : lacks.join("\n");
  }
  function closeness(run, { guard, met, margins, missing, elapsed, needed }) {
    if (missing.length === 0) {
      return needed !== null && needed > 0 ? Math.min(1, (elapsed ?? 0) / needed) : Number(met);
    }
    const parts = missing.map((part) => {
      const [margin, largest] = [margins[part], run.largest(guard, part)];
      return margin === null || margin === void 0 || largest === 0 ? 0 : 1 - Math.abs(margin) / largest;
    });
    return Math.min(...parts);
  }

  // src/live/plot.ts
  var HEIGHT2 = 118;
  var TOP = 2 * STRIP + 8;
  var BOTTOM = 18;
  var LEFT2 = 62;
  var RIGHT = 14;
  var ROWS = 8;
  var LETTERS = 9;
  var Plot = class {
    element;
    subject;
    #actions;
    #svg = svg("svg", { role: "img" });
    #strip = svg("g");
    #second = svg("g", { transform: `translate(0 ${STRIP + 2})` });
    #content = svg("g");
    #cursor = svg("line", { class: "cursor", y1: 0, y2: TOP + HEIGHT2 });
    #values;
    #width;
    #axis = new TimeAxis(0, 1, 0, 1);
    #drawn = "";
    constructor(subject, actions) {
      [this.subject, this.#actions] = [subject, actions];
      this.#values = subject.series.map(() => element("output"));
      const legend = element("div", "legend");
      subject.series.forEach(({ name }, index) => {
        legend.append(element("span", `key s${index % 8}`, name, " ", this.#values[index] ?? ""));
      });
      if (subject.marked) {
        legend.append(element("span", "key marked", subject.marked.name));
      }
      const heading = element("h3", "", subject.title);
      const head = element("div", "plot-head", heading, legend);
      if (subject.close) {
        head.append(button("×", subject.close, `remove the plot of ${subject.title}`));
      }
      this.#svg.append(this.#strip, this.#second, this.#content, this.#cursor);
      const body = element("div", "", this.#svg);
      this.element = element("section", "plot", head, body);
      this.#width = new Width(body, () => actions.refresh());
      this.#svg.setAttribute("aria-label", `${subject.title} over time`);
      this.#svg.addEventListener("pointerdown", (event) => this.#drag(event));
    }
    update(view) {
      const { last } = view.run.history;
      this.element.hidden = last !== void 0 && this.subject.isKnown?.(last) === false;
      const width = this.#width.value;
      if (width === 0 || this.element.hidden) {
        return;
      }
      this.#axis = new TimeAxis(view.from, view.to, LEFT2, width - RIGHT);
      const { frames } = view.run.history;
      const key = [width, view.from, view.to, frames.length, frames.at(-1)?.tick, view.answer?.id, view.answer?.frames.length].join();
      if (key !== this.#drawn) {
        this.#drawn = key;
        this.#draw(view, width);
      }
      const x = this.#axis.x(view.frame?.time ?? 0);
      set(this.#cursor, { x1: x, x2: x });
      this.subject.series.forEach(({ value }, index) => {
        const shown = view.frame === void 0 ? void 0 : value(view.frame);
        const output = this.#values[index];
        if (output) {
          output.textContent = shown === null || shown === void 0 ? "–" : this.#text(shown);
        }
      });
    }
    #draw({ run, answer }, width) {
      const top = answer === void 0 ? TOP - STRIP - 2 : TOP;
      const height = top + HEIGHT2 + BOTTOM;
      set(this.#svg, { viewBox: `0 0 ${width} ${height}`, width, height });
      set(this.#cursor, { y2: top + HEIGHT2 });
      drawStrip(this.#strip, run.history.spans, this.#axis, run.chart, run.shades);
      drawStrip(this.#second, answer?.spans ?? [], this.#axis, run.chart, run.shades);
      const first = Math.max(0, run.history.indexAtTime(this.#axis.from));
      const frames = run.history.frames.slice(first, run.history.indexAtTime(this.#axis.to) + 2);
      const curves2 = this.subject.series.map(({ value }) => this.#reduced(frames, value));
      const { levels = [], choices = [] } = this.subject;
      const values = [...curves2.flat().filter((point) => point !== null).map(([, y2]) => y2)];
      const [low, high] = choices.length > 0 ? [0, Math.max(1, choices.length - 1)] : extent(values, levels.map(({ value }) => value));
      const y = (value) => top + HEIGHT2 - 3 - (value - low) / (high - low) * (HEIGHT2 - 6);
      const parts = [];
      for (const time of ticksOf(this.#axis.from, this.#axis.to, Math.max(2, (width - LEFT2) / 110))) {
        const x = this.#axis.x(time);
        parts.push(svg("line", { class: "grid", x1: x, x2: x, y1: top, y2: top + HEIGHT2 }), svg("text", { class: "tick", x, y: height - 4, "text-anchor": "middle" }, `${Number(time.toPrecision(6))} s`));
      }
      for (const value of choices.length > 0 ? rowsOf(choices.length) : ticksOf(low, high, 4)) {
        parts.push(svg("line", { class: "grid", x1: LEFT2, x2: width - RIGHT, y1: y(value), y2: y(value) }), svg("text", { class: "tick", x: LEFT2 - 4, y: y(value) + 4, "text-anchor": "end" }, short(this.#text(value))));
      }
      for (const { name, value } of levels) {
        parts.push(svg("line", { class: "level", x1: LEFT2, x2: width - RIGHT, y1: y(value), y2: y(value) }, svg("title", {}, name)));
      }
      curves2.forEach((curve2, index) => parts.push(svg("path", { class: `curve s${index % 8}`, d: pathOf(curve2, y) })));
      const { marked } = this.subject;
      if (marked) {
        const marks = frames.filter(marked.holds).map((frame) => `M${this.#axis.x(frame.time).toFixed(1)} ${top}v7`);
        parts.push(svg("path", { class: "marks", d: marks.join("") }));
      }
      this.#content.replaceChildren(...parts);
    }
    /** The text of a value. */
    #text(value) {
      return this.subject.choices?.[value] ?? quantity(value, this.subject.unit);
    }
    /** The curve of a value with at most two points for each pixel: the least and the greatest value. `null` is a gap. */
    #reduced(frames, value) {
      const points = [];
      let column = NaN;
      let [least, greatest] = [0, 0];
      const finish = () => {
        if (!Number.isNaN(column)) {
          points.push([column, least]);
          if (greatest !== least) {
            points.push([column, greatest]);
          }
        }
      };
      const isDense = frames.length > 2 * (this.#axis.right - this.#axis.left);
      for (const frame of frames) {
        const y = value(frame);
        if (y === null || y === void 0 || !Number.isFinite(y)) {
          if (points.at(-1) !== null || !Number.isNaN(column)) {
            finish();
            points.push(null);
            column = NaN;
          }
          continue;
        }
        const exact = this.#axis.x(frame.time);
        const x = isDense ? Math.round(exact) : exact;
        if (x === column) {
          [least, greatest] = [Math.min(least, y), Math.max(greatest, y)];
        } else {
          finish();
          [column, least, greatest] = [x, y, y];
        }
      }
      finish();
      return points;
    }
    /** Selects the tick under the pointer until it is released. */
    #drag(event) {
      const choose = (moved) => {
        const x = moved.clientX - this.#svg.getBoundingClientRect().left;
        this.#actions.seek(Math.min(this.#axis.to, Math.max(this.#axis.from, this.#axis.time(x))));
      };
      choose(event);
      this.#svg.setPointerCapture(event.pointerId);
      this.#svg.addEventListener("pointermove", choose);
      const end = () => this.#svg.removeEventListener("pointermove", choose);
      this.#svg.addEventListener("pointerup", end, { once: true });
      this.#svg.addEventListener("pointercancel", end, { once: true });
    }
  };
  function rowsOf(count) {
    const step = Math.ceil(count / ROWS);
    return Array.from({ length: Math.ceil(count / step) }, (_, row) => row * step);
  }
  function short(text2) {
    return text2.length > LETTERS ? `${text2.slice(0, LETTERS - 1)}…` : text2;
  }
  function extent(values, levels) {
    let [low, high] = [Infinity, -Infinity];
    const include = (value) => {
      [low, high] = [Math.min(low, value), Math.max(high, value)];
    };
    values.forEach(include);
    const reach = 3 * Math.max(Math.abs(low), Math.abs(high));
    levels.filter((level) => !(Math.abs(level) > reach)).forEach(include);
    if (low < high) {
      return [low, high];
    }
    return low === high && low !== 0 ? [Math.min(0, low), Math.max(0, low)] : [0, 1];
  }
  function pathOf(curve2, y) {
    let isDown = false;
    let path = "";
    for (const point of curve2) {
      if (point === null) {
        isDown = false;
        continue;
      }
      path += `${isDown ? "L" : "M"}${point[0].toFixed(1)} ${y(point[1]).toFixed(1)}`;
      path += isDown ? "" : "h0";
      isDown = true;
    }
    return path;
  }

  // src/live/shade.ts
  var HUES = ["#d9e2ec", "#b8dcf0", "#fde3a7", "#d6c9ec", "#c7e8c9", "#f6cfd8", "#e6d5b8", "#bfe3df", "#fbcfb1", "#dfeba8", "#e8bfe6", "#bdc8f5"];
  var INKS = [0, 11, 22, 33, 5, 16, 27];
  var OTHER = "#f0846a";
  var Shades = class {
    #colours = /* @__PURE__ */ new Map();
    constructor(chart) {
      chart.root.children.forEach((outermost, index) => {
        const hue = HUES[index % HUES.length] ?? OTHER;
        outermost.all().forEach((node, rank) => {
          this.#colours.set(node.index, `color-mix(in srgb, ${hue}, #1f2933 ${INKS[rank % INKS.length] ?? 0}%)`);
        });
      });
    }
    of(state) {
      return this.#colours.get(state) ?? OTHER;
    }
  };

  // src/live/run.ts
  var PORTION = 1500;
  var Run = class {
    hello;
    chart;
    shades;
    history = new History();
    status;
    /** The number of ticks that the page was too slow for. It asks for them later. */
    lost = 0;
    #missing = [];
    #largest = /* @__PURE__ */ new Map();
    #requested;
    /** The number of the tick after the newest one. */
    #next = 0;
    constructor(hello) {
      this.hello = hello;
      this.chart = new Chart(hello);
      this.shades = new Shades(this.chart);
    }
    get breakpoints() {
      return (this.status ?? this.hello).breakpoints;
    }
    /** Adds new ticks and notes those that were left out before them. */
    add(frames) {
      const [first, last] = [frames[0], frames.at(-1)];
      if (first === void 0 || last === void 0) {
        return;
      }
      if (first.tick > this.#next) {
        this.#missing.push([this.#next, first.tick]);
      }
      this.#next = Math.max(this.#next, last.tick + 1);
      this.#add(frames);
    }
    /** Notes that there are ticks until this number, also if the page does not receive them by itself. */
    expect(count) {
      if (count > this.#next) {
        this.#missing.push([this.#next, count]);
        this.#next = count;
      }
    }
    /** Adds requested ticks. */
    fill(frames) {
      this.#requested = void 0;
      this.#add(frames);
    }
    #add(frames) {
      this.history.add(frames);
      for (const { guards } of frames) {
        for (const { guard, margins } of guards) {
          margins.forEach((margin, part) => {
            if (margin !== null) {
              const key = `${guard} ${part}`;
              this.#largest.set(key, Math.max(this.#largest.get(key) ?? 0, Math.abs(margin)));
            }
          });
        }
      }
    }
    /** The number of ticks until now, and how many of them the page does not have and asks for. */
    get past() {
      const open = [...this.#missing, ...this.#requested === void 0 ? [] : [this.#requested]];
      return { count: this.#next, missing: open.reduce((sum, [from, to]) => sum + to - from, 0) };
    }
    /** The largest distance of a part of a guard that was seen. */
    largest(guard, part) {
      return this.#largest.get(`${guard} ${part}`) ?? 0;
    }
    /** The next range of ticks to ask for, newest first. None while an answer is expected. */
    request() {
      const range = this.#requested === void 0 ? this.#missing.pop() : void 0;
      if (range === void 0) {
        return void 0;
      }
      const [from, to] = range;
      const start = Math.max(from, to - PORTION);
      if (start > from) {
        this.#missing.push([from, start]);
      }
      this.#requested = [start, to];
      return this.#requested;
    }
  };

  // src/shared/zoom.ts
  var Zoom = class {
    #drawing;
    #svg;
    #size;
    #scale = 1;
    #left = 0;
    #top = 0;
    constructor(drawing, svg2) {
      this.#drawing = drawing;
      this.#svg = svg2;
      const { width, height } = svg2.viewBox.baseVal;
      this.#size = [width, height];
      drawing.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
      drawing.addEventListener("dblclick", (event) => this.by(2, ...this.position(event)));
      drawing.addEventListener("pointerdown", (event) => this.#drag(event));
    }
    /** The view box of the whole picture. */
    get whole() {
      return `0 0 ${this.#size[0]} ${this.#size[1]}`;
    }
    /** Gives the picture another size (px). */
    resize(width, height) {
      this.#size = [width, height];
      this.#show();
    }
    /** Shows a position (px of the picture) in the middle, enlarged by a factor. */
    look(x, y, scale) {
      this.#scale = scale;
      const [width, height] = this.#visible();
      [this.#left, this.#top] = [x - width / 2, y - height / 2];
      this.#show();
    }
    /** The position (px of the picture) of a pointer. */
    position(event) {
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.#svg.getScreenCTM()?.inverse());
      return [x, y];
    }
    /** Zooms by a factor. The position (px of the picture) stays where it is. */
    by(factor, x = this.#left + 0.5 * this.#visible()[0], y = this.#top + 0.5 * this.#visible()[1]) {
      const scale = Math.min(40, Math.max(1, this.#scale * factor));
      const kept = this.#scale / scale;
      [this.#left, this.#top, this.#scale] = [x - (x - this.#left) * kept, y - (y - this.#top) * kept, scale];
      this.#show();
    }
    reset() {
      [this.#scale, this.#left, this.#top] = [1, 0, 0];
      this.#show();
    }
    /** Acts on a key. True if the key belongs to the zoom. */
    key(event) {
      const step = (x, y) => {
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
        case "+":
        case "=":
          this.by(1.5);
          return true;
        case "-":
          this.by(1 / 1.5);
          return true;
        case "0":
          this.reset();
          return true;
        case "ArrowLeft":
          return step(-1, 0);
        case "ArrowRight":
          return step(1, 0);
        case "ArrowUp":
          return step(0, -1);
        case "ArrowDown":
          return step(0, 1);
        default:
          return false;
      }
    }
    #visible() {
      return [this.#size[0] / this.#scale, this.#size[1] / this.#scale];
    }
    #wheel(event) {
      if (event.ctrlKey || event.metaKey) {
        event.preventDefault();
        this.by(1.002 ** -event.deltaY, ...this.position(event));
      }
    }
    #drag(event) {
      if (this.#scale === 1 || event.button !== 0) {
        return;
      }
      this.#drawing.setPointerCapture(event.pointerId);
      const [startX, startY] = this.position(event);
      const move = (moved) => {
        const [x, y] = this.position(moved);
        this.#left -= x - startX;
        this.#top -= y - startY;
        this.#show();
      };
      this.#drawing.addEventListener("pointermove", move);
      const end = () => this.#drawing.removeEventListener("pointermove", move);
      this.#drawing.addEventListener("pointerup", end, { once: true });
      this.#drawing.addEventListener("pointercancel", end, { once: true });
    }
    #show() {
      const [width, height] = this.#visible();
      this.#left = Math.min(this.#size[0] - width, Math.max(0, this.#left));
      this.#top = Math.min(this.#size[1] - height, Math.max(0, this.#top));
      this.#svg.setAttribute("viewBox", `${this.#left} ${this.#top} ${width} ${height}`);
      this.#drawing.classList.toggle("zoomed", this.#scale > 1);
    }
  };

  // src/live/track.ts
  var PART = 300;
  var WRONG = 1e-3;
  var STEP = 4e-3;
  var OVERLAP = 0.3;
  var TARGET = 6;
  var KINDS = ["blocked", "free", "trace", "contour", "contour wrong"];
  var Track = class {
    group;
    #world;
    #layers = KINDS.map((kind) => svg("g", { class: kind === "free" || kind === "blocked" ? "map" : "" }));
    #route = svg("path", { class: "route" });
    #target = svg("path", { class: "route" });
    #parts = [];
    constructor(world) {
      this.#world = world;
      const route = svg("g", { class: "map" }, this.#route, this.#target);
      this.group = svg("g", {}, ...this.#layers, route);
    }
    /** True if the run has a map by touch. */
    hasMap = false;
    /** Forgets the picture, because its scale has changed. */
    clear() {
      this.#parts = [];
      this.#layers.forEach((layer) => layer.replaceChildren());
    }
    /** Draws the past until a tick. */
    show(frames, tick) {
      const count = Math.ceil(frames.length / PART);
      for (let index = 0; index < Math.max(count, this.#parts.length); index += 1) {
        const ticks = frames.slice(index * PART, (index + 1) * PART + 1);
        const [first, last] = [ticks[0], ticks.at(-1)];
        const key = first === void 0 || last === void 0 ? "" : `${first.tick} ${Math.max(first.tick - 1, Math.min(last.tick, tick))} ${ticks.length}`;
        const part = this.#parts[index] ??= this.#added();
        if (part.key !== key) {
          part.key = key;
          this.#draw(part, ticks.filter((frame) => frame.tick <= tick));
        }
      }
      const map = frames.findLast((frame) => frame.tick <= tick && frame.map !== null)?.map ?? null;
      this.hasMap ||= map !== null;
      this.#wanted(map);
    }
    #draw({ paths }, ticks) {
      const own = ticks.slice(0, PART);
      const tips = own.flatMap(({ contour }) => contour);
      const maps = own.flatMap(({ map }) => map ?? []);
      const points = (isWrong) => tips.filter(({ error }) => (error !== null && error > WRONG) === isWrong).map(({ point }) => point);
      set(paths.trace, { d: this.#world.line(thinned(ticks.map(({ pose }) => pose))) });
      set(paths.contour, { d: this.#world.dots(points(false)) });
      set(paths["contour wrong"], { d: this.#world.dots(points(true)) });
      set(paths.free, { d: maps.map((map) => this.#ground(map, map.free)).join("") });
      set(paths.blocked, { d: maps.map((map) => this.#ground(map, map.blocked)).join("") });
    }
    /** Cells as rectangles. They overlap a little, so that no seams are seen between them. */
    #ground({ cell, origin: [x, y] }, spans) {
      const size = cell * this.#world.scale;
      return spans.map(([row, from, to]) => {
        const [left, top] = this.#world.px([x + from * cell, y + (row + 1) * cell]);
        const width = ((to - from + 1) * size + OVERLAP).toFixed(2);
        return `M${left.toFixed(2)} ${top.toFixed(2)}h${width}v${(size + OVERLAP).toFixed(2)}h-${width}z`;
      }).join("");
    }
    /** The route and the next target of the last map up to a tick. */
    #wanted(map) {
      const { route, target } = map ?? { route: [], target: null };
      set(this.#route, { d: this.#world.line(route) });
      const [x, y] = target === null ? [0, 0] : this.#world.px(target);
      set(this.#target, { d: target === null ? "" : `M${x} ${y - TARGET}l${TARGET} ${TARGET}l${-TARGET} ${TARGET}l${-TARGET} ${-TARGET}z` });
    }
    #added() {
      const paths = Object.fromEntries(KINDS.map((kind) => [kind, svg("path", { class: kind })]));
      this.#layers.forEach((layer, index) => layer.append(paths[KINDS[index] ?? "trace"]));
      return { key: "", paths };
    }
  };
  function thinned(poses) {
    const points = [];
    poses.forEach(([x, y], index) => {
      const last = points.at(-1);
      if (last === void 0 || index === poses.length - 1 || Math.hypot(x - last[0], y - last[1]) > STEP) {
        points.push([x, y]);
      }
    });
    return points;
  }

  // src/live/world.ts
  var World = class {
    #low = [Infinity, Infinity];
    #high = [-Infinity, -Infinity];
    #scale = 1;
    #width = 1;
    #shift = [0, 0];
    /** Includes a position and the space (m) around it. True if the drawn part grows. */
    include([x, y], room) {
      if (x - room / 2 >= this.#low[0] && x + room / 2 <= this.#high[0] && y - room / 2 >= this.#low[1] && y + room / 2 <= this.#high[1]) {
        return false;
      }
      this.#low = [Math.min(this.#low[0], x - room), Math.min(this.#low[1], y - room)];
      this.#high = [Math.max(this.#high[0], x + room), Math.max(this.#high[1], y + room)];
      return true;
    }
    /** Fits the part into a width (px) and a largest height (px). The result is its height. */
    fit(width, tallest) {
      const [across, up] = [this.#high[0] - this.#low[0], this.#high[1] - this.#low[1]];
      const height = Math.min(tallest, Math.max(200, width * up / across));
      this.#scale = Math.min(width / across, height / up);
      this.#width = width;
      this.#shift = [(width - across * this.#scale) / 2, (height + up * this.#scale) / 2];
      return height;
    }
    /** The size (px) of a metre. */
    get scale() {
      return this.#scale;
    }
    /** The factor that enlarges a length (m) to the whole width. */
    enlargement(length) {
      return Math.max(1, this.#width / (length * this.#scale));
    }
    /** The position (px) of a point. */
    px([x, y]) {
      return [this.#shift[0] + (x - this.#low[0]) * this.#scale, this.#shift[1] - (y - this.#low[1]) * this.#scale];
    }
    /** The point at a position (px). */
    point([x, y]) {
      return [this.#low[0] + (x - this.#shift[0]) / this.#scale, this.#low[1] + (this.#shift[1] - y) / this.#scale];
    }
    /** The path of a line through points. */
    line(points, isClosed = false) {
      return points.map((point, index) => `${index === 0 ? "M" : "L"}${text(this.px(point))}`).join("") + (isClosed ? "Z" : "");
    }
    /** The path of dots. */
    dots(points) {
      return points.map((point) => `M${text(this.px(point))}h0`).join("");
    }
  };
  function placed([x, y, heading], [ahead, left]) {
    const [sin, cos] = [Math.sin(heading), Math.cos(heading)];
    return [x + ahead * cos - left * sin, y + ahead * sin + left * cos];
  }
  function text([x, y]) {
    return `${x.toFixed(2)} ${y.toFixed(2)}`;
  }

  // src/live/scene.ts
  var CLOSE = 0.45;
  var TALLEST = 560;
  var AHEAD = 0.8;
  var Scene = class {
    element;
    #world = new World();
    /** The largest distance (m) of a part of the robot from its centre. */
    #reach;
    #svg = svg("svg", { viewBox: "0 0 100 100", "aria-hidden": "true" });
    #objects = svg("path", { class: "objects" });
    #track;
    #otherTrace = svg("path", { class: "trace other" });
    #otherContour = svg("path", { class: "contour other" });
    #otherPlatform = svg("path", { class: "platform other" });
    #platform = svg("path", { class: "platform" });
    #command = svg("path", { class: "command" });
    #whiskers;
    #tips;
    #zoom;
    #drawing = element("div", "drawing");
    #close;
    #map;
    #legend = element("p", "hint map-key", element("span", "free", "proved free"), element("span", "blocked", "surface"), element("span", "route", "route, ◇ what is next"), "The rest is unknown.");
    #isClose = false;
    #width;
    #drawnWidth = 0;
    #seen = 0;
    constructor(run, actions) {
      const { hello } = run;
      const { platform, whiskers } = hello.rig;
      this.#reach = Math.max(0.05, ...platform.map(([x, y]) => Math.hypot(x, y)), ...whiskers.map(({ base: [x, y], length }) => Math.hypot(x, y) + length));
      this.#track = new Track(this.#world);
      this.#whiskers = hello.whiskers.map((name, index) => svg("path", { class: `whisker s${index % 8}` }, svg("title", {}, name)));
      this.#tips = hello.whiskers.map((_, index) => svg("path", { class: `tip s${index % 8}` }));
      this.#svg.append(
        this.#objects,
        this.#track.group,
        this.#otherTrace,
        this.#otherContour,
        this.#otherPlatform,
        this.#platform,
        this.#command,
        ...this.#whiskers,
        ...this.#tips
      );
      this.#drawing.append(this.#svg);
      this.#zoom = new Zoom(this.#drawing, this.#svg);
      this.#width = new Width(this.#drawing, () => actions.refresh());
      this.#drawing.tabIndex = 0;
      this.#drawing.setAttribute("role", "group");
      this.#drawing.setAttribute("aria-label", "scene from above. Keys: plus and minus zoom, 0 shows everything, arrows move");
      this.#drawing.addEventListener("keydown", (event) => {
        if (!event.ctrlKey && !event.altKey && !event.metaKey && this.#zoom.key(event)) {
          this.#watch(false);
          event.preventDefault();
          event.stopPropagation();
        }
      });
      this.#drawing.addEventListener("pointerdown", () => this.#watch(false));
      this.#close = button("robot", () => this.#watch(!this.#isClose), "show the surroundings of the robot");
      this.#close.setAttribute("aria-pressed", "false");
      this.#map = button("map", () => this.#showMap(!this.#isMapShown), "show what the robot knows by touch: free ground, surfaces, route and next target");
      this.#showMap(true);
      [this.#map.hidden, this.#legend.hidden] = [true, true];
      const free = (action) => () => {
        this.#watch(false);
        action();
      };
      const tools = element("div", "tools");
      tools.append(
        this.#map,
        this.#close,
        button("+", free(() => this.#zoom.by(1.5)), "zoom into the scene"),
        button("−", free(() => this.#zoom.by(1 / 1.5)), "zoom out of the scene"),
        button("whole", free(() => this.#zoom.reset()), "show the whole scene")
      );
      const note = hello.scene === null ? element("p", "hint", "The scene is not known, because no `--scenario` has it. Only what the robot has felt is shown.") : "";
      this.element = element("section", "scene", element("div", "head", element("h2", "", "Scene"), tools), this.#drawing, this.#legend, note);
      for (const outline of hello.scene ?? []) {
        outline.points.forEach((point) => this.#world.include(point, 0.05));
      }
      if (hello.start) {
        this.#world.include([hello.start[0], hello.start[1]], this.#reach);
      }
    }
    update({ run, frame, answer }) {
      const { scene, start } = run.hello;
      if (frame === void 0 && scene === null && start === null) {
        return;
      }
      const hasGrown = this.#include(run, answer);
      const width = this.#width.value;
      if (hasGrown || width !== this.#drawnWidth) {
        this.#drawnWidth = width;
        const height = this.#world.fit(width, TALLEST);
        this.#zoom.resize(width, height);
        set(this.#objects, { d: (scene ?? []).map(({ points, closed }) => this.#world.line(points, closed)).join("") });
        this.#track.clear();
      }
      const pose = frame?.pose ?? start;
      if (pose === null) {
        return;
      }
      set(this.#platform, { d: this.#outline(run.hello.rig.platform, pose) });
      if (this.#isClose) {
        this.#zoom.look(...this.#world.px([pose[0], pose[1]]), this.#world.enlargement(CLOSE));
      }
      if (frame === void 0) {
        this.#undeflected(run, pose);
        return;
      }
      this.#track.show(run.history.frames, frame.tick);
      this.#map.hidden = !this.#track.hasMap;
      this.#legend.hidden = !this.#track.hasMap || !this.#isMapShown;
      this.#robot(frame);
      this.#other(run, frame, answer);
    }
    /** Includes everything that the page has received since the last call. True if the drawn part grows. */
    #include(run, answer) {
      const { frames } = run.history;
      const points = [];
      const fresh = frames.length < this.#seen ? frames : frames.slice(this.#seen);
      this.#seen = frames.length;
      for (const { pose, contour } of fresh) {
        points.push([pose[0], pose[1]], ...contour.map(({ point }) => point));
      }
      const [first] = frames;
      if (first) {
        points.push([first.pose[0], first.pose[1]]);
      }
      for (const { pose } of answer?.frames ?? []) {
        if (pose) {
          points.push([pose[0], pose[1]]);
        }
      }
      return points.map((point) => this.#world.include(point, this.#reach)).some((grows) => grows);
    }
    /** The whiskers before the first tick. */
    #undeflected({ hello: { rig } }, pose) {
      rig.whiskers.forEach(({ base: [x, y], direction, length }, index) => {
        const tip = [x + length * Math.cos(direction), y + length * Math.sin(direction)];
        const shaft = this.#whiskers[index];
        if (shaft) {
          set(shaft, { d: this.#world.line([placed(pose, [x, y]), placed(pose, tip)]) });
        }
      });
    }
    /** The command, the whiskers and the tips of a tick. */
    #robot(frame) {
      const [x, y] = frame.pose;
      const [vx, vy] = frame.command;
      set(this.#command, { d: Math.hypot(vx, vy) > 1e-4 ? this.#arrow([x, y], [x + vx * AHEAD, y + vy * AHEAD]) : "" });
      frame.whiskers.forEach((whisker, index) => {
        const [shaft, tip] = [this.#whiskers[index], this.#tips[index]];
        if (shaft && tip) {
          set(shaft, { d: this.#world.line(whisker.shaft) });
          shaft.classList.toggle("touching", whisker.touching);
          set(tip, { d: whisker.tip === null ? "" : this.#world.dots([whisker.tip]) });
        }
      });
    }
    /** The robot of a counterfactual in closed loop. */
    #other(run, frame, answer) {
      const moved = (answer?.frames ?? []).filter(({ tick }) => tick <= frame.tick);
      const pose = moved.at(-1)?.pose ?? null;
      set(this.#otherPlatform, { d: pose === null ? "" : this.#outline(run.hello.rig.platform, pose) });
      set(this.#otherTrace, { d: this.#world.line(thinned((answer?.frames ?? []).flatMap(({ pose: pose2 }) => pose2 === null ? [] : [pose2]))) });
      set(this.#otherContour, { d: this.#world.dots(moved.flatMap(({ contour }) => contour)) });
    }
    #outline(corners, pose) {
      return this.#world.line(corners.map((corner) => placed(pose, corner)), true);
    }
    #arrow(from, to) {
      const [[x1, y1], [x2, y2]] = [this.#world.px(from), this.#world.px(to)];
      const angle = Math.atan2(y2 - y1, x2 - x1);
      const barb = (turn) => `M${x2} ${y2}l${-5 * Math.cos(angle + turn)} ${-5 * Math.sin(angle + turn)}`;
      return `M${x1} ${y1}L${x2} ${y2}${barb(0.5)}${barb(-0.5)}`;
    }
    /** Shows the map by touch, or not. */
    #showMap(isShown) {
      this.#isMapShown = isShown;
      this.#map.setAttribute("aria-pressed", String(isShown));
      this.#legend.hidden = !isShown;
      this.#drawing.classList.toggle("mapless", !isShown);
    }
    #isMapShown = true;
    /** Keeps the robot in the middle, or not. */
    #watch(isClose) {
      this.#isClose = isClose;
      this.#close.setAttribute("aria-pressed", String(isClose));
    }
  };

  // src/live/subjects.ts
  function subjects({ hello }) {
    const angles = {
      title: "Base angles",
      unit: "rad",
      series: hello.whiskers.map((name, index) => ({ name, value: ({ whiskers }) => whiskers[index]?.base_angle })),
      levels: [...new Set(hello.rig.whiskers.map(({ threshold }) => threshold))].flatMap((value) => [{ name: "contact", value }, { name: "contact", value: -value }])
    };
    const loop = {
      title: "Control loop",
      unit: "s",
      series: [
        { name: "period", value: ({ loop: loop2 }) => loop2?.period },
        { name: "used", value: ({ loop: loop2 }) => loop2?.used }
      ],
      marked: { name: "overload", holds: ({ loop: loop2 }) => loop2?.overload ?? false },
      isKnown: ({ loop: loop2 }) => loop2 !== null,
      levels: [{ name: "control period", value: hello.control_period }]
    };
    const contour = {
      title: "Contour",
      unit: "m",
      series: [
        { name: "mean error", value: ({ metrics }) => metrics.error },
        { name: "mean standard deviation", value: ({ metrics }) => metrics.spread }
      ]
    };
    const coverage = { title: "Coverage", unit: "", series: [{ name: "coverage", value: ({ metrics }) => metrics.coverage }] };
    const isKnown = hello.scene !== null;
    const ofPolicy = hello.plots.map(({ name, unit, choices }, index) => ({ title: name, unit, choices, series: [{ name: "", value: ({ plots }) => plots[index] }] }));
    return [angles, ...ofPolicy, loop, contour, ...isKnown ? [coverage] : []];
  }
  function subjectsOf(guard) {
    const units = [...new Set(guard.parts.flatMap(({ unit }) => unit === null ? [] : [unit]))];
    return units.map((unit) => ({
      title: `${guard.text}${units.length > 1 ? ` (${unit || "number"})` : ""}`,
      unit,
      series: guard.parts.flatMap((part, index) => {
        const value = ({ guards }) => guards.find((one) => one.guard === guard.index)?.margins[index];
        return part.unit === unit ? [{ name: part.text, value }] : [];
      }),
      levels: [{ name: "limit", value: 0 }],
      marked: { name: "taken", holds: ({ taken }) => taken.includes(guard.index) }
    }));
  }

  // src/live/page.ts
  var PAUSE3 = 50;
  var BEHIND = 0.4;
  var Page = class {
    #root;
    /** Where controls and scene are shown. Above and among the other panels if undefined. */
    #stage;
    #controls;
    #connection;
    #plots = element("div", "plots");
    #run;
    #panels = [];
    #counterfactual;
    #breakpoints;
    #chart;
    /** The shown tick. The newest one if undefined. */
    #selected;
    #duration = 20;
    #answer;
    #isScheduled = false;
    #timer;
    #shownAt = 0;
    constructor(root2, connect = (receive, change) => new Connection(receive, change), stage) {
      this.#stage = stage;
      this.#root = root2;
      this.#controls = new Controls(this, () => this.#chart?.up(), stage === void 0 ? "h1" : "h2");
      (stage ?? root2).replaceChildren(this.#controls.element);
      this.#connection = connect(
        (message) => this.#receive(message),
        (isOpen) => this.#controls.report(isOpen ? "" : "Not connected. The page tries again every second.")
      );
    }
    send(message) {
      this.#controls.report("");
      this.#connection.send(message);
    }
    select(tick) {
      this.#selected = tick;
      this.refresh();
    }
    seek(time) {
      this.select(this.#run?.history.nearest(time)?.tick);
    }
    zoomTime(duration) {
      this.#duration = duration;
      this.refresh();
    }
    toggleBreakpoint(text2) {
      const isSet = this.#run?.breakpoints.some((breakpoint) => breakpoint.text === text2) ?? false;
      this.send({ type: "break", add: isSet ? null : text2, remove: isSet ? text2 : null });
    }
    compare(answer) {
      this.#answer = answer;
      this.refresh();
    }
    /** Shows everything before the next picture of the screen. */
    refresh() {
      if (!this.#isScheduled) {
        this.#isScheduled = true;
        requestAnimationFrame(() => {
          this.#isScheduled = false;
          this.#shownAt = performance.now();
          this.#show();
        });
      }
    }
    #receive(message) {
      const run = this.#run;
      if (message.type === "hello") {
        this.#begin(message);
      } else if (message.type === "error") {
        if (!this.#counterfactual?.fault(message) && !this.#breakpoints?.fault(message)) {
          this.#controls.report(message.message);
        }
      } else if (run !== void 0) {
        switch (message.type) {
          case "ticks":
            run.lost += run.history.last === void 0 ? 0 : message.lost;
            run.add(message.frames);
            break;
          case "history":
            run.fill(message.frames);
            break;
          case "counterfactual":
            this.#counterfactual?.receive(message);
            break;
          case "status":
            run.status = message;
            if (message.state !== "running") {
              run.expect(message.ticks);
            }
            if (message.state === "paused" && message.breakpoint !== null) {
              this.#selected = void 0;
            }
        }
        const range = run.request();
        if (range !== void 0) {
          this.#connection.send({ type: "range", from: range[0], to: range[1], most: null });
        }
      }
      if (message.type === "ticks" || message.type === "history") {
        this.#refreshSoon();
      } else {
        this.refresh();
      }
    }
    /** Shows new ticks, but not each one by itself. */
    #refreshSoon() {
      this.#timer ??= setTimeout(() => {
        this.#timer = void 0;
        this.refresh();
      }, Math.max(0, this.#shownAt + PAUSE3 - performance.now()));
    }
    /** Shows a new run. */
    #begin(hello) {
      const run = new Run(hello);
      [this.#run, this.#selected, this.#answer] = [run, void 0, void 0];
      this.#chart = new ChartPanel(run, this);
      this.#counterfactual = new Counterfactual(run, this);
      const scene = new Scene(run, this);
      const guards = new Guards(run, this, (guard) => this.#plotGuard(guard));
      const figures = new Figures();
      const breakpoints = this.#breakpoints = new BreakpointList(run, this);
      this.#panels = [this.#controls, scene, this.#chart, guards, figures, breakpoints, this.#counterfactual];
      const { breakpoints: breaks, counterfactual, closed_loop: closedLoop } = hello.capabilities;
      breakpoints.element.hidden = !breaks && hello.command === "run";
      this.#counterfactual.element.hidden = !counterfactual && !closedLoop && hello.command === "run";
      this.#plots.replaceChildren();
      subjects(run).forEach((subject) => this.#plot(subject));
      const columns = [
        element("div", "column", ...this.#stage === void 0 ? [scene.element] : [], figures.element, breakpoints.element),
        element("div", "column", this.#chart.element, guards.element),
        element("div", "column", element("section", "", element("h2", "", "Plots"), this.#plots), this.#counterfactual.element)
      ];
      this.#stage?.replaceChildren(this.#controls.element, scene.element);
      this.#root.replaceChildren(...this.#stage === void 0 ? [this.#controls.element] : [], element("div", "panels", ...columns));
    }
    #plotGuard(guard) {
      for (const subject of subjectsOf(guard)) {
        if (!this.#panels.some((panel) => panel instanceof Plot && panel.subject.title === subject.title)) {
          const plot = this.#plot({ ...subject, close: () => this.#remove(plot) });
          plot.element.scrollIntoView({ block: "nearest" });
        }
      }
      this.refresh();
    }
    #plot(subject) {
      const plot = new Plot(subject, this);
      this.#panels.push(plot);
      this.#plots.append(plot.element);
      return plot;
    }
    #remove(plot) {
      this.#panels = this.#panels.filter((panel) => panel !== plot);
      plot.element.remove();
    }
    #show() {
      const run = this.#run;
      if (run === void 0) {
        return;
      }
      const { last } = run.history;
      const frame = this.#selected === void 0 ? last : run.history.at(this.#selected);
      const [from, to] = this.#range(last?.time ?? 0, frame?.time ?? 0);
      const view = { run, frame, isFollowing: this.#selected === void 0, from, to, answer: this.#answer };
      this.#panels.forEach((panel) => panel.update(view));
    }
    /** The times (s) of the plots. */
    #range(end, shown) {
      if (this.#duration === Infinity) {
        return [0, Math.max(end, 1)];
      }
      const to = Math.max(this.#duration, Math.min(end, shown + BEHIND * this.#duration));
      return [to - this.#duration, to];
    }
  };

  // src/live/main.ts
  var root = document.getElementById("live");
  if (root) {
    new Page(root);
  }
})();
