// Stability lobes: largest stable depth of a milling cut over the spindle speed.

import type uPlot from "uplot";

import type { Lobes, LobesRequest, Vec3 } from "./api";
import { Computation, DampingField, choice, fields, typed, type Run } from "./computation";
import { element } from "./panel";
import { axis, css, legend, plot } from "./plot";
import { shown, type Store } from "./store";

/** Most speeds of one request, so that results are drawn, and a stop takes effect, early. */
const PIECE = 8;

type Point = Lobes["points"][number];

/** Cut and spindle speeds of all requests. */
type Cut = Omit<LobesRequest, "state">;

export class LobesView {
  readonly computation: Computation;
  private readonly speeds = [typed("Slowest spindle speed, rpm", 1000, { min: "1" }), typed("Fastest spindle speed, rpm", 6000, { min: "1" })];
  private readonly count = typed("Number of speeds", 60, { min: "2", max: "2000", step: "1" });
  private readonly teeth = typed("Teeth", 2, { min: "1", max: "100", step: "1" });
  private readonly immersion = typed("Immersion: width of cut by diameter", 1, { min: "0", max: "1" });
  private readonly side = choice("Side", { climb: "climb (down)", up: "up (conventional)" }, "climb");
  private readonly feed = ["x", "y", "z"].map((name, k) => typed(`Feed direction ${name}`, k === 0 ? 1 : 0));
  /** Without defaults, because they belong to a material and a tool; the placeholders are examples of an aluminium alloy. */
  private readonly coefficients = [["Tangential", "800"], ["Radial", "240"], ["Axial", "0"]].map(([name, example]) => typed(`${name} coefficient, N/mm^2`, "", { placeholder: `e.g. ${example}` }));
  private readonly depth = typed("Largest depth of cut, mm", 5, { min: "0" });
  private readonly damping: DampingField;
  private points: Point[] = [];

  constructor(private readonly store: Store) {
    this.damping = new DampingField(store.machine.is_damped);
    const rows = [
      fields("Speeds", "rpm", ...this.speeds),
      fields("How many", "", this.count),
      fields("Teeth", "", this.teeth),
      fields("Immersion", "", this.immersion),
      fields("Side", "", this.side),
      fields("Feed x, y, z", "", ...this.feed),
      fields("Coefficients", "N/mm²", ...this.coefficients),
      element("p", { class: "unit" }, "Force by area of chip: tangential, radial, axial. They are those of your material and tool; the examples are of an aluminium alloy."),
      fields("Depth up to", "mm", this.depth),
      ...this.damping.rows,
    ];
    this.computation = new Computation(store, "Chatter: speeds and depths", rows, (run) => this.compute(run));
    this.computation.offerCommand("lobes", () => this.options());
  }

  private cut(): Cut {
    return {
      speed_rpm: this.speeds.map((own) => own.valueAsNumber).sort((a, b) => a - b) as [number, number],
      speeds: this.count.valueAsNumber,
      depth_mm: this.depth.valueAsNumber,
      teeth: this.teeth.valueAsNumber,
      immersion: this.immersion.valueAsNumber,
      up: this.side.value === "up",
      feed_direction: this.feed.map((own) => own.valueAsNumber) as Vec3,
      coefficients_n_per_mm2: this.coefficients.map((own) => own.valueAsNumber) as Vec3,
      damping_ratio: this.damping.value(),
    };
  }

  /** The cut as options of the command. */
  private options(): string {
    const cut = this.cut();
    const damping = cut.damping_ratio === null ? "" : `--damping ${cut.damping_ratio} `;
    return `${damping}--teeth ${cut.teeth} --immersion ${cut.immersion} --${this.side.value} --feed-direction ${cut.feed_direction.join(" ")} --coefficients-n-per-mm2 ${cut.coefficients_n_per_mm2.join(" ")} --depth-mm ${cut.depth_mm} --rpm ${cut.speed_rpm.join(" ")} ${cut.speeds}`;
  }

  private async compute(run: Run): Promise<void> {
    const cut = this.cut();
    const [low, high] = cut.speed_rpm;
    const speed = (i: number) => low + ((high - low) * i) / (cut.speeds - 1);
    const pieces = Math.ceil(cut.speeds / PIECE);
    const bound = (piece: number) => Math.round((piece * cut.speeds) / pieces);
    const warnings = new Set<string>();
    const [best, list] = [element("p", {}), element("div", {})];
    this.computation.say(`0 of ${cut.speeds} speeds.`);
    for (let piece = 0; piece < pieces && !run.isStopped; piece += 1) {
      const [first, end] = [bound(piece), bound(piece + 1)];
      const found = await this.store.source.ask("lobes", { ...cut, state: run.state, speed_rpm: [speed(first), speed(end - 1)], speeds: end - first });
      if (piece === 0) {
        this.points = [];
        this.draw(cut, best, list);
      }
      this.points.push(...found.points);
      found.warnings.forEach((words) => warnings.add(words));
      list.replaceChildren(...[...warnings].map((words) => element("p", { class: "unit" }, words)));
      best.textContent = bestOf(this.points, cut.depth_mm);
      this.computation.chart?.setData(this.data());
      this.computation.say(`${run.isStopped ? "Stopped: " : ""}${end} of ${cut.speeds} speeds. Damping: ${found.damping}.`);
    }
  }

