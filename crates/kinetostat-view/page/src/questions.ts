// The questions of `kinetostat start`: a robot and a program, before there is a machine to be shown.

import type { Source, Start } from "./api";
import { opening, reload } from "./opening";
import { button, element } from "./panel";

export class Questions {
  private readonly given = element("dl", {});
  private readonly form = element("form", {});
  private readonly said = element("div", { role: "status", class: "unit" });
  private readonly refused = element("p", { role: "alert", class: "finding", hidden: "" });

  constructor(
    place: HTMLElement,
    private readonly source: Source,
  ) {
    place.append(
      element(
        "main",
        { class: "questions" },
        element("h1", {}, "Your robot and your program"),
        element("p", { class: "unit" }, "The answers become a job, and the machine is shown along its program."),
        this.given,
        this.said,
        this.refused,
        this.form,
        opening(source),
      ),
    );
  }

  async ask(request: { answer?: string; back?: boolean; write?: boolean }): Promise<void> {
    let start: Start;
    try {
      start = await this.source.ask("start", request);
    } catch (error) {
      this.refuse(String((error as Error).message));
      return;
    }
    if (start.written.length > 0) {
      reload();
      return;
    }
    this.given.replaceChildren(...start.given.flatMap((own) => [element("dt", {}, own.words), element("dd", {}, own.answer)]));
    this.said.replaceChildren(...start.said.map((line) => element("p", {}, line)));
    this.refuse(start.refused);
    // What was not taken stays, to be mended.
    if (start.refused === null || start.question === null) {
      this.show(start);
    }
  }

  private refuse(words: string | null): void {
    this.refused.hidden = words === null;
    this.refused.textContent = words ?? "";
  }

  private show(start: Start): void {
    const { question } = start;
    const back = button("Back", () => void this.ask({ back: true }));
    back.disabled = start.given.length === 0;
    if (question === null) {
      const write = button("Write the files and compensate", () => {
        write.disabled = true;
        write.textContent = "Computing ...";
        void this.ask({ write: true });
      });
      this.form.onsubmit = (event) => event.preventDefault();
      this.form.replaceChildren(element("p", {}, "All is known."), element("div", { class: "row" }, write, back));
      write.focus();
      return;
    }
    const input = element("input", { id: "answer", type: "text", autocomplete: "off", spellcheck: "false", list: "choices", placeholder: question.usual ?? "" });
    const choices = element("datalist", { id: "choices" }, ...question.choices.map((choice) => element("option", { value: choice })));
    const next = element("button", { type: "submit" }, "Next");
    this.form.onsubmit = (event) => {
      event.preventDefault();
      void this.ask({ answer: input.value });
    };
    this.form.replaceChildren(
      element("label", { for: "answer" }, question.words),
      input,
      choices,
      element("p", { class: "unit" }, ...(question.usual === null ? [] : [`Empty: ${question.usual}. `]), question.help),
      element("div", { class: "row" }, next, back),
    );
    input.focus();
  }
}
