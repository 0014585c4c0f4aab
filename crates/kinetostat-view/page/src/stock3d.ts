// The stock as it is left at a place: heights over a grid, with walls where it ends.

import * as three from "three";

import type { Stock } from "./api";
import type { Theme } from "./colour";
import { vector } from "./machine3d";

export function stockMesh(stock: Stock, theme: Theme): three.Mesh {
  const [nx, ny] = stock.counts;
  const corner = vector(stock.corner_mm);
  const [along, across, up] = [vector(stock.steps_mm[0]), vector(stock.steps_mm[1]), vector(stock.up_mm)];
  const height = (i: number, j: number) => (i < 0 || j < 0 || i >= nx || j >= ny ? null : (stock.heights[j * nx + i] ?? null));
  const point = (i: number, j: number, h: number) => corner.clone().addScaledVector(along, i).addScaledVector(across, j).addScaledVector(up, h);
  const corners: three.Vector3[] = [];
  const face = (a: three.Vector3, b: three.Vector3, c: three.Vector3, d: three.Vector3) => corners.push(a, b, c, a, c, d);
  for (let j = 0; j + 1 < ny; j += 1) {
    for (let i = 0; i + 1 < nx; i += 1) {
      const cell = [height(i, j), height(i + 1, j), height(i + 1, j + 1), height(i, j + 1)];
      if (cell.some((h) => h === null)) {
        continue;
      }
      const [a, b, c, d] = cell as [number, number, number, number];
      face(point(i, j, a), point(i + 1, j, b), point(i + 1, j + 1, c), point(i, j + 1, d));
      // A wall down to the bottom on each side without a neighbour.
      const isEmpty = (di: number, dj: number) => [height(i + di, j + dj), height(i + di + 1, j + dj), height(i + di + 1, j + dj + 1), height(i + di, j + dj + 1)].some((h) => h === null);
      const walls: [boolean, number, number, number, number, number, number][] = [
        [isEmpty(0, -1), i, j, a, i + 1, j, b],
        [isEmpty(1, 0), i + 1, j, b, i + 1, j + 1, c],
        [isEmpty(0, 1), i + 1, j + 1, c, i, j + 1, d],
        [isEmpty(-1, 0), i, j + 1, d, i, j, a],
      ];
      walls.filter(([empty]) => empty).forEach(([, i0, j0, h0, i1, j1, h1]) => face(point(i0, j0, 0), point(i1, j1, 0), point(i1, j1, h1), point(i0, j0, h0)));
    }
  }
  const geometry = new three.BufferGeometry().setFromPoints(corners);
  geometry.computeVertexNormals();
  return new three.Mesh(geometry, new three.MeshStandardMaterial({ color: theme.stock, side: three.DoubleSide, roughness: 0.9, flatShading: true, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }));
}
