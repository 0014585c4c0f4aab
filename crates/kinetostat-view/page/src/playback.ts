// Playback of a path: a clock that runs with the times of the program, or evenly along the path.

import type { Place } from "./api";

/** Time in which a whole path is played if no rate is given, s. */
export const FIT = 20;
/** Longest step of the clock, s: a hidden page gets no frames, and goes on from where it was. */
const LONGEST_STEP = 0.5;

/** Times of the places from the first one, s; null if the program gives none. */
export function timesOf(places: Place[]): number[] | null {
  const times = places.map((place) => place.time_s ?? NaN);
  const isRising = times.every((time, i) => i === 0 || time >= times[i - 1]!);
  const first = times[0] ?? NaN;
  return isRising && times[times.length - 1]! > first ? times.map((time) => time - first) : null;
}

export class Playback {
  /** False if the places have no times: the path is then played evenly. */
  readonly hasTimes: boolean;
  /** Multiple of the real speed; null: the whole path in `FIT` seconds. */
  rate: number | null = null;
  private readonly times: number[];
  private clock = 0;
  private index = 0;
  private last: number | null = null;

  constructor(
    places: Place[],
    private readonly go: (index: number) => void,
    private readonly changed: () => void,
  ) {
    const times = timesOf(places);
    this.hasTimes = times !== null;
    this.times = times ?? places.map((place) => place.path_mm - places[0]!.path_mm);
  }

  get isPlaying(): boolean {
    return this.last !== null;
  }

  /** Sets the clock to a place. */
  seek(index: number): void {
    this.index = index;
    this.clock = this.times[index] ?? 0;
  }

  /** Starts or stops; at the end it starts anew. */
  toggle(): void {
    if (this.isPlaying) {
      this.stop();
      return;
    }
    if (this.index >= this.times.length - 1) {
      this.seek(0);
      this.go(0);
    }
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
    this.changed();
  }

  stop(): void {
    this.last = null;
    this.changed();
  }

  private tick(now: number): void {
    if (this.last === null) {
      return;
    }
    const total = this.times[this.times.length - 1] ?? 0;
    const rate = this.hasTimes && this.rate !== null ? this.rate : total / FIT;
    this.clock += rate * Math.min((now - this.last) / 1000, LONGEST_STEP);
    this.last = now;
    let next = this.index;
    while (next < this.times.length - 1 && this.times[next + 1]! <= this.clock) {
      next += 1;
    }
    if (next !== this.index) {
      this.index = next;
      this.go(next);
    }
    if (this.clock >= total) {
      this.stop();
      return;
    }
    requestAnimationFrame((later) => this.tick(later));
  }
}
