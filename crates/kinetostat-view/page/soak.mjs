// Many people drag at once, for minutes: `KINETOSTAT=path/to/kinetostat npm run soak [seconds]`.
// Prints times and memory; fails if a request is lost, or if memory keeps growing.

import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";

const CLIENTS = 50;
const seconds = Number(process.argv[2] ?? 300);
const server = spawn(process.env.KINETOSTAT ?? "kinetostat", ["view", "hexapod", "--no-browser"]);
const line = await new Promise((resolve) => server.stdout.on("data", (data) => resolve(String(data))));
const url = /http:\/\/[^#\s]*/.exec(line)[0];
const megabytes = () => Number(/VmRSS:\s*(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, "utf8"))[1]) / 1024;

const ask = (question, request) => fetch(`${url}api/${question}`, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(request) });
const home = (await (await ask("state", {})).json()).tool.position_mm;
const times = [];
let lost = 0;
const end = Date.now() + 1000 * seconds;

/** One person: the tool goes round in small steps, as by the mouse, at 20 a second at most. */
async function drag(number) {
  for (let step = 0; Date.now() < end; step += 1) {
    const angle = 0.1 * step + number;
    const at_mm = [home[0] + 20 * Math.cos(angle), home[1] + 20 * Math.sin(angle), home[2]];
    const begun = performance.now();
    try {
      const answer = await ask("state", { at_mm, force_n: [100, 50 * Math.sin(angle), -200] });
      const state = await answer.json();
      lost += answer.ok && state.displacement_mm !== null ? 0 : 1;
    } catch {
      lost += 1;
    }
    const took = performance.now() - begun;
    times.push(took);
    await new Promise((resolve) => setTimeout(resolve, Math.max(0, 50 - took)));
  }
}

const memory = [];
const watch = setInterval(() => memory.push(megabytes()), 5000);
await Promise.all(Array.from({ length: CLIENTS }, (_, number) => drag(number)));
clearInterval(watch);
server.kill();
times.sort((a, b) => a - b);
const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(1);
const [early, late] = [memory[Math.floor(memory.length / 4)], memory.at(-1)];
console.log(`${CLIENTS} clients, ${seconds} s: ${times.length} requests, ${lost} lost; median ${at(0.5)} ms, 99 % ${at(0.99)} ms, longest ${at(1)} ms`);
console.log(`memory after a quarter of the time ${early?.toFixed(1)} MB, at the end ${late?.toFixed(1)} MB`);
process.exitCode = lost > 0 || late > 1.2 * early ? 1 : 0;
