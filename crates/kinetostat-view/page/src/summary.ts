// The summary of a run: the lines that the command prints.

import { element } from "./panel";

/** Lines of the first paragraph that are visible at once. */
const VISIBLE = 6;

/** The title and the first paragraph, with the rest behind a disclosure; null without lines. */
export function summary(lines: string[]): HTMLElement | null {
  const isText = (line: string | undefined) => line !== undefined && line.trim() !== "";
  const first = lines.findIndex(isText);
  if (first < 0) {
    return null;
  }
  // Text follows the title after an empty line.
  let start = first + 1;
  while (start < lines.length && !isText(lines[start])) {
    start += 1;
  }
  let end = start;
  while (end < start + VISIBLE && isText(lines[end])) {
    end += 1;
  }
  const text = lines.slice(start, end).map((line) => line.trim());
  const rest = lines.slice(end).join("\n").replace(/^\s*\n/, "").trimEnd();
  const out = element("section", { class: "summary", "aria-label": "Summary of the run" }, element("p", {}, element("strong", {}, lines[first]!.trim())), element("p", {}, text.join(" ")));
  if (rest !== "") {
    const all = element("pre", { tabindex: "0", "aria-label": "Rest of the summary" }, rest);
    out.append(element("details", {}, element("summary", {}, "More of the summary"), all));
  }
  return out;
}
