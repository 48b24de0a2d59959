/** A unit, and its size in SI units. */
export interface Scale {
  factor: number;
  unit: string;
}

const DEGREE = Math.PI / 180;
/** The units of angles, by the SI unit. The first one in which a value is at least 1 is used. */
const ANGLES: Record<string, Scale[]> = {
  rad: [{ factor: DEGREE, unit: "deg" }, { factor: 1e-3, unit: "mrad" }, { factor: 1e-6, unit: "urad" }],
  "rad/s": [{ factor: DEGREE, unit: "deg/s" }],
};
/** Units with a prefix, whose first factor has no power. */
const PREFIXED = /^(?!kg)[A-Za-z]+(?!\^)\b/;

/** The unit in which a value has one to three digits before the point. */
export function scaleOf(value: number, unit: string): Scale {
  const prefixed = (): Scale[] => ["", "m", "u"].map((prefix, index) => ({ factor: 1e-3 ** index, unit: `${prefix}${unit}` }));
  const scales = ANGLES[unit] ?? (PREFIXED.test(unit) ? prefixed() : []);
  const smallest = scales.at(-1) ?? { factor: 1, unit };
  return value === 0 ? { factor: 1, unit } : (scales.find(({ factor }) => Math.abs(value) >= factor * 0.9995) ?? smallest);
}

/** A smaller value with a unit is what the rounding of numbers near 1 leaves, and is shown as 0. */
const ROUNDING = 8 * Number.EPSILON;

/** A value in SI units with three digits, such as "540 urad". */
export function quantity(value: number, unit: string): string {
  const shown = unit !== "" && Math.abs(value) < ROUNDING ? 0 : value;
  const scale = scaleOf(shown, unit);
  return `${digits(shown / scale.factor)} ${scale.unit}`.trim();
}

/** A number with three digits. */
export function digits(value: number): string {
  const size = Math.abs(value);
  if (size >= 1e5 || (size > 0 && size < 1e-4)) {
    return value.toExponential(2);
  }
  return String(Number(value.toPrecision(size >= 100 ? 4 : 3)));
}
