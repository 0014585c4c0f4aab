// Form of a computation: a section that opens, its fields, a button that starts and stops it, and its messages.

import type uPlot from "uplot";

import type { StateRequest } from "./api";
import { button, copyButton, element } from "./panel";
import { inWords, type Store } from "./store";

/** Field for a number; the step 1 makes it a whole one. */
export function typed(label: string, value: number | "", attributes: Record<string, string> = {}, isOptional = false): HTMLInputElement {
  const input = element("input", { type: "number", step: "any", "aria-label": label, value: String(value), ...attributes });
  input.required = !isOptional;
  return input;
}

/** A choice among words; the keys are the values. */
export function choice(label: string, options: Record<string, string>, value: string): HTMLSelectElement {
  const select = element("select", { "aria-label": label }, ...Object.entries(options).map(([key, words]) => element("option", { value: key }, words)));
  select.value = value;
  return select;
}

/** A row of a form: a word, its fields, and their unit. */
export function fields(word: string, unit: string, ...inputs: HTMLElement[]): HTMLElement {
  return element("div", { class: "fields" }, element("span", {}, word), element("div", {}, ...inputs), ...(unit === "" ? [] : [element("span", { class: "unit" }, unit)]));
}

/** Damping ratio of all modes. A model without damping needs one, and any value is an assumption. */
export class DampingField {
  readonly input: HTMLInputElement;
  readonly rows: HTMLElement[];

  constructor(isDamped: boolean) {
    this.input = typed("Damping ratio", isDamped ? "" : 0.03, { min: "0", max: "1", placeholder: isDamped ? "the model's" : "" }, isDamped);
    this.rows = [fields("Damping", "", this.input), ...(isDamped ? [] : [element("p", { class: "unit" }, "The model states no damping: 0.03 of critical in all modes is an assumption.")])];
  }

  value(): number | null {
    return this.input.value === "" ? null : this.input.valueAsNumber;
  }
}

/** A running computation, with the state that was current at its start. */
export interface Run {
  isStopped: boolean;
  readonly state: StateRequest;
}

export class Computation {
  readonly section: HTMLDetailsElement;
  /** Container of the results; it is emptied when another computation begins. */
  readonly output = element("div", {});
  chart: uPlot | null = null;
  private readonly form: HTMLFormElement;
  private readonly said = element("p", { class: "unit", role: "status" });
  private readonly alert = element("p", { class: "finding", role: "alert", hidden: "" });
  private readonly old = element("p", { class: "old", role: "status" });
  private readonly go: HTMLButtonElement;
  private run: Run | null = null;
  private of = "";

  constructor(
    private readonly store: Store,
    title: string,
    rows: HTMLElement[],
    private readonly compute: (run: Run) => Promise<void>,
    private readonly verb = "Compute",
    others: HTMLButtonElement[] = [],
  ) {
    this.go = button(verb, () => void this.start(), `${verb}: ${title}`);
    this.form = element("form", {}, ...rows, element("div", { class: "row" }, this.go, ...others));
    this.form.noValidate = true;
    this.form.addEventListener("submit", (event) => event.preventDefault());
    this.form.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && event.target instanceof HTMLInputElement && this.run === null) {
        event.preventDefault();
        void this.start();
      }
    });
    this.section = element("details", { class: "drawing computation" }, element("summary", {}, title), this.form, this.alert, this.said, this.old, this.output);
  }

  say(words: string): void {
    this.said.textContent = words;
  }

  /** True if the results belong to another state. */
  isOld(): boolean {
    return this.output.childElementCount > 0 && this.of !== JSON.stringify(this.store.request);
  }

  /** Marks results of another state, and draws a chart in the colours of now. */
  show(isOld = this.isOld(), words = "Of the state before: compute again."): void {
    const text = isOld ? words : "";
    if (this.old.textContent !== text) {
      this.old.textContent = text;
    }
    this.chart?.redraw(false);
  }

  clear(): void {
    this.chart?.destroy();
    this.chart = null;
    this.output.replaceChildren();
    this.say("");
  }

  /** Adds a button that copies the equivalent command for the current state. States of a job have no such command: its tool is not an option of `frf` and `lobes`. */
  offerCommand(command: string, options: () => string): void {
    const { store } = this;
    const state = () => /^kinetostat deflect (.* --joints .*)$/.exec(store.state?.cli ?? "")?.[1];
    const copy = copyButton("Copy command", () => (this.isComplete() ? `kinetostat ${command} ${state()} ${options()}` : null), (words) => this.say(words));
    this.go.after(copy);
    store.onChange(() => (copy.hidden = state() === undefined));
    copy.hidden = state() === undefined;
  }

  /** Starts the computation, or stops the one under way once its last request is answered. */
  private async start(): Promise<void> {
    if (this.run !== null) {
      this.run.isStopped = true;
      this.go.textContent = "Stopping";
      return;
    }
    if (!this.isComplete()) {
      return;
    }
    this.clear();
    this.run = { isStopped: false, state: this.store.request };
    this.of = JSON.stringify(this.run.state);
    this.say(`${this.verb} ...`);
    this.show();
    this.go.textContent = "Stop";
    try {
      await this.compute(this.run);
    } catch (error) {
      this.say("");
      this.refuse(inWords(error));
    }
    this.run = null;
    this.go.textContent = this.verb;
  }

  /** True if all fields have valid numbers; else the first invalid one gets the focus and a message. */
  private isComplete(): boolean {
    const wrong = this.form.querySelector<HTMLInputElement>("input:invalid");
    this.refuse(wrong === null ? "" : `${wrong.getAttribute("aria-label")}: ${allowed(wrong)}.`);
    wrong?.focus();
    return wrong === null;
  }

  private refuse(words: string): void {
    this.alert.textContent = words;
    this.alert.hidden = words === "";
  }
}

/** Message with the numbers that a field accepts. */
function allowed({ min, max, step }: HTMLInputElement): string {
  const number = step === "1" ? "a whole number" : "a number";
  const bounds = [min === "" ? "" : ` from ${min}`, max === "" ? "" : min === "" ? ` up to ${max}` : ` to ${max}`];
  return `${number}${bounds.join("")} is needed`;
}
