// The space in which the machine stands: camera, light, floor, names, and what is dragged.

import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import type { State, Vec3 } from "./api";
import { DARK, LIGHT, byShare, type Theme } from "./colour";
import { deflected, dispose, machine, vector } from "./machine3d";
import { round, scaleOf, shown, type Store } from "./store";

/** Directions from which the machine is looked at, by the button's word. */
export const VIEWS: Record<string, Vec3> = { Oblique: [1, -1.4, 0.8], Front: [0, -1, 0], Side: [1, 0, 0], Top: [0, 0, 1] };

export class Stage {
  readonly renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  private readonly scene = new three.Scene();
  private readonly camera = new three.PerspectiveCamera(32, 1, 1, 1e6);
  private readonly controls: OrbitControls;
  private readonly labels = document.createElement("div");
  private readonly note = document.createElement("p");
  private readonly forceTip = handle("Force on the tool: drag its tip");
  private readonly toolTip = handle("Tool: drag it");
  private bodies = new three.Group();
  private over = new three.Group();
  readonly extra = new three.Group();
  private started = performance.now();
  /** Something is to be drawn: nothing moves by itself but a machine that swings. */
  private isOld = true;
  private dragged: "force" | "tool" | null = null;
  /** N for a millimetre of the arrow while it is dragged; else the arrow has one length for every force. */
  private unit: number | null = null;

  constructor(
    private readonly place: HTMLElement,
    private readonly store: Store,
  ) {
    this.labels.className = "labels";
    this.note.className = "scale";
    this.note.setAttribute("role", "status");
    place.append(this.renderer.domElement, this.labels, this.note);
    this.renderer.domElement.tabIndex = 0;
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.listenToKeyEvents(this.renderer.domElement);
    this.controls.addEventListener("change", () => (this.isOld = true));
    this.camera.up.set(0, 0, 1);
    const sun = new three.DirectionalLight(0xffffff, 1.8);
    sun.position.set(0.6, -1, 1.6);
    this.scene.add(new three.HemisphereLight(0xffffff, 0x888888, 1.6), sun, this.extra, this.forceTip, this.toolTip);
    this.listen();
    new ResizeObserver(() => this.resize()).observe(place);
    this.resize();
    this.look("Oblique");
    this.renderer.setAnimationLoop(() => this.frame());
  }

  theme(): Theme {
    return this.dark() ? DARK : LIGHT;
  }

  dark(): boolean {
    return this.store.look.dark ?? window.matchMedia("(prefers-color-scheme: dark)").matches;
  }

  /** Turns the camera, and takes all of the machine into view. */
  look(view: string): void {
    const box = this.box();
    const middle = box.getCenter(new three.Vector3());
    // Seen across, a machine is about as large as its diagonal; on a narrow screen nothing hides beside it.
    const narrow = Math.min(this.camera.aspect, 1);
    const share = this.camera.aspect < 1 ? 0.6 : 0.5;
    const away = (share * box.getSize(new three.Vector3()).length()) / Math.tan((Math.PI / 360) * this.camera.fov);
    this.camera.position.copy(middle).addScaledVector(vector(VIEWS[view] ?? VIEWS.Oblique!).normalize(), away / narrow);
    this.controls.target.copy(middle);
    this.controls.update();
  }

  private box(): three.Box3 {
    const box = new three.Box3();
    this.store.state?.scene.bars.forEach((bar) => bar.ends_mm.forEach((end) => box.expandByPoint(vector(end))));
    return box.isEmpty() ? new three.Box3(new three.Vector3(-500, -500, -500), new three.Vector3(500, 500, 500)) : box;
  }

  /** Draws the state anew. */
  draw(): void {
    const { state, look } = this.store;
    const theme = this.theme();
    this.scene.background = new three.Color(theme.back);
    document.documentElement.dataset.theme = this.dark() ? "dark" : "light";
    if (state === null) {
      return;
    }
    dispose(this.bodies);
    this.bodies = machine(state.scene, theme, limbColours(this.store));
    this.bodies.add(floor(this.box(), theme));
    if (look.ellipsoid || look.rotary) {
      this.bodies.add(...ellipsoids(state, this.store, theme));
    }
    this.bodies.add(...this.load(state, theme));
    this.scene.add(this.bodies);
    this.overdraw(1);
    this.words(state);
    const factor = scaleOf(this.store);
    const mode = look.swing ? this.store.modes?.modes[look.swing - 1] : undefined;
    const bent = mode ? `Mode ${look.swing}, ${mode.words}; its size is free. ` : state.deflected === null ? "" : `Deflection drawn ${shown(factor)} times larger. `;
    this.isOld = true;
    this.note.textContent = `${bent}Squares of ${shown(step(this.box()))} mm`;
  }

  /** The deflected machine, at a share of the factor. */
  private overdraw(share: number): void {
    const motion = this.store.motion();
    dispose(this.over);
    this.over = new three.Group();
    if (motion !== null) {
      this.over = deflected(motion.from, motion.to, share * scaleOf(this.store), this.theme());
      this.scene.add(this.over);
    }
  }

