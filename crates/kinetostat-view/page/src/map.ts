// A quantity over places of the workspace: asked line by line, and drawn as it comes.

import * as three from "three";

import type { Vec3 } from "./api";
import { scaleOver, strip } from "./colour";
import { Computation, choice, fields, typed, type Run } from "./computation";
import type { Label } from "./labels";
import { vector } from "./machine3d";
import { MapCells, cornersOf, type MapPlace, type MapPlanes } from "./map3d";
import { button, element } from "./panel";
import type { Guest, Stage } from "./stage";
import { round, shown, type Store } from "./store";

/** Axes of the lines, across them in the plane, and of its normal. */
const PLANES: Record<string, [number, number, number]> = { xy: [0, 1, 2], xz: [0, 2, 1], yz: [1, 2, 0] };

/** Units as they are read: factor and word of the SI unit. */
const UNITS: Record<string, [number, string]> = { "N/m": [1e-6, "N/um"], "N m/rad": [1e-3, "N m/mrad"], m: [1e6, "um"], rad: [1e3, "mrad"], "1": [1, ""] };

/** A map with its variable and its state. */
interface Shown {
  planes: MapPlanes;
  name: string;
  unit: string;
  /** Load and orientation of the tool: with others the map is another one. */
  under: number[];
}

export class MapView implements Guest {
  readonly computation: Computation;
  private readonly variable: HTMLSelectElement;
  private readonly meaning = element("p", { class: "unit" });
  private readonly plane = choice("Plane", { xy: "xy", xz: "xz", yz: "yz" }, "xy");
  private readonly layers = choice("Number of planes", { 1: "one", 5: "5, a volume" }, "1");
  private readonly fine = choice("Places along a side", { 11: "11 places a side", 21: "21 places a side", 41: "41 places a side" }, "21");
  private readonly ends = ["x", "y", "z"].map((axis) => [typed(`Map ${axis} from, mm`, ""), typed(`Map ${axis} to, mm`, "")] as const);
  private readonly remove = button("Remove", () => this.clear(), "Take the map out of the picture");
  private readonly legend = element("p", { class: "legend maplegend", hidden: "" });
  private readonly cells = new MapCells();
  private readonly marker = new three.Mesh(new three.SphereGeometry(1, 16, 12), new three.MeshBasicMaterial());
  private map: Shown | null = null;
  /** True once the user typed places or computed a map; before, the places follow the tool. */
  private isPlaced = false;
  private drawn = "";

  constructor(
    private readonly store: Store,
    private readonly stage: Stage,
  ) {
    const { variables } = store.machine;
    this.variable = choice("Variable", Object.fromEntries(variables.map(({ name }) => [name, inWords(name)])), "stiffness_softest");
    [...this.variable.options].forEach((option, i) => (option.title = variables[i]!.description));
    this.variable.addEventListener("change", () => this.explain());
    [this.plane, this.layers].forEach((own) => own.addEventListener("change", () => this.fill(true)));
    this.ends.flat().forEach((own) => own.addEventListener("input", () => (this.isPlaced = true)));
    const ends = this.ends.map((pair, k) => fields(`${"xyz"[k]} from, to`, "mm", ...pair));
    const rows = [fields("Variable", "", this.variable), this.meaning, fields("Plane", "", this.plane), fields("Planes", "", this.layers), ...ends, fields("Fineness", "", this.fine)];
    const around = button("Around the tool", () => this.fill(false), "Places around the tool, as far as the machine is large");
    this.computation = new Computation(store, "Map of the workspace", rows, (run) => this.compute(run), "Compute", [around, this.remove]);
    this.explain();
    this.fill(false);
    [this.marker.visible, this.remove.hidden] = [false, true];
    stage.foot.append(this.legend);
    stage.extra.add(this.cells.group, this.marker);
    stage.guests.push(this);
  }

  show(): void {
    if (!this.isPlaced) {
      this.fill(false);
    }
    this.computation.show(this.isOld(), "Of the state before, with another load or orientation of the tool: compute again.");
    const look = `${this.stage.dark()} ${this.isOld()} ${this.stage.glyph()}`;
    if (look !== this.drawn) {
      this.drawn = look;
      this.draw();
    }
  }

