// SPDX-License-Identifier: MIT
// The distance between two places, and how far it goes level and upright.
import * as THREE from "three";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";

export class Measuring {
  constructor(overlay, announce) {
    this.overlay = overlay;
    this.announce = announce;
    this.group = new THREE.Group();
    this.material = new LineMaterial({ color: 0x1f7ae0, linewidth: 2.5, depthTest: false, transparent: true });
    this.places = [];
    this.marks = [];
  }

  clear() {
    this.places = [];
    for (const mark of this.marks) this.overlay.remove(mark);
    this.marks = [];
    for (const line of [...this.group.children]) {
      this.group.remove(line);
      line.geometry.dispose();
    }
  }

  add(place) {
    if (this.places.length === 2) this.clear();
    this.places.push(place);
    this.marks.push(this.overlay.add("v-dot", "", place, () => true));
    if (this.places.length < 2) {
      this.announce("First place taken; choose the second.");
      return;
    }
    const [a, b] = this.places;
    const way = b.clone().sub(a);
    this.group.add(new LineSegments2(new LineSegmentsGeometry().setPositions([...a, ...b]), this.material));
    const text = `${way.length().toFixed(3)} m`;
    const parts = `level ${Math.hypot(way.x, way.y).toFixed(3)} m, upright ${Math.abs(way.z).toFixed(3)} m`;
    const mark = this.overlay.add("v-measure", text, a.clone().lerp(b, 0.5), () => true);
    mark.element.append(document.createElement("small"));
    mark.element.lastChild.textContent = parts;
    this.marks.push(mark);
    this.announce(`${text}: ${parts}`);
  }

  get distance() {
    return this.places.length === 2 ? this.places[0].distanceTo(this.places[1]) : null;
  }
}
