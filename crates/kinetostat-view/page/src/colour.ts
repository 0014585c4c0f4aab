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
  return mixed(PLASMA, low + (high - low) * Math.min(Math.max(share, 0), 1));
}

/** The colour at a share of a list of colours. */
function mixed(list: readonly (readonly [number, number, number])[], share: number): string {
  const at = Math.min(Math.max(share, 0), 1) * (list.length - 1);
  const first = Math.min(Math.floor(at), list.length - 2);
  const [a, b] = [list[first]!, list[first + 1]!];
  return `rgb(${a.map((x, k) => Math.round(x + (at - first) * (b[k]! - x))).join(", ")})`;
}

/** Diverging colours from unfavourable to favourable; the middle is near the background. */
const DIVERGING = {
  light: [[165, 15, 30], [225, 125, 95], [235, 232, 228], [100, 160, 205], [15, 75, 150]],
  dark: [[255, 165, 130], [185, 70, 60], [62, 66, 74], [60, 115, 175], [150, 205, 255]],
} as const;

/** Numbers of a scale, and its colours from the lowest (share 0) to the highest (1). */
export interface Scale {
  low: number;
  middle: number;
  high: number;
  share: (value: number) => number;
  colour: (share: number, dark: boolean) => string;
}

/** Ratio of the most to the least value above which a scale is logarithmic. */
const WIDE = 50;

/** Scale of values: bright for unfavourable ones; with both signs, diverging from zero. */
export function scaleOver(least: number, most: number, isHighWorse: boolean): Scale {
  const [low, high] = [least, most];
  const worse = (share: number) => (isHighWorse ? share : 1 - share);
  if (low < 0 && high > 0) {
    const share = (x: number) => (x < 0 ? 0.5 * (1 - x / low) : 0.5 * (1 + x / high));
    return { low, middle: 0, high, share, colour: (own, dark) => mixed(DIVERGING[dark ? "dark" : "light"], 1 - worse(own)) };
  }
  const colour = (own: number, dark: boolean) => byShare(worse(own), dark);
  if (low > 0 && high > WIDE * low) {
    return { low, middle: Math.sqrt(low * high), high, share: (x) => Math.log(x / low) / Math.log(high / low), colour };
  }
  return { low, middle: (low + high) / 2, high, share: (x) => (high > low ? (x - low) / (high - low) : 0.5), colour };
}

/** A strip with all colours of a scale, for a legend; the saved picture reads them from its data. */
export function strip(colour: (share: number) => string): HTMLElement {
  const out = document.createElement("i");
  const colours = [0, 0.2, 0.4, 0.6, 0.8, 1].map(colour);
  out.className = "ramp";
  out.dataset.colours = colours.join(";");
  out.style.background = `linear-gradient(to right, ${colours.join(", ")})`;
  return out;
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
