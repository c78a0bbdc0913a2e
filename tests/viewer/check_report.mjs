// SPDX-License-Identifier: MIT
// check_report.mjs FOLDER [PICTURES [KEPT]]: opens the report of a result in a browser, works every control
// of its 3D view and holds what it shows against scene.json. Screenshots go to the folder PICTURES, and are held
// against those that the file KEPT describes.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { checkAccessibility, checkContrast } from "./accessibility.mjs";
import { openPage } from "./browser.mjs";
import { compare, describePicture, differenceOf } from "./pictures.mjs";

const [folder, pictures, kept] = process.argv.slice(2);
const url = pathToFileURL(resolve(folder, "report.html")).href;
const scene = JSON.parse(readFileSync(join(folder, "scene.json"), "utf8"));
if (pictures) mkdirSync(pictures, { recursive: true });

const { browser, page, complaints } = await openPage({ isOffline: true });
const run = (code) => page.evaluate(code);
const described = new Map();
async function shoot(name) {
  const png = Buffer.from(await page.screenshot({ captureBeyondViewport: false }));
  if (pictures) writeFileSync(join(pictures, name + ".png"), png);
  described.set(name, await describePicture(page, png));
}

let last;  // picture at rest
/// Lets the picture come to rest, and sums it up in a number.
async function rest() {
  await page.waitForFunction("window.roomscribeViewer.isAtRest", { polling: 30, timeout: 60_000 });
  last = await page.evaluate(() => {
    const { renderer, canvas } = window.roomscribeViewer;
    const gl = renderer.getContext();
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let sum = 0, filled = 0;
    for (let i = 0; i < pixels.length; ++i) sum = (sum * 31 + pixels[i]) >>> 0;
    for (let i = 3; i < pixels.length; i += 4) filled += pixels[i] > 0 ? 1 : 0;
    return { sum, share: filled / (pixels.length / 4) };
  });
  return last;
}

/// Does something, and wants the picture to change.
async function changes(what, act) {
  const before = last;
  await act();
  const after = await rest();
  assert.notEqual(after.sum, before.sum, what + " changes nothing in the picture");
  return after;
}

const flip = (text) => run(`(() => { const input = [...document.querySelectorAll(".v-check")].find((e) => e.textContent.trim() === ${JSON.stringify(text)})?.querySelector("input"); if (!input) throw Error("no switch " + ${JSON.stringify(text)}); input.click(); })()`);
const tool = (text) => run(`[...document.querySelectorAll(".v-tools button")].find((e) => e.textContent === ${JSON.stringify(text)}).click()`);
const viewer = "window.roomscribeViewer";

