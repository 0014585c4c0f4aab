// Lengths as they are read: um below 0.1 mm, mm above.

import { shown } from "./store";

export interface LengthUnit {
  word: "um" | "mm";
  perMm: number;
}

/** Unit of a length; for an axis, that of its largest value. */
export function unitOf(mm: number): LengthUnit {
  return Math.abs(mm) < 0.1 ? { word: "um", perMm: 1000 } : { word: "mm", perMm: 1 };
}

/** A length with its unit. */
export function length(mm: number): string {
  // JSON has no NaN.
  if (!Number.isFinite(mm)) {
    return "not known";
  }
  const unit = unitOf(mm);
  return `${shown(mm * unit.perMm)} ${unit.word}`;
}

/** A time with its unit. */
export function time(s: number): string {
  const minutes = Math.floor(s / 60);
  return minutes === 0 ? `${s.toFixed(s < 10 ? 2 : 1)} s` : `${minutes} min ${(s - 60 * minutes).toFixed(0)} s`;
}
