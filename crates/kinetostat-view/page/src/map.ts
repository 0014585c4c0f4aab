// A quantity over places of the workspace: asked line by line, and drawn as it comes.

import * as three from "three";

import type { StateRequest, Vec3 } from "./api";
import { Computation, choice, fields, typed, type Run } from "./computation";
import { scaleOver, strip } from "./colour";
import type { Label } from "./labels";
import { vector } from "./machine3d";
import { MapCells, cornersOf, inGrid, indexOf, placeOf, type Grid } from "./map3d";
import { button, element } from "./panel";
import type { Guest, Stage } from "./stage";
import { round, shown, type Store } from "./store";

/** Axes of the lines, across them in the plane, and of its normal. */
const PLANES: Record<string, [number, number, number]> = { xy: [0, 1, 2], xz: [0, 2, 1], yz: [1, 2, 0] };

/** Planes of a volume. */
const LAYERS = 5;

/** Units as they are read: factor and word of the SI unit. */
const UNITS: Record<string, [number, string]> = { "N/m": [1e-6, "N/um"], "N m/rad": [1e-3, "N m/mrad"], m: [1e6, "um"], rad: [1e3, "mrad"], "1": [1, ""] };

/** A map and what it is of. */
interface Shown {
  grid: Grid;
  values: (number | null | undefined)[];
  name: string;
  factor: number;
  unit: string;
  /** Load and orientation of the tool: with others the map is another one. */
  under: number[];
}

