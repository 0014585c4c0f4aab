// Charts in the colours of the page: axes, size, legend, and a tip that follows the pointer or the arrow keys.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import { element } from "./panel";

/** A colour of the page as it is now. */
export const css = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name);

const FONT = "11px system-ui, sans-serif";

/** An axis; it reads its colours anew when it is drawn. */
export function axis(own: uPlot.Axis): uPlot.Axis {
  return { stroke: () => css("--ink"), grid: { stroke: () => css("--line"), width: 1 }, ticks: { show: false }, font: FONT, labelFont: FONT, labelSize: 15, labelGap: 0, ...own };
}

/** A chart that fills its frame; `words` are the lines of the tip at an index of the data. */
export function plot(frame: HTMLElement, options: Omit<uPlot.Options, "width" | "height">, data: uPlot.AlignedData, words: (index: number) => string[]): uPlot {
  const tip = element("div", { class: "tip", role: "status", hidden: "" });
  const size = () => ({ width: Math.max(frame.clientWidth, 100), height: Math.max(frame.clientHeight, 90) });
  const showTip = ({ cursor, over }: uPlot) => {
    const { idx, left = -1 } = cursor;
    tip.hidden = typeof idx !== "number" || left < 0;
    if (typeof idx !== "number" || left < 0) {
      return;
    }
    tip.replaceChildren(...words(idx).map((line) => element("div", {}, line)));
    const beside = left > over.clientWidth / 2 ? left - tip.offsetWidth - 12 : left + 12;
    tip.style.left = `${Math.max(Math.min(over.offsetLeft + beside, frame.clientWidth - tip.offsetWidth), 0)}px`;
    tip.style.top = "4px";
  };
  const fixed = { padding: [8, 18, 0, 0] as uPlot.Padding, legend: { show: false }, cursor: { y: false, drag: { x: false, y: false } } };
  const made = new uPlot({ ...options, ...fixed, ...size(), hooks: { ...options.hooks, setCursor: [showTip] } }, data, frame);
  frame.append(tip);
  frame.tabIndex = 0;
  frame.setAttribute("role", "img");
  frame.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    const xs = made.data[0];
    if (step !== undefined && xs.length > 0) {
      event.preventDefault();
      const next = (made.cursor.idx ?? 0) + step * Math.ceil(xs.length / 200);
      made.setCursor({ left: made.valToPos(xs[Math.min(Math.max(next, 0), xs.length - 1)]!, "x"), top: 0 });
    }
  });
  new ResizeObserver(() => made.setSize(size())).observe(frame);
  return made;
}

/** Lines of a chart with their words. */
export function legend(lines: [colour: string, style: string, words: string][]): HTMLElement[] {
  return lines.map(([colour, style, words]) => {
    const line = element("i", {});
    line.style.borderTop = `${style} ${colour}`;
    return element("span", { class: "legend" }, line, words);
  });
}
