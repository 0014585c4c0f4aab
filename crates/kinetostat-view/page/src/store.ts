// What is shown: the state that is asked for, its answer, and how it is drawn. All of it stands in the address of the page.

import { keep } from "./address";
import { nearest } from "./api";
import type { Machine, Modes, Path, Scene, Source, State, StateRequest, Stock } from "./api";

export type Colours = "none" | "share" | "load" | "buckling";

/** How a state is drawn. */
export interface Look {
  /** Factor of the deflection; 0: a round one that shows it. */
  scale: number;
  ellipsoid: boolean;
  rotary: boolean;
  colours: Colours;
  names: boolean;
  /** What swings: nothing, the deflection, or a mode by its number from 1. */
  swing: number | null;
  /** What the path of a program is coloured by, by its key. */
  path: string;
  boxes: boolean;
  dark: boolean | null;
}

export class Store {
  request: StateRequest = {};
  look: Look = {
    scale: 0,
    ellipsoid: false,
    rotary: false,
    colours: "none",
    names: true,
    swing: null,
    path: "before",
    boxes: true,
    dark: null,
  };
  state: State | null = null;
  /** Vibrations about the state; none until they are asked for. */
  modes: Modes | null = null;
  stock: Stock | null = null;
  error: string | null = null;
  /** The machine at a place of a curve, drawn as it is; none: as it bends under its load. */
  private shape: Scene | null = null;
  private readonly listeners: (() => void)[] = [];
  private asking = false;
  private waiting = false;

  constructor(
    readonly source: Source,
    readonly machine: Machine,
    readonly path: Path | null,
  ) {
    this.restore();
    window.addEventListener("hashchange", () => {
      if (window.location.hash !== this.hash()) {
        this.restore();
        void this.ask();
      }
    });
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Asks for another state; what is not named stays. */
  change(request: StateRequest): void {
    const isPlace = request.actuators !== undefined || request.at_mm !== undefined || request.place !== undefined;
    const { force_n, moment_n_m } = this.request;
    this.request = isPlace ? { force_n, moment_n_m, ...request } : { ...this.request, ...request };
    // Of a place of the program the load is the program's.
    if (typeof request.place === "number") {
      this.request = { place: request.place };
    }
    void this.ask();
  }

  /** What is left of the stock at the place that is shown, if there is one and boxes are drawn. */
  private async stockNow(): Promise<Stock | null> {
    const { place } = this.request;
    const isAsked = this.look.boxes && this.source.live && this.path?.has_stock === true;
    return isAsked && typeof place === "number" ? this.source.ask("stock", { place }) : null;
  }

  showShape(shape: Scene | null): void {
    this.shape = shape;
    this.changed();
  }

  /** True while a shape is shown in its own size. */
  hasShape(): boolean {
    return this.shape !== null && !this.look.swing;
  }

  draw(look: Partial<Look>): void {
    this.look = { ...this.look, ...look };
    const lacksStock = look.boxes === true && this.stock === null;
    if ((this.look.swing && this.modes === null) || lacksStock) {
      void this.ask();
    }
    this.changed();
  }

  /** The motion that is drawn: from the machine as commanded to its equilibrium, or along a mode. */
  motion(): { from: Scene; to: Scene } | null {
    const mode = this.look.swing ? this.modes?.modes[this.look.swing - 1] : undefined;
    if (mode !== undefined && this.modes !== null) {
      return { from: this.modes.from, to: mode.moved };
    }
    const { state } = this;
    if (state !== null && this.shape !== null) {
      return { from: state.scene, to: this.shape };
    }
    return state?.deflected ? { from: state.scene, to: state.deflected } : null;
  }

  /** One request is under way at a time, and the latest one waits: whoever drags is never behind. */
  async ask(): Promise<void> {
    this.waiting = true;
    if (this.asking) {
      return;
    }
    this.asking = true;
    while (this.waiting) {
      this.waiting = false;
      try {
        this.state = await this.source.ask("state", this.request);
        this.shape = null;
        this.stock = await this.stockNow();
        this.modes = this.look.swing ? await this.source.ask("modes", this.request) : null;
        this.error = null;
      } catch (error) {
        this.error = inWords(error);
      }
      this.changed();
    }
    this.asking = false;
  }

  /** Which state is shown where not all have been stored; empty where it is that of the place. */
  nearby(): string {
    const { stored } = this.source;
    const { place } = this.request;
    const own = stored === null || typeof place !== "number" ? null : nearest(stored, place);
    if (stored === null || own === null || own === place) {
      return "";
    }
    return `Machine drawn at line ${this.path?.places[own]?.line}: the nearest of ${stored.length} stored places.`;
  }

  link(): string {
    return window.location.href.split("#")[0] + this.hash();
  }

  private changed(): void {
    keep(this.hash());
    this.listeners.forEach((listener) => listener());
  }

  private hash(): string {
    const plain: StateRequest = Object.fromEntries(Object.entries(this.request).filter(([, value]) => value !== null && value !== undefined));
    return `#state=${encodeURIComponent(JSON.stringify(plain))}&look=${encodeURIComponent(JSON.stringify(this.look))}`;
  }

  private restore(): void {
    const words = new URLSearchParams(window.location.hash.slice(1));
    const read = <T>(key: string, otherwise: T): T => {
      try {
        return { ...otherwise, ...(JSON.parse(words.get(key) ?? "{}") as T) };
      } catch {
        return otherwise;
      }
    };
    const { start } = this.source;
    this.request = words.has("state") || start === undefined ? read<StateRequest>("state", {}) : start;
    this.look = read("look", this.look);
  }
}

/** Message of an error of a request. */
export function inWords(error: unknown): string {
  return error instanceof TypeError ? "The server does not answer: is the command still running?" : String((error as Error).message ?? error);
}

/** 1, 2 or 5 times a power of ten, at most `x`. */
export function round(x: number): number {
  if (!(x > 0) || !Number.isFinite(x)) {
    return 1;
  }
  const power = 10 ** Math.floor(Math.log10(x));
  const digit = [5, 2, 1].find((d) => d * power <= x * (1 + 1e-9)) ?? 1;
  return digit * power;
}

/** A number with three digits, as people read it. */
export function shown(x: number): string {
  if (x === 0) {
    return "0";
  }
  const size = Math.abs(x);
  return size >= 1e5 || size < 1e-3 ? x.toExponential(2) : String(Number(x.toPrecision(size >= 1000 ? 4 : 3)));
}

/** The factor at which the deflection is drawn. */
export function scaleOf(store: Store): number {
  const { look, machine } = store;
  const motion = store.motion();
  if (store.hasShape()) {
    return 1;
  }
  // A mode has no size of its own.
  if (motion === null || (look.scale > 0 && !look.swing)) {
    return look.scale > 0 ? look.scale : 1;
  }
  let most = 0;
  motion.from.bars.forEach((bar, i) => {
    const moved = motion.to.bars[i];
    bar.ends_mm.forEach((end, k) => {
      const to = moved?.ends_mm[k] ?? end;
      most = Math.max(most, Math.hypot(to[0] - end[0], to[1] - end[1], to[2] - end[2]));
    });
  });
  return most > 0 ? round((0.08 * machine.size_mm) / most) : 1;
}