  private data(): uPlot.AlignedData {
    const { points } = this;
    return [points.map((own) => own.speed_rpm), points.map((own) => own.limit_mm), points.map((own) => own.zeroth_order_mm)];
  }

  private draw(cut: Cut, best: HTMLElement, list: HTMLElement): void {
    const frame = element("div", { class: "plot", "aria-label": "Largest stable depth of cut in mm over the spindle speed in rpm; the arrow keys read it" });
    const lines = legend([["var(--ink)", "2px solid", "limit"], ["var(--pale)", "1px dashed", "zeroth order, no bound"]]);
    const stable = element("span", { class: "legend" }, element("i", { class: "stable" }), "stable");
    this.computation.output.replaceChildren(frame, element("div", { class: "row" }, ...lines, stable), best, list);
    const highest = () => {
      const limits = this.points.map((own) => own.limit_mm);
      // Without a limit the stable area is open: it reaches the largest depth of the search.
      return limits.length === 0 || limits.includes(null) ? cut.depth_mm : Math.min(cut.depth_mm, 1.15 * Math.max(...limits.map(Number)));
    };
    const options = {
      // Points, because a limit between two speeds without one has no line.
      series: [{}, { stroke: () => css("--ink"), width: 1.5, points: { show: true, size: 4, fill: () => css("--ink") } }, { stroke: () => css("--pale"), width: 1, dash: [5, 4], points: { show: false } }],
      axes: [axis({ label: "spindle speed, rpm", size: 26, values: (_: uPlot, splits: number[]) => splits.map(String) }), axis({ label: "depth, mm", size: 34 })],
      scales: { x: { time: false, range: (): [number, number] => cut.speed_rpm }, y: { range: (): [number, number] => [0, highest()] } },
      hooks: { drawAxes: [(own: uPlot) => shade(own, this.points)] },
    };
    this.computation.chart = plot(frame, options, this.data(), (i) => wordsOf(this.points[i]!, cut.depth_mm));
  }
}

/** A point of the chart in words. */
function wordsOf({ speed_rpm, limit_mm, kind, chatter_hz, stable_mm, zeroth_order_mm }: Point, depth: number): string[] {
  const islands = stable_mm.slice(1).map(([low, high]) => `and from ${shown(low)} to ${shown(high)} mm`);
  const chatter = kind === null ? [] : [`${kind === "flip" ? "period doubling" : "chatter"}${chatter_hz === null ? "" : ` at ${shown(chatter_hz)} Hz`}`];
  const zeroth = zeroth_order_mm === null ? [] : [`zeroth order: ${shown(zeroth_order_mm)} mm`];
  return [`${speed_rpm.toFixed(0)} rpm`, `stable up to ${shown(limit_mm ?? depth)} mm${limit_mm === null ? ", no limit found" : ""}`, ...islands, ...chatter, ...zeroth];
}

/** The speed with the largest limit in words. */
function bestOf(points: Point[], depth: number): string {
  const open = points.filter((own) => own.limit_mm === null);
  if (open.length > 0) {
    return `No limit was found up to ${shown(depth)} mm, the depth that was looked at, at ${open.length} of ${points.length} speeds; the slowest is ${open[0]!.speed_rpm.toFixed(0)} rpm.`;
  }
  const best = points.reduce((a, b) => (b.limit_mm! > a.limit_mm! ? b : a));
  return `Best speed: ${best.speed_rpm.toFixed(0)} rpm, stable up to ${shown(best.limit_mm!)} mm.`;
}

/** Shades the stable area: below the limit, open upwards without one, and islands above it. */
function shade(own: uPlot, points: Point[]): void {
  const { ctx, bbox } = own;
  const x = (rpm: number) => own.valToPos(rpm, "x", true);
  const y = (mm: number | null) => (mm === null ? bbox.top : Math.max(own.valToPos(mm, "y", true), bbox.top));
  const floor = bbox.top + bbox.height;
  const area = new Path2D();
  const trapezium = (x0: number, top0: number, x1: number, top1: number, bottom = floor) => {
    const corners: [number, number][] = [[x0, bottom], [x0, top0], [x1, top1], [x1, bottom]];
    corners.forEach(([px, py], k) => (k === 0 ? area.moveTo(px, py) : area.lineTo(px, py)));
  };
  points.forEach((point, i) => {
    const [last, next] = [points[i - 1], points[i + 1]];
    const here = x(point.speed_rpm);
    const middle = (other: Point | undefined) => (other === undefined ? here : (here + x(other.speed_rpm)) / 2);
    for (const other of [last, next].filter((one) => one !== undefined)) {
      // Nothing is known between a speed with a limit and one without.
      const isOneOpen = (other.limit_mm === null) !== (point.limit_mm === null);
      trapezium(here, y(point.limit_mm), middle(other), isOneOpen ? y(point.limit_mm) : (y(point.limit_mm) + y(other.limit_mm)) / 2);
    }
    point.stable_mm.slice(1).forEach(([low, high]) => trapezium(middle(last), y(high), middle(next), y(high), y(low)));
  });
  ctx.save();
  ctx.globalAlpha = 0.2;
  ctx.fillStyle = css("--compensated");
  ctx.fill(area);
  ctx.restore();
}
