// Colours by value, and by theme.

/** Some colours of viridis, which are told apart in grey and by most eyes. */
const VIRIDIS: [number, number, number][] = [
  [68, 1, 84],
  [59, 82, 139],
  [33, 145, 140],
  [94, 201, 98],
  [253, 231, 37],
];

/** Colour of a share from 0 to 1. */
export function byShare(share: number): string {
  const at = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1);
  const first = Math.min(Math.floor(at), VIRIDIS.length - 2);
  const [a, b] = [VIRIDIS[first]!, VIRIDIS[first + 1]!];
  const mixed = a.map((x, k) => Math.round(x + (at - first) * (b[k]! - x)));
  return `rgb(${mixed.join(", ")})`;
}

/** All of the scale, for a legend. */
export const RAMP = `linear-gradient(to right, ${VIRIDIS.map((colour) => `rgb(${colour.join(", ")})`).join(", ")})`;

export interface Theme {
  back: string;
  rigid: string;
  elastic: string;
  joint: string;
  drive: string;
  plate: string;
  moved: string;
  force: string;
  grid: string;
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
  grid: "#d3d7dd",
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
  grid: "#2b313a",
};
