// The page in a browser, against the built command: `KINETOSTAT=path/to/kinetostat npm test`.

import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { chromium } from "playwright-core";

const command = process.env.KINETOSTAT ?? "kinetostat";
const shots = process.env.SHOTS ?? mkdtempSync(join(tmpdir(), "view-shots-"));
const folder = mkdtempSync(join(tmpdir(), "view-"));
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const running = [];
let browser;

/** Address of a server of the command that ends with the tests, in the folder of the demo. */
const served = (...words) => servedIn(join(folder, "kinetostat-demo"), ...words);

async function servedIn(cwd, ...words) {
  const server = spawn(command, ["view", ...words, "--no-browser"], { cwd });
  running.push(server);
  const line = await new Promise((resolve) => server.stdout.on("data", (data) => resolve(String(data))));
  const found = /http:\/\/[^#\s]*/.exec(line);
  assert.ok(found, line);
  return found[0];
}

/** A page that keeps what goes wrong on it; with another path than the server's if one is given. */
async function opened(url, { path, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  page.wrong = [];
  page.asked = [];
  page.on("console", (message) => message.type() === "error" && page.wrong.push(message.text()));
  page.on("pageerror", (error) => page.wrong.push(String(error)));
  page.on("request", (request) => page.asked.push(request.url()));
  if (path !== undefined) {
    await page.route("**/api/path", (route) => route.fulfill({ json: path }));
  }
  await page.goto(url);
  await page.getByRole("heading", { level: 1 }).waitFor();
  return page;
}

/** Number of colours of a canvas. */
const colours = (page, selector) =>
  page.evaluate((own) => {
    const flat = document.createElement("canvas");
    [flat.width, flat.height] = [120, 80];
    const context = flat.getContext("2d");
    context.drawImage(document.querySelector(own), 0, 0, 120, 80);
    return new Set(new Uint32Array(context.getImageData(0, 0, 120, 80).data.buffer)).size;
  }, selector);

const figure = (page, label) => page.locator("dt", { hasText: label }).first().locator("xpath=following-sibling::dd[1]").innerText();

before(async () => {
  assert.equal(spawnSync(command, ["demo"], { cwd: folder }).status, 0, "the demo is written");
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});

afterEach(() => Promise.all(browser.contexts().map((context) => context.close())));

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
  // The model is a file that the command reads.
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save model" }).click();
  const saved = join(folder, "saved.toml");
  await (await download).saveAs(saved);
  const again_said = JSON.parse(spawnSync(command, ["deflect", saved, ...words.slice(2)], { encoding: "utf8" }).stdout);
  assert.deepEqual(again_said.displacement_mm, said.displacement_mm);
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
  await page.locator("#panel > .finding", { hasText: "cannot be reached" }).waitFor();
  await page.getByRole("button", { name: "Home" }).click();
  await page.locator("#panel > .finding").waitFor({ state: "hidden" });
  const refused = page.wrong.filter((text) => !text.includes("422"));
  assert.deepEqual(refused, []);
});

/** The path of a job as the server gives it. */
const pathOf = async (url) => (await fetch(`${url}api/path`, { method: "POST", headers: { "content-type": "application/json" }, body: "{}" })).json();

const digits = (x) => String(Number(x.toPrecision(3)));
/** An error as it is to be read: um below 0.1 mm, mm above. */
const error = (mm) => (mm < 0.1 ? `${digits(1000 * mm)} um` : `${digits(mm)} mm`);
const force = (place) => `${digits(Math.hypot(...place.force_n))} N`;
const ofPlace = (page, label) => page.locator(".placeside dt", { hasText: label }).locator("xpath=following-sibling::dd[1]").innerText();
const slider = (page) => page.getByLabel("Place along the path");
const worstOf = (places, value) => places.reduce((worst, place, i) => (value(place) > value(places[worst]) ? i : worst), 0);
const at = (page, index) => page.waitForFunction((text) => document.querySelector("[aria-label='Place along the path']").value === text && document.querySelector(".placeside dd"), String(index));

