"use strict";
(() => {
  // src/shared/button.ts
  function button(label, action, description) {
    const button2 = document.createElement("button");
    button2.type = "button";
    button2.textContent = label;
    if (description !== void 0) {
      button2.title = description;
      button2.setAttribute("aria-label", description.startsWith(label) || !/[\p{L}\p{N}]/u.test(label) ? description : `${label}: ${description}`);
    }
    button2.addEventListener("click", () => action(button2));
    return button2;
  }

  // src/shared/download.ts
  function download(name, type, text) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e3);
  }
  function fileName(title, extension) {
    return `${title.replace(/[^\p{L}\p{N}.]+/gu, "-").replace(/^-|-$/g, "")}.${extension}`;
  }

  // src/report/positions.ts
  var REACH = 14;
  function tipAt({ sides, strips, end_s, tips }, x, y) {
    const isInStrips = y >= strips[0] && y <= strips[1];
    const time = (x - sides[0]) / (sides[1] - sides[0]) * end_s;
    const distance = (tip) => isInStrips ? Math.abs(tip[3] - time) : Math.hypot(tip[0] - x, tip[1] - y);
    let nearest;
    let least = isInStrips ? end_s / 100 : REACH;
    tips.forEach((tip, index) => {
      const found = distance(tip);
      if (found < least) {
        [nearest, least] = [index, found];
      }
    });
    return nearest;
  }
  function byTime({ tips }) {
    return tips.map((_, index) => index).sort((a, b) => (tips[a]?.[3] ?? 0) - (tips[b]?.[3] ?? 0));
  }
  function describe({ tips, states, whiskers }, index) {
    const tip = tips[index];
    if (tip === void 0) {
      return "";
    }
    const [, , error, time, state, whisker] = tip;
    const name = state === null ? "Failure" : states[state] ?? "";
    return `${(error / 1e3).toFixed(error < 100 ? 4 : 2)} mm · ${time.toFixed(2)} s · ${name} · ${whiskers[whisker] ?? ""}`;
  }

  // src/report/cursor.ts
  var SVG = "http://www.w3.org/2000/svg";
  var Cursor = class {
    #drawing;
    #svg;
    #positions;
    #order;
    #overlay = document.createElementNS(SVG, "g");
    #ring = document.createElementNS(SVG, "circle");
    #line = document.createElementNS(SVG, "line");
    #note = document.createElement("div");
    /** Position of the selected estimate in the order of times. */
    #selected;
    constructor(drawing, svg, positions) {
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
      drawing.addEventListener("pointerleave", () => this.#select(void 0));
      drawing.addEventListener("blur", () => this.#select(void 0));
    }
    /** Acts on a key. True if the key belongs to the cursor. */
    key(event) {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (step === void 0 || this.#order.length === 0) {
        return false;
      }
      const next = (this.#selected ?? (step > 0 ? -1 : this.#order.length)) + step * (event.shiftKey ? 30 : 1);
      this.#select(Math.min(this.#order.length - 1, Math.max(0, next)));
      return true;
    }
    #point(event) {
      const matrix = this.#svg.getScreenCTM()?.inverse();
      if (matrix) {
        const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
        const index = tipAt(this.#positions, x, y);
        this.#select(index === void 0 ? void 0 : this.#order.indexOf(index));
      }
    }
    #select(selected) {
      if (selected === this.#selected) {
        return;
      }
      this.#selected = selected;
      const index = selected === void 0 ? void 0 : this.#order[selected];
      const tip = index === void 0 ? void 0 : this.#positions.tips[index];
      if (index === void 0 || tip === void 0) {
        this.#overlay.remove();
        this.#note.remove();
        return;
      }
      const { sides, strips, end_s } = this.#positions;
      const x = sides[0] + tip[3] / end_s * (sides[1] - sides[0]);
      const places = [
        [this.#ring, { cx: tip[0], cy: tip[1] }],
        [this.#line, { x1: x, x2: x, y1: strips[0], y2: strips[1] }]
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
    #place(x, y) {
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
  };

  // src/shared/zoom.ts
  var Zoom = class {
    #drawing;
    #svg;
    #size;
    #scale = 1;
    #left = 0;
    #top = 0;
    constructor(drawing, svg) {
      this.#drawing = drawing;
      this.#svg = svg;
      const { width, height } = svg.viewBox.baseVal;
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

  // src/report/figure.ts
  function enhanceFigure(figure) {
    const drawing = figure.querySelector(".drawing");
    const svg = drawing?.querySelector("svg");
    if (!drawing || !svg) {
      return;
    }
    const name = figure.dataset["name"] ?? "figure";
    const title = svg.querySelector("title")?.textContent ?? name;
    const data = figure.querySelector("script[type='application/json']")?.textContent;
    const zoom = new Zoom(drawing, svg);
    const cursor = data ? new Cursor(drawing, svg, JSON.parse(data)) : void 0;
    drawing.tabIndex = 0;
    drawing.setAttribute("role", "group");
    drawing.setAttribute("aria-label", `${title}. Keys: plus and minus zoom, 0 shows everything, arrows move`);
    drawing.addEventListener("keydown", (event) => {
      if (zoom.key(event) || cursor?.key(event)) {
        event.preventDefault();
      }
    });
    const tools = document.createElement("div");
    tools.className = "tools";
    tools.append(
      button("+", () => zoom.by(1.5), `zoom into ${title}`),
      button("−", () => zoom.by(1 / 1.5), `zoom out of ${title}`),
      button("whole", () => zoom.reset(), `show all of ${title}`),
      button("SVG", () => download(fileName(name, "svg"), "image/svg+xml", svgText(svg, zoom)), `save ${title} as SVG`),
      button("PDF", () => printAlone(svg, zoom), `print ${title} alone, for example to a PDF file`)
    );
    drawing.before(tools);
  }
  function plain(svg, zoom) {
    const copy = svg.cloneNode(true);
    copy.querySelectorAll(".overlay").forEach((overlay) => overlay.remove());
    copy.setAttribute("viewBox", zoom.whole);
    return copy;
  }
  function svgText(svg, zoom) {
    return new XMLSerializer().serializeToString(plain(svg, zoom));
  }
  function printAlone(svg, zoom) {
    const [, , width = "1", height = "1"] = zoom.whole.split(" ");
    const sheet = document.createElement("div");
    sheet.className = "one-figure";
    sheet.append(plain(svg, zoom));
    const style = document.createElement("style");
    style.textContent = `@page { size: ${width}px ${height}px; margin: 0 }`;
    document.head.append(style);
    document.body.append(sheet);
    document.body.classList.add("one-figure");
    const clean = () => {
      document.body.classList.remove("one-figure");
      sheet.remove();
      style.remove();
    };
    addEventListener("afterprint", clean, { once: true });
    print();
  }

  // src/report/fills.ts
  function flattenFills(root) {
    const hatched = Array.from(root.querySelectorAll("[fill^='url(#']"));
    const kept = hatched.map((area) => [area, area.getAttribute("fill") ?? ""]);
    for (const [area, fill] of kept) {
      const pattern = document.getElementById(fill.slice(5, -1));
      area.setAttribute("fill", pattern?.querySelector("rect")?.getAttribute("fill") ?? "none");
    }
    return () => kept.forEach(([area, fill]) => area.setAttribute("fill", fill));
  }

  // src/report/cells.ts
  var NONE = "–";
  function leadingNumber(text) {
    const match = /^[+\-−]?\d+(?:\.\d+)?(?:e[+-]?\d+)?/i.exec(text.trim());
    return match === null ? void 0 : Number(match[0].replace("−", "-"));
  }
  function compareCells(a, b, direction) {
    const missing = Number(a === NONE || a === "") - Number(b === NONE || b === "");
    if (missing !== 0) {
      return missing;
    }
    const [x, y] = [leadingNumber(a), leadingNumber(b)];
    if (x !== void 0 && y !== void 0 && x !== y) {
      return direction * (x - y);
    }
    return direction * a.localeCompare(b, "en", { numeric: true });
  }
  function cellsOf(table) {
    const texts = (row) => Array.from(row?.cells ?? [], (cell) => cell.innerText.trim() || (cell.textContent ?? "").trim());
    const [head, ...rows] = Array.from(table.rows);
    return { headings: texts(head), rows: rows.map(texts) };
  }
  var FIGURE = /^[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?: ± \d+(?:\.\d+)?(?:e[+-]?\d+)?)?(?: [%°µ\p{L}/]+)?$/iu;
  function inert(text) {
    return /^[=+\-@\t\r]/.test(text) && !FIGURE.test(text) ? `'${text}` : text;
  }
  function csv({ headings, rows }) {
    const quoted = (text) => /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
    const cell = (text) => quoted(inert(text));
    return [headings, ...rows].map((row) => row.map(cell).join(",") + "\r\n").join("");
  }
  var LATEX = {
    "\\": "\\textbackslash{}",
    "&": "\\&",
    "%": "\\%",
    "$": "\\$",
    "#": "\\#",
    _: "\\_",
    "{": "\\{",
    "}": "\\}",
    "~": "\\textasciitilde{}",
    "^": "\\textasciicircum{}",
    "±": "$\\pm$",
    "×": "$\\times$",
    "µ": "$\\mu$",
    "°": "$^\\circ$",
    "–": "--",
    "−": "$-$"
  };
  function latex({ headings, rows }, names) {
    const cell = (text) => Array.from(text, (letter) => LATEX[letter] ?? letter).join("");
    const line = (row) => `${row.map(cell).join(" & ")} \\\\
`;
    const columns = headings.map((_, column) => column < names ? "l" : "r").join("");
    return `\\begin{tabular}{${columns}}
\\toprule
${line(headings)}\\midrule
${rows.map(line).join("")}\\bottomrule
\\end{tabular}
`;
  }

  // src/report/table.ts
  function enhanceTable(frame) {
    const table = frame.querySelector("table");
    const head = table?.tHead?.rows[0];
    const body = table?.tBodies[0];
    if (!table || !head || !body) {
      return;
    }
    const names = Number(frame.dataset["names"] ?? 1);
    const title = table.caption?.textContent ?? "table";
    Array.from(head.cells).forEach((heading, column) => makeSortable(heading, head, body, column));
    const fit = fitted(frame, table, names);
    const tools = document.createElement("div");
    tools.className = "tools";
    tools.append(
      fit.toggle,
      button("CSV", () => download(fileName(title, "csv"), "text/csv", csv(cellsOf(table))), `save the table ${title} as CSV`),
      button("LaTeX", () => download(fileName(title, "tex"), "application/x-tex", latex(cellsOf(table), names)), `save the table ${title} for LaTeX`)
    );
    frame.before(tools);
    new ResizeObserver(fit.apply).observe(frame);
    fit.apply();
  }
  function makeSortable(heading, head, body, column) {
    const sort = button(heading.textContent ?? "", () => {
      const descends = heading.ariaSort === "ascending";
      for (const other of head.cells) {
        other.removeAttribute("aria-sort");
      }
      heading.ariaSort = descends ? "descending" : "ascending";
      const text = (row) => (row.cells[column]?.textContent ?? "").trim();
      const rows = Array.from(body.rows);
      rows.sort((a, b) => compareCells(text(a), text(b), descends ? -1 : 1));
      body.append(...rows);
    });
    heading.replaceChildren(sort);
  }
  function fitted(frame, table, names) {
    let all = false;
    const show = (column, isShown) => {
      for (const row of table.rows) {
        const cell = row.cells[column];
        if (cell) {
          cell.hidden = !isShown;
        }
      }
    };
    const apply = () => {
      const count = table.rows[0]?.cells.length ?? 0;
      const columns = Array.from({ length: count }, (_, column) => column);
      columns.forEach((column) => show(column, true));
      const figures = columns.filter((column) => column > names).reverse();
      const dispensable = [...figures, ...columns.filter((column) => column > 0 && column < names).reverse()];
      let hidden = 0;
      while (!all && hidden < dispensable.length && frame.scrollWidth > frame.clientWidth) {
        show(dispensable[hidden] ?? 0, false);
        hidden += 1;
      }
      toggle.hidden = hidden === 0 && !all;
      toggle.textContent = all ? "fewer columns" : `${hidden} more ${hidden === 1 ? "column" : "columns"}`;
      toggle.setAttribute("aria-pressed", String(all));
    };
    const toggle = button("", () => {
      all = !all;
      apply();
    });
    addEventListener("beforeprint", apply);
    return { toggle, apply };
  }

  // src/report/main.ts
  document.querySelectorAll(".table").forEach(enhanceTable);
  document.querySelectorAll("figure").forEach(enhanceFigure);
  addEventListener("beforeprint", () => {
    const restore = flattenFills(document);
    addEventListener("afterprint", restore, { once: true });
  });
})();
