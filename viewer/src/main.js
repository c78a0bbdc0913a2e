// SPDX-License-Identifier: MIT
// The 3D view of a report: puts itself into #viewer, from #viewer-model and #viewer-points.
import * as THREE from "three";
import { availableColorings, makeControls } from "./controls.js";
import { make } from "./dom.js";
import { ElementPanel } from "./element_panel.js";
import { EyeDome } from "./eye_dome.js";
import { Measuring } from "./measuring.js";
import { ModelMeshes } from "./model_meshes.js";
import { isInside, NearWalls } from "./near_walls.js";
import { Navigation } from "./navigation.js";
import { Overlay } from "./overlay.js";
import { Pacing } from "./pacing.js";
import { Picking } from "./picking.js";
import { colorings, PointCloud } from "./point_cloud.js";
import { readEmbeddedPoints } from "./point_source.js";
import { PointStream } from "./point_stream.js";
import { linkRows, markRow } from "./table_rows.js";
import style from "./viewer.css";

// Colours are what files say, as seen: no conversion between.
THREE.ColorManagement.enabled = false;

const ceilingLabel = 2;
const inputColoring = 7;
/// Of points that stand for many, while not all are drawn: larger ones hide what the picture is of.
const largestGrowth = 4;
const restTime = 120;  // ms without a change after which a picture is finished

/// What the points and the model fill, without what shines in through windows.
function cornersOf(model) {
  const corners = [];
  const add = (...corner) => corners.push(new THREE.Vector3(...corner));
  for (const room of model.rooms) {
    for (const [x, y] of room.polygon) {
      add(x, y, room.floor);
      add(x, y, room.ceiling);
    }
  }
  for (const { outline } of model.components) outline?.forEach((p) => add(...p));
  if (corners.length === 0) {
    const low = new THREE.Vector3(...model.cube.low);
    const size = new THREE.Vector3(...(model.cube.size ?? [1, 1, 1].map(() => model.cube.step * 65535)));
    corners.push(low, low.clone().add(size));
  }
  return corners;
}