  /** Force and tool with their handles. */
  private load(state: State, theme: Theme): three.Object3D[] {
    const size = this.store.machine.size_mm;
    const at = vector(state.tool.position_mm);
    const force = vector(state.force_n);
    const length = force.length() === 0 ? 0 : this.unit === null ? 0.22 * size : force.length() / this.unit;
    const out: three.Object3D[] = [];
    if (length > 0) {
      out.push(new three.ArrowHelper(force.clone().normalize(), at, length, theme.force, 0.05 * size, 0.025 * size));
    }
    const tip = at.clone().addScaledVector(force.length() === 0 ? new three.Vector3(0, 0, 1) : force.clone().normalize(), length === 0 ? 0.12 * size : length);
    const mayDrag = this.store.source.live && this.store.request.place === undefined;
    for (const [own, place] of [[this.forceTip, tip], [this.toolTip, at]] as const) {
      own.position.copy(place);
      own.scale.setScalar(0.014 * size);
      own.visible = mayDrag;
    }
    (this.forceTip.material as three.MeshBasicMaterial).color.set(theme.force);
    (this.toolTip.material as three.MeshBasicMaterial).color.set(theme.moved);
    const triad = new three.AxesHelper(0.08 * size);
    triad.position.copy(at);
    triad.quaternion.set(...state.tool.quaternion_xyzw);
    out.push(triad);
    return out;
  }

  private words(state: State): void {
    const list = this.store.look.names ? state.scene.words : [];
    const force = vector(state.force_n).length();
    const all = list.map((word) => ({ at: vector(word.at_mm), text: word.text }));
    if (force > 0) {
      all.push({ at: this.forceTip.position.clone(), text: `${shown(force)} N` });
    }
    this.labels.replaceChildren(
      ...all.map(({ at, text }) => {
        const own = document.createElement("span");
        own.textContent = text;
        own.dataset.at = at.toArray().join(",");
        return own;
      }),
    );
  }

  private frame(): void {
    if (this.store.look.swing !== null && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) {
      this.overdraw(Math.sin((performance.now() - this.started) / 400));
      this.isOld = true;
    }
    this.controls.update();
    if (!this.isOld) {
      return;
    }
    this.isOld = false;
    this.renderer.render(this.scene, this.camera);
    const { width, height } = this.renderer.domElement.getBoundingClientRect();
    for (const own of this.labels.children as HTMLCollectionOf<HTMLElement>) {
      const [x, y, z] = (own.dataset.at ?? "").split(",").map(Number);
      const at = new three.Vector3(x, y, z).project(this.camera);
      own.style.transform = `translate(${((at.x + 1) / 2) * width + 8}px, ${((1 - at.y) / 2) * height - 8}px)`;
      own.hidden = at.z > 1;
    }
    for (const [own, name] of [[this.toolTip, "tool"], [this.forceTip, "force"]] as const) {
      const at = own.position.clone().project(this.camera);
      this.place.dataset[name] = `${((at.x + 1) / 2) * width},${((1 - at.y) / 2) * height}`;
    }
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = Math.max(width, 1) / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.isOld = true;
  }

  /** What is under the pointer, and where the pointer is in the plane through a point that faces the camera. */
  private ray(event: PointerEvent): three.Raycaster {
    const box = this.renderer.domElement.getBoundingClientRect();
    const at = new three.Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    const ray = new three.Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray;
  }

  private listen(): void {
    const canvas = this.renderer.domElement;
    // Before the camera's own listener, which would turn the view.
    const first = { capture: true };
    const down = (event: PointerEvent) => {
      const hit = this.ray(event).intersectObjects([this.forceTip, this.toolTip].filter((own) => own.visible))[0];
      this.dragged = hit === undefined ? null : hit.object === this.forceTip ? "force" : "tool";
      this.controls.enabled = this.dragged === null;
      if (this.dragged !== null) {
        canvas.setPointerCapture(event.pointerId);
        const force = vector(this.store.state?.force_n ?? [0, 0, 0]).length();
        this.unit = (force || 100) / (0.22 * this.store.machine.size_mm);
      }
    };
    canvas.addEventListener("pointerdown", down, first);
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("pointerup", () => {
      if (this.dragged !== null) {
        this.dragged = null;
        this.unit = null;
        this.controls.enabled = true;
        this.draw();
      }
    });
  }

  private drag(event: PointerEvent): void {
    const { state } = this.store;
    if (this.dragged === null || state === null) {
      return;
    }
    const from = (this.dragged === "force" ? this.forceTip : this.toolTip).position;
    const facing = new three.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new three.Vector3()), from);
    const at = this.ray(event).ray.intersectPlane(facing, new three.Vector3());
    if (at === null) {
      return;
    }
    const digits = (v: three.Vector3): Vec3 => v.toArray().map((x) => Number(x.toPrecision(4))) as Vec3;
    if (this.dragged === "tool") {
      this.store.change({ at_mm: digits(at) });
      return;
    }
    const arm = at.sub(vector(state.tool.position_mm));
    this.store.change({ force_n: digits(arm.multiplyScalar(this.unit ?? 1)) });
  }
}

function handle(name: string): three.Mesh {
  const mesh = new three.Mesh(new three.SphereGeometry(1, 18, 12), new three.MeshBasicMaterial());
  mesh.name = name;
  return mesh;
}

/** Side of the squares on the floor, mm. */
function step(box: three.Box3): number {
  return round(box.getSize(new three.Vector3()).length() / 8);
}

/** Squares of a round length on the floor. */
function floor(box: three.Box3, theme: Theme): three.GridHelper {
  const size = box.getSize(new three.Vector3()).length();
  const side = step(box);
  const count = 2 * Math.ceil((0.8 * size) / side);
  const grid = new three.GridHelper(count * side, count, theme.grid, theme.grid);
  grid.rotateX(Math.PI / 2);
  const middle = box.getCenter(new three.Vector3());
  grid.position.set(Math.round(middle.x / side) * side, Math.round(middle.y / side) * side, box.min.z);
  return grid;
}

/** Colour of each limb by what is asked for. */
export function limbColours(store: Store): Map<number, string> {
  const found = new Map<number, string>();
  const values = limbValues(store);
  const most = Math.max(...values, 1e-300);
  values.forEach((value, limb) => found.set(limb, byShare(value / most)));
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
function ellipsoids(state: State, store: Store, theme: Theme): three.Object3D[] {
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
