// The path of a program: in space, as a chart, as its lines, and played.

import * as three from "three";

import type { Path } from "./api";
import { COMPENSATED, ErrorChart, PROGRAMMED, figuresOf } from "./chart";
import { byShare, strip } from "./colour";
import { vector } from "./machine3d";
import { button, element } from "./panel";
import { PathLine } from "./path3d";
import { FIT, Playback } from "./playback";
import { legend } from "./plot";
import { ProgramLines } from "./programlines";
import type { Stage } from "./stage";
import { pathColours, type PathColour } from "./pathcolours";
import type { Store } from "./store";
import { length } from "./units";

export class PathView {
  private readonly lines: ProgramLines;
  private readonly slider = element("input", { type: "range", min: "0", step: "1", "aria-label": "Place along the path" });
  private readonly overall = element("p", { class: "overall" });
  private readonly figures = element("dl", {});
  private readonly overWords = element("span", {});
  private readonly hint = element("p", { class: "unit" });
  private readonly legend = element("p", { class: "legend pathlegend" });
  private readonly play = button("Play", () => this.playback.toggle(), "Play or stop (space on the slider)");
  private readonly marker = new three.Mesh(new three.SphereGeometry(1, 16, 12), new three.MeshBasicMaterial());
  private readonly all: PathColour[];
  private readonly chart: ErrorChart;
  private readonly line: PathLine;
  private readonly playback: Playback;
  /** Colours of the path now, so that it is made anew only for others. */
  private coloured = "";

  constructor(
    place: HTMLElement,
    private readonly store: Store,
    private readonly stage: Stage,
    private readonly path: Path,
  ) {
    place.hidden = false;
    const { places } = path;
    this.all = pathColours(path, store.machine);
    this.playback = new Playback(
      places,
      (index) => store.change({ place: index }),
      () => (this.play.textContent = this.playback.isPlaying ? "Stop" : "Play"),
    );
    this.playback.seek(store.request.place ?? 0);
    this.lines = new ProgramLines(path, (index) => this.go(index));
    this.line = new PathLine(places);
    this.slider.max = String(Math.max(places.length - 1, 0));
    this.slider.value = "0";
    this.slider.addEventListener("input", () => this.go(this.slider.valueAsNumber));
    this.slider.addEventListener("keydown", (event) => {
      if (event.key === " ") {
        event.preventDefault();
        this.playback.toggle();
      }
    });
    const chart = element("div", { class: "chart" });
    const worst = button("Worst place", () => this.go(this.worst()), "The place with the largest value of the colour");
    const controls = element("div", { class: "row controls" }, element("strong", {}, path.program), this.play, this.rates(), this.slider, worst, this.colours());
    place.append(
      controls,
      element("div", { class: "chartside" }, this.overall, chart, this.chartLegend()),
      element("div", { class: "placeside" }, element("h2", {}, "Place"), this.figures, this.hint),
      this.lines.element,
    );
    this.chart = new ErrorChart(chart, path, (index) => this.go(index));
    stage.foot.append(this.legend);
    stage.extra.add(this.line.group, this.marker);
    // Before the map, on which the path may lie.
    stage.guests.unshift({
      pick: (x, y, project) => {
        const index = this.line.pick(x, y, project);
        return index === null ? null : () => this.go(index);
      },
    });
  }

  private rates(): HTMLElement {
    const words = this.playback.hasTimes ? ["1x", "10x", "100x"] : [];
    const options = [...words.map((word) => element("option", { value: String(parseInt(word, 10)) }, word)), element("option", { value: "fit" }, `in ${FIT} s`)];
    const select = element("select", { title: this.playback.hasTimes ? "At the feed of the program, or faster" : "Evenly along the path: its places have no times" }, ...options);
    select.value = "fit";
    select.addEventListener("change", () => (this.playback.rate = select.value === "fit" ? null : Number(select.value)));
    return element("label", {}, "Speed ", select);
  }

