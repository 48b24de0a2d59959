import { enhanceFigure } from "./figure.ts";
import { flattenFills } from "./fills.ts";
import { enhanceTable } from "./table.ts";

document.querySelectorAll<HTMLElement>(".table").forEach(enhanceTable);
document.querySelectorAll<HTMLElement>("figure").forEach(enhanceFigure);

addEventListener("beforeprint", () => {
  const restore = flattenFills(document);
  addEventListener("afterprint", restore, { once: true });
});