test("a program is followed in chart, lines and space", async () => {
  const url = await served("job.toml");
  const { places, tolerance_mm } = await pathOf(url);
  const page = await opened(url);
  const most = Math.max(...places.map((place) => place.error_before_mm));
  const over = places.filter((place) => place.error_before_mm > tolerance_mm).length;
  assert.equal(await page.locator(".overall").innerText(), `Up to ${error(most)} as programmed, tolerance ${error(tolerance_mm)}; ${over} of ${places.length} places over tolerance.`);
  assert.ok((await page.locator(".pathlegend").innerText()).endsWith(error(most)));
  await page.getByRole("button", { name: "Worst place" }).click();
  await page.locator("li[aria-current]", { hasText: "G3" }).waitFor();
  const worst = worstOf(places, (place) => place.error_before_mm);
  await at(page, worst);
  const shownFigures = async (index) => {
    const place = places[index];
    assert.equal(await ofPlace(page, "Line"), String(place.line));
    assert.equal(await ofPlace(page, "Error as programmed"), error(place.error_before_mm));
    assert.equal(await ofPlace(page, "Error compensated"), error(place.error_after_mm));
    assert.equal(await ofPlace(page, "Path"), `${place.path_mm.toFixed(1)} mm`);
    assert.equal(await ofPlace(page, "Force"), force(place));
  };
  await shownFigures(worst);
  // The chart: its tip says what the list says, and a click goes there.
  const chart = await page.locator(".u-over").boundingBox();
  await page.mouse.move(chart.x + 0.9 * chart.width, chart.y + 10);
  const tip = await page.locator(".tip").innerText();
  await page.mouse.click(chart.x + 0.9 * chart.width, chart.y + 10);
  await page.waitForFunction(() => document.querySelector("li[aria-current]")?.textContent.includes("X25"));
  const clicked = Number(await slider(page).inputValue());
  assert.ok(tip.includes(`Error as programmed: ${error(places[clicked].error_before_mm)}`), tip);
  await shownFigures(clicked);
  // A line, by click and by keys.
  await page.locator(".program li", { hasText: "plunge" }).click();
  await at(page, places.findIndex((place) => place.line === 7));
  await page.locator(".program").press("ArrowDown");
  await at(page, places.findIndex((place) => place.line === 8));
  // The path itself: the tool is at the place that is shown.
  await page.getByRole("button", { name: "Near path" }).click();
  const target = places.findIndex((place, i) => place.line === 8 && i > 0.3 * places.length);
  await slider(page).fill(String(target));
  await at(page, target);
  await page.waitForTimeout(500);
  const [x, y] = (await page.locator("#stage").getAttribute("data-tool")).split(",").map(Number);
  await page.getByRole("button", { name: "Worst place" }).click();
  await at(page, worst);
  const box = await page.locator("canvas").first().boundingBox();
  await page.mouse.click(box.x + x, box.y + y);
  await page.waitForFunction(([goal]) => Math.abs(document.querySelector("[aria-label='Place along the path']").value - goal) < 8, [target]);
  await page.screenshot({ path: join(shots, "path.png") });
  assert.deepEqual(page.wrong, []);
});

test("the path is coloured by an error or by the force, and the chart follows", async () => {
  const url = await served("job.toml");
  const { places } = await pathOf(url);
  const page = await opened(url);
  const chart = page.locator(".chart");
  assert.match(await chart.getAttribute("aria-label"), / in mm,/);
  for (const [colour, value, text] of [
    ["after", (place) => place.error_after_mm, error],
    ["force", (place) => Math.hypot(...place.force_n), (n) => `${digits(n)} N`],
  ]) {
    await page.getByLabel("Colour of the path").selectOption(colour);
    await page.getByRole("button", { name: "Worst place" }).click();
    const worst = worstOf(places, value);
    await at(page, worst);
    assert.ok((await page.locator(".pathlegend").innerText()).endsWith(text(value(places[worst]))), colour);
    assert.match(await chart.getAttribute("aria-label"), colour === "after" ? / in um,/ : / in mm,/);
  }
  assert.deepEqual(page.wrong, []);
});

test("a program is played evenly, or with its times", async () => {
  const url = await served("job.toml");
  const path = await pathOf(url);
  path.places.forEach((place) => (place.time_s = null));
  const evenly = await opened(url, { path });
  assert.deepEqual(await evenly.locator(".controls").getByLabel("Speed").locator("option").allInnerTexts(), ["in 20 s"]);
  await slider(evenly).focus();
  await evenly.keyboard.press(" ");
  await evenly.waitForFunction(() => document.querySelector("[aria-label='Place along the path']").value > 20);
  await evenly.keyboard.press(" ");
  await evenly.getByRole("button", { name: "Play" }).waitFor();
  const value = Number(await slider(evenly).inputValue());
  await evenly.keyboard.press("ArrowRight");
  await at(evenly, value + 1);
  assert.equal(await ofPlace(evenly, "Time"), "not given");
  // The first half of the places takes no second, the other half a minute.
  const half = Math.floor(path.places.length / 2);
  path.places.forEach((place, i) => (place.time_s = 3 + (i < half ? (0.5 * i) / half : 0.5 + (60 * (i - half)) / half)));
  const timed = await opened(url, { path });
  await timed.locator(".controls").getByLabel("Speed").selectOption("1x");
  await timed.getByRole("button", { name: "Play" }).click();
  await timed.waitForFunction((goal) => document.querySelector("[aria-label='Place along the path']").value >= goal, half);
  await timed.getByRole("button", { name: "Stop" }).click();
  const index = Number(await slider(timed).inputValue());
  assert.ok(index < half + 0.1 * path.places.length, `${index} of ${path.places.length}`);
  assert.equal(await ofPlace(timed, "Time"), `${path.places[index].time_s.toFixed(2)} s`);
  await timed.locator(".controls").getByLabel("Speed").selectOption("100x");
  await timed.getByRole("button", { name: "Play" }).click();
  await at(timed, path.places.length - 1);
  await timed.getByRole("button", { name: "Play" }).waitFor();
  assert.deepEqual([...evenly.wrong, ...timed.wrong], []);
});

