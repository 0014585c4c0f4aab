// Words over the picture: each beside its point, where it covers no other word and no arrow.

import * as three from "three";

export interface Label {
  at: three.Vector3;
  text: string;
  /** True if the word is shown even where it covers others. */
  isNeeded?: boolean;
}

interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

const GAP = 8;

const overlaps = (a: Box, b: Box) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

export class Labels {
  readonly element = document.createElement("div");
  private placed: { own: HTMLElement; at: three.Vector3; isNeeded: boolean; width: number; height: number }[] = [];

  constructor() {
    this.element.className = "labels";
  }

  /** Sets the words; the first ones get the best places. */
  set(labels: Label[]): void {
    const made = labels.map(({ at, text, isNeeded = false }) => {
      const own = document.createElement("span");
      own.textContent = text;
      return { own, at, isNeeded };
    });
    this.element.replaceChildren(...made.map(({ own }) => own));
    this.placed = made.map((label) => ({ ...label, width: label.own.offsetWidth, height: label.own.offsetHeight }));
  }

  /** Puts each word beside its point; a word without a free place is not shown. */
  place(project: (v: three.Vector3) => three.Vector3, blocked: three.Vector3[], fixed: DOMRect[]): void {
    const { clientWidth: wide, clientHeight: high } = this.element;
    const frame = this.element.getBoundingClientRect();
    const taken: Box[] = fixed.map((own) => ({ x: own.x - frame.x, y: own.y - frame.y, width: own.width, height: own.height }));
    taken.push(...blocked.map(project).map((at) => ({ x: at.x - 3, y: at.y - 3, width: 6, height: 6 })));
    for (const { own, at, isNeeded, width, height } of this.placed) {
      const p = project(at);
      const sides: [number, number][] = [
        [GAP, -height / 2],
        [-width - GAP, -height / 2],
        [-width / 2, -height - GAP],
        [-width / 2, GAP],
        [GAP, -height - GAP],
        [GAP, GAP],
        [-width - GAP, -height - GAP],
        [-width - GAP, GAP],
        [2.5 * GAP, -2 * height],
        [2.5 * GAP, height],
      ];
      const inside = sides.map(([dx, dy]): Box => ({ x: p.x + dx, y: p.y + dy, width, height })).filter((box) => box.x >= 0 && box.y >= 0 && box.x + width <= wide && box.y + height <= high);
      const box = inside.find((one) => !taken.some((other) => overlaps(one, other))) ?? (isNeeded ? inside[0] : undefined);
      own.style.visibility = box !== undefined && p.z <= 1 ? "visible" : "hidden";
      if (box !== undefined) {
        own.style.transform = `translate(${box.x}px, ${box.y}px)`;
        taken.push(box);
      }
    }
  }
}
