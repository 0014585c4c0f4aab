// The path of a program: in space, as a chart, and as its lines.

import * as three from "three";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import type { Path, Place } from "./api";
import { RAMP, byShare } from "./colour";
import { dispose, vector } from "./machine3d";
import { button, element } from "./panel";
import type { Stage } from "./stage";
import { shown, type Store } from "./store";

/** Lines of the program that stand around the current one. */
const AROUND = 60;
const PROGRAMMED = "#d9480f";
const COMPENSATED = "#2b8a3e";
/** Time in which the whole path is played, s. */
const PLAYED = 20;

export class PathView {
  private readonly lines: string[];
  private readonly text = element("ol", { class: "program", tabindex: "0", "aria-label": "Lines of the program" });
  private readonly slider = element("input", { type: "range", min: "0", step: "1", "aria-label": "Place along the path" });
  private readonly said = element("p", { role: "status" });
  private readonly most = element("span", {});
  private readonly play = button("Play", () => this.toggle());
  private readonly marker = new three.Mesh(new three.SphereGeometry(1, 16, 12), new three.MeshBasicMaterial());
  private readonly chart: uPlot;
  private line: three.Object3D | null = null;
  /** The error by which the path is coloured now. */
  private coloured: boolean | null = null;
  private timer = 0;

  constructor(
    place: HTMLElement,
    private readonly store: Store,
    private readonly stage: Stage,
    private readonly path: Path,
  ) {
    place.hidden = false;
    this.lines = path.text.split(/\r?\n/);
    this.slider.max = String(Math.max(path.places.length - 1, 0));
    this.slider.addEventListener("input", () => this.go(this.slider.valueAsNumber));
    const after = element("input", { type: "checkbox" });
    after.checked = store.look.compensated;
    after.addEventListener("change", () => store.draw({ compensated: after.checked }));
    const chart = element("div", { class: "chart" });
    const worst = button("Worst place", () => this.go(this.worst()));
    place.append(
      element("div", { class: "chartside" }, element("div", { class: "row" }, element("strong", {}, path.program), this.play, worst, element("label", {}, after, "Colour by the error that is left"), ...this.legend()), this.said, this.slider, chart),
      this.text,
    );
    this.chart = this.draw(chart);
    new ResizeObserver(() => this.chart.setSize({ width: chart.clientWidth, height: Math.max(chart.clientHeight, 90) })).observe(chart);
    stage.extra.add(this.marker);
  }

  private draw(place: HTMLElement): uPlot {
    const { places, tolerance_mm } = this.path;
    const css = (name: string) => () => getComputedStyle(document.documentElement).getPropertyValue(name);
    const ink = css("--ink");
    const axis = { stroke: ink, grid: { stroke: css("--line"), width: 1 }, ticks: { show: false } };
    const series: uPlot.Series[] = [
      { label: "path, mm" },
      { label: "as programmed, mm", stroke: PROGRAMMED, width: 1.5 },
      { label: "compensated, mm", stroke: COMPENSATED, width: 1.5 },
      { label: "tolerance, mm", stroke: ink, width: 1, dash: [6, 4] },
    ];
    const data: uPlot.AlignedData = [
      places.map((p) => p.path_mm),
      places.map((p) => p.error_before_mm),
      places.map((p) => p.error_after_mm),
      places.map(() => tolerance_mm),
    ];
    const options: uPlot.Options = {
      width: Math.max(place.clientWidth, 200),
      height: Math.max(place.clientHeight, 90),
      series,
      axes: [{ ...axis, label: "length of the path, mm", labelSize: 16, size: 28 }, { ...axis, label: "error, mm", labelSize: 16, size: 52 }],
      scales: { x: { time: false }, y: { range: (_, __, high) => [0, 1.05 * high || 1] } },
      legend: { show: false },
    };
    const chart = new uPlot(options, data, place);
    chart.over.addEventListener("click", () => {
      const index = chart.cursor.idx;
      if (typeof index === "number") {
        this.go(index);
      }
    });
    return chart;
  }

