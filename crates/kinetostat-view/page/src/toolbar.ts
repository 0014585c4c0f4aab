// Buttons over the picture: views, theme, and the panel beside it.

import { isEmbedded } from "./address";
import { button, element } from "./panel";
import { VIEWS, type Stage } from "./stage";
import type { Store } from "./store";

/** Puts the buttons on the stage. In a frame of another page the panel is closed at first. */
export function toolbar(place: HTMLElement, panel: HTMLElement, store: Store, stage: Stage): void {
  const toggle = button("", () => show(panel.classList.contains("closed")), "Show or hide the panel");
  toggle.setAttribute("aria-controls", panel.id);
  const show = (isOpen: boolean) => {
    panel.classList.toggle("closed", !isOpen);
    document.body.classList.toggle("without-panel", !isOpen);
    toggle.textContent = isOpen ? "Hide panel" : "Show panel";
    toggle.setAttribute("aria-expanded", String(isOpen));
  };
  show(!isEmbedded());
  const views = Object.keys(VIEWS).map((view) => button(view, () => stage.look(view), `Look: ${view.toLowerCase()}`));
  const near = store.path === null ? "tool" : "path";
  views.push(button(`Near ${near}`, () => stage.look("Near"), `Look: ${near} from near`));
  const theme = button("Light / dark", () => store.draw({ dark: !stage.dark() }));
  place.append(element("div", { class: "toolbar", role: "group", "aria-label": "View" }, ...views, theme, toggle));
}
