// The page in a browser, against the built command: `KINETOSTAT=path/to/kinetostat npm test`.

import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";

const command = process.env.KINETOSTAT ?? "kinetostat";
const shots = process.env.SHOTS ?? mkdtempSync(join(tmpdir(), "view-shots-"));
const folder = mkdtempSync(join(tmpdir(), "view-"));
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const running = [];
let browser;

/** Address of a server of the command that ends with the tests. */
async function served(...words) {
  const server = spawn(command, ["view", ...words, "--no-browser"], { cwd: join(folder, "kinetostat-demo") });
  running.push(server);
  for await (const line of server.stdout) {
    const found = /http:\/\/[^#\s]*/.exec(line);
    assert.ok(found, String(line));
    return found[0];
  }
}

/** A page that keeps what goes wrong on it. */
async function opened(url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  page.wrong = [];
  page.asked = [];
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  page.on("pageerror", (error) => page.wrong.push(String(error)));
  page.on("request", (request) => page.asked.push(request.url()));
  await page.goto(url);
  await page.getByRole("heading", { level: 1 }).waitFor();
  return page;
}

const figure = (page, label) => page.locator("dt", { hasText: label }).first().locator("xpath=following-sibling::dd[1]").innerText();

before(async () => {
  assert.equal(spawnSync(command, ["demo"], { cwd: folder }).status, 0, "the demo is written");
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});

after(async () => {
  await browser?.close();
  running.forEach((server) => server.kill());
});

test("figures are those of deflect, by typing, by keys and by a link", async () => {
  const page = await opened(await served("heavy_6r"));
  for (const [axis, value] of [["x", "300"], ["z", "-900"]]) {
    await page.getByLabel(`Force ${axis}, N`).fill(value);
    await page.keyboard.press("Tab");
  }
  await page.getByLabel("joint 1, deg").last().fill("20");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => document.querySelector("canvas") && location.hash.includes("20"));
  const words = ["deflect", "heavy_6r", "--joints", "joint 1=20", "--force", "300", "0", "-900", "--json"];
  const said = JSON.parse(spawnSync(command, words, { encoding: "utf8" }).stdout);
  await page.locator("dd", { hasText: said.displacement_size_mm.toPrecision(4) }).first().waitFor();
  const detail = `(${said.displacement_mm.map((x) => x.toFixed(4)).join(", ")}) mm`;
  assert.ok((await figure(page, "Displacement of the tool")).includes(detail));
  // The state is a link.
  const again = await opened(page.url());
  assert.equal(await figure(again, "Displacement of the tool"), await figure(page, "Displacement of the tool"));
  // Keys move a joint.
  await page.getByLabel("joint 2, deg").first().focus();
  const was = await figure(page, "Displacement of the tool");
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction((text) => document.querySelector("dd").innerText !== text, was);
  assert.deepEqual([...page.wrong, ...again.wrong], []);
});

test("the tool and the force are dragged, and the page is quiet about it", async () => {
  const page = await opened(await served("orthoglide"));
  const box = await page.locator("canvas").first().boundingBox();
  const drag = async (handle, x, y) => {
    await page.waitForTimeout(300);
    const at = (await page.locator("#stage").getAttribute(`data-${handle}`)).split(",").map(Number);
    await page.mouse.move(box.x + at[0], box.y + at[1]);
    await page.mouse.down();
    await page.mouse.move(box.x + at[0] + x, box.y + at[1] + y, { steps: 5 });
    await page.mouse.up();
  };
  const value = (label) => page.getByLabel(label).inputValue().then(Number);
  await page.getByTitle("Look: front").click();
  await drag("tool", 0, -30);
  await page.waitForFunction(() => location.hash.includes("at_mm"));
  await page.waitForFunction(() => Number(document.querySelector("[aria-label='Tool z, mm']").value) > 5);
  assert.ok(Math.abs(await value("Tool y, mm")) < 1, "in the plane that faces the camera");
  await drag("force", 40, 0);
  await page.waitForFunction(() => Number(document.querySelector("[aria-label='Force x, N']").value) > 10);
  assert.match(await figure(page, "Displacement of the tool"), /mm/);
  assert.deepEqual(page.wrong, []);
});

