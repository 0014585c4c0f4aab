// Arrows of the load, and the directions of the base axes.

import * as three from "three";

import type { Theme } from "./colour";

/** Angle that the arc of a moment goes round. */
const ROUND = 1.5 * Math.PI;

/** A straight arrow. */
export function arrow(along: three.Vector3, at: three.Vector3, length: number, size: number, colour: string): three.Object3D[] {
  const material = new three.MeshBasicMaterial({ color: colour });
  const [head, radius] = [Math.min(0.05 * size, 0.6 * length), 0.004 * size];
  const shaft = new three.Mesh(new three.CylinderGeometry(radius, radius, length - head, 12), material);
  const tip = new three.Mesh(new three.ConeGeometry(0.35 * head, head, 20), material);
  const direction = along.clone().normalize();
  for (const [mesh, middle] of [[shaft, (length - head) / 2], [tip, length - head / 2]] as const) {
    mesh.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), direction);
    mesh.position.copy(at).addScaledVector(direction, middle);
  }
  return [shaft, tip];
}

class Arc extends three.Curve<three.Vector3> {
  constructor(
    private readonly at: three.Vector3,
    private readonly x: three.Vector3,
    private readonly y: three.Vector3,
  ) {
    super();
  }

  override getPoint(t: number, out = new three.Vector3()): three.Vector3 {
    const angle = t * ROUND;
    return out.copy(this.at).addScaledVector(this.x, Math.cos(angle)).addScaledVector(this.y, Math.sin(angle));
  }
}

/** An arc with a head that turns about `axis` by the right hand, with a thin line along the axis, and the point for its value. */
export function arcArrow(axis: three.Vector3, at: three.Vector3, radius: number, colour: string): { bodies: three.Object3D[]; label: three.Vector3; points: three.Vector3[] } {
  const z = axis.clone().normalize();
  const helper = Math.abs(z.z) < 0.9 ? new three.Vector3(0, 0, 1) : new three.Vector3(1, 0, 0);
  const x = helper.cross(z).normalize().multiplyScalar(radius);
  const y = z.clone().cross(x);
  const arc = new Arc(at, x, y);
  const material = new three.MeshBasicMaterial({ color: colour });
  const tube = new three.Mesh(new three.TubeGeometry(arc, 48, 0.045 * radius, 8, false), material);
  const head = new three.Mesh(new three.ConeGeometry(0.16 * radius, 0.42 * radius, 20), material);
  const along = arc.getTangent(1);
  head.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), along);
  head.position.copy(arc.getPoint(1)).addScaledVector(along, 0.18 * radius);
  const ends = [-1.3, 1.3].map((k) => at.clone().addScaledVector(z, k * radius));
  const line = new three.Line(new three.BufferGeometry().setFromPoints(ends), new three.LineBasicMaterial({ color: colour }));
  const label = at.clone().addScaledVector(x, -1.15).addScaledVector(y, 0.3);
  return { bodies: [tube, head, line], label, points: [...arc.getPoints(16), ...ends] };
}

/** Side of the picture of the base axes, px. */
const SIDE = 76;

/** Draws the base axes as the camera sees them. */
export function showAxes(canvas: HTMLCanvasElement, camera: three.Camera, theme: Theme): void {
  const ratio = 2;
  [canvas.width, canvas.height] = [ratio * SIDE, ratio * SIDE];
  const context = canvas.getContext("2d")!;
  context.scale(ratio, ratio);
  context.translate(SIDE / 2, SIDE / 2);
  context.globalAlpha = 0.7;
  context.fillStyle = theme.back;
  context.arc(0, 0, SIDE / 2, 0, 2 * Math.PI);
  context.fill();
  context.globalAlpha = 1;
  [context.lineWidth, context.lineCap, context.textAlign, context.textBaseline] = [2.5, "round", "center", "middle"];
  context.font = "700 13px system-ui, sans-serif";
  const turn = camera.quaternion.clone().invert();
  const axes = ["x", "y", "z"].map((name, k) => ({ name, v: new three.Vector3().setComponent(k, 1).applyQuaternion(turn), colour: theme.axes[k]! }));
  // The axis that points to the viewer is drawn last.
  for (const { name, v, colour } of axes.sort((a, b) => a.v.z - b.v.z)) {
    context.strokeStyle = colour;
    context.fillStyle = colour;
    context.beginPath();
    context.moveTo(0, 0);
    context.lineTo(22 * v.x, -22 * v.y);
    context.stroke();
    // Seen along an axis, its letter would lie on the others.
    if (Math.hypot(v.x, v.y) > 0.25) {
      context.fillText(name, 31 * v.x, -31 * v.y);
    }
  }
}
