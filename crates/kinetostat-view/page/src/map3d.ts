// A map of the workspace in space: cells coloured by the values at their corners.

import * as three from "three";

import type { Vec3 } from "./api";
import type { Scale } from "./colour";
import { dispose, vector } from "./machine3d";

/** A place of a map; without a value it is not asked yet (undefined), or has none (null). */
export interface MapPlace {
  at: Vec3;
  value?: number | null;
}

/** Places by plane, by line of the plane, and along the line. */
export type MapPlanes = MapPlace[][][];

/** The corners of a plane, around it. */
export function cornersOf(plane: MapPlace[][]): three.Vector3[] {
  const [first, last] = [plane[0]!, plane[plane.length - 1]!];
  return [first[0], first[first.length - 1], last[last.length - 1], last[0]].map((place) => vector(place!.at));
}

export class MapCells {
  readonly group = new three.Group();
  private mesh: three.Mesh | null = null;
  /** Corners of the cells that are drawn; each cell has two triangles. */
  private cells: (MapPlace & { value: number })[][] = [];

  /** Draws the cells whose four corners have values, and the edges of the planes, within which an empty place has none. */
  show(planes: MapPlanes, scale: Scale, dark: boolean, edge: string): void {
    this.clear();
    const all = planes.flatMap((plane) => plane.slice(1).flatMap((line, j) => line.slice(1).map((place, i) => [plane[j]![i]!, plane[j]![i + 1]!, place, line[i]!])));
    this.cells = all.filter((cell) => cell.every((place) => typeof place.value === "number")) as typeof this.cells;
    const corners = this.cells.flatMap((cell) => [0, 1, 2, 0, 2, 3].map((k) => cell[k]!));
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(corners.flatMap((place) => place.at), 3));
    // Values are interpolated, and then coloured: a mixture of two colours would be no colour of the scale.
    geometry.setAttribute("uv", new three.Float32BufferAttribute(corners.flatMap((place) => [scale.share(place.value), 0.5]), 2));
    const material = new three.MeshBasicMaterial({ map: texture(scale, dark), transparent: true, opacity: planes.length > 1 ? 0.55 : 0.8, side: three.DoubleSide, depthWrite: false });
    this.mesh = new three.Mesh(geometry, material);
    const edges = planes.map(cornersOf).flatMap((outer) => outer.flatMap((corner, k) => [corner, outer[(k + 1) % 4]!]));
    this.group.add(this.mesh, new three.LineSegments(new three.BufferGeometry().setFromPoints(edges), new three.LineBasicMaterial({ color: edge })));
  }

  /** The place nearest to where a ray meets a cell first. */
  pick(ray: three.Raycaster): MapPlace | null {
    const hit = this.mesh === null ? undefined : ray.intersectObject(this.mesh)[0];
    const cell = this.cells[Math.floor((hit?.faceIndex ?? 0) / 2)];
    const far = (place: MapPlace) => hit!.point.distanceTo(vector(place.at));
    return hit === undefined || cell === undefined ? null : cell.reduce((a, b) => (far(b) < far(a) ? b : a));
  }

  clear(): void {
    (this.mesh?.material as three.MeshBasicMaterial | undefined)?.map?.dispose();
    [...this.group.children].forEach(dispose);
    this.mesh = null;
  }
}

/** The colours of a scale, those of the lowest value first. */
function texture(scale: Scale, dark: boolean): three.DataTexture {
  const pixels = Array.from({ length: 256 }, (_, i) => [...[...scale.colour(i / 255, dark).matchAll(/\d+/g)].map(Number), 255]);
  const made = new three.DataTexture(new Uint8Array(pixels.flat()), 256, 1);
  made.colorSpace = three.SRGBColorSpace;
  [made.magFilter, made.minFilter, made.needsUpdate] = [three.LinearFilter, three.LinearFilter, true];
  return made;
}