export class MapView implements Guest {
  readonly computation: Computation;
  private readonly variable: HTMLSelectElement;
  private readonly meaning = element("p", { class: "unit" });
  private readonly plane = choice("Plane", { xy: "xy", xz: "xz", yz: "yz" }, "xy");
  private readonly layers = choice("Number of planes", { 1: "one", [LAYERS]: `${LAYERS}, a volume` }, "1");
  private readonly fine = choice("Places along a side", { 11: "11 places a side", 21: "21 places a side", 41: "41 places a side" }, "21");
  private readonly ends = ["x", "y", "z"].map((axis) => ["from", "to"].map((end) => typed(`Map ${axis} ${end}, mm`, "")));
  private readonly remove = button("Remove", () => this.clear(), "Take the map out of the picture");
  private readonly legend = element("p", { class: "legend maplegend", hidden: "" });
  private readonly cells = new MapCells();
  private readonly marker = new three.Mesh(new three.SphereGeometry(1, 16, 12), new three.MeshBasicMaterial());
  private map: Shown | null = null;
  /** True once the places are those of the user: they follow the tool no more. */
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
    [this.plane, this.layers].forEach((own) => own.addEventListener("change", () => this.around()));
    this.ends.flat().forEach((own) => own.addEventListener("input", () => (this.isPlaced = true)));
    const rows = [
      fields("Variable", "", this.variable),
      this.meaning,
      fields("Plane", "", this.plane),
      fields("Planes", "", this.layers),
      ...this.ends.map((pair, k) => fields(`${"xyz"[k]} from, to`, "mm", ...pair)),
      fields("Fineness", "", this.fine),
    ];
    const around = button("Around the tool", () => this.around(), "Places around the tool, as large as the machine");
    this.computation = new Computation("Map of the workspace", rows, (run) => this.compute(run), "Compute", [around, this.remove]);
    this.explain();
    this.around();
    stage.foot.append(this.legend);
    stage.extra.add(this.cells.group, this.marker);
    stage.guests.push(this);
    [this.marker.visible, this.remove.hidden] = [false, true];
  }

  show(): void {
    const { map } = this;
    if (!this.isPlaced) {
      this.around();
    }
    const isOld = map !== null && !isSame(map.under, this.under());
    this.computation.mark(isOld, "Of the state before, with another load or orientation of the tool: compute again.");
    const look = `${this.stage.dark()} ${isOld} ${this.stage.glyph()}`;
    if (map !== null && look !== this.drawn) {
      this.drawn = look;
      this.draw();
    }
  }

  private explain(): void {
    this.meaning.textContent = this.store.machine.variables.find((own) => own.name === this.variable.value)?.description ?? "";
  }

  /** Places around the tool, as far as the machine is large. */
  private around(): void {
    const at = this.store.state?.tool.position_mm ?? [0, 0, 0];
    const [, , normal] = PLANES[this.plane.value]!;
    const half = 0.75 * round(this.store.machine.size_mm);
    const isOne = this.layers.value === "1";
    this.ends.forEach(([from, to], k) => {
      const far = k !== normal ? half : isOne ? 0 : half / 2;
      [from!.value, to!.value] = [at[k]! - far, at[k]! + far].map((x) => String(Number(x.toFixed(k === normal ? 3 : 0)))) as [string, string];
      to!.hidden = k === normal && isOne;
    });
    this.isPlaced = false;
  }

  private grid(): Grid {
    const [along, across, normal] = PLANES[this.plane.value]!;
    const counts: Vec3 = [Number(this.fine.value), Number(this.fine.value), Number(this.fine.value)];
    counts[normal] = Number(this.layers.value);
    const pairs = this.ends.map((pair) => pair.map((own) => own.valueAsNumber).sort((a, b) => a - b));
    if (counts[normal] === 1) {
      pairs[normal] = [this.ends[normal]![0]!.valueAsNumber, this.ends[normal]![0]!.valueAsNumber];
    }
    return { from: pairs.map((own) => own[0]) as Vec3, to: pairs.map((own) => own[1]) as Vec3, counts, along, across, normal };
  }

  /** Load and orientation of the tool now. */
  private under(): number[] {
    const { state } = this.store;
    // A quaternion and its opposite are the same orientation.
    const [x, y, z, w] = state?.tool.quaternion_xyzw ?? [0, 0, 0, 1];
    const turned = [x * x, y * y, z * z, w * w, x * y, x * z, x * w, y * z, y * w, z * w];
    return [...(state?.force_n ?? []), ...(state?.moment_n_m ?? []), ...turned];
  }

  private async compute(run: Run): Promise<void> {
    const { request, machine } = this.store;
    const grid = this.grid();
    const variable = this.variable.value;
    const unit = machine.variables.find((own) => own.name === variable)?.unit ?? "";
    const [factor, word] = UNITS[unit] ?? [1, unit];
    const map: Shown = { grid, values: [], name: variable, factor, unit: word, under: this.under() };
    const all = grid.counts.reduce((a, b) => a * b);
    let done = 0;
    this.isPlaced = true;
    this.map = map;
    this.computation.output.replaceChildren();
    this.computation.say(`0 of ${all} places.`);
    this.stage.refit();
    for (let plane = 0; plane < grid.counts[grid.normal]!; plane += 1) {
      for (let line = 0; line < grid.counts[grid.across]! && !run.isStopped && this.map === map; line += 1) {
        const places = Array.from({ length: grid.counts[grid.along]! }, (_, i) => inGrid(grid, i, line, plane));
        const values = await this.ask(request, variable, grid, places);
        values.forEach((value, i) => (map.values[indexOf(grid, places[i]!)] = value === null ? null : factor * value));
        done += values.length;
        this.draw();
        this.computation.say(`${run.isStopped ? "Stopped: " : ""}${done} of ${all} places.`);
      }
    }
    if (this.map !== map) {
      return;
    }
    this.explainEnds(`${run.isStopped ? "Stopped: " : ""}${done} of ${all} places`);
    this.store.draw({});
  }

  /** The values of a line of places. */
  private async ask(state: StateRequest, variable: string, grid: Grid, places: Vec3[]): Promise<(number | null)[]> {
    const counts: Vec3 = [1, 1, 1];
    counts[grid.along] = places.length;
    const [from_mm, to_mm] = [placeOf(grid, places[0]!), placeOf(grid, places[places.length - 1]!)];
    return (await this.store.source.ask("map", { state, variable, from_mm, to_mm, counts })).values;
  }

  /** The places with the least and the most value; null without any value. */
  private found(): { least: Vec3; most: Vec3 } | null {
    const { grid, values } = this.map!;
    let [least, most]: [Vec3 | null, Vec3 | null] = [null, null];
    const [nx, ny] = grid.counts;
    values.forEach((value, i) => {
      if (typeof value === "number") {
        const at: Vec3 = [i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny))];
        least = least === null || value < this.value(least)! ? at : least;
        most = most === null || value > this.value(most)! ? at : most;
      }
    });
    return least === null || most === null ? null : { least, most };
  }

  private value(at: Vec3): number | null {
    const { map } = this;
    return map?.values[indexOf(map.grid, at)] ?? null;
  }

  private inUnit(value: number): string {
    return `${shown(value)} ${this.map!.unit}`.trim();
  }

  /** The place with the least favourable value. */
  private worst(): Vec3 | null {
    const found = this.map === null ? null : this.found();
    return found === null ? null : isHighWorse(this.map!.name) ? found.most : found.least;
  }

  /** Draws cells and legend by the values that are known. */
  private draw(): void {
    const { map, stage } = this;
    const found = map === null ? null : this.found();
    if (map === null || found === null) {
      return;
    }
    const theme = stage.theme();
    const dark = stage.dark();
    const scale = scaleOver(this.value(found.least)!, this.value(found.most)!, isHighWorse(map.name));
    this.cells.show(map.grid, map.values, scale, dark, theme.joint);
    const half = (k: number) => strip((share) => scale.colour((k + share) / 2, dark));
    const old = isSame(map.under, this.under()) ? "" : " (of the state before)";
    const words = `${inWords(map.name)}${map.unit === "" ? "" : `, ${map.unit}`}${old}: `;
    this.legend.replaceChildren(words.charAt(0).toUpperCase() + words.slice(1), element("span", {}, shown(scale.low)), half(0), element("span", {}, shown(scale.middle)), half(1), element("span", {}, shown(scale.high)));
    const worst = this.worst();
    this.marker.visible = worst !== null;
    if (worst !== null) {
      this.marker.position.copy(vector(placeOf(map.grid, worst)));
      this.marker.scale.setScalar(0.008 * stage.glyph());
      (this.marker.material as three.MeshBasicMaterial).color.set(theme.alert);
    }
    this.legend.hidden = false;
    this.remove.hidden = false;
    stage.refresh();
  }

  pick(_x: number, _y: number, _project: unknown, ray: three.Raycaster): (() => void) | null {
    const at = this.cells.pick(ray);
    return at === null ? null : () => this.go(at);
  }

  points(): three.Vector3[] {
    const { grid } = this.map ?? {};
    return grid === undefined ? [] : [0, grid.counts[grid.normal]! - 1].flatMap((plane) => cornersOf(grid, plane));
  }

  /** The word at the worst place. */
  words(): Label[] {
    const worst = this.worst();
    return worst === null || !this.marker.visible ? [] : [{ at: this.marker.position.clone(), text: `${superlative(this.map!.name)}: ${this.inUnit(this.value(worst)!)}`, isNeeded: true }];
  }

  private explainEnds(progress: string): void {
    const { map } = this;
    const found = map === null ? null : this.found();
    const out = map?.values.filter((value) => value === null).length ?? 0;
    this.computation.say(`${progress}.${out > 0 ? ` ${out} have no value: the machine cannot reach them, or it is not finite there.` : ""}`);
    if (map === null || found === null) {
      return;
    }
    const row = (label: string, at: Vec3) => {
      const place = placeOf(map.grid, at).map(shown).join(", ");
      return [element("dt", {}, label), element("dd", {}, this.inUnit(this.value(at)!), element("small", {}, `at (${place}) mm`))];
    };
    const go = button(`Go to the ${superlative(map.name)} place`, () => this.go(this.worst()!));
    const hint = element("p", { class: "unit" }, "A click on the map sends the tool there.");
    this.computation.output.replaceChildren(element("dl", {}, ...row("Least", found.least), ...row("Most", found.most)), element("div", { class: "row" }, go), hint);
  }

  private go(at: Vec3): void {
    const place = placeOf(this.map!.grid, at);
    const value = this.value(at);
    this.computation.say(`Tool at (${place.map(shown).join(", ")}) mm: ${value === null ? "no value" : this.inUnit(value)}.`);
    this.store.change({ at_mm: place });
  }

  private clear(): void {
    this.map = null;
    this.cells.clear();
    this.marker.visible = false;
    this.legend.hidden = true;
    this.remove.hidden = true;
    this.computation.output.replaceChildren();
    this.computation.say("");
    this.computation.mark(false);
    this.store.draw({});
  }
}

/** A variable as people say it: `stiffness_softest` is the softest stiffness. */
function inWords(name: string): string {
  const mode = /^f(\d)$/.exec(name)?.[1];
  if (mode !== undefined) {
    return `natural frequency ${mode}`;
  }
  const words = name.replaceAll("_", " ");
  return words.replace(/^(.*stiffness) (softest|stiffest)$/, "$2 $1").replace(/^(rotational.*) ([xyz])$/, "$1 about $2").replace(/^(stiffness) ([xyz])$/, "$1 along $2");
}

/** True if the machine is worse off where the value is high. */
const isHighWorse = (name: string) => /^(deflection|rotation$|effort|share)/.test(name);

/** The word of the place where the machine is worst off. */
const superlative = (name: string) => (name.includes("stiffness") ? "softest" : "worst");

/** True if numbers are equal as far as they are computed. */
const isSame = (a: number[], b: number[]) => a.length === b.length && a.every((x, i) => Math.abs(x - b[i]!) <= 1e-9 * Math.max(1, Math.abs(x)));