class Viewer {
  constructor(root, model) {
    this.root = root;
    this.model = model;
    this.state = {
      coloring: availableColorings(model)[0], compare: "result", split: 0.5,
      points: true, faces: model.components.length > 0, edges: true, grasps: true, scanners: true, roomNames: true,
      ceilingOff: true, nearWallsOff: true, cut: Infinity, size: 1, hiddenLabels: new Set(), hiddenRooms: new Set(), selected: null, measures: false,
    };
    this.canvas = make("canvas", { tabindex: 0, role: "application", "aria-roledescription": "3D view", "aria-label": this.#describe(), "aria-describedby": "v-keys" });
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.localClippingEnabled = true;
    this.renderer.autoClear = false;
    this.renderer.setClearColor(0, 0);

    const corners = cornersOf(model);
    this.box = new THREE.Box3().setFromPoints(corners);
    this.cloud = new PointCloud(model);
    this.nearWalls = new NearWalls(model);
    this.nearHidden = new Set();
    this.meshes = new ModelMeshes(model);
    this.pointScene = new THREE.Scene();
    this.pointScene.add(this.cloud.group);
    this.scene = new THREE.Scene();
    this.scanners = this.#makeScanners();
    this.eyeDome = new EyeDome();
    this.frames = 0;
    this.turn = 0;  // of pictures: what belongs to an older one ends
    this.pacing = new Pacing(this.renderer.getContext());
    this.picking = new Picking(this.renderer, this.cloud, this.meshes);
    this.navigation = new Navigation(this.canvas, corners, () => this.draw());
    this.#buildPage();
    this.measuring = new Measuring(this.overlay, (text) => this.announce(text));
    this.scene.add(this.meshes.group, this.meshes.highlight, this.measuring.group, this.scanners);
    this.#listen();
    this.apply();
    this.navigation.showAll(true);
  }

  #describe() {
    const { components, rooms } = this.model;
    return `3D view of ${rooms.length} rooms with ${components.length} elements. What it shows is also in the tables below.`;
  }

  #makeScanners() {
    const group = new THREE.Group();
    const colors = [0xd5362c, 0x2f9e4f, 0x2f6fd6];
    for (const { position, axes } of this.model.scans) {
      if (!position || !axes) continue;
      axes.forEach((axis, i) => {
        const from = new THREE.Vector3(...position);
        const geometry = new THREE.BufferGeometry().setFromPoints([from, from.clone().addScaledVector(new THREE.Vector3(...axis), 0.35)]);
        group.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colors[i] })));
      });
    }
    return group;
  }

  #buildPage() {
    const { model, state } = this;
    const tool = (text, title, onclick, pressed) => make("button", { type: "button", title, onclick, "aria-pressed": pressed }, text);
    this.tools = {
      walk: tool("Walk", "Walk through at eye height", () => this.setMode(this.navigation.mode === "walk" ? "orbit" : "walk"), "false"),
      measure: tool("Measure", "Distance between two places", () => this.setMeasuring(!state.measures), "false"),
      fit: tool("Show all", "The whole in view", () => { this.setMode("orbit"); this.navigation.showAll(); }),
      above: tool("From above", "As a plan", () => { this.setMode("orbit"); this.navigation.showFromAbove(); }),
      full: tool("Full screen", "The view alone on the screen", () => (document.fullscreenElement ? document.exitFullscreen() : this.root.requestFullscreen?.())),
    };
    this.help = make("span", { class: "v-hint-line", id: "v-help" });
    this.message = make("p", { class: "v-message", role: "status" }, "Unpacking points \u2026");
    this.split = make("div", { class: "v-split", role: "slider", tabindex: 0, "aria-label": "Border between input and result", "aria-valuemin": 0, "aria-valuemax": 100 });
    this.sideNames = [make("span", { class: "v-side-name" }, "Input"), make("span", { class: "v-side-name" }, "Result")];
    this.keys = make("span", { class: "v-hidden", id: "v-keys" });
    // A press by key or by a screen reader has no length: it is a step.
    const step = (code) => { this.navigation.hold(code); setTimeout(() => this.navigation.release(code), 300); };
    const press = (code) => ({ onpointerdown: () => this.navigation.hold(code), onpointerup: () => this.navigation.release(code), onpointerleave: () => this.navigation.release(code),
      onclick: (event) => event.detail === 0 && step(code), type: "button" });
    const pad = make("div", { class: "v-pad", role: "group", "aria-label": "Walk" },
      make("button", { ...press("KeyW"), "aria-label": "ahead" }, "\u2191"), make("button", { ...press("KeyA"), "aria-label": "left" }, "\u2190"),
      make("button", { ...press("KeyS"), "aria-label": "back" }, "\u2193"), make("button", { ...press("KeyD"), "aria-label": "right" }, "\u2192"));
    this.live = make("span", { class: "v-hidden", "aria-live": "polite" });
    this.stage = make("div", { class: "v-stage" }, this.canvas);
    this.overlay = new Overlay(this.stage);
    this.stage.append(this.message, this.split, ...this.sideNames, pad, make("div", { class: "v-tools", role: "group", "aria-label": "3D view" }, ...Object.values(this.tools), this.help), this.live, this.keys);

    model.rooms.forEach((room, i) => {
      const middle = room.polygon.reduce((sum, [x, y]) => [sum[0] + x / room.polygon.length, sum[1] + y / room.polygon.length], [0, 0]);
      this.overlay.add("v-room", `${room.id} \u00b7 ${room.area.toFixed(1)}\u202fm\u00b2`, [...middle, room.floor + 0.05], () => state.roomNames && !state.hiddenRooms.has(i));
    });
    model.scans.forEach((scan, i) => scan.position && this.overlay.add("v-scanner", String(i), scan.position, () => state.scanners));

    const ids = new Set([...model.components, ...model.rooms].map(({ id }) => id));
    this.rows = linkRows(ids, (id) => this.choose(id, true));
    this.panel = new ElementPanel(model, {
      choose: (id, goThere) => this.choose(id, goThere), show: (id) => this.goTo(id), row: (id) => this.rows.get(id)?.[0],
    });
    this.controls = makeControls(model, state, this.cloud.heights, () => this.apply());
    const side = make("div", { class: "v-side" }, this.panel.element, this.controls);
    this.root.replaceChildren(this.stage, side);
  }

  #listen() {
    const { canvas } = this;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => { down = event.isPrimary ? [event.clientX, event.clientY] : null; });
    canvas.addEventListener("pointerup", (event) => {
      if (!down || event.button !== 0 || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5) return;
      const { left, top } = canvas.getBoundingClientRect();
      this.click(event.clientX - left, event.clientY - top);
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        this.click(canvas.clientWidth / 2, canvas.clientHeight / 2);
      } else if (event.key === "Escape") {
        if (this.state.measures) this.setMeasuring(false);
        else this.choose(null);
      }
    });
    canvas.addEventListener("focus", () => this.draw());
    canvas.addEventListener("blur", () => this.draw());
    const moveSplit = (share) => { this.state.split = Math.min(0.98, Math.max(0.02, share)); this.apply(); };
    this.split.addEventListener("pointerdown", (event) => this.split.setPointerCapture(event.pointerId));
    this.split.addEventListener("pointermove", (event) => {
      if (!this.split.hasPointerCapture(event.pointerId)) return;
      const { left, width } = this.stage.getBoundingClientRect();
      moveSplit((event.clientX - left) / width);
    });
    this.split.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
      if (!step) return;
      event.preventDefault();
      moveSplit(this.state.split + step);
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
    this.resize();
  }

  announce(text) {
    this.live.textContent = text;
  }

  resize() {
    const width = this.stage.clientWidth, height = this.stage.clientHeight;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    this.eyeDome.setSize(size.x, size.y);
    this.navigation.camera.aspect = width / height;
    this.navigation.camera.updateProjectionMatrix();
    for (const material of [this.meshes.accent, this.measuring.material]) material.resolution.set(width, height);
    // A canvas of a new size is empty: it must not be seen so.
    this.isAtRest = false;
    this.#drawNow();
  }

  isShown(component) {
    const { state } = this;
    if (state.hiddenLabels.has(component.label)) return false;
    if (state.ceilingOff && component.label === ceilingLabel) return false;
    if (this.nearHidden.has(this.model.components.indexOf(component) + 1)) return false;
    return !state.hiddenRooms.has(component.room === null ? -1 : component.room);
  }

  /// Brings the picture in line with the state.
  apply() {
    const { state, cloud, meshes, model } = this;
    cloud.setRooms((number) => !state.hiddenRooms.has(number - 1));
    meshes.setCut(Number.isFinite(state.cut) ? state.cut : 1e9);
    meshes.update((component) => this.isShown(component), state);
    this.scanners.visible = state.scanners;
    const isSplit = state.compare === "split";
    this.split.hidden = !isSplit;
    this.sideNames.forEach((name) => { name.hidden = !isSplit; });
    this.split.style.left = `${100 * state.split}%`;
    this.split.setAttribute("aria-valuenow", Math.round(100 * state.split));
    this.sideNames[0].style.right = `calc(${100 * (1 - state.split)}% + 1rem)`;
    this.sideNames[1].style.left = `calc(${100 * state.split}% + 1rem)`;
    this.help.textContent = state.measures ? "Click two places; Esc ends measuring"
      : this.navigation.mode === "walk" ? "Drag to look, WASD or arrows to walk, Q and E down and up"
      : "Drag to turn, right drag to shift, wheel to zoom once clicked";
    this.keys.textContent = this.navigation.mode === "walk" ? "Arrows or W A S D walk and turn, Q and E go down and up, Enter picks what is in the middle, Escape lets go."
      : "Arrows turn, W A S D Q E shift, plus and minus zoom, Enter picks what is in the middle, Escape lets go.";
    this.draw();
  }

  #hideNearWalls() {
    const { state, navigation } = this;
    const isOn = state.nearWallsOff && navigation.mode === "orbit";
    const hidden = this.nearWalls.hiddenFrom(navigation.camera, isOn);
    if (!hidden) return;
    this.nearHidden = hidden;
    this.cloud.setHidden(hidden);
    this.meshes.update((component) => this.isShown(component), state);
  }

  #pointUniforms(isInput, share) {
    const { state, model } = this;
    const uniforms = this.cloud.material.uniforms;
    let mask = 1023;
    let cut = Number.isFinite(state.cut) ? state.cut : 1e9;
    if (isInput) {
      // Nobody had told floor from ceiling yet: what is taken off is what lies as high.
      if (state.ceilingOff && model.rooms.length) cut = Math.min(cut, this.cloud.heights[1] - 0.15);
    } else {
      for (const label of state.hiddenLabels) mask &= ~(1 << label);
      if (state.ceilingOff) mask &= ~(1 << ceilingLabel);
    }
    uniforms.labelMask.value = mask;
    uniforms.cutHeight.value = cut;
    const raw = model.points.colors ? "color" : model.points.intensities ? "intensity" : null;
    uniforms.coloring.value = isInput ? (raw ? colorings.indexOf(raw) : inputColoring) : colorings.indexOf(state.coloring);
    uniforms.selected.value = !isInput && state.selected && state.selected.label !== undefined ? model.components.indexOf(state.selected) + 1 : 0;
    const height = this.renderer.domElement.height;
    uniforms.pixelsPerUnit.value = height / (2 * Math.tan(THREE.MathUtils.degToRad(this.navigation.camera.fov / 2)));
    uniforms.pointSize.value = 1.35 * state.size * (this.cloud.spacing || 0.01) * Math.min(largestGrowth, 1 / Math.sqrt(share));
    // Streamed points are as far apart on the screen wherever they are.
    uniforms.maxPixels.value = this.stream ? 3.2 * state.size * this.renderer.getPixelRatio() : 0.02 * height + 4;
  }

  /// The parts of the picture: [is it the input, [from, to] of the width].
  #halves() {
    const { compare, split } = this.state;
    return compare === "split" ? [[true, [0, split]], [false, [split, 1]]] : [[compare === "input", [0, 1]]];
  }

  /// Draws points from a share of them to another, as large as befits `share`, beside what is drawn.
  #addPoints(from, to, share) {
    this.cloud.setRange(from, to);
    for (const [isInput, half] of this.#halves()) {
      if (!this.state.points && !isInput) continue;
      this.#pointUniforms(isInput, share);
      this.eyeDome.add(this.renderer, this.pointScene, this.navigation.camera, half);
    }
  }

  /// Brings points and model to the canvas.
  #show() {
    const { renderer, state } = this;
    const { camera } = this.navigation;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    renderer.setRenderTarget(null);
    renderer.clear();
    for (const [isInput, half] of this.#halves()) {
      renderer.setScissorTest(true);
      renderer.setScissor(half[0] * width, 0, (half[1] - half[0]) * width, height);
      if (state.points || isInput) this.eyeDome.show(renderer, camera);
      if (!isInput) renderer.render(this.scene, camera);
      renderer.setScissorTest(false);
    }
  }

  /// One picture: of as many points as the graphics draw in the time of a frame. Where these are not all,
  /// the finished picture follows once nothing has changed for a while.
  #drawNow(now = performance.now()) {
    const { navigation, cloud, pacing } = this;
    // What moves asks for a picture, and this is it. The shortest press of a key is a step.
    navigation.advance(this.lastFrame ? Math.min(0.2, (now - this.lastFrame) / 1000) : 0.05);
    this.pending = false;
    this.lastFrame = navigation.isMoving ? now : undefined;
    this.#hideNearWalls();
    const share = Math.min(1, pacing.pointsOfFrame / Math.max(1, cloud.count));
    this.eyeDome.clear(this.renderer);
    this.#addPoints(0, share, share);
    this.#show();
    this.overlay.update(navigation.camera, this.canvas.clientWidth, this.canvas.clientHeight);
    this.drawnShare = share;
    ++this.frames;
    ++this.turn;
    clearTimeout(this.resting);
    this.#whenDrawn(share * cloud.count, true, () => {
      this.resting = setTimeout(() => this.#finish(share === 1 ? 1 : 0), restTime);
    });
    if (navigation.isMoving) this.draw();
  }

  /// Waits for the graphics. What was asked for meanwhile comes first, else `next`.
  #whenDrawn(points, isFrame, next) {
    const { turn } = this;
    this.pacing.follow(points, isFrame, () => {
      if (turn !== this.turn) return;
      if (this.pending) this.#request();
      else next();
    });
  }

  /// Draws all points, part by part and unseen, and shows them when `done`, the share that is drawn, is 1.
  #finish(done) {
    this.resting = null;
    if (this.pending) return;
    if (done === 1) {
      this.stream?.update(this.navigation.camera, this.canvas.height);
      this.isAtRest = true;
      this.finishedAt ??= this.isReady ? performance.now() : undefined;
      return;
    }
    if (done === 0) this.eyeDome.clear(this.renderer);
    const part = this.pacing.pointsOfPart / Math.max(1, this.cloud.count);
    const to = Math.min(1, done + part);
    this.#addPoints(done, to, 1);
    if (to === 1) {
      this.#show();
      this.drawnShare = 1;
    }
    this.#whenDrawn((to - done) * this.cloud.count, to === 1, () => this.#finish(to));
  }

  #request() {
    requestAnimationFrame((now) => this.#drawNow(now));
  }

  /// Asks for a new picture; many calls make one.
  draw() {
    this.isAtRest = false;
    if (this.pending) return;
    this.pending = true;
    clearTimeout(this.resting);
    if (!this.pacing.isBusy) this.#request();
  }

  find(id) {
    return this.model.components.find((component) => component.id === id) ?? this.model.rooms.find((room) => room.id === id) ?? null;
  }

  choose(id, goThere = false) {
    const thing = id ? this.find(id) : null;
    this.state.selected = thing;
    let triangles = [], edges = [];
    if (thing && thing.label !== undefined) {
      ({ triangles, edges } = this.meshes.parts[this.model.components.indexOf(thing)]);
    } else if (thing) {
      const at = ([x, y], z) => [x, y, z];
      const { polygon, floor, ceiling } = thing;
      polygon.forEach((p, i) => {
        const q = polygon[(i + 1) % polygon.length];
        edges.push(...at(p, floor), ...at(q, floor), ...at(p, ceiling), ...at(q, ceiling), ...at(p, floor), ...at(p, ceiling));
      });
    }
    this.meshes.select(triangles, edges);
    this.panel.show(thing);
    markRow(this.rows, id);
    if (thing && goThere) this.goTo(id);
    this.apply();
  }

  goTo(id) {
    const thing = this.find(id);
    if (!thing) return;
    const box = new THREE.Box3();
    if (thing.label === undefined) {
      thing.polygon.forEach(([x, y]) => box.expandByPoint(new THREE.Vector3(x, y, thing.floor)).expandByPoint(new THREE.Vector3(x, y, thing.ceiling)));
    } else {
      const { edges } = this.meshes.parts[this.model.components.indexOf(thing)];
      box.setFromArray(edges);
    }
    this.navigation.lookAt(box);
  }

  pickAt(x, y) {
    const { state } = this;
    const isInput = state.compare === "input" || (state.compare === "split" && x < state.split * this.canvas.clientWidth);
    this.#pointUniforms(isInput, 1);
    this.cloud.setRange(0, 1);
    const hit = this.picking.pick(this.navigation.camera, x, y, this.canvas.clientWidth, this.canvas.clientHeight, state.points || isInput);
    this.draw();
    return hit;
  }

  click(x, y) {
    const hit = this.pickAt(x, y);
    if (this.state.measures) {
      if (hit) this.measuring.add(hit.place);
      this.draw();
      return;
    }
    this.choose(hit && hit.index !== null ? this.model.components[hit.index].id : null);
  }

  setMeasuring(on) {
    this.state.measures = on;
    this.tools.measure.setAttribute("aria-pressed", String(on));
    this.stage.classList.toggle("v-measures", on);
    if (!on) this.measuring.clear();
    this.apply();
  }

  setMode(mode) {
    const first = this.model.scans.find((scan) => scan.position)?.position;
    const room = this.model.rooms.find(({ polygon }) => first && isInside(polygon, first)) ?? this.model.rooms[0];
    const middle = this.box.getCenter(new THREE.Vector3());
    const start = first ? [first[0], first[1], room ? room.floor : this.box.min.z] : [middle.x, middle.y, this.box.min.z];
    // Along the longest way that the room leaves.
    const corners = room ? room.polygon : [[this.box.min.x, this.box.min.y], [this.box.max.x, this.box.max.y]];
    const farness = ([x, y]) => Math.hypot(x - start[0], y - start[1]);
    const goal = corners.reduce((best, corner) => (farness(corner) > farness(best) ? corner : best));
    this.navigation.setMode(mode, start, goal);
    this.tools.walk.setAttribute("aria-pressed", String(mode === "walk"));
    this.stage.classList.toggle("v-walks", mode === "walk");
    if (mode === "walk") this.canvas.focus({ preventScroll: true });
    this.apply();
  }

  async load() {
    const element = document.getElementById("viewer-points");
    if (element.dataset.stream) {
      this.stream = new PointStream(element.dataset.stream, this.model, this.cloud, () => this.draw());
      await this.stream.start();
    } else {
      this.cloud.add(await readEmbeddedPoints(element, this.model.points));
    }
    this.message.remove();
    this.draw();
    await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  }
}

function start() {
  const root = document.getElementById("viewer");
  if (!root) return;
  document.head.append(make("style", {}, style));
  const model = JSON.parse(document.getElementById("viewer-model").textContent);
  let viewer;
  try {
    if (!document.createElement("canvas").getContext("webgl2")) throw new Error("no WebGL 2");
    viewer = new Viewer(root, model);
  } catch (error) {
    const text = "The 3D view needs WebGL 2, which this browser does not give; pictures and tables below show the same result.";
    root.replaceChildren(make("p", { class: "note", role: "status", style: "padding:1rem;margin:0;grid-column:1/-1" }, text));
    window.roomscribeViewer = { failed: String(error) };
    return;
  }
  window.roomscribeViewer = viewer;
  viewer.ready = viewer.load().then(() => { viewer.isReady = true; viewer.readyAt = performance.now(); }, (error) => {
    viewer.message.textContent = `The points could not be read: ${error.message}.`;
    viewer.failed = String(error);
  });
}

start();
