// SPDX-License-Identifier: MIT
// Walls that turn their back on the viewer hide the room behind them: which these are, and what is
// in them.
import * as THREE from "three";

const standingLabels = new Set(["wall", "door", "door_frame", "window", "window_frame"]);

function normalOf(outline) {
  const normal = new THREE.Vector3();
  const [origin, ...rest] = outline.map((p) => new THREE.Vector3(...p));
  for (let i = 0; i + 1 < rest.length; ++i) {
    normal.add(rest[i].clone().sub(origin).cross(rest[i + 1].clone().sub(origin)));
  }
  return normal.normalize();
}

export function isInside(polygon, [x, y]) {
  let inside = false;
  polygon.forEach(([ax, ay], i) => {
    const [bx, by] = polygon[(i + 1) % polygon.length];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  });
  return inside;
}

export class NearWalls {
  constructor(model) {
    this.faces = [];
    const byId = new Map(model.components.map((component, i) => [component.id, { component, number: i + 1 }]));
    for (const { component, number } of byId.values()) {
      if (model.labels[component.label].name !== "wall" || !component.outline || component.room === null) continue;
      const normal = normalOf(component.outline);
      if (Math.abs(normal.z) > 0.7) continue;
      const middle = component.outline.reduce((sum, p) => sum.add(new THREE.Vector3(...p)), new THREE.Vector3()).divideScalar(component.outline.length);
      const { polygon } = model.rooms[component.room];
      const before = middle.clone().addScaledVector(normal, 0.2);
      if (!isInside(polygon, [before.x, before.y])) normal.negate();
      const numbers = [...byId.values()].filter((other) => other.number === number || this.#hangsOn(byId, other.component, component.id, model))
          .map((other) => other.number);
      this.faces.push({ normal, middle, numbers });
    }
    this.key = "";
  }

  #hangsOn(byId, component, wall, model) {
    for (let at = component, depth = 0; at && depth < 6; at = byId.get(at.parent)?.component, ++depth) {
      if (!standingLabels.has(model.labels[at.label].name)) return false;
      if (at.parent === wall) return true;
    }
    return false;
  }

  /// Numbers of the components to leave out, or null if they are those of the last time.
  hiddenFrom(camera, isOn) {
    const turned = isOn ? this.faces.filter(({ normal, middle }) => normal.dot(camera.position.clone().sub(middle)) < -0.05) : [];
    const numbers = turned.flatMap((face) => face.numbers);
    const key = numbers.join();
    if (key === this.key) return null;
    this.key = key;
    return new Set(numbers);
  }
}
