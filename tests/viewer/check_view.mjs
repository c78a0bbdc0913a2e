// SPDX-License-Identifier: MIT
// check_view.mjs PROGRAM FOLDER: serves a result, asks for what it may and may not have, and opens
// it in a browser, where points come by and by.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { request } from "node:http";
import { networkInterfaces } from "node:os";
import { createConnection } from "node:net";
import { openPage } from "./browser.mjs";

const [program, folder] = process.argv.slice(2);
const server = spawn(program, ["view", folder], { stdio: ["ignore", "pipe", "inherit"] });
const ended = new Promise((resolve) => server.on("exit", resolve));

try {
  const address = await new Promise((resolve, reject) => {
    server.stdout.on("data", (data) => resolve(String(data).trim()));
    ended.then((code) => reject(new Error("roomscribe view ended with " + code)));
  });
  assert.match(address, /^http:\/\/127\.0\.0\.1:\d+\/$/);
  const { port } = new URL(address);

  /// The path goes out as it stands: a browser would take ".." out of it.
  const ask = (path, options = {}) => new Promise((resolve, reject) => {
    const asked = request({ host: "127.0.0.1", port, path, ...options }, (answer) => {
      const parts = [];
      answer.on("data", (part) => parts.push(part));
      answer.on("end", () => resolve({ status: answer.statusCode, body: Buffer.concat(parts) }));
    });
    asked.on("error", reject);
    asked.end();
  });
  assert.equal((await ask("/")).status, 200);
  for (const path of ["/labels.ply", "/report.html", "/../labels.ply", "/points/../../labels.ply", "/..%2f..%2f..%2fetc%2fpasswd", "//etc/passwd", "/points/999999999", "/points/-1", "/points/0x1"]) {
    assert.equal((await ask(path)).status, 404, path);
  }
  for (const method of ["POST", "PUT", "DELETE", "PATCH"]) assert.equal((await ask("/", { method })).status, 405, method);
  assert.equal((await ask("/", { headers: { Host: "somewhere.example" } })).status, 403);
  // No other address of this machine answers.
  const others = Object.values(networkInterfaces()).flat().filter((own) => !own.internal && own.family === "IPv4");
  for (const { address: other } of others) {
    const isOpen = await new Promise((resolve) => {
      const socket = createConnection({ host: other, port }, () => { socket.destroy(); resolve(true); });
      socket.on("error", () => resolve(false));
    });
    assert.equal(isOpen, false, other + " answers");
  }

  // The nodes hold every point once: as many as they say.
  const { nodes } = JSON.parse((await ask("/points/nodes.json")).body);
  const total = nodes.reduce((sum, node) => sum + node.count, 0);
  assert.equal(nodes[0].depth, 0);

  const { browser, page, complaints } = await openPage();
  try {
    await page.goto(address, { waitUntil: "load" });
    await page.waitForFunction("window.roomscribeViewer?.isReady || window.roomscribeViewer?.failed", { timeout: 90_000 });
    assert.equal(await page.evaluate("roomscribeViewer.failed ?? ''"), "");
    await page.evaluate("roomscribeViewer.setMode('walk')");
    await page.waitForFunction(`roomscribeViewer.cloud.count > ${nodes[0].count}`, { timeout: 90_000 });
    assert.ok(await page.evaluate("roomscribeViewer.cloud.count") <= total);
    assert.deepEqual(complaints, []);
  } finally {
    await browser.close();
  }
} finally {
  server.kill("SIGINT");
}
assert.equal(await ended, 0);
console.log("the result is served, and nothing else");
