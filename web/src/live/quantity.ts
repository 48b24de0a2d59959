/** The prefixes of units, largest first. */
const PREFIXES: readonly [number, string][] = [[1, ""], [1e-3, "m"], [1e-6, "u"]];
/** Units that have no prefix. */
const PLAIN = ["", "kg", "m^2", "1/m", "1"];

/** A unit with a prefix, and its size in SI units. */
export interface Scale {
  factor: number;
  unit: string;
}

/** The unit in which a value has one to three digits before the point. */
export function scaleOf(value: number, unit: string): Scale {
  const size = Math.abs(value);
  if (size === 0 || PLAIN.includes(unit)) {
    return { factor: 1, unit };
  }
  const [factor, prefix] = PREFIXES.find(([factor]) => size >= factor * 0.9995) ?? [1e-6, "u"];
  return { factor, unit: `${prefix}${unit}` };
}

/** A value in SI units with three digits, such as "540 urad". */
export function quantity(value: number, unit: string): string {
  const scale = scaleOf(value, unit);
  return `${digits(value / scale.factor)} ${scale.unit}`.trim();
}

/** A number with three digits. */
export function digits(value: number): string {
  const size = Math.abs(value);
  if (size >= 1e5 || (size > 0 && size < 1e-4)) {
    return value.toExponential(2);
  }
  return String(Number(value.toPrecision(size >= 100 ? 4 : 3)));
}