test("the summary of the run is that of the command", async () => {
  const url = await served("job.toml");
  const { headline } = await pathOf(url);
  const page = await opened(url);
  const box = page.locator(".summary");
  assert.equal(await box.locator("strong").innerText(), headline[0].trim());
  assert.ok(await box.locator("pre").isHidden());
  await box.locator("summary").click();
  assert.ok(await box.locator("pre").isVisible());
  const words = (text) => text.split(/\s+/).filter((word) => word !== "");
  const read = [...(await box.locator("p").allInnerTexts()), await box.locator("pre").innerText()];
  assert.deepEqual(words(read.join(" ")), words(headline.join(" ")));
  assert.deepEqual(page.wrong, []);
});

test("a moment is an arc with its value, and axes and floor have words", async () => {
  const page = await opened(await served("heavy_6r"));
  for (const [axis, value] of [["y", "3"], ["z", "-4"]]) {
    await page.getByLabel(`Moment ${axis}, N m`).fill(value);
    await page.keyboard.press("Tab");
  }
  await page.locator(".labels span", { hasText: /^5 N m$/ }).waitFor();
  assert.match(await page.locator(".scale").innerText(), /Squares of \d+ mm/);
  assert.ok(await page.getByRole("img", { name: "base axes x, y and z" }).isVisible());
  const [saved] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save picture" }).click()]);
  assert.equal(saved.suggestedFilename(), "heavy_6r.png");
  assert.deepEqual(page.wrong, []);
});

test("boxes of a job are drawn with their names, where there are any", async () => {
  const url = await served("job.toml");
  const path = await pathOf(url);
  const corner_mm = path.places[0].position_mm;
  const edges_mm = [[80, 0, 0], [0, 60, 0], [0, 0, 30]];
  path.boxes = [{ name: "blank", kind: "stock", corner_mm, edges_mm }, { name: "clamp", kind: "obstacle", corner_mm: corner_mm.map((x) => x + 100), edges_mm }];
  const page = await opened(url, { path });
  await page.getByRole("button", { name: "Near path" }).click();
  const name = page.locator(".labels span", { hasText: "blank (stock)" });
  await name.waitFor();
  await page.getByLabel("Stock, part and obstacles").uncheck();
  await name.waitFor({ state: "detached" });
  const without = await opened(url, { path: { ...path, boxes: [] } });
  assert.equal(await without.getByLabel("Stock, part and obstacles").count(), 0);
  assert.deepEqual([...page.wrong, ...without.wrong], []);
});

test("the stock is drawn as it is left", async () => {
  const here = mkdtempSync(join(tmpdir(), "stock-"));
  const job = `schema = 1
model = "orthoglide"
program = "slot.ngc"
[placement]
part_origin_mm = [0, 0, 100]
[tool]
length_mm = 60
cutter = { shape = "flat", diameter_mm = 10, teeth = 2, helix_deg = 30, flute_length_mm = 18 }
[material]
name = "AlMg4.5Mn"
[stock]
block_mm = [[-5, -10, -10], [40, 10, 0]]
`;
  writeFileSync(join(here, "job.toml"), job);
  writeFileSync(join(here, "slot.ngc"), "G21 G90\nS10000 M3\nG0 X-12 Y0 Z5\nG1 Z-2 F600\nG1 X40\nG0 Z5\nM2\n");
  const page = await opened(await servedIn(here, "job.toml"));
  const left = () => page.waitForResponse((response) => response.url().endsWith("/api/stock")).then((response) => response.json());
  await page.getByRole("button", { name: "Near path" }).click();
  const answer = left();
  await page.locator("#path input[type=range]").fill("1000");
  const stock = await answer;
  assert.ok(stock.heights.some((height) => Math.abs(height - 8) < 1e-3) && stock.heights.some((height) => height === 10));
  // A box that is not drawn is not asked for.
  await page.getByLabel("Stock, part and obstacles").uncheck();
  const asked = page.asked.length;
  await page.locator("#path input[type=range]").fill("900");
  await page.locator("#path").getByText("Line").waitFor();
  assert.ok(!page.asked.slice(asked).some((url) => url.endsWith("/api/stock")));
  assert.deepEqual(page.wrong, []);
});

