/** The key of the texts in the storage of the browser. */
const KEY = "vibrissa-playground";

/** Texts that a reload brings back. */
export interface Kept {
  policy: string;
  scenario: string;
}

/** Keeps texts. Where the browser allows no storage, a reload forgets them. */
export function keep(kept: Kept): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(kept));
  } catch {
    // The link of the page can hold the texts as well.
  }
}

/** The texts that were kept last. Undefined if there are none. */
export function restored(): Kept | undefined {
  try {
    const value = JSON.parse(localStorage.getItem(KEY) ?? "null") as Partial<Kept> | null;
    return typeof value?.policy === "string" && typeof value.scenario === "string" ? { policy: value.policy, scenario: value.scenario } : undefined;
  } catch {
    return undefined;
  }
}
