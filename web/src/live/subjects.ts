import type { Subject } from "./plot.ts";
import type { GuardInfo } from "./protocol.ts";
import type { Run } from "./run.ts";

/** The plots of every run, and those of its policy. */
export function subjects({ hello }: Run): Subject[] {
  const angles: Subject = {
    title: "Base angles",
    unit: "rad",
    series: hello.whiskers.map((name, index) => ({ name, value: ({ whiskers }) => whiskers[index]?.base_angle })),
    levels: [...new Set(hello.rig.whiskers.map(({ threshold }) => threshold))].flatMap((value) => [{ name: "contact", value }, { name: "contact", value: -value }]),
  };
  const loop: Subject = {
    title: "Control loop",
    unit: "s",
    series: [
      { name: "period", value: ({ loop }) => loop?.period },
      { name: "used", value: ({ loop }) => loop?.used },
    ],
    marked: { name: "overload", holds: ({ loop }) => loop?.overload ?? false },
    isKnown: ({ loop }) => loop !== null,
    levels: [{ name: "control period", value: hello.control_period }],
  };
  const contour: Subject = {
    title: "Contour",
    unit: "m",
    series: [
      { name: "mean error", value: ({ metrics }) => metrics.error },
      { name: "mean standard deviation", value: ({ metrics }) => metrics.spread },
    ],
  };
  const coverage: Subject = { title: "Coverage", unit: "", series: [{ name: "coverage", value: ({ metrics }) => metrics.coverage }] };
  const isKnown = hello.scene !== null;
  const ofPolicy = hello.plots.map(({ name, unit, choices }, index): Subject => ({ title: name, unit, choices, series: [{ name: "", value: ({ plots }) => plots[index] }] }));
  return [angles, ...ofPolicy, loop, contour, ...(isKnown ? [coverage] : [])];
}

/** The plots of a guard: the margins of its parts, one plot for each unit. */
export function subjectsOf(guard: GuardInfo): Subject[] {
  const units = [...new Set(guard.parts.flatMap(({ unit }) => (unit === null ? [] : [unit])))];
  return units.map((unit) => ({
    title: `${guard.text}${units.length > 1 ? ` (${unit || "number"})` : ""}`,
    unit,
    series: guard.parts.flatMap((part, index) => {
      const value: Subject["series"][number]["value"] = ({ guards }) => guards.find((one) => one.guard === guard.index)?.margins[index];
      return part.unit === unit ? [{ name: part.text, value }] : [];
    }),
    levels: [{ name: "limit", value: 0 }],
    marked: { name: "taken", holds: ({ taken }) => taken.includes(guard.index) },
  }));
}
