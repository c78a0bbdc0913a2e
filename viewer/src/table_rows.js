// SPDX-License-Identifier: MIT
// Rows of the report's tables that tell of an element or a room lead to it; it may have several.
import { make } from "./dom.js";

export function linkRows(ids, onChoose) {
  const rows = new Map();
  for (const head of document.querySelectorAll("main tbody th[scope=row]")) {
    const id = head.dataset.sort ?? head.textContent.trim();
    if (!ids.has(id)) continue;
    const row = head.parentElement;
    const name = head.firstChild;
    const button = make("button", { type: "button", class: "v-row", title: "Show in the 3D view" }, id);
    if (name && name.nodeType === Node.TEXT_NODE) {
      name.textContent = name.textContent.replace(id, "");
      head.prepend(button);
    }
    row.classList.add("v-linked");
    row.addEventListener("click", () => onChoose(id));
    rows.set(id, [...(rows.get(id) ?? []), row]);
  }
  return rows;
}

export function markRow(rows, id) {
  for (const [other, of] of rows) {
    for (const row of of) {
      row.classList.toggle("v-chosen", other === id);
      if (other === id) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
    }
  }
}
