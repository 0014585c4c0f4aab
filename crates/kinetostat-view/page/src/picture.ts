// The picture as it is seen, with its words: to be saved, and to be printed.

import type { Stage } from "./stage";
import type { Store } from "./store";

/** Texts of an element with their places on the screen. */
function texts(from: Element): { text: string; box: DOMRect; own: HTMLElement }[] {
  const walker = document.createTreeWalker(from, NodeFilter.SHOW_TEXT);
  const out = [];
  while (walker.nextNode()) {
    const range = document.createRange();
    range.selectNode(walker.currentNode);
    out.push({ text: walker.currentNode.textContent ?? "", box: range.getBoundingClientRect(), own: walker.currentNode.parentElement! });
  }
  return out.filter(({ own }) => getComputedStyle(own).visibility !== "hidden");
}

/** The picture with labels, axes, scale and legend in one canvas. */
export function picture(stage: Stage): HTMLCanvasElement {
  const { canvas, frame } = stage.rendered();
  const out = document.createElement("canvas");
  [out.width, out.height] = [canvas.width, canvas.height];
  const context = out.getContext("2d")!;
  const origin = frame.getBoundingClientRect();
  context.drawImage(canvas, 0, 0);
  context.scale(canvas.width / origin.width, canvas.height / origin.height);
  context.translate(-origin.x, -origin.y);
  context.textBaseline = "middle";
  for (const own of frame.querySelectorAll<HTMLCanvasElement>(".foot canvas")) {
    const box = own.getBoundingClientRect();
    context.drawImage(own, box.x, box.y, box.width, box.height);
  }
  for (const { text, box, own } of [...frame.querySelectorAll(".labels, .foot")].flatMap(texts)) {
    const style = getComputedStyle(own);
    context.font = style.font;
    context.fillStyle = style.backgroundColor;
    context.fillRect(box.x - 4, box.y, box.width + 8, box.height);
    context.fillStyle = style.color;
    context.fillText(text.trim(), box.x, box.y + box.height / 2, box.width);
  }
  for (const own of frame.querySelectorAll<HTMLElement>(".ramp")) {
    const box = own.getBoundingClientRect();
    const shades = context.createLinearGradient(box.left, 0, box.right, 0);
    (own.dataset.colours ?? "").split(";").forEach((colour, i, all) => shades.addColorStop(i / (all.length - 1), colour));
    context.fillStyle = shades;
    context.fillRect(box.x, box.y, box.width, box.height);
  }
  return out;
}

/** Prints a still picture in the colours of paper: what is drawn by the graphics card may be missing there. */
export function printable(stage: Stage, store: Store): void {
  let still: HTMLCanvasElement | null = null;
  window.addEventListener("beforeprint", () => {
    stage.isPrinted = true;
    store.draw({});
    still = picture(stage);
    still.className = "print";
    stage.rendered().frame.append(still);
  });
  window.addEventListener("afterprint", () => {
    stage.isPrinted = false;
    still?.remove();
    store.draw({});
  });
}