  /** What the colours of chart and path mean. */
  private legend(): HTMLElement[] {
    const lines = [[PROGRAMMED, "as programmed"], [COMPENSATED, "compensated"]].map(([colour, words]) => {
      const line = element("i", {});
      line.style.borderColor = colour!;
      return element("span", { class: "legend" }, line, words!);
    });
    const ramp = element("i", { class: "ramp" });
    ramp.style.background = RAMP;
    return [...lines, element("span", { class: "legend" }, "path: 0", ramp, this.most)];
  }

  private error(place: Place): number {
    return this.store.look.compensated ? place.error_after_mm : place.error_before_mm;
  }

  private worst(): number {
    return this.path.places.reduce((worst, place, i, all) => (this.error(place) > this.error(all[worst]!) ? i : worst), 0);
  }

  private go(index: number): void {
    this.store.change({ place: index });
  }

  private toggle(): void {
    if (this.timer !== 0) {
      window.clearInterval(this.timer);
      this.timer = 0;
    } else {
      const count = this.path.places.length;
      const step = Math.max(Math.round(count / (PLAYED * 15)), 1);
      this.timer = window.setInterval(() => this.go(((this.store.request.place ?? 0) + step) % count), 1000 / 15);
    }
    this.play.textContent = this.timer === 0 ? "Play" : "Stop";
  }

  /** The path in space, made anew only where it is coloured by the other error. */
  private colour(most: number): void {
    if (this.coloured === this.store.look.compensated) {
      return;
    }
    this.coloured = this.store.look.compensated;
    if (this.line !== null) {
      dispose(this.line);
    }
    const { places } = this.path;
    const geometry = new three.BufferGeometry().setFromPoints(places.map((place) => vector(place.position_mm)));
    const colours = places.flatMap((place) => new three.Color(byShare(this.error(place) / most)).toArray());
    geometry.setAttribute("color", new three.Float32BufferAttribute(colours, 3));
    this.line = new three.Line(geometry, new three.LineBasicMaterial({ vertexColors: true, linewidth: 2 }));
    this.stage.extra.add(this.line);
  }

  /** Shows the path, and the place that is asked for. */
  show(): void {
    this.chart.redraw(false);
    const { places, tolerance_mm } = this.path;
    const size = this.store.machine.size_mm;
    const most = places.reduce((sum, place) => Math.max(sum, this.error(place)), 1e-12);
    this.most.textContent = `${shown(most)} mm`;
    this.colour(most);
    const index = this.store.request.place ?? null;
    const place = index === null ? undefined : places[index];
    this.marker.visible = place !== undefined;
    const kind = this.store.look.compensated ? "compensated" : "as programmed";
    if (place === undefined || index === null) {
      this.said.textContent = `up to ${shown(most)} mm ${kind}, tolerance ${shown(tolerance_mm)} mm`;
      this.window(0, -1);
      return;
    }
    this.marker.position.copy(vector(place.position_mm));
    this.marker.scale.setScalar(0.008 * size);
    (this.marker.material as three.MeshBasicMaterial).color.set(byShare(this.error(place) / most));
    this.slider.value = String(index);
    this.said.textContent = `line ${place.line}, ${shown(place.path_mm)} mm along: ${shown(place.error_before_mm)} mm off as programmed, ${shown(place.error_after_mm)} mm compensated`;
    this.chart.setCursor({ left: this.chart.valToPos(place.path_mm, "x"), top: 10 });
    this.window(place.line - 1, place.line - 1);
  }

  /** The lines around one; the current one is marked. */
  private window(middle: number, current: number): void {
    const first = Math.max(middle - AROUND, 0);
    const list = this.lines.slice(first, middle + AROUND);
    this.text.start = first + 1;
    this.text.replaceChildren(...list.map((line, i) => element("li", first + i === current ? { "aria-current": "true" } : {}, line || " ")));
    const marked = this.text.querySelector<HTMLElement>("[aria-current]");
    this.text.scrollTop = marked === null ? 0 : marked.offsetTop - this.text.offsetTop - this.text.clientHeight / 2;
  }
}