  pick(_x: number, _y: number, _project: unknown, ray: three.Raycaster): (() => void) | null {
    const place = this.cells.pick(ray);
    return place === null ? null : () => this.go(place);
  }

  points(): three.Vector3[] {
    return this.map?.planes.flatMap(cornersOf) ?? [];
  }

  /** The value at the worst place. */
  words(): Label[] {
    const worst = this.found()?.worst;
    return worst === undefined ? [] : [{ at: vector(worst.at), text: `${superlative(this.map!.name)}: ${this.valueOf(worst)}`, isNeeded: true }];
  }

  private explain(): void {
    this.meaning.textContent = this.store.machine.variables.find((own) => own.name === this.variable.value)?.description ?? "";
  }

  /** Places around the tool, as far as the machine is large; ranges that the user typed may be kept. */
  private fill(isKept: boolean): void {
    const at = this.store.state?.tool.position_mm ?? [0, 0, 0];
    const [, , normal] = PLANES[this.plane.value]!;
    const half = 0.75 * round(this.store.machine.size_mm);
    this.ends.forEach(([from, to], k) => {
      const isRange = k !== normal || this.layers.value !== "1";
      to.hidden = !isRange;
      if (!(isKept && this.isPlaced && isRange && from.value !== to.value)) {
        const far = k !== normal ? half : isRange ? half / 2 : 0;
        [from, to].forEach((own, end) => (own.value = String(Number((at[k]! + (2 * end - 1) * far).toFixed(k === normal ? 3 : 0)))));
      }
    });
    this.isPlaced &&= isKept;
  }

  /** The places that are asked for, without values. */
  private places(): MapPlanes {
    const [along, across, normal] = PLANES[this.plane.value]!;
    const list = (axis: number, count: number): number[] => {
      const [from, to] = this.ends[axis]!.map((own) => own.valueAsNumber) as [number, number];
      return Array.from({ length: count }, (_, i) => (count > 1 ? Math.min(from, to) + (Math.abs(to - from) * i) / (count - 1) : from));
    };
    const place = (plane: number, line: number, x: number): MapPlace => {
      const at: Vec3 = [0, 0, 0];
      [at[along], at[across], at[normal]] = [x, line, plane];
      return { at };
    };
    const [lines, xs] = [list(across, Number(this.fine.value)), list(along, Number(this.fine.value))];
    return list(normal, Number(this.layers.value)).map((plane) => lines.map((line) => xs.map((x) => place(plane, line, x))));
  }

  /** Load and orientation of the tool now. */
  private under(): number[] {
    const { force_n = [], moment_n_m = [], tool } = this.store.state ?? {};
    const q = tool?.quaternion_xyzw ?? [];
    // A quaternion and its opposite are the same orientation.
    return [...force_n, ...moment_n_m, ...q.flatMap((a) => q.map((b) => a * b))];
  }

  private isOld(): boolean {
    const now = this.under();
    return this.map?.under.some((x, i) => Math.abs(x - (now[i] ?? NaN)) > 1e-9 * Math.max(1, Math.abs(x))) ?? false;
  }

  private async compute(run: Run): Promise<void> {
    const { machine, source } = this.store;
    const variable = this.variable.value;
    const si = machine.variables.find((own) => own.name === variable)?.unit ?? "";
    const [factor, unit] = UNITS[si] ?? [1, si];
    const map: Shown = { planes: this.places(), name: variable, unit, under: this.under() };
    const lines = map.planes.flat();
    const counts = [0, 1, 2].map((axis) => (axis === PLANES[this.plane.value]![0] ? lines[0]!.length : 1)) as Vec3;
    const all = map.planes.flat(2);
    const progress = () => `${run.isStopped ? "Stopped: " : ""}${all.filter((place) => place.value !== undefined).length} of ${all.length} places.`;
    this.isPlaced = true;
    this.map = map;
    this.stage.refit();
    for (const line of lines) {
      this.computation.say(progress());
      const { values } = await source.ask("map", { state: run.state, variable, from_mm: line[0]!.at, to_mm: line[line.length - 1]!.at, counts });
      line.forEach((place, i) => (place.value = typeof values[i] === "number" ? factor * values[i] : null));
      if (this.map !== map) {
        return;
      }
      this.draw();
      if (run.isStopped) {
        break;
      }
    }
    const without = all.filter((place) => place.value === null).length;
    this.computation.say(`${progress()}${without > 0 ? ` ${without} have no value: out of reach, without an equilibrium, or not finite.` : ""}`);
    this.summarise();
    this.store.draw({});
  }

