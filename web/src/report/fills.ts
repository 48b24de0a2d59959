/**
 * Replaces hatched fills by their ground, and returns a function that restores them. A browser prints each hatched area as an image of
 * hundreds of kilobytes.
 */
export function flattenFills(root: ParentNode): () => void {
  const hatched = Array.from(root.querySelectorAll<SVGElement>("[fill^='url(#']"));
  const kept = hatched.map((area) => [area, area.getAttribute("fill") ?? ""] as const);
  for (const [area, fill] of kept) {
    const pattern = document.getElementById(fill.slice(5, -1));
    area.setAttribute("fill", pattern?.querySelector("rect")?.getAttribute("fill") ?? "none");
  }
  return () => kept.forEach(([area, fill]) => area.setAttribute("fill", fill));
}
