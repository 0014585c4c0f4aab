// What the server answers. The types are those of `kinetostat schema view`.

export type Vec3 = [number, number, number];

export interface Pose {
  position_mm: Vec3;
  quaternion_xyzw: [number, number, number, number];
}

export interface Machine {
  name: string;
  description: string | null;
  source: string;
  actuators: { name: string; unit: "deg" | "mm"; low: number | null; high: number | null; home: number }[];
  limbs: string[];
  size_mm: number;
  gravity_m_per_s2: Vec3;
  has_path: boolean;
  /** What a map of it can show. */
  variables: { name: string; unit: string; description: string }[];
  /** True if the model states how vibrations are damped. */
  is_damped: boolean;
  /** The model file. */
  model_text: string;
  version: string;
}

export interface StateRequest {
  actuators?: number[] | null;
  at_mm?: Vec3 | null;
  place?: number | null;
  force_n?: Vec3 | null;
  moment_n_m?: Vec3 | null;
}

export interface Bar {
  limb: number | null;
  ends_mm: [Vec3, Vec3];
  tangents_mm: [Vec3, Vec3];
  kind: "rigid" | "elastic" | "rod" | "ram" | "twice" | "rail" | "spring";
}

export interface Joint {
  at_mm: Vec3;
  axis: Vec3;
  across: Vec3;
  half_mm: number;
  kind: "motor" | "sleeve" | "slide" | "turn" | "universal" | "spherical" | "spring";
}

export interface Scene {
  bars: Bar[];
  joints: Joint[];
  plates: { points_mm: Vec3[]; base: boolean }[];
  grounds: { at_mm: Vec3; away: Vec3 }[];
  words: { at_mm: Vec3; text: string }[];
  tool: Pose;
  size_mm: number;
}

export interface State {
  actuators: number[];
  within_limits: boolean;
  tool: Pose;
  tool_deflected: Pose | null;
  scene: Scene;
  deflected: Scene | null;
  force_n: Vec3;
  moment_n_m: Vec3;
  figures: { label: string; value: string; detail: string | null }[];
  displacement_mm: Vec3 | null;
  displacement_by_load_mm: Vec3 | null;
  turn_mrad: Vec3 | null;
  compliance: { axes: Vec3[]; um_per_n: number[] } | null;
  rotary_compliance: { axes: Vec3[]; urad_per_n_m: number[] } | null;
  shares: { part: string; limb: string | null; percent: number }[];
  stable: boolean | null;
  limb_loads: { limb: string; force_n: Vec3; share_to_buckling: number | null }[];
  finding: string | null;
  cli: string;
  python: string;
}

export interface Place {
  line: number;
  path_mm: number;
  /** Time from the start of the program at its feed, s; not in older results. */
  time_s?: number | null;
  position_mm: Vec3;
  force_n: Vec3;
  error_before_mm: number;
  error_after_mm: number;
  /** Of each actuator, N or N m. */
  drives?: number[];
  share_of_rating?: number | null;
  share_to_buckling?: number | null;
  /** Depth of the cut by the depth at which it chatters. */
  depth_by_limit?: number | null;
}

/** A box in base axes. */
export interface SolidBox {
  name: string;
  kind: "stock" | "part" | "obstacle";
  corner_mm: Vec3;
  edges_mm: [Vec3, Vec3, Vec3];
}

export interface Path {
  program: string;
  text: string;
  places: Place[];
  tolerance_mm: number;
  headline: string[];
  boxes?: SolidBox[];
  has_stock?: boolean;
}

export interface Modes {
  from: Scene;
  modes: { frequency_hz: number; words: string; moved: Scene }[];
}

/** An equilibrium while the load grows. */
export interface CurvePlace {
  factor: number;
  along: number;
  stable: boolean;
  shape: Scene;
}

export interface Curve {
  unit: "mm" | "deg";
  branches: { places: CurvePlace[] }[];
  marks: { words: string; factor: number; along: number }[];
  more_branches: boolean;
}

/** A grid of places, the tool turned as in the state and under its load; x runs fastest. */
export interface MapRequest {
  state: StateRequest;
  variable: string;
  from_mm: Vec3;
  to_mm: Vec3;
  counts: [number, number, number];
}

export interface ResponseRequest {
  state: StateRequest;
  frequencies_hz: [number, number];
  count: number;
  /** Of all modes; without it the damping of the model. */
  damping_ratio?: number | null;
}

export interface Response {
  frequencies_hz: number[];
  /** Along x, y and z, each by a force along itself. */
  um_per_n: [number[], number[], number[]];
  natural_frequencies_hz: number[];
  damping: string;
  warnings: string[];
}

export interface LobesRequest {
  state: StateRequest;
  speed_rpm: [number, number];
  speeds: number;
  depth_mm: number;
  teeth: number;
  /** Width of cut by diameter. */
  immersion: number;
  up: boolean;
  feed_direction: Vec3;
  /** Tangential, radial, axial. */
  coefficients_n_per_mm2: Vec3;
  damping_ratio?: number | null;
}

export interface Lobes {
  points: { speed_rpm: number; limit_mm: number | null; kind: string | null; chatter_hz: number | null; stable_mm: [number, number][]; zeroth_order_mm: number | null }[];
  best: { speed_rpm: number; depth_mm: number; no_limit_found: boolean } | null;
  damping: string;
  warnings: string[];
}

export interface Exported {
  /** Further states come from the page around this one. */
  live?: boolean;
  machine: Machine;
  state: State;
  path: Path | null;
  states: { place: number; state: State }[];
}

