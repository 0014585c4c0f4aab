// The panel beside the machine: joints, tool, load, figures, and what can be copied.

import { hasAddress, isEmbedded } from "./address";
import type { State, Vec3 } from "./api";
import { limbValues } from "./byvalue";
import { byShare } from "./colour";
import type { Computation } from "./computation";
import { CurveView } from "./curve";
import { LobesView } from "./lobes";
import { MapView } from "./map";
import { opening } from "./opening";
import { picture } from "./picture";
import { ResponseView } from "./response";
import type { Stage } from "./stage";
import { scaleOf, shown, type Colours, type Store } from "./store";
import { summary } from "./summary";

/** An element with attributes and content. */
export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, string> = {}, ...content: (Node | string)[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  made.append(...content);
  return made;
}

export function button(words: string, action: () => void, title = words): HTMLButtonElement {
  const made = element("button", { type: "button", title }, words);
  made.addEventListener("click", action);
  return made;
}

/** A button that copies a text, if there is one; where the browser refuses, the text is shown. */
export function copyButton(words: string, text: () => string | null, say: (words: string) => void): HTMLButtonElement {
  return button(words, () => {
    const own = text();
    const ask = () => void window.prompt("To be copied:", own ?? "");
    if (own !== null && navigator.clipboard === undefined) {
      ask();
    } else if (own !== null) {
      navigator.clipboard.writeText(own).then(() => say("copied"), ask);
    }
  });
}

function section(title: string, ...content: (Node | string)[]): HTMLElement {
  return element("section", {}, element("h2", {}, title), ...content);
}

/** A number that is typed; empty counts as nothing. */
function number(label: string, unit: string, change: (x: number) => void): HTMLInputElement {
  const input = element("input", { type: "number", step: "any", "aria-label": `${label}, ${unit}` });
  input.addEventListener("change", () => {
    if (input.value !== "" && Number.isFinite(input.valueAsNumber)) {
      change(input.valueAsNumber);
    }
  });
  return input;
}

/** A number as its field has room for it. */
function inField(x: number): string {
  return String(Number(Math.abs(x) < 100 ? x.toPrecision(5) : x.toFixed(2)));
}

/** Three numbers of a vector. */
class VectorInput {
  readonly row: HTMLElement;
  private readonly inputs: HTMLInputElement[];
  private values: Vec3 = [0, 0, 0];

  constructor(label: string, unit: string, live: boolean, change: (v: Vec3) => void) {
    this.inputs = ["x", "y", "z"].map((axis, k) =>
      number(`${label} ${axis}`, unit, (x) => {
        const next: Vec3 = [...this.values];
        next[k] = x;
        // The next number may be typed before the answer comes.
        this.values = next;
        change(next);
      }),
    );
    this.inputs.forEach((input) => (input.disabled = !live));
    this.row = element("div", { class: "triple" }, element("span", {}, label), ...this.inputs, element("span", { class: "unit" }, unit));
  }

  /** Lets the numbers be typed, or not. */
  enable(isEnabled: boolean): void {
    this.inputs.forEach((input) => (input.disabled = !isEnabled));
  }

  show(values: Vec3): void {
    this.values = values;
    this.inputs.forEach((input, k) => {
      if (document.activeElement !== input) {
        input.value = inField(values[k]!);
      }
    });
  }
}

export class Panel {
  private readonly finding = element("p", { class: "finding", role: "alert" });
  private readonly sliders: { range: HTMLInputElement; typed: HTMLInputElement }[];
  /** Computations on demand; none in a file. */
  private readonly computations: { computation: Computation; show?(): void }[];
  private readonly tool: VectorInput;
  private readonly force: VectorInput;
  private readonly moment: VectorInput;
  private readonly noLoad = button("No load", () => this.store.change({ force_n: null, moment_n_m: null }));
  private readonly figures = element("dl", {});
  private readonly nearby = element("p", { class: "unit" });
  private readonly shares = element("div", { class: "shares" });
  private readonly legend = element("div", { class: "shares" });
  private readonly scale: HTMLInputElement;
  private readonly said = element("span", { role: "status", class: "unit" });

