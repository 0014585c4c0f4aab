// The address of the page. It holds the state only where it can be passed on: not in a file, and not in a frame of a report.

/** True if the page is part of another one. */
export const isEmbedded = (): boolean => window.self !== window.top;

/** True if the page has an address that others can open. `about:srcdoc` and `file:` are none, and refuse changes. */
export const hasAddress = (): boolean => !isEmbedded() && /^https?:$/.test(window.location.protocol);

/** Writes the state into the address. */
export function keep(hash: string): void {
  if (hasAddress()) {
    window.history.replaceState(null, "", hash);
  }
}
