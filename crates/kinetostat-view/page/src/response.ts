// Response of the tip to a vibrating force, over the frequency.

import type uPlot from "uplot";

import type { Response } from "./api";
import { Computation, DampingField, fields, typed, type Run } from "./computation";
import { element } from "./panel";
import { axis, css, legend, plot } from "./plot";
import { shown, type Store } from "./store";

/** Frequencies of a curve. */
const COUNT = 1000;

const AXES = ["x", "y", "z"];

/** Dashes of x, y and z: colours alone do not distinguish the lines for every eye. */
const DASHES: number[][] = [[], [8, 4], [2, 3]];
const STYLES = ["2px solid", "2px dashed", "2px dotted"];

export class ResponseView {
  readonly computation: Computation;
  private readonly from = typed("Lowest frequency, Hz", 1, { min: "0" });
  private readonly to = typed("Highest frequency, Hz", 200, { min: "0" });
  private readonly damping: DampingField;

  constructor(private readonly store: Store) {
    this.damping = new DampingField(store.machine.is_damped);
    const rows = [fields("Frequencies", "Hz", this.from, this.to), ...this.damping.rows];
    this.computation = new Computation(store, "Response of the tip", rows, (run) => this.compute(run));
    this.computation.offerCommand("frf", () => {
      const ratio = this.damping.value();
      return `${ratio === null ? "" : `--damping ${ratio} `}--frequencies ${this.from.value} ${this.to.value} ${COUNT}`;
    });
  }

  private async compute(run: Run): Promise<void> {
    const frequencies_hz: [number, number] = [this.from.valueAsNumber, this.to.valueAsNumber];
    const response = await this.store.source.ask("response", { state: run.state, frequencies_hz, count: COUNT, damping_ratio: this.damping.value() });
    this.computation.say(run.isStopped ? "Stopped." : `Damping: ${response.damping}.`);
    if (!run.isStopped) {
      this.draw(response);
    }
  }

  private draw({ frequencies_hz, um_per_n, natural_frequencies_hz, warnings }: Response): void {
    const frame = element("div", { class: "plot", "aria-label": "Displacement of the tip by a vibrating force along x, y and z in um/N over the frequency in Hz; the arrow keys read it" });
    const axes = AXES.map((name, k): [string, string, string] => [`var(--axis-${name})`, STYLES[k]!, name]);
    const lines = element("div", { class: "row" }, ...legend([...axes, ["var(--pale)", "1px solid", "natural frequencies"]]));
    // The peaks limit a cut, and a chart of this size does not show them exactly.
    const peaks = um_per_n.map((own, k) => {
      const peak = own.reduce((best, value, i) => (value > own[best]! ? i : best), 0);
      return [element("dt", {}, `Largest along ${AXES[k]}`), element("dd", {}, `${shown(own[peak]!)} um/N at ${shown(frequencies_hz[peak]!)} Hz`)];
    });
    this.computation.output.replaceChildren(frame, lines, element("dl", {}, ...peaks.flat()), ...warnings.map((words) => element("p", { class: "unit" }, words)));
    const series = DASHES.map((dash, k): uPlot.Series => ({ stroke: () => css(`--axis-${AXES[k]}`), width: 1.5, dash, points: { show: false } }));
    const options = {
      series: [{}, ...series],
      axes: [axis({ label: "frequency, Hz", size: 26 }), axis({ label: "um/N", size: 44, values: (_: uPlot, splits: number[]) => splits.map((x) => (x === null ? "" : shown(x))) })],
      scales: { x: { time: false }, y: { distr: 3 as const } },
      hooks: { drawAxes: [(own: uPlot) => markFrequencies(own, natural_frequencies_hz)] },
    };
    // A logarithm has no place for zero, the response of a rigid direction.
    const data = [frequencies_hz, ...um_per_n.map((own) => own.map((x) => (x > 0 ? x : null)))] as uPlot.AlignedData;
    this.computation.chart = plot(frame, options, data, (i) => [`${shown(frequencies_hz[i]!)} Hz`, ...um_per_n.map((own, k) => `${AXES[k]}: ${shown(own[i]!)} um/N`)]);
  }
}

/** Thin lines at the natural frequencies. */
function markFrequencies(own: uPlot, frequencies: number[]): void {
  const { ctx, bbox, scales } = own;
  ctx.save();
  ctx.fillStyle = css("--pale");
  ctx.globalAlpha = 0.5;
  for (const frequency of frequencies.filter((hz) => hz >= scales.x!.min! && hz <= scales.x!.max!)) {
    ctx.fillRect(own.valToPos(frequency, "x", true) - 0.5, bbox.top, devicePixelRatio, bbox.height);
  }
  ctx.restore();
}