  constructor(
    place: HTMLElement,
    private readonly store: Store,
    private readonly stage: Stage,
  ) {
    const { machine, source } = store;
    const live = source.live;
    this.computations = live ? [new CurveView(store), new MapView(store, stage), new ResponseView(store), new LobesView(store)] : [];
    this.sliders = machine.actuators.map((actuator, i) => {
      const far = actuator.unit === "deg" ? 180 : machine.size_mm;
      const [low, high] = [actuator.low ?? actuator.home - far, actuator.high ?? actuator.home + far];
      const change = (x: number) => {
        const values = [...(store.request.actuators ?? store.state?.actuators ?? machine.actuators.map((own) => own.home))];
        values[i] = x;
        store.change({ actuators: values });
      };
      const label = `${actuator.name}, ${actuator.unit}`;
      const range = element("input", { type: "range", min: String(low), max: String(high), step: "any", "aria-label": label });
      range.addEventListener("input", () => change(Number(range.valueAsNumber.toPrecision(7))));
      const typed = number(actuator.name, actuator.unit, change);
      range.disabled = !live;
      typed.disabled = !live;
      return { range, typed };
    });
    const joints = machine.actuators.map((actuator, i) => {
      const { range, typed } = this.sliders[i]!;
      return element("div", { class: "joint" }, element("span", {}, actuator.name), range, typed, element("span", { class: "unit" }, actuator.unit));
    });
    this.tool = new VectorInput("Tool", "mm", live, (at_mm) => store.change({ at_mm }));
    this.force = new VectorInput("Force", "N", live, (force_n) => store.change({ force_n }));
    this.moment = new VectorInput("Moment", "N m", live, (moment_n_m) => store.change({ moment_n_m }));
    this.scale = element("input", { type: "range", min: "0", max: "6", step: "0.01", "aria-label": "Factor of the drawn deflection" });
    this.scale.addEventListener("input", () => store.draw({ scale: 10 ** this.scale.valueAsNumber }));
    place.append(
      element("h1", {}, machine.name),
      ...(machine.description === null ? [] : [element("p", { class: "unit" }, machine.description)]),
      ...(live ? [] : [element("p", { class: "unit" }, "This file holds results; kinetostat view computes new ones.")]),
      ...[summary(store.path?.headline ?? [])].filter((own) => own !== null),
      this.finding,
      section("Joints", ...joints, element("div", { class: "row" }, ...(live ? [button("Home", () => store.change({ actuators: null }))] : []))),
      section("Tool and load, base axes", this.tool.row, this.force.row, this.moment.row, element("div", { class: "row" }, ...(live ? [this.noLoad] : []))),
      this.drawing(),
      section("Figures", this.nearby, this.figures),
      section("What bends", this.shares),
      ...this.computations.map((own) => own.computation.section),
      element("div", { class: "row" }, ...(hasAddress() ? [this.copy("Copy link", () => store.link())] : []), this.copy("Copy command", () => store.state?.cli ?? ""), this.copy("Copy Python", () => store.state?.python ?? ""), this.picture(), ...(isEmbedded() ? [] : [this.saveModel()]), this.said),
      ...(source.opens ? [opening(source)] : []),
      element("p", { class: "unit" }, `kinetostat ${machine.version}`),
    );
  }

  /** How the state is drawn; it is not printed. */
  private drawing(): HTMLElement {
    const { store } = this;
    const out = section(
      "Drawing",
      element("div", { class: "joint" }, element("span", {}, "Deflection"), this.scale, button("Round", () => store.draw({ scale: 0 }), "A round factor that shows it")),
      element("div", { class: "row" }, this.swing(), this.check("Names", "names"), this.check("Ellipsoid of displacements", "ellipsoid"), this.check("of turns", "rotary"), ...((store.path?.boxes ?? []).length > 0 ? [this.check("Stock, part and obstacles", "boxes")] : [])),
      this.colours(),
      this.legend,
    );
    out.classList.add("drawing");
    return out;
  }

  private swing(): HTMLElement {
    const words = ["nothing", "the deflection", ...[1, 2, 3, 4, 5, 6].map((mode) => `mode ${mode}`)];
    const list = this.store.source.live ? words : words.slice(0, 2);
    const select = element("select", {}, ...list.map((text, i) => element("option", { value: String(i - 1) }, text)));
    select.value = String(this.store.look.swing ?? -1);
    select.addEventListener("change", () => this.store.draw({ swing: select.value === "-1" ? null : Number(select.value) }));
    return element("label", { class: "row" }, "Swing", select);
  }

  private check(words: string, key: "names" | "ellipsoid" | "rotary" | "boxes"): HTMLElement {
    const box = element("input", { type: "checkbox" });
    box.checked = this.store.look[key];
    box.addEventListener("change", () => this.store.draw({ [key]: box.checked }));
    return element("label", {}, box, words);
  }

