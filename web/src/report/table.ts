import { button } from "../shared/button.ts";
import { download, fileName } from "../shared/download.ts";
import { cellsOf, compareCells, csv, latex } from "./cells.ts";

/** Makes a table sortable by its headings, fits it into the window, and exports it. */
export function enhanceTable(frame: HTMLElement): void {
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
    button("LaTeX", () => download(fileName(title, "tex"), "application/x-tex", latex(cellsOf(table), names)), `save the table ${title} for LaTeX`),
  );
  frame.before(tools);
  new ResizeObserver(fit.apply).observe(frame);
  fit.apply();
}

function makeSortable(heading: HTMLTableCellElement, head: HTMLTableRowElement, body: HTMLTableSectionElement, column: number): void {
  const sort = button(heading.textContent ?? "", () => {
    const descends = heading.ariaSort === "ascending";
    for (const other of head.cells) {
      other.removeAttribute("aria-sort");
    }
    heading.ariaSort = descends ? "descending" : "ascending";
    const text = (row: HTMLTableRowElement): string => (row.cells[column]?.textContent ?? "").trim();
    const rows = Array.from(body.rows);
    rows.sort((a, b) => compareCells(text(a), text(b), descends ? -1 : 1));
    body.append(...rows);
  });
  heading.replaceChildren(sort);
}

/**
 * Hides the columns that do not fit, from the right, as the terminal does. The first name and the first figure stay. The button shows all
 * columns.
 */
function fitted(frame: HTMLElement, table: HTMLTableElement, names: number): { toggle: HTMLButtonElement; apply: () => void } {
  let all = false;
  const show = (column: number, isShown: boolean): void => {
    for (const row of table.rows) {
      const cell = row.cells[column];
      if (cell) {
        cell.hidden = !isShown;
      }
    }
  };
  const apply = (): void => {
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
  // Before printing, the page has the width of the paper.
  addEventListener("beforeprint", apply);
  return { toggle, apply };
}