  private colours(): HTMLElement {
    const select = element("select", { "aria-label": "Colour of the path" }, ...this.all.map((own) => element("option", { value: own.key }, own.words)));
    select.value = this.colour().key;
    select.addEventListener("change", () => this.store.draw({ path: select.value }));
    return element("label", {}, "Colour ", select);
  }

  private chartLegend(): HTMLElement {
    const each = legend([
      [PROGRAMMED, "2px solid", "as programmed"],
      [COMPENSATED, "2px solid", "compensated"],
      ["var(--ink)", "2px dashed", "tolerance"],
    ]);
    const over = element("span", { class: "legend" }, element("i", { class: "over" }), this.overWords);
    return element("div", { class: "row" }, ...each, over);
  }

  /** What the path is coloured by; a link may name what this one has not. */
  private colour(): PathColour {
    return this.all.find((own) => own.key === this.store.look.path) ?? this.all[0]!;
  }

  private worst(): number {
    const { places } = this.path;
    const { value } = this.colour();
    return places.reduce((worst, place, i) => (value(place) > value(places[worst]!) ? i : worst), 0);
  }

  private go(index: number): void {
    this.playback.seek(index);
    this.store.change({ place: index });
  }

  /** Shows the path, and the place that is asked for. */
  show(): void {
    const { places } = this.path;
    const colour = this.colour();
    const { key: by, value } = colour;
    const dark = this.stage.dark();
    const most = places.reduce((sum, place) => Math.max(sum, value(place)), 1e-12);
    const isOver = places.map(colour.isOver);
    if (this.coloured !== `${by} ${dark}`) {
      this.coloured = `${by} ${dark}`;
      this.line.colour(places.map((place) => value(place) / most), isOver, this.stage.theme(), dark);
      this.explain(most, isOver, dark);
    }
    const index = this.store.request.place ?? null;
    const place = index === null ? undefined : places[index];
    this.chart.show(index, isOver, by);
    this.marker.visible = place !== undefined;
    if (place === undefined || index === null) {
      this.figures.replaceChildren();
      this.hint.textContent = "None yet: click on the path, on the chart or on a line, or move the slider.";
      this.lines.show(null);
      return;
    }
    this.marker.position.copy(vector(place.position_mm));
    this.marker.scale.setScalar(0.008 * this.stage.glyph());
    (this.marker.material as three.MeshBasicMaterial).color.set(byShare(value(place) / most, dark));
    const figures = figuresOf(place);
    if (!["before", "after", "force"].includes(by)) {
      figures.push([`${colour.words.charAt(0).toUpperCase()}${colour.words.slice(1)}`, colour.text(value(place))]);
    }
    this.slider.value = String(index);
    this.slider.setAttribute("aria-valuetext", figures.map(([label, value]) => `${label} ${value}`).join(", "));
    this.figures.replaceChildren(...figures.flatMap(([label, value]) => [element("dt", {}, label), element("dd", {}, value)]));
    this.hint.textContent = this.store.nearby();
    this.lines.show(place.line);
  }

  /** The numbers of the colours, and how many places are over tolerance. */
  private explain(most: number, isOver: boolean[], dark: boolean): void {
    const { places, tolerance_mm } = this.path;
    const { key: by, words, text, over } = this.colour();
    const scale = strip((share) => byShare(share, dark));
    this.legend.replaceChildren(`Path, ${words}: 0`, scale, text(most));
    const count = isOver.filter((own) => own).length;
    this.overWords.textContent = over;
    const kind = by === "after" ? "compensated" : "as programmed";
    const error = places.reduce((sum, place) => Math.max(sum, by === "after" ? place.error_after_mm : place.error_before_mm), 0);
    this.overall.textContent = `Up to ${length(error)} ${kind}, tolerance ${length(tolerance_mm)}; ${count} of ${places.length} places ${over}.`;
  }
}
