// The lines of a program: the one at hand is marked, and each leads to its place.

import type { Path } from "./api";
import { element } from "./panel";

/** Lines on each side of the current one. */
const AROUND = 60;

export class ProgramLines {
  readonly element = element("ol", { class: "program", tabindex: "0", "aria-label": "Lines of the program; the arrow keys go from line to line" });
  private readonly lines: string[];
  /** First place of each line that has one, by line. */
  private readonly first = new Map<number, number>();
  private current: number | null | undefined;

  constructor(
    path: Path,
    private readonly go: (index: number) => void,
  ) {
    this.lines = path.text.split(/\r?\n/);
    path.places.forEach((place, i) => this.first.has(place.line) || this.first.set(place.line, i));
    this.element.addEventListener("click", (event) => {
      const item = (event.target as HTMLElement).closest("li");
      if (item !== null) {
        this.choose(item.value);
      }
    });
    this.element.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step !== undefined) {
        event.preventDefault();
        this.step(step);
      }
    });
  }

  /** Goes to a line, or to the next one that has a place. */
  private choose(line: number): void {
    const far = (own: number) => Math.abs(own - line);
    const own = [...this.first.keys()].reduce((best, other) => (far(other) < far(best) ? other : best), Infinity);
    const index = this.first.get(own);
    if (index !== undefined) {
      this.go(index);
    }
  }

  private step(step: number): void {
    const lines = [...this.first.keys()].sort((a, b) => a - b);
    const from = this.current ?? 0;
    const next = step > 0 ? lines.find((line) => line > from) : lines.reverse().find((line) => line < from);
    if (next !== undefined) {
      this.choose(next);
    }
  }

  /** Shows the lines around one and marks it; the beginning without one. */
  show(line: number | null): void {
    if (this.current === line) {
      return;
    }
    this.current = line;
    const middle = (line ?? 1) - 1;
    const start = Math.max(middle - AROUND, 0);
    const list = this.lines.slice(start, middle + AROUND);
    this.element.replaceChildren(
      ...list.map((text, i) => {
        const number = start + i + 1;
        const item = element("li", { value: String(number) }, text || " ");
        item.classList.toggle("has-place", this.first.has(number));
        if (number === line) {
          item.setAttribute("aria-current", "true");
        }
        return item;
      }),
    );
    const marked = this.element.querySelector<HTMLElement>("[aria-current]");
    this.element.scrollTop = marked === null ? 0 : marked.offsetTop - this.element.offsetTop - this.element.clientHeight / 2;
  }
}
