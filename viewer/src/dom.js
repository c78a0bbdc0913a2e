// SPDX-License-Identifier: MIT
/// make("button", { class: "v-tool", onclick: f }, "Fit", child...)
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === undefined || value === null) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

export const inWords = (name) => name.replaceAll("_", " ");
export const metres = (value, decimals = 2) => `${value.toFixed(decimals)}\u202fm`;
export const percent = (value) => (value === null || value === undefined ? "\u2013" : `${Math.round(100 * value)}\u202f%`);
export const rgb = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;
