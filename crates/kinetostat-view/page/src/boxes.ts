// Boxes of a job: stock, part and obstacles.

import * as three from "three";

import type { SolidBox, Vec3 } from "./api";
import type { Theme } from "./colour";
import { vector } from "./machine3d";

/** The corners of a box; bit k of the number says which end of edge k. */
export function corners(box: SolidBox): three.Vector3[] {
  return Array.from({ length: 8 }, (_, i) => box.edges_mm.reduce((at: three.Vector3, edge: Vec3, k) => at.addScaledVector(vector(edge), (i >> k) & 1), vector(box.corner_mm)));
}

const SIDES = [
  [0, 1, 3, 2],
  [4, 5, 7, 6],
  [0, 1, 5, 4],
  [2, 3, 7, 6],
  [0, 2, 6, 4],
  [1, 3, 7, 5],
];

/** A translucent box with its edges. */
export function solid(box: SolidBox, theme: Theme): three.Object3D[] {
  const colour = theme[box.kind];
  const points = corners(box);
  const faces = SIDES.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].map((i) => points[i!]!));
  const edges = points.flatMap((point, i) => [1, 2, 4].filter((bit) => (i & bit) === 0).flatMap((bit) => [point, points[i | bit]!]));
  const face = new three.MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.14, side: three.DoubleSide, depthWrite: false });
  const mesh = new three.Mesh(new three.BufferGeometry().setFromPoints(faces), face);
  return [mesh, new three.LineSegments(new three.BufferGeometry().setFromPoints(edges), new three.LineBasicMaterial({ color: colour }))];
}

/** The name of a box, at the middle of its highest edge. */
export function boxLabel(box: SolidBox): { at: three.Vector3; text: string } {
  const [first, second] = corners(box).sort((a, b) => b.z - a.z);
  return { at: first!.clone().add(second!).multiplyScalar(0.5), text: box.name === box.kind ? box.name : `${box.name} (${box.kind})` };
}
