// What the path of a program can be coloured by, as far as its results say.

import type { Machine, Path, Place } from "./api";
import { shown } from "./store";
import { length } from "./units";

export interface PathColour {
  key: string;
  words: string;
  value: (place: Place) => number;
  text: (value: number) => string;
  /** True at a place that is marked, and what that says. */
  isOver: (place: Place) => boolean;
  over: string;
}

const percent = (value: number) => `${shown(100 * value)} %`;

export function pathColours(path: Path, machine: Machine): PathColour[] {
  const tolerance = { isOver: (place: Place) => place.error_before_mm > path.tolerance_mm, over: "over tolerance" };
  const has = (value: (place: Place) => number | null | undefined) => path.places.some((place) => typeof value(place) === "number");
  const drives = machine.actuators.map((actuator, i): PathColour => {
    const unit = actuator.unit === "deg" ? "N m" : "N";
    return { key: `drive ${i}`, words: `load of ${actuator.name}`, value: (place) => Math.abs(place.drives?.[i] ?? 0), text: (value) => `${shown(value)} ${unit}`, ...tolerance };
  });
  const all: (PathColour | false)[] = [
    { key: "before", words: "error as programmed", value: (place) => place.error_before_mm, text: length, ...tolerance },
    { key: "after", words: "error compensated", value: (place) => place.error_after_mm, text: length, ...tolerance, isOver: (place) => place.error_after_mm > path.tolerance_mm },
    { key: "force", words: "size of the force", value: (place) => Math.hypot(...place.force_n), text: (value) => `${shown(value)} N`, ...tolerance },
    has((place) => place.depth_by_limit) && { key: "chatter", words: "depth by chatter limit", value: (place) => place.depth_by_limit ?? 0, text: percent, isOver: (place) => (place.depth_by_limit ?? 0) >= 1, over: "that chatter" },
    has((place) => place.share_of_rating) && { key: "rating", words: "share of a drive's rating", value: (place) => place.share_of_rating ?? 0, text: percent, isOver: (place) => (place.share_of_rating ?? 0) > 1, over: "over the rating" },
    has((place) => place.share_to_buckling) && { key: "buckling", words: "way to buckling", value: (place) => place.share_to_buckling ?? 0, text: percent, ...tolerance },
    ...(has((place) => place.drives?.[0]) ? drives : []),
  ];
  return all.filter((own) => own !== false);
}