/** The file of the job, with all that it holds. */
function exported() {
  const cwd = join(folder, "kinetostat-demo");
  assert.equal(spawnSync(command, ["view", "job.toml", "--export", "page.html", "--force-overwrite"], { cwd }).status, 0);
  const file = join(cwd, "page.html");
  const text = readFileSync(file, "utf8");
  return { file, text, held: JSON.parse(text.split('<script id="kinetostat-data" type="application/json">')[1].split("</script>")[0]) };
}

test("an exported file asks nobody and shows what it holds", async () => {
  const { file, held } = exported();
  const page = await opened(`file://${file}`);
  await page.getByRole("button", { name: "Worst place" }).click();
  await page.locator("li[aria-current]").waitFor();
  assert.ok(await page.getByLabel("Force x, N").isDisabled());
  assert.equal(await page.getByRole("button", { name: "Copy link" }).count(), 0);
  // Figures of a place are its own; the machine is drawn at the nearest stored one.
  const stored = held.states.map((own) => own.place);
  const between = stored[2] + 1;
  assert.ok(!stored.includes(between), "some places have no state");
  await slider(page).fill(String(between));
  await at(page, between);
  const { places } = held.path;
  assert.equal(await ofPlace(page, "Error as programmed"), error(places[between].error_before_mm));
  assert.ok((await page.locator(".placeside p").innerText()).includes(`at line ${places[stored[2]].line}: the nearest of ${stored.length} stored places`));
  const { state } = held.states[2];
  assert.ok(Math.abs(Number(await page.getByLabel("Tool x, mm").inputValue()) - state.tool.position_mm[0]) < 5e-3);
  await slider(page).fill(String(stored[3]));
  await at(page, stored[3]);
  assert.equal(await page.locator(".placeside p").innerText(), "");
  assert.deepEqual(page.asked.filter((url) => !/^(file|data|blob):/.test(url)), []);
  assert.deepEqual(page.wrong, []);
});

test("a page in a frame of a report works, with its panel closed at first", async () => {
  const { text } = exported();
  const report = join(folder, "report.html");
  const quoted = text.replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  writeFileSync(report, `<!doctype html><html lang="en"><title>Report</title><h1>Report</h1><iframe title="Machine" width="960" height="640" srcdoc="${quoted}"></iframe></html>`);
  const page = await opened(`file://${report}`);
  const frame = page.frameLocator("iframe");
  await frame.getByRole("button", { name: "Worst place" }).click();
  await frame.locator("li[aria-current]").waitFor();
  assert.ok(await frame.locator("#panel").isHidden());
  await page.screenshot({ path: join(shots, "frame.png") });
  await frame.getByRole("button", { name: "Show panel" }).press("Enter");
  const inner = page.frames()[1];
  await inner.evaluate(axe);
  const { violations } = await inner.evaluate(() => window.axe.run());
  assert.deepEqual(violations.map((own) => `${own.id}: ${own.nodes[0].html}`), []);
  assert.ok(await frame.getByRole("heading", { level: 1 }).isVisible());
  assert.equal(await frame.getByRole("button", { name: "Copy link" }).count(), 0);
  await frame.getByRole("button", { name: "Hide panel" }).press("Enter");
  assert.ok(await frame.locator("#panel").isHidden());
  assert.deepEqual(page.wrong, []);
});

/** A section of the panel that computes, opened by keys. */
async function computation(page, title) {
  const section = page.locator("details", { has: page.locator("summary", { hasText: title }) });
  await section.locator("summary").press("Enter");
  return section;
}

/** JSON of a command as it is typed in a shell. */
function saidBy(line) {
  const words = [...line.matchAll(/'([^']*)'|(\S+)/g)].map(([, quoted, plain]) => quoted ?? plain);
  return JSON.parse(spawnSync(command, [...words.slice(1), "--json"], { encoding: "utf8" }).stdout);
}

/** The command that a section has to be copied. */
async function copied(page, section) {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await section.getByRole("button", { name: "Copy command" }).press("Enter");
  await section.getByText("copied").waitFor();
  return page.evaluate(() => navigator.clipboard.readText());
}

/** Slows a question down, so that somebody can stop it; counts how often it is asked. */
async function slow(page, question) {
  const count = { asked: 0 };
  await page.route(`**/api/${question}`, async (route) => {
    count.asked += 1;
    await new Promise((resolve) => setTimeout(resolve, 300));
    await route.continue();
  });
  return count;
}

