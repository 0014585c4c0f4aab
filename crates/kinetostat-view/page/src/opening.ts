// Files of one's own on the page: dropped onto it, or chosen.

import type { Source } from "./api";
import { element } from "./panel";

/** Bytes that the server takes at once. */
const MOST_BYTES = 60e6;

/** Shows the machine that the server has now, from its first state. */
export function reload(): void {
  window.history.replaceState(null, "", window.location.pathname);
  window.location.reload();
}

async function open(source: Source, list: FileList, said: HTMLElement): Promise<void> {
  said.textContent = "Reading ...";
  try {
    const files = [...list];
    if (files.reduce((sum, file) => sum + file.size, 0) > MOST_BYTES) {
      throw new Error(`Files of more than ${MOST_BYTES / 1e6} MB are shown from the command line: kinetostat view job.toml`);
    }
    const read = async (file: globalThis.File) => ({ name: file.name, text: await file.text() });
    await source.ask("open", { files: await Promise.all(files.map(read)) });
    reload();
  } catch (error) {
    said.textContent = String((error as Error).message);
  }
}

/** A field that opens files, and the whole page as a place to drop them; what is said of them stands beside it. */
export function opening(source: Source): HTMLElement {
  const said = element("p", { role: "alert", class: "unit" });
  const input = element("input", { type: "file", multiple: "", "aria-label": "Open a model, or a job with its files" });
  input.addEventListener("change", () => input.files !== null && void open(source, input.files, said));
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const files = event.dataTransfer?.files;
    if (files !== undefined && files.length > 0) {
      void open(source, files, said);
    }
  });
  return element("details", { class: "computation" }, element("summary", {}, "Open files"), element("p", { class: "unit" }, "A model, or a job with its model and program: all together, chosen here or dropped onto the page."), input, said);
}