  private colours(): HTMLElement {
    const words: Record<Colours, string> = { none: "Plain", share: "Share of the deflection", load: "Force on the limb", buckling: "Way to buckling" };
    const select = element("select", {}, ...Object.entries(words).map(([value, text]) => element("option", { value }, text)));
    select.value = this.store.look.colours;
    select.addEventListener("change", () => this.store.draw({ colours: select.value as Colours }));
    return element("label", { class: "row" }, "Limbs coloured by", select);
  }

  private copy(words: string, text: () => string): HTMLElement {
    return copyButton(words, text, (said) => (this.said.textContent = said));
  }

  private saveModel(): HTMLElement {
    const { machine } = this.store;
    return button("Save model", () => {
      const href = URL.createObjectURL(new Blob([machine.model_text], { type: "text/plain" }));
      element("a", { href, download: `${machine.name}.toml` }).click();
      URL.revokeObjectURL(href);
    });
  }

  private picture(): HTMLElement {
    return button("Save picture", () => {
      element("a", { href: picture(this.stage).toDataURL("image/png"), download: `${this.store.machine.name}.png` }).click();
    });
  }

  show(): void {
    const { state, error } = this.store;
    const text = error ?? state?.finding ?? (state?.stable === false ? "Not stable: the machine does not stay here." : "");
    this.finding.textContent = text || (state?.within_limits === false ? "Beyond the limits of a joint." : "");
    this.finding.hidden = this.finding.textContent === "";
    if (state === null) {
      return;
    }
    this.sliders.forEach(({ range, typed }, i) => {
      const value = state.actuators[i] ?? 0;
      if (document.activeElement !== range) {
        range.value = String(value);
      }
      if (document.activeElement !== typed) {
        typed.value = String(Number(value.toFixed(3)));
      }
    });
    this.tool.show(state.tool.position_mm);
    // At a place of the program its own load acts.
    const isLoadFree = this.store.source.live && typeof this.store.request.place !== "number";
    this.force.enable(isLoadFree);
    this.moment.enable(isLoadFree);
    this.noLoad.disabled = !isLoadFree;
    this.force.show(state.force_n);
    this.moment.show(state.moment_n_m);
    this.scale.value = String(Math.log10(scaleOf(this.store)));
    this.nearby.textContent = this.store.nearby().replace("Machine drawn", "Figures");
    this.figures.replaceChildren(
      ...state.figures.flatMap((own) => [element("dt", {}, own.label), element("dd", {}, own.value, ...(own.detail === null ? [] : [element("small", {}, own.detail)]))]),
    );
    if (state.compliance && this.store.look.ellipsoid) {
      const list = state.compliance.um_per_n.map(shown).join(", ");
      this.figures.append(element("dt", {}, "Axes of the ellipsoid"), element("dd", {}, `${list} um/N`));
    }
    if (state.rotary_compliance && this.store.look.rotary) {
      const list = state.rotary_compliance.urad_per_n_m.map(shown).join(", ");
      this.figures.append(element("dt", {}, "Axes of the turns"), element("dd", {}, `${list} urad/(N m)`));
    }
    this.showShares(state);
    this.showLegend();
    this.computations.forEach((own) => (own.show === undefined ? own.computation.show() : own.show()));
  }

  private showShares(state: State): void {
    const several = this.store.machine.limbs.length > 1;
    const list = state.shares.filter((share) => Math.abs(share.percent) >= 0.1).slice(0, 12);
    this.shares.replaceChildren(
      ...list.map((share) => bar(several && share.limb !== null ? `${share.limb}: ${share.part}` : share.part, share.percent / 100, `${share.percent.toFixed(1)} %`, "var(--accent)")),
    );
    if (list.length === 0) {
      this.shares.append(element("p", { class: "unit" }, "A load shows it: shares are those of the deflection along the load."));
    }
  }

  private showLegend(): void {
    const values = limbValues(this.store);
    const most = Math.max(...values, 1e-300);
    const unit = this.store.look.colours === "load" ? "N" : "%";
    this.legend.replaceChildren(...values.map((value, i) => bar(this.store.machine.limbs[i]!, value / most, `${shown(value)} ${unit}`, byShare(value / most, this.stage.dark()))));
  }
}

function bar(label: string, share: number, value: string, colour: string): HTMLElement {
  const fill = element("span", { class: "fill" });
  fill.style.width = `${Math.min(Math.max(100 * share, 0), 100)}%`;
  fill.style.background = colour;
  return element("div", { class: "bar" }, element("span", {}, label), element("span", { class: "track" }, fill), element("span", { class: "value" }, value));
}
