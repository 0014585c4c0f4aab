// Errors along the path as a chart, with the tolerance and the places over it.

import type uPlot from "uplot";

import type { Path, Place } from "./api";
import { axis, css, plot } from "./plot";
import { shown } from "./store";
import { length, time, unitOf } from "./units";

export const PROGRAMMED = "var(--programmed)";
export const COMPENSATED = "var(--compensated)";

/** Figures of a place, each with its label. */
export function figuresOf(place: Place): [string, string][] {
  return [
    ["Line", String(place.line)],
    ["Path", `${place.path_mm.toFixed(1)} mm`],
    ["Time", typeof place.time_s === "number" ? time(place.time_s) : "not given"],
    ["Error as programmed", length(place.error_before_mm)],
    ["Error compensated", length(place.error_after_mm)],
    ["Force", `${shown(Math.hypot(...place.force_n))} N`],
  ];
}

export class ErrorChart {
  private readonly plot: uPlot;
  private index: number | null = null;
  private isOver: boolean[] = [];
  private by = "before";

  constructor(
    private readonly frame: HTMLElement,
    private readonly path: Path,
    go: (index: number) => void,
  ) {
    const { places, tolerance_mm } = path;
    const data: uPlot.AlignedData = [places.map((place) => place.path_mm), places.map((place) => place.error_before_mm), places.map((place) => place.error_after_mm), places.map(() => tolerance_mm)];
    const series: uPlot.Series[] = [
      {},
      { stroke: () => css("--programmed"), width: 1.5 },
      { stroke: () => css("--compensated"), width: 1.5 },
      { stroke: () => css("--ink"), width: 1, dash: [6, 4], points: { show: false } },
    ];
    const options = {
      series,
      axes: [axis({ label: "length of the path, mm", size: 26 }), axis({ size: 58, space: 22, values: (_, splits) => splits.map((mm) => this.tick(mm)) })],
      scales: { x: { time: false }, y: { range: (): [number, number] => [0, this.highest()] } },
      hooks: { drawAxes: [(own: uPlot) => this.mark(own, css("--alert"))], draw: [(own: uPlot) => this.current(own, css("--accent"))] },
    };
    this.plot = plot(frame, options, data, (i) => figuresOf(places[i]!).map(([label, value]) => `${label}: ${value}`));
    this.plot.over.addEventListener("click", () => {
      const { idx } = this.plot.cursor;
      if (typeof idx === "number") {
        go(idx);
      }
    });
  }

  /** Draws anew: the place that is shown, which places are over tolerance, and by which error. */
  show(index: number | null, isOver: boolean[], by: string): void {
    this.index = index;
    this.isOver = isOver;
    const isOther = by !== this.by;
    this.by = by;
    this.frame.setAttribute("aria-label", `Error of the tool along the path in ${unitOf(this.highest()).word}, as programmed and compensated, with the tolerance`);
    if (isOther) {
      this.plot.setData(this.plot.data, true);
    } else {
      this.plot.redraw(false);
    }
  }

  /** Upper end of the axis, mm: a compensated error is seen only without the larger one. */
  private highest(): number {
    const { places, tolerance_mm } = this.path;
    const errors = places.map((place) => (this.by === "after" ? place.error_after_mm : Math.max(place.error_before_mm, place.error_after_mm)));
    return 1.1 * errors.reduce((most, error) => Math.max(most, error), tolerance_mm) || 1;
  }

  /** A number at the axis; all have the unit of the largest. */
  private tick(mm: number): string {
    const unit = unitOf(this.highest());
    return `${shown(mm * unit.perMm)} ${unit.word}`;
  }

  /** Shades the places over tolerance, with a strip on top that is seen even where the shade is thin. */
  private mark(plot: uPlot, colour: string): void {
    const { ctx, bbox } = plot;
    const x = (i: number) => plot.valToPos(this.path.places[i]!.path_mm, "x", true);
    const last = this.path.places.length - 1;
    ctx.save();
    ctx.fillStyle = colour;
    for (let i = 0; i <= last; i += 1) {
      const first = i;
      while (this.isOver[i + 1] && this.isOver[i]) {
        i += 1;
      }
      if (this.isOver[i]) {
        const low = (x(first) + x(Math.max(first - 1, 0))) / 2;
        const width = Math.max((x(i) + x(Math.min(i + 1, last))) / 2 - low, 2 * devicePixelRatio);
        ctx.globalAlpha = 0.12;
        ctx.fillRect(low, bbox.top, width, bbox.height);
        ctx.globalAlpha = 1;
        ctx.fillRect(low, bbox.top, width, 4 * devicePixelRatio);
      }
    }
    ctx.restore();
  }

  private current(plot: uPlot, colour: string): void {
    const place = this.index === null ? undefined : this.path.places[this.index];
    if (place === undefined) {
      return;
    }
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = colour;
    ctx.fillRect(plot.valToPos(place.path_mm, "x", true) - devicePixelRatio, bbox.top, 2 * devicePixelRatio, bbox.height);
    ctx.restore();
  }
}