test("a map of the workspace is that of the command, and leads to its places", async () => {
  const page = await opened(`${await served("orthoglide")}#state=${encodeURIComponent(JSON.stringify({ force_n: [100, 50, -200] }))}`);
  const map = await computation(page, "Map of the workspace");
  await page.getByLabel("Variable").selectOption({ label: "deflection" });
  for (const [end, value] of [["from", "-60"], ["to", "60"]]) {
    await page.getByLabel(`Map x ${end}, mm`).fill(value);
    await page.getByLabel(`Map y ${end}, mm`).fill(value);
  }
  await page.getByLabel("Places along a side").selectOption("11");
  const before = await page.locator("#stage").screenshot();
  await map.getByRole("button", { name: "Compute" }).press("Enter");
  await map.getByText("121 of 121 places").waitFor();
  const words = "kinetostat map orthoglide --x -60 60 11 --y -60 60 11 --z 0 --force 100 50 -200 --variables deflection";
  const said = saidBy(words).figures.find((own) => own.name === "deflection");
  for (const [label, { value, position_mm }] of [["Least", said.least], ["Most", said.most]]) {
    assert.equal(await figure(page, label), `${digits(1e6 * value)} um\nat (${position_mm.map(digits).join(", ")}) mm`);
  }
  const legend = page.locator(".maplegend");
  assert.match(await legend.innerText(), /^Deflection, um:/);
  assert.ok((await legend.innerText()).endsWith(digits(1e6 * said.most.value)));
  assert.notDeepEqual(await page.locator("#stage").screenshot(), before);
  await map.scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(shots, "map.png") });
  // The worst place, and one under the pointer.
  await map.getByRole("button", { name: "Go to the worst place" }).press("Enter");
  const tool = (x) => page.waitForFunction((goal) => Math.abs(document.querySelector("[aria-label='Tool x, mm']").value - goal) < 0.01, x);
  await tool(said.most.position_mm[0]);
  const displacement = 1e3 * said.most.value;
  assert.ok((await figure(page, "Displacement of the tool")).startsWith(`${displacement.toPrecision(4)} mm`));
  for (const axis of ["x", "y"]) {
    await page.getByLabel(`Tool ${axis}, mm`).fill("0");
    await page.getByLabel(`Tool ${axis}, mm`).press("Enter");
  }
  await page.waitForFunction(() => ["x", "y"].every((axis) => Math.abs(document.querySelector(`[aria-label='Tool ${axis}, mm']`).value) < 0.01));
  await page.getByTitle("Look: top").click();
  await page.waitForTimeout(1000);
  const box = await page.locator("canvas").first().boundingBox();
  const [left, top] = (await page.locator("#stage").getAttribute("data-tool")).split(",").map(Number);
  const place = map.getByText(/^Tool at/);
  const was = await place.innerText();
  await page.mouse.click(box.x + left + 30, box.y + top);
  await place.filter({ hasNotText: was }).waitFor();
  const [, x, value] = /Tool at \((.*?), .* mm: (.*) um\.$/.exec(await place.innerText());
  assert.equal(Math.abs(Number(x) % 12), 0);
  await tool(Number(x));
  assert.equal(digits(1e3 * parseFloat(await figure(page, "Displacement of the tool"))), value);
  assert.equal(await map.locator(".old").innerText(), "");
  // With another load it is the map of another state.
  await page.getByLabel("Force x, N").fill("500");
  await page.getByLabel("Force x, N").press("Enter");
  await map.getByText("compute again").waitFor();
  assert.match(await legend.innerText(), /of the state before/);
  const count = await slow(page, "map");
  await map.getByRole("button", { name: "Compute" }).press("Enter");
  await map.getByText(/^\d\d of 121 places/).waitFor();
  await map.getByRole("button", { name: "Stop" }).press("Enter");
  await map.getByText(/^Stopped: \d+ of 121 places/).waitFor();
  assert.ok(count.asked < 11, `${count.asked} lines asked`);
  assert.equal(await map.locator(".old").innerText(), "");
  await map.getByRole("button", { name: "Remove" }).press("Enter");
  assert.ok(await legend.isHidden());
  // What cannot be computed is said here.
  await page.getByLabel("Map x to, mm").fill("1e9");
  await map.getByRole("button", { name: "Compute" }).press("Enter");
  await map.getByRole("alert").filter({ hasText: "at most 10 km away" }).waitFor();
  assert.deepEqual(page.wrong.filter((text) => !text.includes("422")), []);
});

