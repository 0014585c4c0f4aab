// A scene of the server as bodies in space: millimetres, base axes, z up.

import * as three from "three";

import type { Bar, Joint, Scene, Vec3 } from "./api";
import type { Theme } from "./colour";

export const vector = (v: Vec3) => new three.Vector3(...v);

/** A bar as a curve: a cubic with the bar's ends and directions. */
function curve(bar: Bar): three.Curve<three.Vector3> {
  const [a, b] = [vector(bar.ends_mm[0]), vector(bar.ends_mm[1])];
  const [u, v] = [vector(bar.tangents_mm[0]), vector(bar.tangents_mm[1])];
  const chord = b.clone().sub(a);
  const bent = u.clone().sub(chord).length() + v.clone().sub(chord).length();
  if (bent < 1e-6 * chord.length()) {
    return new three.LineCurve3(a, b);
  }
  return new three.CubicBezierCurve3(a, a.clone().addScaledVector(u, 1 / 3), b.clone().addScaledVector(v, -1 / 3), b);
}

/** The bar where it is drawn: as commanded, moved on by the deflection times a factor. */
export function moved(bar: Bar, to: Bar | undefined, factor: number): Bar {
  if (to === undefined) {
    return bar;
  }
  const between = (a: Vec3, b: Vec3): Vec3 => [0, 1, 2].map((k) => a[k]! + factor * (b[k]! - a[k]!)) as Vec3;
  const pair = (a: [Vec3, Vec3], b: [Vec3, Vec3]): [Vec3, Vec3] => [between(a[0], b[0]), between(a[1], b[1])];
  return { ...bar, ends_mm: pair(bar.ends_mm, to.ends_mm), tangents_mm: pair(bar.tangents_mm, to.tangents_mm) };
}

const RADIUS: Record<Bar["kind"], number> = { rigid: 0.006, elastic: 0.011, rod: 0.006, ram: 0.009, twice: 0, rail: 0.003, spring: 0.004 };

/** A bar as a tube; none for one that another covers. */
export function tube(bar: Bar, size: number, material: three.Material, thin = 1): three.Mesh | null {
  const radius = RADIUS[bar.kind] * size * thin;
  const line = curve(bar);
  if (radius === 0 || line.getLength() < 1e-6) {
    return null;
  }
  const pieces = line instanceof three.LineCurve3 ? 1 : 16;
  return new three.Mesh(new three.TubeGeometry(line, pieces, radius, 10, false), material);
}

/** A joint: drives are dark, passive ones pale. */
function joint(own: Joint, size: number, theme: Theme): three.Object3D {
  const isDrive = own.kind === "motor" || own.kind === "sleeve";
  const material = new three.MeshStandardMaterial({ color: isDrive ? theme.drive : theme.joint, roughness: 0.7 });
  const [r, half] = [0.018 * size, Math.max(own.half_mm, 0.02 * size)];
  const disc = (radius: number, length: number) => new three.CylinderGeometry(radius, radius, length, 28);
  const shapes: three.BufferGeometry[] = (() => {
    switch (own.kind) {
      case "motor":
        return [disc(1.5 * r, 2 * half)];
      case "sleeve":
      case "slide":
        return [new three.BoxGeometry(2 * r, 2 * half, 2 * r)];
      case "turn":
        return [disc(r, 1.6 * r)];
      case "universal":
        return [disc(0.9 * r, 1.6 * r), disc(0.9 * r, 1.6 * r).rotateZ(Math.PI / 2)];
      case "spherical":
        return [new three.SphereGeometry(1.1 * r, 20, 14)];
      case "spring":
        return [new three.TorusGeometry(0.9 * r, 0.3 * r, 8, 20).rotateX(Math.PI / 2)];
    }
  })();
  const group = new three.Group();
  shapes.forEach((shape) => group.add(new three.Mesh(shape, material)));
  const y = vector(own.axis).normalize();
  const x = vector(own.across).normalize();
  group.setRotationFromMatrix(new three.Matrix4().makeBasis(x, y, x.clone().cross(y)));
  group.position.copy(vector(own.at_mm));
  return group;
}

/** A body between limbs, as a fan around its middle. */
function plate(points: Vec3[], theme: Theme): three.Mesh {
  const middle = points.reduce((sum, p) => sum.add(vector(p)), new three.Vector3()).divideScalar(points.length);
  const corners = points.flatMap((p, i) => [middle, vector(p), vector(points[(i + 1) % points.length]!)]);
  const geometry = new three.BufferGeometry().setFromPoints(corners);
  geometry.computeVertexNormals();
  const material = new three.MeshStandardMaterial({ color: theme.plate, transparent: true, opacity: 0.45, side: three.DoubleSide, depthWrite: false });
  return new three.Mesh(geometry, material);
}

/** Ground: a pale disc into which a limb goes. */
function ground(at: Vec3, away: Vec3, size: number, theme: Theme): three.Mesh {
  const mesh = new three.Mesh(new three.CylinderGeometry(0.03 * size, 0.035 * size, 0.012 * size, 24), new three.MeshStandardMaterial({ color: theme.joint }));
  mesh.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), vector(away).normalize().negate());
  mesh.position.copy(vector(at).addScaledVector(vector(away).normalize(), 0.006 * size));
  return mesh;
}

/** The machine as it is commanded. `colours` has a colour for each limb that is to have one. */
export function machine(scene: Scene, theme: Theme, colours: Map<number, string>): three.Group {
  const group = new three.Group();
  const plain = (bar: Bar) => (bar.kind === "elastic" ? theme.elastic : theme.rigid);
  for (const bar of scene.bars) {
    const colour = (bar.limb === null ? undefined : colours.get(bar.limb)) ?? plain(bar);
    const mesh = tube(bar, scene.size_mm, new three.MeshStandardMaterial({ color: colour, roughness: 0.75 }));
    if (mesh !== null) {
      group.add(mesh);
    }
  }
  scene.joints.forEach((own) => group.add(joint(own, scene.size_mm, theme)));
  scene.plates.forEach((own) => group.add(plate(own.points_mm, theme)));
  scene.grounds.forEach((own) => group.add(ground(own.at_mm, own.away, scene.size_mm, theme)));
  return group;
}

/** The deflected machine, drawn over it. */
export function deflected(scene: Scene, to: Scene, factor: number, theme: Theme): three.Group {
  const group = new three.Group();
  const material = new three.MeshStandardMaterial({ color: theme.moved, transparent: true, opacity: 0.85, roughness: 0.6 });
  const same = scene.bars.length === to.bars.length;
  scene.bars.forEach((bar, i) => {
    const mesh = bar.kind === "rail" ? null : tube(same ? moved(bar, to.bars[i], factor) : bar, scene.size_mm, material, 0.55);
    if (mesh !== null) {
      group.add(mesh);
    }
  });
  return group;
}

/** Frees what a group holds on the graphics card. */
export function dispose(group: three.Object3D): void {
  group.traverse((own) => {
    const mesh = own as three.Mesh;
    mesh.geometry?.dispose();
    for (const material of [mesh.material].flat()) {
      material?.dispose?.();
    }
  });
  group.removeFromParent();
}
