import { digits, quantity } from "../live/quantity.ts";
import type { Lesson, Result } from "./messages.ts";

/** A figure of a run that the page compares. */
interface Figure {
  /** Its path in the JSON document of the run. */
  key: string;
  name: string;
  /** The factor to the unit in which it is shown. */
  factor: number;
  unit: string;
}

/** The figures, the most important ones first. */
export const FIGURES: readonly Figure[] = [
  { key: "error_mm.mean", name: "mean error", factor: 1e-3, unit: "m" },
  { key: "coverage", name: "coverage", factor: 100, unit: "%" },
  { key: "sim_s", name: "time", factor: 1, unit: "s" },
  { key: "error_mm.max", name: "largest error", factor: 1e-3, unit: "m" },
];

/** The value at a path of a result. */
export function figure(result: Result | undefined, path: string): number | undefined {
  const value = path.split(".").reduce<unknown>((value, key) => (typeof value === "object" && value !== null ? (value as Record<string, unknown>)[key] : undefined), result);
  return typeof value === "number" ? value : undefined;
}

/** A value of a figure with its unit. */
export function shown({ factor, unit }: Figure, value: number | undefined): string {
  return value === undefined ? "–" : unit === "%" ? `${digits(value * factor)} %` : quantity(value * factor, unit);
}

/** What a result misses of the bounds of a step, in words. */
export function shortfalls(result: Result, bounds: Lesson["bounds"]): string[] {
  return bounds.flatMap(({ figure: key, least, most }) => {
    const value = figure(result, key);
    const known = FIGURES.find((known) => known.key === key) ?? { key, name: key, factor: 1, unit: "" };
    if (value === undefined) {
      return [`there is no ${known.name}, because nothing was recorded`];
    }
    const now = shown(known, value);
    if (value > (most ?? Infinity)) {
      return [key === "sim_s" ? `the run has to end within ${shown(known, most)} (it took ${now})` : `the ${known.name} has to be at most ${shown(known, most)} (now ${now})`];
    }
    if (key === "sim_s" && value < (least ?? -Infinity)) {
      return [`the run must not end before ${shown(known, least)} (it ended after ${now})`];
    }
    return value < (least ?? -Infinity) ? [`the ${known.name} has to be at least ${shown(known, least)} (now ${now})`] : [];
  });
}

/** The expectations of the scenario that a run does not meet. That of the outcome is left out, which stands beside. */
export function unmet({ outcome, violations }: Result): string[] {
  const others = violations.filter((text) => !text.startsWith(`${outcome}:`) && !text.startsWith("the outcome is "));
  return others.map((text) => (text.startsWith("error_mean is not known") ? "there is no mean error, because nothing was recorded" : text.replace(/^error_mean /, "the mean error ").replace(/^error_max /, "the largest error ")));
}