test("the response of the tip is that of the command", async () => {
  const page = await opened(await served("heavy_6r"));
  await page.getByLabel("joint 1, deg").last().fill("20");
  await page.keyboard.press("Tab");
  const response = await computation(page, "Response of the tip");
  await response.getByText("is an assumption").waitFor();
  await page.getByLabel("Highest frequency, Hz").fill("100");
  await response.getByLabel("Damping ratio").fill("");
  await response.getByRole("button", { name: "Compute" }).press("Enter");
  await response.getByRole("alert").filter({ hasText: "Damping ratio: a number from 0 to 1 is needed." }).waitFor();
  await response.getByLabel("Damping ratio").fill("0.02");
  await response.getByLabel("Damping ratio").press("Enter");
  await response.locator("canvas").waitFor();
  assert.ok(await response.getByRole("alert").isHidden());
  const said = saidBy(await copied(page, response));
  const sizes = said.curves.map(({ real, imaginary }) => real.map((x, i) => 1e6 * Math.hypot(x, imaginary[i])));
  for (const [k, axis] of ["x", "y", "z"].entries()) {
    const peak = sizes[k].indexOf(Math.max(...sizes[k]));
    assert.equal(await figure(page, `Largest along ${axis}`), `${digits(sizes[k][peak])} um/N at ${digits(said.frequencies_hz[peak])} Hz`);
  }
  // Keys read the chart.
  await response.locator(".plot").press("ArrowRight");
  const tip = await response.locator(".tip").innerText();
  assert.equal(tip, [`${digits(said.frequencies_hz[5])} Hz`, ...sizes.map((own, k) => `${"xyz"[k]}: ${digits(own[5])} um/N`)].join("\n"));
  await response.scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(shots, "response.png") });
  await page.getByLabel("Force z, N").fill("-100");
  await page.getByLabel("Force z, N").press("Enter");
  await response.getByText("compute again").waitFor();
  await slow(page, "response");
  await response.getByRole("button", { name: "Compute" }).press("Enter");
  await response.getByRole("button", { name: "Stop" }).press("Enter");
  await response.getByText("Stopped.").waitFor();
  // A machine without masses says why it has none.
  const without = await opened(await served("orthoglide"));
  const none = await computation(without, "Response of the tip");
  await none.getByRole("button", { name: "Compute" }).click();
  await none.getByRole("alert").filter({ hasText: "no mass" }).waitFor();
  assert.deepEqual(page.wrong, []);
});

test("speeds and depths without chatter are those of the command, piece by piece", async () => {
  const page = await opened(await served("heavy_6r"));
  const lobes = await computation(page, "Chatter: speeds and depths");
  await lobes.getByRole("button", { name: "Compute" }).press("Enter");
  await lobes.getByRole("alert").filter({ hasText: "Tangential coefficient, N/mm^2: a number is needed." }).waitFor();
  for (const [label, value] of [["Tangential coefficient", "800"], ["Radial coefficient", "240"], ["Axial coefficient", "0"], ["Immersion", "0.5"], ["Number of speeds", "20"], ["Fastest spindle speed", "4000"]]) {
    await lobes.getByLabel(label).fill(value);
  }
  await lobes.getByLabel("Side").selectOption("up");
  await lobes.getByRole("button", { name: "Compute" }).press("Enter");
  await lobes.getByText("20 of 20 speeds. Damping: 0.03 of critical in every mode.").waitFor();
  const said = saidBy(await copied(page, lobes));
  assert.equal(said.points.length, 20);
  await lobes.getByText(`Best speed: ${said.best.speed_rpm.toFixed(0)} rpm, stable up to ${digits(said.best.depth_mm)} mm.`).waitFor();
  for (const { speed_rpm, limit_mm, kind, chatter_hz, zeroth_order_mm } of said.points.slice(1, 12)) {
    await lobes.locator(".plot").press("ArrowRight");
    const tip = (await lobes.locator(".tip").innerText()).split("\n");
    assert.deepEqual(tip, [`${speed_rpm.toFixed(0)} rpm`, `stable up to ${digits(limit_mm)} mm`, `${kind === "flip" ? "period doubling" : "chatter"} at ${digits(chatter_hz)} Hz`, `zeroth order: ${digits(zeroth_order_mm)} mm`]);
  }
  await lobes.scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(shots, "lobes.png") });
  // Where nothing chatters up to the depth that was looked at, no limit is stated.
  await lobes.getByLabel("Largest depth of cut, mm").fill("0.1");
  await lobes.getByRole("button", { name: "Compute" }).press("Enter");
  await lobes.getByText("No limit was found up to 0.1 mm, the depth that was looked at, at 20 of 20 speeds; the slowest is 1000 rpm.").waitFor();
  const count = await slow(page, "lobes");
  await lobes.getByLabel("Number of speeds").fill("200");
  await lobes.getByRole("button", { name: "Compute" }).press("Enter");
  await lobes.getByText("8 of 200 speeds").first().waitFor();
  await lobes.getByRole("button", { name: "Stop" }).press("Enter");
  await lobes.getByText(/^Stopped: \d+ of 200 speeds/).waitFor();
  assert.ok(count.asked < 25, `${count.asked} pieces asked`);
  assert.deepEqual(page.wrong, []);
});

