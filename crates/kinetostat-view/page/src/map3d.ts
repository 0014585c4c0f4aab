// A map of the workspace in space: cells coloured by the values at their corners.

import * as three from "three";

import type { Vec3 } from "./api";
import type { Scale } from "./colour";
import { dispose, vector } from "./machine3d";

/** Places of planes across the axis `normal`, in lines along the axis `along`; x runs fastest. */
export interface Grid {
  from: Vec3;
  to: Vec3;
  counts: Vec3;
  along: number;
  across: number;
  normal: number;
}

/** Where a place of a grid is, mm. */
export function placeOf({ from, to, counts }: Grid, at: Vec3): Vec3 {
  return at.map((i, k) => (counts[k]! > 1 ? from[k]! + ((to[k]! - from[k]!) * i) / (counts[k]! - 1) : from[k]!)) as Vec3;
}

export function indexOf({ counts }: Grid, at: Vec3): number {
  return at[0] + counts[0] * (at[1] + counts[1] * at[2]);
}

/** A place of a grid by its numbers along the axes of the planes. */
export function inGrid(grid: Grid, along: number, across: number, plane: number): Vec3 {
  const at: Vec3 = [0, 0, 0];
  [at[grid.along], at[grid.across], at[grid.normal]] = [along, across, plane];
  return at;
}

/** The corners of a plane, around it. */
export function cornersOf(grid: Grid, plane: number): three.Vector3[] {
  const [wide, high] = [grid.counts[grid.along]! - 1, grid.counts[grid.across]! - 1];
  return [[0, 0], [wide, 0], [wide, high], [0, high]].map(([i, j]) => vector(placeOf(grid, inGrid(grid, i!, j!, plane))));
}

export class MapCells {
  readonly group = new three.Group();
  private cells: three.Mesh | null = null;
  private grid: Grid | null = null;

  /** Draws the cells whose four corners have values, and the edges of the planes, within which an empty place cannot be reached. */
  show(grid: Grid, values: (number | null | undefined)[], scale: Scale, dark: boolean, edge: string): void {
    this.clear();
    this.grid = grid;
    const positions: number[] = [];
    const shares: number[] = [];
    const edges: three.Vector3[] = [];
    const [wide, high, planes] = [grid.counts[grid.along]!, grid.counts[grid.across]!, grid.counts[grid.normal]!];
    for (let plane = 0; plane < planes; plane += 1) {
      const outer = cornersOf(grid, plane);
      edges.push(...outer.flatMap((corner, k) => [corner, outer[(k + 1) % 4]!]));
      for (let j = 0; j + 1 < high; j += 1) {
        for (let i = 0; i + 1 < wide; i += 1) {
          const corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([a, b]) => inGrid(grid, a!, b!, plane));
          const found = corners.map((at) => values[indexOf(grid, at)]);
          if (found.every((x) => typeof x === "number")) {
            for (const k of [0, 1, 2, 0, 2, 3]) {
              positions.push(...placeOf(grid, corners[k]!));
              shares.push(scale.share(found[k] as number), 0.5);
            }
          }
        }
      }
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(positions, 3));
    // Values are interpolated, and then coloured: a mixture of two colours would be no colour of the scale.
    geometry.setAttribute("uv", new three.Float32BufferAttribute(shares, 2));
    const material = new three.MeshBasicMaterial({ map: texture(scale, dark), transparent: true, opacity: planes > 1 ? 0.55 : 0.8, side: three.DoubleSide, depthWrite: false });
    this.cells = new three.Mesh(geometry, material);
    const frame = new three.LineSegments(new three.BufferGeometry().setFromPoints(edges), new three.LineBasicMaterial({ color: edge }));
    this.group.add(this.cells, frame);
  }

  /** The place nearest to where a ray meets a cell first. */
  pick(ray: three.Raycaster): Vec3 | null {
    const { grid } = this;
    const hit = this.cells === null ? undefined : ray.intersectObject(this.cells)[0];
    if (grid === null || hit === undefined) {
      return null;
    }
    const steps = grid.counts.map((n, k) => (n > 1 ? (grid.to[k]! - grid.from[k]!) / (n - 1) : Infinity));
    return hit.point.toArray().map((x, k) => Math.round((x - grid.from[k]!) / steps[k]!)) as Vec3;
  }

  clear(): void {
    (this.cells?.material as three.MeshBasicMaterial | undefined)?.map?.dispose();
    [...this.group.children].forEach(dispose);
    this.cells = null;
  }
}

/** The colours of a scale, the lowest value on the left. */
function texture(scale: Scale, dark: boolean): three.DataTexture {
  const count = 256;
  const pixels = Array.from({ length: count }, (_, i) => [...scale.colour(i / (count - 1), dark).matchAll(/\d+/g)].map(Number));
  const made = new three.DataTexture(new Uint8Array(pixels.flatMap((rgb) => [...rgb, 255])), count, 1);
  made.colorSpace = three.SRGBColorSpace;
  made.magFilter = three.LinearFilter;
  made.minFilter = three.LinearFilter;
  made.needsUpdate = true;
  return made;
}
