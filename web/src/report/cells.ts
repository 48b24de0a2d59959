/** The heading and the rows of a table as texts. */
export interface Cells {
  headings: string[];
  rows: string[][];
}

/** The text of a missing figure. */
const NONE = "–";

/** The number at the begin of a cell, such as 0.8 of "0.8 ± 0.5". Undefined without one. */
export function leadingNumber(text: string): number | undefined {
  const match = /^[+\-−]?\d+(?:\.\d+)?(?:e[+-]?\d+)?/i.exec(text.trim());
  return match === null ? undefined : Number(match[0].replace("−", "-"));
}

/** The order of two cells. Missing figures are last in both directions. */
export function compareCells(a: string, b: string, direction: 1 | -1): number {
  const missing = Number(a === NONE || a === "") - Number(b === NONE || b === "");
  if (missing !== 0) {
    return missing;
  }
  const [x, y] = [leadingNumber(a), leadingNumber(b)];
  if (x !== undefined && y !== undefined && x !== y) {
    return direction * (x - y);
  }
  return direction * a.localeCompare(b, "en", { numeric: true });
}

/** The cells of a table, of all columns and in the order that is shown. */
export function cellsOf(table: HTMLTableElement): Cells {
  const texts = (row: HTMLTableRowElement | undefined): string[] => Array.from(row?.cells ?? [], (cell) => cell.innerText.trim() || (cell.textContent ?? "").trim());
  const [head, ...rows] = Array.from(table.rows);
  return { headings: texts(head), rows: rows.map(texts) };
}

/** A figure with its sign, deviation and unit. A spreadsheet takes any other text that begins with a sign for a formula. */
const FIGURE = /^[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?: ± \d+(?:\.\d+)?(?:e[+-]?\d+)?)?(?: [%°µ\p{L}/]+)?$/iu;

/** The text of a cell that no spreadsheet evaluates: a quote stands before what would begin a formula. */
function inert(text: string): string {
  return /^[=+\-@\t\r]/.test(text) && !FIGURE.test(text) ? `'${text}` : text;
}

/** The table as comma-separated values (RFC 4180). */
export function csv({ headings, rows }: Cells): string {
  const quoted = (text: string): string => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const cell = (text: string): string => quoted(inert(text));
  return [headings, ...rows].map((row) => row.map(cell).join(",") + "\r\n").join("");
}

const LATEX: Record<string, string> = {
  "\\": "\\textbackslash{}", "&": "\\&", "%": "\\%", "$": "\\$", "#": "\\#", _: "\\_", "{": "\\{", "}": "\\}",
  "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "±": "$\\pm$", "×": "$\\times$", "µ": "$\\mu$", "°": "$^\\circ$", "–": "--", "−": "$-$",
};

/** The table for LaTeX with the package booktabs. The first `names` columns are left-aligned. */
export function latex({ headings, rows }: Cells, names: number): string {
  const cell = (text: string): string => Array.from(text, (letter) => LATEX[letter] ?? letter).join("");
  const line = (row: string[]): string => `${row.map(cell).join(" & ")} \\\\\n`;
  const columns = headings.map((_, column) => (column < names ? "l" : "r")).join("");
  return `\\begin{tabular}{${columns}}\n\\toprule\n${line(headings)}\\midrule\n${rows.map(line).join("")}\\bottomrule\n\\end{tabular}\n`;
}
