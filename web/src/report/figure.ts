import { button } from "../shared/button.ts";
import { download, fileName } from "../shared/download.ts";
import { Cursor } from "./cursor.ts";
import type { Positions } from "./positions.ts";
import { Zoom } from "../shared/zoom.ts";

/** Lets a figure be zoomed, read by pointer and keyboard, and exported. */
export function enhanceFigure(figure: HTMLElement): void {
  const drawing = figure.querySelector<HTMLElement>(".drawing");
  const svg = drawing?.querySelector("svg");
  if (!drawing || !svg) {
    return;
  }
  const name = figure.dataset["name"] ?? "figure";
  const title = svg.querySelector("title")?.textContent ?? name;
  const data = figure.querySelector("script[type='application/json']")?.textContent;
  const zoom = new Zoom(drawing, svg);
  const cursor = data ? new Cursor(drawing, svg, JSON.parse(data) as Positions) : undefined;
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
    button("PDF", () => printAlone(svg, zoom), `print ${title} alone, for example to a PDF file`),
  );
  drawing.before(tools);
}

/** The picture without what the page has added. */
function plain(svg: SVGSVGElement, zoom: Zoom): SVGSVGElement {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  copy.querySelectorAll(".overlay").forEach((overlay) => overlay.remove());
  copy.setAttribute("viewBox", zoom.whole);
  return copy;
}

function svgText(svg: SVGSVGElement, zoom: Zoom): string {
  return new XMLSerializer().serializeToString(plain(svg, zoom));
}

/** Opens the print dialogue for one figure on a page of its size. The browser writes it as PDF with its texts and curves. */
function printAlone(svg: SVGSVGElement, zoom: Zoom): void {
  const [, , width = "1", height = "1"] = zoom.whole.split(" ");
  const sheet = document.createElement("div");
  sheet.className = "one-figure";
  sheet.append(plain(svg, zoom));
  const style = document.createElement("style");
  style.textContent = `@page { size: ${width}px ${height}px; margin: 0 }`;
  document.head.append(style);
  document.body.append(sheet);
  document.body.classList.add("one-figure");
  const clean = (): void => {
    document.body.classList.remove("one-figure");
    sheet.remove();
    style.remove();
  };
  addEventListener("afterprint", clean, { once: true });
  print();
}