/** What is left of the stock at a place: heights above its bottom over a grid of the part, x fastest; null where there is nothing. */
export interface Stock {
  corner_mm: Vec3;
  steps_mm: [Vec3, Vec3];
  up_mm: Vec3;
  counts: [number, number];
  heights: (number | null)[];
}

/** Where the questions of `kinetostat start` stand. */
export interface Start {
  /** Null: all is known. */
  question: { words: string; help: string; usual: string | null; choices: string[] } | null;
  given: { words: string; answer: string }[];
  /** What was understood of the last answer. */
  said: string[];
  refused: string | null;
  /** The machine stands behind the next question for it. */
  written: string[];
}

/** What the page asks: the request and the answer of each question. */
export interface Questions {
  /** Null: there is none yet, and the questions of `start` come first. */
  machine: [Record<string, never>, Machine | null];
  start: [{ answer?: string; back?: boolean; write?: boolean }, Start];
  /** Shows the job, or else the model, of some files. */
  open: [{ files: { name: string; text: string }[] }, null];
  /** Null: there is no program. */
  path: [Record<string, never>, Path | null];
  state: [StateRequest, State];
  stock: [{ place: number }, Stock];
  /** Vibrations about a state; the lowest first. */
  modes: [StateRequest, Modes];
  /** Equilibria while the load of a state grows to a factor of it. */
  curve: [{ state: StateRequest; factor: number }, Curve];
  /** A quantity over places; null where the machine cannot be. */
  map: [MapRequest, { values: (number | null)[] }];
  /** How the tip answers to a vibrating force. */
  response: [ResponseRequest, Response];
  /** At which speeds and depths a cut chatters. */
  lobes: [LobesRequest, Lobes];
}

/** Where answers come from: the server, the file itself, or the page around it. */
export interface Source {
  /** True if it opens other files. */
  readonly opens: boolean;
  /** The state that is shown first, if not that at home. */
  readonly start?: StateRequest;
  readonly live: boolean;
  /** Places of the path of which there are states; null: of all. */
  readonly stored: number[] | null;
  ask<Q extends keyof Questions>(question: Q, request: Questions[Q][0]): Promise<Questions[Q][1]>;
}

class Server implements Source {
  readonly opens = true;
  readonly live = true;
  readonly stored = null;

  async ask<Q extends keyof Questions>(question: Q, request: Questions[Q][0]): Promise<Questions[Q][1]> {
    const headers = { "content-type": "application/json" };
    const answer = await fetch(`api/${question}`, { method: "POST", headers, body: JSON.stringify(request) });
    const body: unknown = await answer.json();
    if (answer.ok) {
      return body as Questions[Q][1];
    }
    const error = (body as { error?: { message?: string } }).error;
    throw new Error(error?.message ?? `The server answers with ${answer.status}.`);
  }
}

class File implements Source {
  readonly opens = false;
  readonly live = false;
  readonly stored: number[];

  constructor(private readonly held: Exported) {
    this.stored = held.states.map((own) => own.place);
  }

  async ask<Q extends keyof Questions>(question: Q, request: Questions[Q][0]): Promise<Questions[Q][1]> {
    const answers: { [K in keyof Questions]?: () => Questions[K][1] } = {
      machine: () => this.held.machine,
      path: () => this.held.path,
      state: () => this.state(request as StateRequest),
    };
    const answer = answers[question];
    if (answer === undefined) {
      throw new Error("This file holds results; kinetostat view computes new ones.");
    }
    return answer();
  }

  private state(request: StateRequest): State {
    const place = typeof request.place === "number" ? nearest(this.stored, request.place) : null;
    return this.held.states.find((own) => own.place === place)?.state ?? this.held.state;
  }
}

/** The page around this one answers, as a notebook does: a message with a number, and one with the same number back. */
class Around implements Source {
  readonly opens = false;
  readonly live = true;
  readonly stored = null;
  readonly start: StateRequest;
  private readonly waiting = new Map<number, { resolve: (answer: never) => void; reject: (error: Error) => void }>();
  private asked = 0;

  constructor(private readonly held: Exported) {
    const { actuators, force_n, moment_n_m } = held.state;
    this.start = { actuators, force_n, moment_n_m };
    window.addEventListener("message", ({ source, data }) => {
      const own = source === window.parent ? this.waiting.get(data?.id) : undefined;
      this.waiting.delete(data?.id);
      if (data?.error !== undefined) {
        own?.reject(new Error(String(data.error)));
      } else {
        own?.resolve(data?.answer as never);
      }
    });
  }

  async ask<Q extends keyof Questions>(question: Q, request: Questions[Q][0]): Promise<Questions[Q][1]> {
    // The machine and its first state came with the page.
    if (question === "machine" || request === this.start) {
      return (question === "machine" ? this.held.machine : this.held.state) as Questions[Q][1];
    }
    const id = (this.asked += 1);
    window.parent.postMessage({ kinetostat: question, id, request }, "*");
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve: resolve as (answer: never) => void, reject }));
  }
}

/** The place of a list that is nearest to one. */
export function nearest(places: number[], place: number): number | null {
  const far = (own: number) => Math.abs(own - place);
  return places.reduce((best: number | null, own) => (best === null || far(own) < far(best) ? own : best), null);
}

export function source(): Source {
  const text = document.getElementById("kinetostat-data")?.textContent ?? "";
  if (text === "") {
    return new Server();
  }
  const held = JSON.parse(text) as Exported;
  return held.live && window.parent !== window ? new Around(held) : new File(held);
}
