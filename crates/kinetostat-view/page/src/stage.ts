// The space in which the machine stands: camera, light, floor, names, and what is dragged.

import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { isEmbedded } from "./address";
import type { SolidBox, State, Vec3 } from "./api";
import { arcArrow, arrow, showAxes } from "./arrows";
import { boxLabel, corners, solid } from "./boxes";
import { ellipsoids, limbColours } from "./byvalue";
import { DARK, LIGHT, type Theme } from "./colour";
import { frame } from "./framing";
import { Labels, type Label } from "./labels";
import { deflected, dispose, machine, vector } from "./machine3d";
import { stockMesh } from "./stock3d";
import { round, scaleOf, shown, type Store } from "./store";

/** Directions from which the machine is looked at, by the button's word. */
export const VIEWS: Record<string, Vec3> = { Oblique: [1, -1.4, 0.8], Front: [0, -1, 0], Side: [1, 0, 0], Top: [0, 0, 1] };

/** Length of the arrow of a force, as a share of the size of the machine. */
const ARROW = 0.22;

/** An object in the picture that is not part of the state, as a path or a map. */
export interface Guest {
  /** Finds what a click does at a point of the picture (px), or on the ray through it; null: nothing. */
  pick(x: number, y: number, project: (v: three.Vector3) => three.Vector3, ray: three.Raycaster): (() => void) | null;
  words?(): Label[];
  /** Points that a view of all has in it. */
  points?(): three.Vector3[];
}

export class Stage {
  readonly renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  private readonly scene = new three.Scene();
  private readonly camera = new three.PerspectiveCamera(32, 1, 1, 1e6);
  private readonly controls: OrbitControls;
  private readonly labels = new Labels();
  /** Points of arrows, which words do not cover. */
  private arrows: three.Vector3[] = [];
  private readonly triad = document.createElement("canvas");
  /** What stands at the foot of the picture: axes, scale, legends. */
  readonly foot = document.createElement("div");
  /** Objects of others in the picture; the first one that takes a click gets it. */
  readonly guests: Guest[] = [];
  private readonly note = document.createElement("p");
  private readonly forceTip = handle("Force on the tool: drag its tip");
  private readonly toolTip = handle("Tool: drag it");
  /** Size of arrows and marks as they are drawn now, mm. */
  private drawn = 1;
  /** View that was chosen last; null once the camera is turned by hand. */
  private view: string | null = null;
  private direction = new three.Vector3(0, 0, 1);
  private readonly momentLabel = new three.Vector3();
  private size = { width: 1, height: 1 };
  private bodies = new three.Group();
  private over = new three.Group();
  readonly extra = new three.Group();
  /** True while the page is printed. */
  isPrinted = false;
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
    this.foot.className = "foot";
    this.triad.setAttribute("role", "img");
    this.triad.setAttribute("aria-label", "Directions of the base axes x, y and z");
    this.note.className = "scale";
    this.note.setAttribute("role", "status");
    this.foot.append(this.triad, this.note);
    place.append(this.renderer.domElement, this.labels.element, this.foot);
    this.renderer.domElement.tabIndex = 0;
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.listenToKeyEvents(this.renderer.domElement);
    this.controls.addEventListener("change", () => (this.isOld = true));
    this.controls.addEventListener("start", () => (this.view = null));
    this.controls.addEventListener("end", () => this.fit());
    if (isEmbedded()) {
      // The wheel scrolls the page around until somebody works here.
      const canvas = this.renderer.domElement;
      this.controls.enableZoom = false;
      canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
      canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
    }
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

  /** True if the colours are those for a dark background; paper is light. */
  dark(): boolean {
    return !this.isPrinted && (this.store.look.dark ?? window.matchMedia("(prefers-color-scheme: dark)").matches);
  }

  /** Turns the camera, and takes all of the machine into view; or only the path, or the tool, from near. */
  look(view: string): void {
    this.view = view;
    const points = view === "Near" ? this.near() : [...this.points(), ...this.tip(), ...this.guests.flatMap((own) => own.points?.() ?? [])];
    if (view !== "Near") {
      this.direction = vector(VIEWS[view] ?? VIEWS.Oblique!).normalize();
    }
    const target = frame(this.camera, points, this.direction);
    this.controls.target.copy(target);
    this.controls.update();
    this.fit();
  }

