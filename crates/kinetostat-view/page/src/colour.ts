// Colours by value, and by theme.

/** Some colours of plasma, which are told apart in grey and by most eyes. */
const PLASMA: [number, number, number][] = [
  [13, 8, 135],
  [75, 3, 161],
  [125, 3, 168],
  [168, 34, 150],
  [203, 70, 121],
  [229, 107, 93],
  [248, 148, 65],
  [253, 195, 40],
  [240, 249, 33],
];

/** Part of the scale that is legible on the background: its dark colours on a light one. */
const part = (dark: boolean): [number, number] => (dark ? [0.42, 1] : [0, 0.6]);

/** Colour of a share from 0 to 1. */
export function byShare(share: number, dark: boolean): string {
  const [low, high] = part(dark);
  const at = (low + (high - low) * Math.min(Math.max(share, 0), 1)) * (PLASMA.length - 1);
  const first = Math.min(Math.floor(at), PLASMA.length - 2);
  const [a, b] = [PLASMA[first]!, PLASMA[first + 1]!];
  const mixed = a.map((x, k) => Math.round(x + (at - first) * (b[k]! - x)));
  return `rgb(${mixed.join(", ")})`;
}

/** All of the scale, for a legend. */
export function ramp(dark: boolean): string {
  return `linear-gradient(to right, ${[0, 0.2, 0.4, 0.6, 0.8, 1].map((share) => byShare(share, dark)).join(", ")})`;
}

export interface Theme {
  back: string;
  rigid: string;
  elastic: string;
  joint: string;
  drive: string;
  plate: string;
  moved: string;
  force: string;
  moment: string;
  grid: string;
  alert: string;
  stock: string;
  part: string;
  obstacle: string;
  /** Axes x, y and z. */
  axes: [string, string, string];
}

export const LIGHT: Theme = {
  back: "#f4f5f7",
  rigid: "#6b7280",
  elastic: "#475569",
  joint: "#9aa3af",
  drive: "#334155",
  plate: "#94a3b8",
  moved: "#d9480f",
  force: "#1864ab",
  moment: "#7b2cbf",
  grid: "#c3c9d1",
  alert: "#e03131",
  stock: "#8a6d1a",
  part: "#087f5b",
  obstacle: "#b42318",
  axes: ["#c92a2a", "#2b8a3e", "#1864ab"],
};

export const DARK: Theme = {
  back: "#14171c",
  rigid: "#8b95a3",
  elastic: "#aab4c2",
  joint: "#6d7784",
  drive: "#c3ccd8",
  plate: "#5b6675",
  moved: "#ff922b",
  force: "#74c0fc",
  moment: "#d0a2ff",
  grid: "#363e49",
  alert: "#ff6b6b",
  stock: "#e0c36a",
  part: "#63e6be",
  obstacle: "#ff8787",
  axes: ["#ff8787", "#8ce99a", "#74c0fc"],
};
