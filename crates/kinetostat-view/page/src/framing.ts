// Where the camera stands so that all of a thing is in the picture.

import * as three from "three";

/** Share of the picture that is filled. */
const FILLED = 0.78;

/** Looks at points from a direction, from as near as all are seen; returns the point at which the camera looks. */
export function frame(camera: three.PerspectiveCamera, points: three.Vector3[], direction: three.Vector3): three.Vector3 {
  const target = new three.Box3().setFromPoints(points).getCenter(new three.Vector3());
  const tangent = Math.tan((Math.PI / 360) * camera.fov);
  const [wide, high] = [FILLED * tangent * camera.aspect, FILLED * tangent];
  // The middle of what is seen is another one than the middle of the box.
  for (let pass = 0; pass < 4; pass += 1) {
    camera.position.copy(target).add(direction);
    camera.lookAt(target);
    const back = camera.quaternion.clone().invert();
    const seen = points.map((point) => point.clone().sub(target).applyQuaternion(back));
    const away = seen.reduce((most, p) => Math.max(most, p.z + Math.abs(p.x) / wide, p.z + Math.abs(p.y) / high), 1);
    const middle = (k: "x" | "y") => {
      const all = seen.map((p) => p[k] / Math.max(away - p.z, 1e-9));
      return (away * (all.reduce((a, b) => Math.max(a, b)) + all.reduce((a, b) => Math.min(a, b)))) / 2;
    };
    const shift = new three.Vector3(middle("x"), middle("y"), 0).applyQuaternion(camera.quaternion);
    target.add(shift);
    camera.position.copy(target).addScaledVector(direction, away);
  }
  return target;
}