  /** Size by which arrows and marks are drawn, mm: that of the machine, or less from near. */
  glyph(): number {
    return Math.min(this.store.machine.size_mm, 0.6 * this.camera.position.distanceTo(this.controls.target));
  }

  /** Draws arrows and marks in another size if the camera is much nearer or farther. */
  private fit(): void {
    const ratio = this.glyph() / this.drawn;
    if (this.dragged === null && (ratio < 0.8 || ratio > 1.25)) {
      this.drawn = this.glyph();
      this.store.draw({});
    }
  }

  /** Points that a view of all has in it. */
  private points(): three.Vector3[] {
    const { state, path } = this.store;
    const bars = state?.scene.bars.flatMap((bar) => bar.ends_mm.map(vector)) ?? [];
    const all = [...bars, ...(path?.places ?? []).map((own) => vector(own.position_mm)), ...this.boxes().flatMap(corners)];
    return all.length > 0 ? all : [new three.Vector3(-500, -500, -500), new three.Vector3(500, 500, 500)];
  }

  /** The tip of the arrow of the force, if there is one. */
  private tip(): three.Vector3[] {
    const { position_mm } = this.store.state?.tool ?? { position_mm: [0, 0, 0] };
    const force = vector(this.store.state?.force_n ?? [0, 0, 0]);
    return force.length() === 0 ? [] : [vector(position_mm).addScaledVector(force.normalize(), ARROW * this.store.machine.size_mm)];
  }

  /** Points around the path, or the tool. */
  private near(): three.Vector3[] {
    const places = (this.store.path?.places ?? []).map((own) => vector(own.position_mm));
    const tool = vector(this.store.state?.tool.position_mm ?? [0, 0, 0]);
    const box = new three.Box3().setFromPoints(places.length > 0 ? places : [tool]);
    box.expandByScalar(places.length > 0 ? 0.02 * this.store.machine.size_mm : 0.15 * this.store.machine.size_mm);
    return [box.min, box.max].flatMap((a) => [a, new three.Vector3(box.min.x, box.max.y, a.z), new three.Vector3(box.max.x, box.min.y, a.z)]);
  }

  private box(): three.Box3 {
    return new three.Box3().setFromPoints(this.points());
  }

  private boxes(): SolidBox[] {
    return this.store.look.boxes ? (this.store.path?.boxes ?? []) : [];
  }

