// What is drawn by values of a state: colours of limbs, ellipsoids of the compliance.

import * as three from "three";

import type { State, Vec3 } from "./api";
import { byShare, type Theme } from "./colour";
import { vector } from "./machine3d";
import type { Store } from "./store";

/** Colour of each limb by what is asked for. */
export function limbColours(store: Store, dark: boolean): Map<number, string> {
  const found = new Map<number, string>();
  const values = limbValues(store);
  const most = Math.max(...values, 1e-300);
  values.forEach((value, limb) => found.set(limb, byShare(value / most, dark)));
  return found;
}

/** Value of each limb by what is asked for; empty for plain colours. */
export function limbValues(store: Store): number[] {
  const { state, look, machine: own } = store;
  if (state === null || look.colours === "none") {
    return [];
  }
  return own.limbs.map((limb) => {
    const load = state.limb_loads.find((other) => other.limb === limb);
    switch (look.colours) {
      case "share":
        return state.shares.filter((share) => share.limb === limb).reduce((sum, share) => sum + share.percent, 0);
      case "load":
        return Math.hypot(...(load?.force_n ?? [0, 0, 0]));
      default:
        return 100 * (load?.share_to_buckling ?? 0);
    }
  });
}

/** Ellipsoids whose half axes are the displacements by a force in any direction, or the turns by a moment. */
export function ellipsoids(state: State, store: Store, theme: Theme): three.Object3D[] {
  const { machine: own, look } = store;
  const one = (axes: Vec3[], values: number[], colour: string) => {
    const most = Math.max(...values, 1e-300);
    const mesh = new three.Mesh(new three.SphereGeometry(1, 32, 20), new three.MeshStandardMaterial({ color: colour, transparent: true, opacity: 0.35, depthWrite: false }));
    const [x, y, z] = axes.map(vector);
    const basis = new three.Matrix4().makeBasis(x!, y!, x!.clone().cross(y!).dot(z!) < 0 ? z!.negate() : z!);
    mesh.setRotationFromMatrix(basis);
    mesh.scale.set(...(values.map((v) => Math.max((0.14 * own.size_mm * v) / most, 0.002 * own.size_mm)) as Vec3));
    mesh.position.copy(vector(state.tool.position_mm));
    return mesh;
  };
  const out: three.Object3D[] = [];
  if (look.ellipsoid && state.compliance) {
    out.push(one(state.compliance.axes, state.compliance.um_per_n, theme.force));
  }
  if (look.rotary && state.rotary_compliance) {
    out.push(one(state.rotary_compliance.axes, state.rotary_compliance.urad_per_n_m, theme.moved));
  }
  return out;
}
