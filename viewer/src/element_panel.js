// SPDX-License-Identifier: MIT
// What is known of the chosen element or room, and a list to choose from by keyboard.
import { inWords, make, metres, percent, rgb } from "./dom.js";

function facts(rows) {
  const list = make("dl");
  for (const [name, value] of rows) {
    if (value === null || value === undefined || value === "") continue;
    list.append(make("dt", {}, name), make("dd", {}, value));
  }
  return list;
}

const verdict = (name) => make("span", { class: `verdict ${name}` }, name);

function componentFacts(model, component) {
  const { evidence } = component;
  const room = component.room === null ? null : model.rooms[component.room];
  return facts([
    ["Verdict", make("span", {}, verdict(component.verdict), ` ${percent(component.confidence)}`)],
    ["Size", component.size.map((value) => value.toFixed(2)).join("\u202f\u00d7\u202f") + "\u202fm"],
    ["Area", component.area === undefined ? null : `${component.area.toFixed(2)}\u202fm\u00b2`],
    ["In", [component.parent, room && room.id !== component.parent ? room.id : ""].filter(Boolean).join(", ")],
    ["Points", evidence.points ? evidence.points.toLocaleString("en") : null],
    ["Covered", evidence.coverage === null ? null : percent(evidence.coverage)],
    ["Hidden", evidence.occluded === null ? null : percent(evidence.occluded)],
    ["RMS", evidence.rms === null ? null : `${(1000 * evidence.rms).toFixed(1)}\u202fmm`],
    ["Opens", component.opens ? component.opens.motion : null],
    ["Grasp", component.grasp ? `fingers ${metres(component.grasp.opening, 3)} apart` : null],
    ["Why", evidence.rule],
    ["Or else", evidence.alternative],
  ]);
}

function roomFacts(room) {
  return facts([
    ["Area", `${room.area.toFixed(2)}\u202fm\u00b2`],
    ["Height", metres(room.ceiling - room.floor)],
    ["Volume", `${room.volume.toFixed(2)}\u202fm\u00b3`],
  ]);
}

export class ElementPanel {
  /// `actions`: choose(id or null), show(id), row(id) -> element or undefined.
  constructor(model, actions) {
    this.model = model;
    this.actions = actions;
    this.select = make("select", { id: "v-element", onchange: () => actions.choose(this.select.value || null, true) },
      make("option", { value: "" }, "none"),
      ...this.#groups().map(([name, entries]) => make("optgroup", { label: name }, ...entries.map((id) => make("option", { value: id }, id)))));
    this.body = make("div", { class: "v-facts", "aria-live": "polite" });
    this.element = make("section", { class: "v-element", "aria-label": "Chosen element" },
      make("label", { class: "v-select" }, make("span", {}, "Element"), this.select), this.body);
    this.show(null);
  }

  #groups() {
    const { model } = this;
    const groups = new Map();
    if (model.rooms.length) groups.set("rooms", model.rooms.map((room) => room.id));
    for (const component of model.components) {
      const name = inWords(model.labels[component.label].name);
      if (!groups.has(name)) groups.set(name, []);
      groups.get(name).push(component.id);
    }
    return [...groups];
  }

  show(thing) {
    const { model, actions } = this;
    this.select.value = thing ? thing.id : "";
    if (!thing) {
      this.body.replaceChildren(make("p", { class: "v-hint" }, model.components.length ? "Click on an element, or on its name in a table." : "Nothing was recognised here."));
      return;
    }
    const isRoom = thing.label === undefined;
    const what = isRoom ? "room" : inWords(thing.kind || model.labels[thing.label].name);
    const row = actions.row(thing.id);
    this.body.replaceChildren(
      make("h3", {}, thing.id, make("small", {}, ...(isRoom ? [] : [make("i", { class: "swatch", style: `background:${rgb(model.labels[thing.label].color)}` })]), what)),
      isRoom ? roomFacts(thing) : componentFacts(model, thing),
      make("p", { class: "v-actions" },
        make("button", { type: "button", onclick: () => actions.show(thing.id) }, "Go there"),
        ...(row ? [make("button", { type: "button", onclick: () => { row.scrollIntoView({ block: "center" }); row.querySelector("button")?.focus({ preventScroll: true }); } }, "In the table")] : []),
        make("button", { type: "button", onclick: () => actions.choose(null) }, "Let go")));
  }
}
