// The path of a program in space: coloured by a value, with the places over tolerance marked.

import * as three from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

import type { Place } from "./api";
import { byShare, type Theme } from "./colour";
import { dispose, vector } from "./machine3d";

/** Distance from the path at which a click is meant for it, px. */
const NEAR = 12;

export class PathLine {
  readonly group = new three.Group();
  private readonly points: three.Vector3[];

  constructor(places: Place[]) {
    this.points = places.map((place) => vector(place.position_mm));
  }

  /** Makes the line anew, with a share of the colours and a mark for each place. */
  colour(shares: number[], isOver: boolean[], theme: Theme, dark: boolean): void {
    [...this.group.children].forEach(dispose);
    if (this.points.length < 2) {
      return;
    }
    const halo = this.points.flatMap((at, i) => {
      if (!isOver[i]) {
        return [];
      }
      const others = [this.points[i - 1], this.points[i + 1]].filter((own) => own !== undefined);
      return others.flatMap((other) => [...at.toArray(), ...at.clone().lerp(other, 0.5).toArray()]);
    });
    if (halo.length > 0) {
      const material = new LineMaterial({ color: theme.alert, linewidth: 11, transparent: true, opacity: 0.3, depthWrite: false });
      const mark = new LineSegments2(new LineSegmentsGeometry().setPositions(halo), material);
      mark.renderOrder = 1;
      this.group.add(mark);
    }
    const geometry = new LineGeometry().setPositions(this.points.flatMap((at) => at.toArray()));
    geometry.setColors(shares.flatMap((share) => new three.Color(byShare(share, dark)).toArray()));
    const line = new Line2(geometry, new LineMaterial({ vertexColors: true, linewidth: 3.5, transparent: true }));
    line.renderOrder = 2;
    this.group.add(line);
  }

  /** The place next to a point of the picture, px; null if the path is not there. */
  pick(x: number, y: number, project: (v: three.Vector3) => three.Vector3): number | null {
    let found: { place: number; far: number } | null = null;
    const at = this.points.map(project);
    for (let i = 0; i + 1 < at.length; i += 1) {
      const [a, b] = [at[i]!, at[i + 1]!];
      const [dx, dy] = [b.x - a.x, b.y - a.y];
      const square = dx * dx + dy * dy;
      const share = square === 0 ? 0 : Math.min(Math.max(((x - a.x) * dx + (y - a.y) * dy) / square, 0), 1);
      const far = Math.hypot(a.x + share * dx - x, a.y + share * dy - y);
      if (a.z < 1 && far < (found?.far ?? NEAR)) {
        found = { place: share < 0.5 ? i : i + 1, far };
      }
    }
    return found?.place ?? null;
  }
}
