// The load grows: equilibria as a curve with its branches, each with the shape of the machine.

import type { Curve, CurvePlace } from "./api";
import { Computation, fields, typed, type Run } from "./computation";
import { element } from "./panel";
import { round, shown, type Store } from "./store";

const WIDTH = 300;
const HEIGHT = 190;
const [LEFT, RIGHT, TOP, BOTTOM] = [46, 10, 10, 34];

function svg(tag: string, attributes: Record<string, string>, text = ""): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  made.textContent = text;
  return made;
}

/** Round values from the lowest to the highest, some four. */
function ticks(low: number, high: number): number[] {
  const step = round((high - low) / 2.5);
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => (first + i) * step);
}

export class CurveView {
  readonly computation: Computation;
  private readonly factor = typed("Largest factor of the load", 10, { min: "0" });
  private readonly slider = element("input", { type: "range", min: "0", value: "0", "aria-label": "Place on the curve" }) as HTMLInputElement;
  private readonly chart = element("div", { class: "curve" });
  private curve: Curve | null = null;

  constructor(private readonly store: Store) {
    this.computation = new Computation(store, "Let the load grow", [fields("From 0 to", "times", this.factor)], (run) => this.follow(run), "Follow");
    this.slider.addEventListener("input", () => this.choose(this.places()[this.slider.valueAsNumber] ?? null));
  }

  /** A curve is that of one posture under one load: with another one it goes. */
  show(): void {
    if (this.computation.isOld()) {
      this.curve = null;
      this.computation.clear();
    }
  }

  private places(): CurvePlace[] {
    return this.curve?.branches.flatMap((branch) => branch.places) ?? [];
  }

  private async follow(run: Run): Promise<void> {
    const curve = await this.store.source.ask("curve", { state: run.state, factor: this.factor.valueAsNumber });
    if (run.isStopped) {
      this.computation.say("Stopped.");
      return;
    }
    this.curve = curve;
    this.slider.max = String(this.places().length - 1);
    this.computation.output.append(this.chart, this.slider);
    const more = this.curve.more_branches ? " There are more branches than these." : "";
    const words = this.curve.marks.map((mark) => `${mark.words} at ${shown(mark.factor)} times the load`);
    const all = words.length > 0 ? words.join("; ") : "no special point";
    this.computation.say(`${all.charAt(0).toUpperCase()}${all.slice(1)}.${more}`);
    this.choose(null);
  }

  /** Shows the shape of a place. */
  private choose(place: CurvePlace | null): void {
    this.draw(place);
    this.store.showShape(place === null ? null : place.shape);
  }

  private draw(chosen: CurvePlace | null): void {
    const { curve } = this;
    if (curve === null) {
      return;
    }
    const places = this.places();
    const span = (of: (place: CurvePlace) => number) => {
      const all = places.map(of);
      const [low, high] = [Math.min(0, ...all), Math.max(0, ...all)];
      return [low, high > low ? high : low + 1] as const;
    };
    const [x0, x1] = span((place) => place.along);
    const [y0, y1] = span((place) => place.factor);
    const x = (along: number) => LEFT + ((along - x0) / (x1 - x0)) * (WIDTH - LEFT - RIGHT);
    const y = (factor: number) => HEIGHT - BOTTOM - ((factor - y0) / (y1 - y0)) * (HEIGHT - TOP - BOTTOM);
    const out = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "Factor of the load over the displacement along it" });
    ticks(x0, x1).forEach((value) => out.append(svg("line", { class: "grid", x1: String(x(value)), x2: String(x(value)), y1: String(TOP), y2: String(HEIGHT - BOTTOM) }), svg("text", { x: String(x(value)), y: String(HEIGHT - BOTTOM + 13), "text-anchor": "middle" }, shown(value))));
    ticks(y0, y1).forEach((value) => out.append(svg("line", { class: "grid", x1: String(LEFT), x2: String(WIDTH - RIGHT), y1: String(y(value)), y2: String(y(value)) }), svg("text", { x: String(LEFT - 5), y: String(y(value) + 4), "text-anchor": "end" }, shown(value))));
    out.append(svg("text", { x: String((LEFT + WIDTH - RIGHT) / 2), y: String(HEIGHT - 4), "text-anchor": "middle" }, `displacement along the load, ${curve.unit}`));
    out.append(svg("text", { x: "12", y: String((TOP + HEIGHT - BOTTOM) / 2), "text-anchor": "middle", transform: `rotate(-90 12 ${(TOP + HEIGHT - BOTTOM) / 2})` }, "times the load"));
    for (const { places: own } of curve.branches) {
      own.slice(1).forEach((to, i) => {
        const from = own[i]!;
        const stable = from.stable && to.stable;
        out.append(svg("line", { class: stable ? "stable" : "unstable", x1: String(x(from.along)), y1: String(y(from.factor)), x2: String(x(to.along)), y2: String(y(to.factor)) }));
      });
    }
    curve.marks.forEach((mark) => {
      const circle = svg("circle", { class: "mark", cx: String(x(mark.along)), cy: String(y(mark.factor)), r: "4" });
      circle.append(svg("title", {}, `${mark.words}: ${shown(mark.factor)} times the load`));
      out.append(circle);
    });
    if (chosen !== null) {
      out.append(svg("circle", { class: "chosen", cx: String(x(chosen.along)), cy: String(y(chosen.factor)), r: "5" }));
    }
    out.addEventListener("click", (event) => {
      const box = out.getBoundingClientRect();
      const at = [((event.clientX - box.left) / box.width) * WIDTH, ((event.clientY - box.top) / box.height) * HEIGHT];
      const far = (place: CurvePlace) => Math.hypot(x(place.along) - at[0]!, y(place.factor) - at[1]!);
      const nearest = places.reduce((best, own, i) => (far(own) < far(places[best]!) ? i : best), 0);
      this.slider.value = String(nearest);
      this.choose(places[nearest] ?? null);
    });
    this.chart.replaceChildren(out);
    if (chosen !== null) {
      const state = chosen.stable ? "stable" : "not stable";
      this.chart.append(element("p", { class: "unit" }, `${shown(Math.abs(chosen.factor) < 1e-9 ? 0 : chosen.factor)} times the load: ${shown(chosen.along)} ${curve.unit}, ${state}; drawn as large as it is.`));
    }
  }
}
