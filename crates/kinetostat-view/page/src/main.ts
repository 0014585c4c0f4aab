// The page: machine, panel, and the path of a program.

import { hasAddress } from "./address";
import { source } from "./api";
import { Panel, button, element } from "./panel";
import { PathView } from "./pathview";
import { printable } from "./picture";
import { Questions } from "./questions";
import { Stage } from "./stage";
import { Store, inWords } from "./store";
import { toolbar } from "./toolbar";
import "./style.css";

async function start(): Promise<void> {
  const from = source();
  const machine = await from.ask("machine", {});
  if (machine === null) {
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    const theme = () => (document.documentElement.dataset.theme = dark.matches ? "dark" : "light");
    dark.addEventListener("change", theme);
    theme();
    document.body.replaceChildren();
    await new Questions(document.body, from).ask({});
    return;
  }
  const path = machine.has_path ? await from.ask("path", {}) : null;
  document.title = `${machine.name} - kinetostat`;
  const store = new Store(from, machine, path);
  await store.ask();
  const place = (id: string) => document.getElementById(id) ?? document.body;
  const stage = new Stage(place("stage"), store);
  const panel = new Panel(place("panel"), store, stage);
  toolbar(place("stage"), place("panel"), store, stage);
  const program = path === null ? null : new PathView(place("path"), store, stage, path);
  document.body.classList.toggle("with-path", program !== null);
  const draw = () => {
    stage.draw();
    panel.show();
    program?.show();
  };
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  store.onChange(draw);
  draw();
  stage.look("Oblique");
  printable(stage, store);
}

start().catch((error: unknown) => {
  document.body.replaceChildren(element("p", { class: "finding", role: "alert" }, inWords(error)), ...(hasAddress() ? [button("Retry", () => window.location.reload())] : []));
});