test("a load grows along a curve, and its places have shapes", async () => {
  const url = await served("orthoglide", "--force", "0", "0", "-2000");
  const page = await opened(`${url}#state=${encodeURIComponent(JSON.stringify({ force_n: [100, 50, -2000] }))}`);
  await computation(page, "Let the load grow");
  await page.getByLabel("Largest factor of the load").fill("60");
  await page.getByRole("button", { name: "Follow" }).press("Enter");
  const curve = page.locator(".curve svg");
  await curve.waitFor();
  const said = JSON.parse(spawnSync(command, ["curve", "orthoglide", "--force", "100", "50", "-2000", "--factor", "0", "60", "--branches", "4", "--json"], { encoding: "utf8" }).stdout);
  assert.equal(await page.locator(".curve .mark").count(), said.named_points.filter((own) => !["start", "end"].includes(own.kind)).length);
  assert.ok((await page.locator(".curve .unstable").count()) > 0);
  const before = await page.locator("#stage").screenshot();
  await page.getByLabel("Place on the curve").fill("20");
  await page.locator(".curve").getByText("drawn as large as it is").waitFor();
  assert.notDeepEqual(await page.locator("#stage").screenshot(), before);
  await curve.click({ position: { x: 60, y: 150 } });
  await curve.scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(shots, "curve.png") });
  // Another load has another curve.
  await page.getByLabel("Force z, N", { exact: true }).fill("-100");
  await page.getByLabel("Force z, N", { exact: true }).press("Enter");
  await curve.waitFor({ state: "detached" });
  assert.deepEqual(page.wrong, []);
});

test("a live page in a frame is answered by the page around it", async () => {
  const file = join(folder, "alone.html");
  assert.equal(spawnSync(command, ["view", "orthoglide", "--force", "100", "50", "0", "--export", file]).status, 0);
  const live = readFileSync(file, "utf8").replace('"live":false', '"live":true');
  const around = join(folder, "around.html");
  const quoted = live.replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  writeFileSync(around, `<!doctype html><html lang="en"><title>Notebook</title><iframe title="Machine" sandbox="allow-scripts" width="1000" height="700" srcdoc="${quoted}"></iframe></html>`);
  const url = await served("orthoglide");
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  await page.exposeFunction("answer", async (kind, request) => {
    const headers = { "content-type": "application/json" };
    const answer = await (await fetch(`${url}api/${kind}`, { method: "POST", headers, body: JSON.stringify(request) })).json();
    return answer.error === undefined ? { answer } : { error: answer.error.message };
  });
  await page.addInitScript(() =>
    window.addEventListener("message", async ({ data, source }) => data.kinetostat && source.postMessage({ id: data.id, ...(await window.answer(data.kinetostat, data.request)) }, "*")),
  );
  await page.goto(`file://${around}`);
  const frame = page.frameLocator("iframe");
  await frame.getByRole("button", { name: "Show panel" }).click();
  const field = (name) => frame.getByLabel(name, { exact: true });
  // The load that came with the page stays when another number is typed.
  assert.equal(await field("Force x, N").inputValue(), "100");
  await field("Force z, N").fill("-300");
  await field("Force z, N").press("Enter");
  const said = JSON.parse(spawnSync(command, ["deflect", "orthoglide", "--force", "100", "50", "-300", "--json"], { encoding: "utf8" }).stdout);
  const detail = `(${said.displacement_mm.map((x) => x.toFixed(4)).join(", ")}) mm`;
  await frame.getByText(detail).first().waitFor();
  await field("Tool x, mm").fill("5000");
  await field("Tool x, mm").press("Enter");
  await frame.getByRole("alert").filter({ hasText: "reached" }).waitFor();
});

test("the questions of start are answered on the page, and the machine stands along its program", async () => {
  const here = mkdtempSync(join(tmpdir(), "start-"));
  const slot = ["DEF part()", "$BASE=BASE_DATA[3]", "$TOOL=TOOL_DATA[2]", "$VEL.CP=0.2", "LIN {X 0,Y 0,Z 50,A 0,B 0,C 180,S 2,T 35}", "$VEL.CP=0.01", "LIN {X 0,Y 0,Z -1,A 0,B 0,C 180}", "LIN {X 60,Y 0,Z -1,A 0,B 0,C 180}", "$VEL.CP=0.2", "LIN {X 60,Y 0,Z 50,A 0,B 0,C 180}", "END", ""];
  writeFileSync(join(here, "part.src"), slot.join("\n"));
  const page = await opened(await servedIn(here));
  const answer = page.locator("#answer");
  const given = page.locator("dd");
  await answer.fill("no_such_robot");
  await page.keyboard.press("Enter");
  await page.getByRole("alert").filter({ hasText: "no_such_robot" }).waitFor();
  const list = ["heavy_6r", "part.src", "0 0 180", "-z", "20", "1800 0 900 30 0 0", "touch-off", "", "300 -100 -50", "100", "0.05"];
  for (const [i, text] of list.entries()) {
    await answer.fill(text);
    await page.keyboard.press("Enter");
    await page.waitForFunction((count) => document.querySelectorAll("dd").length === count, i + 1);
  }
  assert.equal(await given.nth(0).innerText(), "heavy_6r");
  await page.screenshot({ path: join(shots, "questions.png") });
  const found = await page.evaluate(`${axe}; axe.run()`);
  assert.deepEqual(found.violations.map((own) => own.id), []);
  // The button has the focus: keys are enough.
  await page.keyboard.press("Enter");
  await page.locator("#path").getByText("part.src").first().waitFor({ timeout: 30000 });
  assert.ok(readFileSync(join(here, "job.toml"), "utf8").includes("heavy_6r"));
  assert.deepEqual(page.wrong, []);
});