  /** Draws the state anew. */
  draw(): void {
    const { state, look } = this.store;
    const theme = this.theme();
    this.scene.background = new three.Color(theme.back);
    document.documentElement.dataset.theme = this.dark() ? "dark" : "light";
    theme.axes.forEach((colour, k) => document.documentElement.style.setProperty(`--axis-${"xyz"[k]}`, colour));
    if (state === null) {
      return;
    }
    dispose(this.bodies);
    this.bodies = machine(state.scene, theme, limbColours(this.store, this.dark()));
    this.bodies.add(floor(this.box(), theme));
    if (look.ellipsoid || look.rotary) {
      this.bodies.add(...ellipsoids(state, this.store, theme));
    }
    const { stock } = this.store;
    const isLeft = stock !== null && look.boxes;
    this.boxes()
      .filter((own) => !isLeft || own.kind !== "stock")
      .forEach((own) => this.bodies.add(...solid(own, theme)));
    if (isLeft) {
      this.bodies.add(stockMesh(stock, theme));
    }
    this.bodies.add(...this.load(state, theme));
    this.scene.add(this.bodies);
    this.overdraw(1);
    this.labels.set(this.words(state));
    const factor = scaleOf(this.store);
    const mode = look.swing ? this.store.modes?.modes[look.swing - 1] : undefined;
    const bent = mode ? `Mode ${look.swing}, ${mode.words}; its size is free. ` : state.deflected === null ? "" : this.store.hasShape() ? "Drawn as large as it is. " : `Deflection drawn ${shown(factor)} times larger. `;
    this.isOld = true;
    this.note.textContent = `${bent}Squares of ${shown(step(this.box()))} mm.`;
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
    const size = this.glyph();
    const at = vector(state.tool.position_mm);
    const force = vector(state.force_n);
    const length = force.length() === 0 ? 0 : this.unit === null ? ARROW * size : force.length() / this.unit;
    const out: three.Object3D[] = [];
    this.arrows = [];
    if (length > 0) {
      this.arrows = Array.from({ length: 13 }, (_, k) => at.clone().addScaledVector(force, ((k / 12) * length) / force.length()));
      out.push(...arrow(force, at, length, size, theme.force));
    }
    const moment = vector(state.moment_n_m);
    if (moment.length() > 0) {
      const { bodies, label, points } = arcArrow(moment, at, 0.09 * size, theme.moment);
      out.push(...bodies);
      this.arrows.push(...points);
      this.momentLabel.copy(label);
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
    triad.setColors(...theme.axes);
    triad.position.copy(at);
    triad.quaternion.set(...state.tool.quaternion_xyzw);
    out.push(triad);
    return out;
  }

  /** Words of the picture, the most important first. */
  private words(state: State): Label[] {
    const out: Label[] = [];
    const force = vector(state.force_n).length();
    const moment = vector(state.moment_n_m).length();
    if (force > 0) {
      const beyond = vector(state.force_n).multiplyScalar((0.02 * this.glyph()) / force);
      out.push({ at: this.forceTip.position.clone().add(beyond), text: `${shown(force)} N`, isNeeded: true });
    }
    if (moment > 0) {
      out.push({ at: this.momentLabel.clone(), text: `${shown(moment)} N m`, isNeeded: true });
    }
    out.push(...this.boxes().map(boxLabel), ...this.guests.flatMap((own) => own.words?.() ?? []));
    const names = this.store.look.names ? state.scene.words : [];
    return [...out, ...names.map((word) => ({ at: vector(word.at_mm), text: word.text }))];
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
    this.render();
  }

  /** Draws the picture and puts the words over it. */
  private render(): void {
    this.isOld = false;
    this.renderer.render(this.scene, this.camera);
    showAxes(this.triad, this.camera, this.theme());
    const fixed = [...this.foot.children, ...this.place.querySelectorAll(".toolbar button")].map((own) => own.getBoundingClientRect());
    this.labels.place(this.project, this.arrows, fixed);
    for (const [own, name] of [[this.toolTip, "tool"], [this.forceTip, "force"]] as const) {
      const at = this.project(own.position);
      this.place.dataset[name] = `${at.x},${at.y}`;
    }
  }

  /** Has the picture drawn with the next frame. */
  refresh(): void {
    this.isOld = true;
  }

  /** The picture as it is now, and the element that it fills. */
  rendered(): { canvas: HTMLCanvasElement; frame: HTMLElement } {
    this.render();
    return { canvas: this.renderer.domElement, frame: this.place };
  }

  /** Where a point is in the picture, px; z is above 1 behind the camera. */
  private readonly project = (v: three.Vector3): three.Vector3 => {
    const { width, height } = this.size;
    const at = v.clone().project(this.camera);
    return at.set(((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height, at.z);
  };

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    this.size = { width, height };
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = Math.max(width, 1) / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.refit();
  }

  /** Takes all into view again, unless the camera was turned by hand. */
  refit(): void {
    this.isOld = true;
    if (this.view !== null) {
      this.look(this.view);
    }
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
        this.unit = (force || 100) / (ARROW * this.glyph());
      }
    };
    let pressed: [number, number] | null = null;
    const picked = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      const ray = this.ray(event);
      for (const guest of this.guests) {
        const found = guest.pick(event.clientX - box.left, event.clientY - box.top, this.project, ray);
        if (found !== null) {
          return found;
        }
      }
      return null;
    };
    canvas.addEventListener("pointerdown", down, first);
    canvas.addEventListener("pointerdown", (event) => (pressed = this.dragged === null ? [event.clientX, event.clientY] : null));
    canvas.addEventListener("pointermove", (event) => {
      this.drag(event);
      if (event.buttons === 0) {
        canvas.style.cursor = picked(event) === null ? "" : "pointer";
      }
    });
    canvas.addEventListener("pointerup", (event) => {
      // A click does not move; a turn of the view does.
      if (pressed !== null && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4) {
        picked(event)?.();
      }
      pressed = null;
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
