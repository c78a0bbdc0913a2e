// SPDX-License-Identifier: MIT
// What can be switched, as plain form elements: a keyboard and a screen reader know them.
import { inWords, make, rgb } from "./dom.js";
import { scanColors } from "./point_cloud.js";

const coloringNames = {
  label: "Label", instance: "Element", height: "Height", intensity: "Intensity", color: "Colour of the scan",
  scan: "Scan", confidence: "Confidence",
};

export function availableColorings(model) {
  const { points } = model;
  return Object.keys(coloringNames).filter((name) => {
    if (name === "label" || name === "instance" || name === "confidence") return points.labels;
    if (name === "intensity") return points.intensities;
    if (name === "color") return points.colors;
    return name !== "scan" || model.scans.length > 1;
  });
}

function check(text, checked, onChange, swatch) {
  const input = make("input", { type: "checkbox", checked, onchange: () => onChange(input.checked) });
  return make("label", { class: "v-check" }, input, ...(swatch ? [make("i", { class: "swatch", style: `background:${swatch}` })] : []), make("span", {}, text));
}

function group(title, ...children) {
  return make("fieldset", {}, make("legend", {}, title), ...children);
}

function slider(text, { min, max, step, value }, show, onInput) {
  const output = make("span", { "aria-hidden": "true" }, show(value));
  const input = make("input", { type: "range", min, max, step, value, "aria-label": text, "aria-valuetext": show(value), oninput: () => {
    output.textContent = show(Number(input.value));
    input.setAttribute("aria-valuetext", output.textContent);
    onInput(Number(input.value));
  } });
  return make("label", { class: "v-slider" }, make("span", {}, text, output), input);
}

function legendOf(coloring, model, heights) {
  const ramp = (name, from, to) => [make("i", { class: `v-ramp v-${name}` }), make("span", {}, from), make("span", {}, to)];
  if (coloring === "height") return ramp("viridis", `${heights[0].toFixed(1)} m`, `${heights[1].toFixed(1)} m`);
  if (coloring === "intensity") return ramp("grey", "weak", "strong");
  if (coloring === "confidence") return ramp("confidence", "0 %", "100 %");
  if (coloring === "scan") {
    return model.scans.map((scan, i) => make("span", { class: "v-scan" }, make("i", { class: "swatch", style: `background:${rgb(scanColors[i % scanColors.length])}` }), `${i} ${scan.name}`));
  }
  return [];
}

/// The controls as an element. `state` is changed in place; `changed()` is called after.
export function makeControls(model, state, heights, changed) {
  const set = (name) => (value) => { state[name] = value; changed(); };
  const flip = (hidden, key) => (shown) => { if (shown) hidden.delete(key); else hidden.add(key); changed(); };

  const legend = make("div", { class: "v-legend" });
  const showLegend = () => legend.replaceChildren(...legendOf(state.coloring, model, heights));
  const coloring = make("select", { onchange: () => { state.coloring = coloring.value; showLegend(); changed(); } },
    ...availableColorings(model).map((name) => make("option", { value: name, selected: name === state.coloring }, coloringNames[name])));
  showLegend();

  const compare = [["result", "Result"], ["input", "Input"], ["split", "Side by side"]].map(([value, text]) =>
    make("label", { class: "v-choice" },
      make("input", { type: "radio", name: "v-compare", value, checked: state.compare === value, onchange: () => set("compare")(value) }), make("span", {}, text)));

  const present = model.labels.map((label, id) => ({ ...label, id }))
      .filter(({ id, points }) => points > 0 || model.components.some((component) => component.label === id));
  const labels = [...present.slice(present[0]?.id === 0 ? 1 : 0), ...present.filter(({ id }) => id === 0)]
      .map(({ id, name, color }) => check(inWords(name), true, flip(state.hiddenLabels, id), rgb(color)));
  const rooms = model.rooms.map((room, i) => check(`${room.id}, ${room.area.toFixed(1)} m\u00b2`, true, flip(state.hiddenRooms, i)));
  if (rooms.length) rooms.push(check("outside rooms", true, flip(state.hiddenRooms, -1)));

  const top = heights[1] + 0.3;
  const isInterpreted = model.components.length > 0 || model.points.labels;
  return make("form", { class: "v-controls", "aria-label": "What the 3D view shows", onsubmit: (event) => event.preventDefault() },
    group("Colour by", make("label", { class: "v-select" }, make("span", { class: "v-hidden" }, "Colour points by"), coloring), legend),
    group("Compare", make("div", { class: "v-choices" }, ...compare)),
    group("Show",
      check("Points", state.points, set("points")),
      ...(model.components.length ? [
        check("Faces", state.faces, set("faces")),
        check("Edges", state.edges, set("edges")),
      ] : []),
      ...(model.components.some((component) => component.grasp) ? [check("Grasps", state.grasps, set("grasps"))] : []),
      ...(model.scans.some((scan) => scan.position) ? [check("Scanners", state.scanners, set("scanners"))] : []),
      ...(model.rooms.length ? [check("Names of rooms", state.roomNames, set("roomNames"))] : []),
      slider("Size of points", { min: 0.3, max: 3, step: 0.1, value: 1 }, (value) => `${value.toFixed(1)}\u00d7`, set("size"))),
    group("Cut",
      ...(isInterpreted ? [check("Ceiling off", state.ceilingOff, set("ceilingOff"))] : []),
      ...(model.components.length ? [check("Walls before the view off", state.nearWallsOff, set("nearWallsOff"))] : []),
      slider("Cut off above", { min: heights[0], max: top, step: 0.05, value: top }, (value) => (value >= top - 0.03 ? "nothing" : `${value.toFixed(2)} m`), (value) => { state.cut = value >= top - 0.03 ? Infinity : value; changed(); })),
    ...(present.length > 1 ? [group("Labels", ...labels)] : []),
    ...(rooms.length ? [group("Rooms", ...rooms)] : []));
}
