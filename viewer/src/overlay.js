// SPDX-License-Identifier: MIT
// Words over the picture that keep to places in the room: names of rooms, scanners, a measurement.
import * as THREE from "three";

export class Overlay {
  constructor(parent) {
    this.element = document.createElement("div");
    this.element.className = "v-overlay";
    this.element.setAttribute("aria-hidden", "true");
    parent.append(this.element);
    this.marks = [];
  }

  add(className, text, place, isShown) {
    const element = document.createElement("span");
    element.className = className;
    element.textContent = text;
    this.element.append(element);
    const mark = { element, place: new THREE.Vector3(...place), isShown };
    this.marks.push(mark);
    return mark;
  }

  remove(mark) {
    mark.element.remove();
    this.marks = this.marks.filter((other) => other !== mark);
  }

  update(camera, width, height) {
    const at = new THREE.Vector3();
    for (const { element, place, isShown } of this.marks) {
      at.copy(place).project(camera);
      const shown = isShown() && Math.abs(at.z) < 1 && Math.abs(at.x) < 1 && Math.abs(at.y) < 1;
      element.hidden = !shown;
      if (shown) element.style.transform = `translate(${((at.x + 1) / 2) * width}px, ${((1 - at.y) / 2) * height}px) translate(-50%, -50%)`;
    }
  }
}