test("modes swing, and a machine without masses says why it has none", async () => {
  const page = await opened(await served("heavy_6r"));
  await page.getByLabel("Swing").selectOption("2");
  const said = JSON.parse(spawnSync(command, ["modes", "heavy_6r", "--json"], { encoding: "utf8" }).stdout);
  await page.locator(".scale", { hasText: `Mode 2, ${said.modes[1].frequency_hz.toPrecision(4)} Hz` }).waitFor();
  const without = await opened(await served("orthoglide"));
  await without.getByLabel("Swing").selectOption("1");
  await without.locator(".finding", { hasText: "no mass" }).waitFor();
  assert.deepEqual(page.wrong, []);
});

test("a place out of reach is said, and the page goes on", async () => {
  const page = await opened(await served("orthoglide"));
  await page.getByLabel("Tool x, mm").fill("2000");
  await page.keyboard.press("Tab");
  await page.locator(".finding", { hasText: "cannot be reached" }).waitFor();
  await page.getByRole("button", { name: "Home" }).click();
  await page.locator(".finding").waitFor({ state: "hidden" });
  const refused = page.wrong.filter((text) => !text.includes("422"));
  assert.deepEqual(refused, []);
});

test("a program is followed in chart, lines and space", async () => {
  const page = await opened(await served("job.toml"));
  const said = page.locator("#path p[role=status]");
  assert.match(await said.innerText(), /up to 0\.77\d mm as programmed, tolerance \S+ mm/);
  await page.getByRole("button", { name: "Worst place" }).click();
  await page.locator("li[aria-current]", { hasText: "G3" }).waitFor();
  assert.match(await said.innerText(), /line 8/);
  const chart = await page.locator(".u-over").boundingBox();
  await page.mouse.click(chart.x + 0.9 * chart.width, chart.y + 10);
  await page.waitForFunction(() => document.querySelector("li[aria-current]")?.textContent.includes("X25"));
  await page.getByRole("button", { name: "Play" }).click();
  const before = await said.innerText();
  await page.waitForFunction((text) => document.querySelector("#path p[role=status]").innerText !== text, before);
  await page.getByRole("button", { name: "Stop" }).click();
  await page.screenshot({ path: join(shots, "path.png") });
  assert.deepEqual(page.wrong, []);
});

test("an exported file asks nobody and shows what it holds", async () => {
  const cwd = join(folder, "kinetostat-demo");
  assert.equal(spawnSync(command, ["view", "job.toml", "--export", "page.html"], { cwd }).status, 0);
  const page = await opened(`file://${join(cwd, "page.html")}`);
  await page.getByRole("button", { name: "Worst place" }).click();
  await page.locator("li[aria-current]").waitFor();
  assert.ok(await page.getByLabel("Force x, N").isDisabled());
  assert.deepEqual(page.asked.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), []);
  assert.deepEqual(page.wrong, []);
});

for (const [name, options] of [
  ["light", { colorScheme: "light" }],
  ["dark", { colorScheme: "dark" }],
  ["phone", { viewport: { width: 390, height: 844 } }],
]) {
  test(`nothing bars the way (${name})`, async () => {
    const page = await opened(await served("job.toml"), { ...options, bypassCSP: true });
    await page.screenshot({ path: join(shots, `${name}.png`) });
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map((own) => `${own.id}: ${own.nodes[0].html}`), []);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.equal(wide, 0, "nothing sticks out");
    // The picture has a machine in it.
    const colours = await page.evaluate(() => {
      const canvas = document.querySelector("canvas");
      const flat = document.createElement("canvas");
      [flat.width, flat.height] = [120, 80];
      const context = flat.getContext("2d");
      context.drawImage(canvas, 0, 0, 120, 80);
      return new Set(new Uint32Array(context.getImageData(0, 0, 120, 80).data.buffer)).size;
    });
    assert.ok(colours > 50, `${colours} colours`);
  });
}