try {
  await page.goto(url, { waitUntil: "load" });
  await page.waitForFunction(`${viewer} && (${viewer}.isReady || ${viewer}.failed)`, { timeout: 90_000 });
  assert.equal(await run(`${viewer}.failed ?? ""`), "");
  await run("document.getElementById('viewer').scrollIntoView()");
  const first = await rest();
  assert.ok(first.share > 0.05, "the picture is empty");
  await shoot("result");

  // The model is that of scene.json.
  const model = await run(`(${viewer}.model)`);
  assert.deepEqual(model.components.map((c) => c.id), scene.components.map((c) => c.id));
  const rows = scene.to_room;
  const toRoom = ([x, y, z]) => rows.slice(0, 3).map((r) => r[0] * x + r[1] * y + r[2] * z + r[3]);
  scene.components.forEach((component, i) => {
    const shown = model.components[i];
    assert.equal(shown.verdict, component.verdict);
    assert.equal(model.labels[shown.label].name, component.label);
    (component.polygon ?? []).forEach((corner, k) => toRoom(corner).forEach((value, axis) =>
      assert.ok(Math.abs(value - shown.outline[k][axis]) < 5e-4, component.id + " lies elsewhere")));
    if (component.box) toRoom(component.box.center).forEach((value, axis) =>
      assert.ok(Math.abs(value - shown.box.center[axis]) < 5e-4, component.id + " lies elsewhere"));
  });
  scene.rooms.forEach((room, i) => {
    assert.ok(Math.abs(room.area - model.rooms[i].area) < 1e-6 && Math.abs(room.volume - model.rooms[i].volume) < 1e-6);
  });
  assert.ok(await run(`${viewer}.cloud.count`) === model.points.shown);

  // Colours.
  const colorings = await run("[...document.querySelectorAll('.v-controls select option')].map((o) => o.value)");
  assert.ok(colorings.includes("label") && colorings.includes("instance") && colorings.includes("height") && colorings.includes("confidence"));
  for (const coloring of colorings.slice(1)) {
    await changes("colour by " + coloring, () => page.select(".v-controls select", coloring));
    await shoot("colour-" + coloring);
  }
  await page.select(".v-controls select", "label");
  assert.equal((await rest()).sum, first.sum, "the first picture does not come back");

  // What is shown, labels and rooms, each off and on again.
  const checks = await run("[...document.querySelectorAll('.v-check')].map((e) => [e.textContent.trim(), e.querySelector('input').checked])");
  for (const [name] of checks) {
    // Names are words over the picture; ceilings are off, grasps small, and outside may be nothing.
    const isSure = !["Names of rooms", "ceiling", "outside rooms", "Grasps", "handle", "door", "door frame", "window", "window frame", "unknown"].includes(name);
    await flip(name);
    const after = await rest();
    if (isSure) assert.notEqual(after.sum, first.sum, "the switch " + name + " changes nothing");
    if (name === "Ceiling off") await shoot("with-ceiling");
    await flip(name);
    assert.equal((await rest()).sum, first.sum, "the switch " + name + " does not switch back");
  }
  await flip("Names of rooms");
  await rest();
  assert.equal(await run("[...document.querySelectorAll('.v-room')].every((e) => e.hidden)"), true);
  await flip("Names of rooms");
  const slide = (index, value) => run(`(() => { const input = document.querySelectorAll(".v-controls input[type=range]")[${index}]; input.value = ${value}; input.dispatchEvent(new Event("input")); })()`);
  await changes("the size of points", () => slide(0, 2));
  await slide(0, 1);
  await changes("the cut", () => slide(1, 1));
  await shoot("cut");
  await slide(1, 99);
  assert.equal((await rest()).sum, first.sum, "the first picture does not come back");

  // Input against result.
  await changes("input", () => run("document.querySelector('[name=v-compare][value=input]').click()"));
  await changes("side by side", () => run("document.querySelector('[name=v-compare][value=split]').click()"));
  await page.focus(".v-split");
  await changes("the border by keyboard", () => page.keyboard.press("ArrowLeft"));
  await shoot("side-by-side");
  await run("document.querySelector('[name=v-compare][value=result]').click()");

  // An element by its row, by the list, by a click in the picture.
  const wall = model.components.find((c) => model.labels[c.label].name === "wall");
  const rowOf = (id) => `[...document.querySelectorAll(".v-row")].find((e) => e.textContent === "${id}")`;
  await changes("the row of " + wall.id, () => run(rowOf(wall.id) + ".click()"));
  const facts = () => run("document.querySelector('.v-facts').textContent");
  for (const text of [wall.id, wall.verdict, wall.size[0].toFixed(2), wall.evidence.rule]) {
    assert.ok((await facts()).includes(text), "the panel does not say " + text);
  }
  assert.equal(await run(`${rowOf(wall.id)}.closest("tr").getAttribute("aria-current")`), "true");
  await shoot("chosen");
  const action = (text) => run(`[...document.querySelectorAll(".v-actions button")].find((e) => e.textContent === ${JSON.stringify(text)}).click()`);
  await tool("Show all");
  await rest();
  await changes("to go there", () => action("Go there"));
  await action("In the table");
  assert.equal(await run("document.activeElement.textContent"), wall.id);
  await run("document.getElementById('viewer').scrollIntoView()");
  await action("Let go");
  assert.equal(await run(`${viewer}.state.selected`), null);
  await rest();
  await tool("From above");
  await rest();
  const floorPlace = await run(`(() => { const v = ${viewer}; const r = v.model.rooms[0]; const { width, height } = v.canvas.getBoundingClientRect();
    for (let k = 0; k < 400; ++k) {
      const x = width * (.2 + .6 * ((k * .618034) % 1)), y = height * (.15 + .6 * (k / 400));
      const hit = v.pickAt(x, y);
      if (hit && hit.index !== null && v.model.labels[v.model.components[hit.index].label].name === "floor") return [x, y, hit.index, hit.place.z];
    } })()`);
  assert.ok(floorPlace, "no floor under the pointer");
  assert.ok(Math.abs(floorPlace[3]) < 0.1, "the floor is picked at the height " + floorPlace[3]);
  const corner = await run("(() => { const { left, top } = document.querySelector('.v-stage canvas').getBoundingClientRect(); return [left, top]; })()");
  await page.mouse.click(corner[0] + floorPlace[0], corner[1] + floorPlace[1]);
  assert.equal(await run(`${viewer}.state.selected?.id`), model.components[floorPlace[2]].id);
  await page.keyboard.press("Escape");
  assert.equal(await run(`${viewer}.state.selected`), null);
  await page.select("#v-element", model.rooms[0].id);
  assert.ok((await facts()).includes(model.rooms[0].area.toFixed(2)));

  // Measuring: the ends of a wall's foot, over the model alone, are as far apart as the model says.
  await run(`${viewer}.choose(null)`);
  await tool("From above");
  await rest();
  await tool("Measure");
  const measured = await run(`(() => { const v = ${viewer}; const { width, height } = v.canvas.getBoundingClientRect();
    const at = ([x, y, z]) => { const p = v.navigation.camera.position.clone().set(x, y, z).project(v.navigation.camera); return [(p.x + 1) / 2 * width, (1 - p.y) / 2 * height]; };
    const floor = v.model.components.find((c) => v.model.labels[c.label].name === "floor" && c.outline);
    // Places within its convex pieces: between corners of its outline there may be none of it.
    const places = floor.pieces.flatMap((piece) => {
      const middle = piece.reduce((s, p) => s.map((x, i) => x + p[i] / piece.length), [0, 0, 0]);
      return piece.map((p) => p.map((x, i) => middle[i] + .8 * (x - middle[i])));
    });
    const way = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
    const a = places[0];
    const b = places.reduce((best, p) => (way(a, p) > way(a, best) ? p : best));
    v.state.points = false;
    v.model.labels.forEach(({ name }, id) => name !== "floor" && v.state.hiddenLabels.add(id));
    v.apply();
    v.click(...at(a)); v.click(...at(b));
    v.state.points = true;
    v.state.hiddenLabels.clear();
    v.apply();
    return [v.measuring.distance, Math.hypot(...a.map((x, i) => x - b[i]))]; })()`);
  assert.ok(Math.abs(measured[0] - measured[1]) < 0.025, `measured ${measured[0]} m for ${measured[1]} m`);
  await rest();
  assert.ok((await run("document.querySelector('.v-measure').textContent")).includes("m"));
  await shoot("measured");
  await tool("Measure");
  assert.equal(await run("document.querySelector('.v-measure')"), null);

  // Walking and orbiting by keyboard, the mouse, and back.
  const place = () => run(`${viewer}.navigation.camera.position.toArray()`);
  const moves = async (what, act) => {
    const before = await place();
    await act();
    const after = await place();
    assert.ok(Math.hypot(...before.map((x, i) => x - after[i])) > 0.05, what + " moves nothing");
  };
  const holdKey = async (key) => {
    await page.keyboard.down(key);
    await new Promise((done) => setTimeout(done, 400));
    await page.keyboard.up(key);
    await rest();
  };
  await tool("Walk");
  await rest();
  const eye = await place();
  assert.ok(model.rooms.some((room) => Math.abs(eye[2] - (room.floor + 1.6)) < 0.01), "eyes are at " + eye[2]);
  await shoot("walk");
  for (const key of ["w", "s", "a", "d", "ArrowUp", "ArrowDown", "q", "e"]) await moves("walking by " + key, () => holdKey(key));
  await changes("turning by ArrowLeft", () => holdKey("ArrowLeft"));
  await tool("Show all");
  await rest();
  await page.focus(".v-stage canvas");
  for (const key of ["ArrowLeft", "ArrowUp", "w", "+"]) await moves("orbiting by " + key, () => holdKey(key));
  await moves("a drag", async () => {
    const [left, top] = await run("(() => { const { left, top } = document.querySelector('.v-stage canvas').getBoundingClientRect(); return [left, top]; })()");
    await page.mouse.move(left + 200, top + 200);
    await page.mouse.down();
    await page.mouse.move(left + 320, top + 230, { steps: 4 });
    await page.mouse.up();
    await rest();
  });

  // The view alone on the screen, and back.
  await page.click(".v-tools button:last-of-type");
  await page.waitForFunction("document.fullscreenElement?.id === 'viewer'", { timeout: 10_000 });
  await rest();
  await page.click(".v-tools button:last-of-type");
  await page.waitForFunction("!document.fullscreenElement", { timeout: 10_000 });
  await tool("Show all");
  await rest();

  // Each column of each table sorts its rows, up and down, and says so.
  const unsorted = await page.evaluate(() => {
    const wrong = [];
    for (const table of document.querySelectorAll("main table")) {
      [...table.tHead.rows[0].cells].forEach((head, column) => {
        for (const way of ["ascending", "descending"]) {
          head.querySelector("button").click();
          const cells = [...table.tBodies[0].rows].map((row) => row.cells[column]).filter((cell) => cell.textContent !== "\u2013");
          const keys = cells.map((cell) => cell.dataset.sort ?? cell.textContent);
          const areNumbers = keys.every((key) => !Number.isNaN(Number(key)));
          const order = (a, b) => (areNumbers ? Number(a) - Number(b) : a.localeCompare(b, "en", { numeric: true }));
          const isInOrder = keys.every((key, i) => i === 0 || (way === "ascending" ? order(keys[i - 1], key) <= 0 : order(keys[i - 1], key) >= 0));
          if (head.getAttribute("aria-sort") !== way || !isInOrder) wrong.push(`${head.textContent} ${way}`);
        }
      });
    }
    return wrong;
  });
  assert.deepEqual(unsorted, []);

  // For those who do not see it or have no mouse.
  const access = await checkAccessibility(page);
  assert.deepEqual(access.complaints, []);
  assert.ok(access.tabs > 40, "Tab meets " + access.tabs);
  await tool("Walk");
  await page.focus(".v-stage canvas");
  await page.keyboard.press("Tab");
  assert.notEqual(await run("document.activeElement.tagName"), "CANVAS", "a walk keeps the Tab key");
  await page.focus(".v-stage canvas");
  await page.keyboard.down("Shift");
  await page.keyboard.press("Tab");
  await page.keyboard.up("Shift");
  assert.notEqual(await run("document.activeElement.tagName"), "CANVAS", "the view keeps the Tab key");
  await tool("Show all");
  await rest();

  // Dark, and on a telephone.
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  assert.deepEqual(await checkContrast(page), []);
  await run("document.activeElement.blur()");
  await run("document.querySelector('.v-side').scrollTop = 0");  // Tab went down there
  await run("document.getElementById('viewer').scrollIntoView()");
  await tool("Show all");
  await rest();
  await shoot("dark");
  await page.setViewport({ width: 390, height: 800, hasTouch: true, isMobile: true });
  await rest();
  assert.ok(await run("document.documentElement.scrollWidth <= innerWidth + 1"), "the page is wider than a telephone");
  await run("document.getElementById('viewer').scrollIntoView()");
  await shoot("telephone");

  // By touch: one finger turns once the picture was touched, two zoom, and a pad walks.
  const fingers = await page.createCDPSession();
  const touch = (type, ...points) => fingers.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const slideFingers = async (from, to) => {
    await touch("touchStart", ...from);
    for (let k = 1; k <= 4; ++k) await touch("touchMove", ...from.map(([x, y], i) => [x + (to[i][0] - x) * k / 4, y + (to[i][1] - y) * k / 4]));
    await touch("touchEnd");
    await rest();
  };
  const [left, top] = await run("(() => { const { left, top } = document.querySelector('.v-stage canvas').getBoundingClientRect(); return [left, top]; })()");
  await page.focus(".v-stage canvas");
  await moves("one finger", () => slideFingers([[left + 120, top + 150]], [[left + 220, top + 170]]));
  await moves("two fingers", () => slideFingers([[left + 120, top + 150], [left + 220, top + 150]], [[left + 70, top + 150], [left + 270, top + 150]]));
  await tool("Walk");
  await rest();
  const pad = await run(`[...document.querySelectorAll(".v-pad button")].map((e) => { const { left, top, width, height } = e.getBoundingClientRect(); return [left + width / 2, top + height / 2, width, height]; })`);
  assert.equal(pad.length, 4);
  for (const [x, y, width, height] of pad) {
    assert.ok(width >= 40 && height >= 40, "a finger is wider than " + width);
    await moves("the pad", async () => {
      await touch("touchStart", [x, y]);
      await new Promise((done) => setTimeout(done, 300));
      await touch("touchEnd");
      await rest();
    });
  }
  await moves("the pad by key", async () => {
    await page.focus(".v-pad button");
    await page.keyboard.press("Enter");
    await new Promise((done) => setTimeout(done, 400));
    await rest();
  });
  await fingers.detach();
  assert.deepEqual(complaints, []);
  if (kept) {
    // What is told apart at all: else nothing could be told to be wrong.
    for (const other of ["walk", "dark"]) assert.ok(differenceOf(described.get("result"), described.get(other)) > 0.2, other);
    assert.deepEqual(compare(kept, described), []);
  }
} finally {
  await browser.close();
}

// Without WebGL there is a word instead.
const plain = await openPage({ withoutWebGL: true });
try {
  await plain.page.goto(url, { waitUntil: "load" });
  assert.match(await plain.page.evaluate("document.getElementById('viewer').textContent"), /needs WebGL/);
} finally {
  await plain.browser.close();
}
console.log("every control does its work");