  /** The places with the least, the most and the least favourable value; null without any. */
  private found(): { least: MapPlace; most: MapPlace; worst: MapPlace } | null {
    const known = this.map?.planes.flat(2).filter((place) => typeof place.value === "number") ?? [];
    if (known.length === 0) {
      return null;
    }
    const [least, most] = [known.reduce((a, b) => (b.value! < a.value! ? b : a)), known.reduce((a, b) => (b.value! > a.value! ? b : a))];
    return { least, most, worst: isHighWorse(this.map!.name) ? most : least };
  }

  private valueOf({ value }: MapPlace): string {
    return `${shown(value!)} ${this.map!.unit}`.trim();
  }

  /** Draws cells and legend by the values that are known. */
  private draw(): void {
    const { map, stage } = this;
    const found = this.found();
    if (map === null || found === null) {
      return;
    }
    const dark = stage.dark();
    const scale = scaleOver(found.least.value!, found.most.value!, isHighWorse(map.name));
    this.cells.show(map.planes, scale, dark, stage.theme().joint);
    const half = (k: number) => strip((share) => scale.colour((k + share) / 2, dark));
    const words = `${inWords(map.name)}${map.unit === "" ? "" : `, ${map.unit}`}${this.isOld() ? " (of the state before)" : ""}: `;
    const [low, middle, high] = [scale.low, scale.middle, scale.high].map((x) => element("span", {}, shown(x)));
    this.legend.replaceChildren(words.charAt(0).toUpperCase() + words.slice(1), low!, half(0), middle!, half(1), high!);
    this.marker.position.copy(vector(found.worst.at));
    this.marker.scale.setScalar(0.008 * stage.glyph());
    this.marker.material.color.set(stage.theme().alert);
    [this.marker.visible, this.legend.hidden, this.remove.hidden] = [true, false, false];
    stage.refresh();
  }

  /** The ends of the values, each with its place. */
  private summarise(): void {
    const found = this.found();
    if (found === null) {
      return;
    }
    const row = (label: string, place: MapPlace) => [element("dt", {}, label), element("dd", {}, this.valueOf(place), element("small", {}, `at (${place.at.map(shown).join(", ")}) mm`))];
    const go = button(`Go to the ${superlative(this.map!.name)} place`, () => this.go(found.worst));
    this.computation.output.replaceChildren(element("dl", {}, ...row("Least", found.least), ...row("Most", found.most)), element("div", { class: "row" }, go), element("p", { class: "unit" }, "A click on the map sends the tool there."));
  }

  private go(place: MapPlace): void {
    this.computation.say(`Tool at (${place.at.map(shown).join(", ")}) mm: ${this.valueOf(place)}.`);
    this.store.change({ at_mm: place.at });
  }

  private clear(): void {
    this.map = null;
    this.cells.clear();
    [this.marker.visible, this.legend.hidden, this.remove.hidden] = [false, true, true];
    this.computation.clear();
    this.store.draw({});
  }
}

/** Name of a variable in words: `stiffness_softest` is the softest stiffness. */
function inWords(name: string): string {
  const words = name.replaceAll("_", " ").replace(/^f(\d)$/, "natural frequency $1");
  return words.replace(/^(.*stiffness) (softest|stiffest)$/, "$2 $1").replace(/^(rotational.*) ([xyz])$/, "$1 about $2").replace(/^(stiffness) ([xyz])$/, "$1 along $2");
}

/** True if high values are unfavourable. */
const isHighWorse = (name: string) => /^(deflection|rotation$|effort|share)/.test(name);

/** Adjective of the least favourable place. */
const superlative = (name: string) => (name.includes("stiffness") ? "softest" : "worst");