test("no request breaks the server, and refusals are what its description says", { skip: process.env.SCHEMATHESIS ? false : "schemathesis is not installed" }, async () => {
  const url = await served("heavy_6r");
  const description = join(folder, "openapi.json");
  const headers = { "content-type": "application/json" };
  writeFileSync(description, await (await fetch(`${url}api/openapi`, { method: "POST", headers, body: "{}" })).text());
  const checks = ["not_a_server_error", "status_code_conformance", "content_type_conformance", "response_schema_conformance", "negative_data_rejection", "unsupported_method"];
  const said = spawnSync(process.env.SCHEMATHESIS, ["run", description, "--url", url.replace(/\/$/, ""), "--checks", checks.join(","), "--max-examples", "100", "--seed", "20261201"], { cwd: folder, encoding: "utf8" });
  assert.equal(said.status, 0, said.stdout);
});

test("files are opened on the page", async () => {
  const page = await opened(await served("heavy_6r"));
  await page.getByText("Open files").click();
  const files = page.getByLabel("Open a model, or a job with its files");
  const own = (name) => join(folder, "kinetostat-demo", name);
  // What is missing is named.
  await files.setInputFiles([own("job.toml")]);
  await page.getByRole("alert").filter({ hasText: "original.ngc" }).waitFor();
  page.wrong.length = 0;
  const transfer = await page.evaluateHandle((list) => {
    const data = new DataTransfer();
    list.forEach(([name, text]) => data.items.add(new File([text], name)));
    return data;
  }, ["job.toml", "model.toml", "original.ngc"].map((name) => [name, readFileSync(own(name), "utf8")]));
  await page.dispatchEvent("#stage", "drop", { dataTransfer: transfer });
  await page.locator("#path").getByText("original.ngc").first().waitFor();
  assert.deepEqual(page.wrong, []);
});

test("paper has the picture and the figures", async () => {
  const { file } = exported();
  const page = await opened(`file://${file}`, { colorScheme: "dark" });
  await page.getByRole("button", { name: "Worst place" }).click();
  await page.locator("li[aria-current]").waitFor();
  await page.getByRole("button", { name: "Hide panel" }).click();
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  assert.ok(await page.locator("canvas.print").isVisible());
  assert.ok((await colours(page, "canvas.print")) > 50);
  const paper = await page.evaluate(() => document.querySelector("canvas.print").getContext("2d").getImageData(5, 5, 1, 1).data[0]);
  assert.ok(paper > 200, "paper is light");
  for (const seen of ["#panel dl", ".placeside dl", ".chart canvas", ".summary"]) {
    assert.ok(await page.locator(seen).first().isVisible(), seen);
  }
  for (const hidden of ["input[type=range]", "button", "select", ".program"]) {
    assert.equal(await page.locator(`${hidden}:visible`).count(), 0, hidden);
  }
  await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
  assert.equal(await page.locator("canvas.print").count(), 0);
  assert.equal(await page.locator("html").getAttribute("data-theme"), "dark");
  await page.pdf({ path: join(shots, "paper.pdf") });
  assert.deepEqual(page.wrong, []);
});

for (const [name, options] of [
  ["light", { colorScheme: "light" }],
  ["dark", { colorScheme: "dark" }],
  ["phone", { viewport: { width: 390, height: 844 } }],
]) {
  test(`nothing bars the way (${name})`, async () => {
    const page = await opened(await served("job.toml"), { ...options, bypassCSP: true });
    await page.getByRole("button", { name: "Worst place" }).click();
    await page.locator("li[aria-current]").waitFor();
    await page.evaluate(() => document.querySelectorAll("details").forEach((own) => (own.open = true)));
    await page.screenshot({ path: join(shots, `${name}.png`) });
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map((own) => `${own.id}: ${own.nodes[0].html}`), []);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.equal(wide, 0, "nothing sticks out");
    // The picture has a machine in it.
    assert.ok((await colours(page, "canvas")) > 50);
  });
}
