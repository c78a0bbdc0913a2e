// SPDX-License-Identifier: MIT
// The model: each component's faces, edges and a copy for picking, that are shown and hidden as one.
import * as THREE from "three";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";

const faceOpacity = { window: 0.3, ceiling: 0.12, floor: 0.12, wall: 0.14 };

function boxCorners(box) {
  const [a, b, c] = box.axes.map((axis, i) => new THREE.Vector3(...axis).multiplyScalar(box.size[i] / 2));
  const corner = (i) => new THREE.Vector3(...box.center)
      .addScaledVector(a, i & 1 ? 1 : -1).addScaledVector(b, i & 2 ? 1 : -1).addScaledVector(c, i & 4 ? 1 : -1);
  return [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
}
const boxFaces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const boxEdges = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Corners of convex faces, three a triangle.
function fan(faces) {
  const positions = [];
  for (const face of faces) {
    for (let i = 1; i + 1 < face.length; ++i) positions.push(face[0], face[i], face[i + 1]);
  }
  return positions;
}

/// Flat number arrays: the component's triangles and the ends of its edges.
function shapeOf(component) {
  if (component.box) {
    const corners = boxCorners(component.box);
    return {
      triangles: fan(boxFaces.map((face) => face.map((i) => corners[i]))).flatMap((p) => p.toArray()),
      edges: boxEdges.flatMap(([i, k]) => [...corners[i].toArray(), ...corners[k].toArray()]),
    };
  }
  const outline = component.outline ?? [];
  return {
    triangles: fan(component.pieces ?? []).flat(),
    edges: outline.flatMap((p, i) => [...p, ...outline[(i + 1) % outline.length]]),
  };
}

const pickVertex = `
uniform float cutHeight;
varying float above;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.);
  above = world.z - cutHeight;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const pickFragment = `
precision highp int;
uniform int pass;
uniform float number;
varying float above;
void main() {
  if (above > 0.) discard;
  if (pass == 2) {
    vec4 e = fract(gl_FragCoord.z * vec4(1., 255., 65025., 16581375.));
    gl_FragColor = e - e.yzww * vec4(1. / 255., 1. / 255., 1. / 255., 0.);
  } else {
    gl_FragColor = vec4(mod(number, 256.) / 255., floor(number / 256.) / 255., 2. / 255., 1.);
  }
}`;

function geometryOf(numbers) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(numbers, 3));
  return geometry;
}

/// How a gripper takes hold: a line that leads to the place, and one across as wide as it opens.
function graspLines({ position, axis, approach, opening }) {
  const at = new THREE.Vector3(...position);
  const along = (direction, length) => at.clone().addScaledVector(new THREE.Vector3(...direction), length).toArray();
  const half = Math.max(opening, 0.02) / 2;
  return [...along(approach, -0.15), ...at.toArray(), ...along(axis, -half), ...along(axis, half)];
}

export class ModelMeshes {
  constructor(model) {
    this.group = new THREE.Group();
    this.pickScene = new THREE.Scene();
    this.pickUniforms = { pass: { value: 1 }, cutHeight: { value: 1e9 } };
    this.cut = new THREE.Plane(new THREE.Vector3(0, 0, -1), 1e9);
    this.parts = model.components.map((component, index) => this.#makePart(model, component, index));
    this.highlight = new THREE.Group();
    this.accent = new LineMaterial({ color: 0xff8c1a, linewidth: 3.5, depthTest: false, transparent: true });
  }

  #makePart(model, component, index) {
    const { triangles, edges } = shapeOf(component);
    const label = model.labels[component.label];
    const color = new THREE.Color().setRGB(...label.color.map((c) => c / 255));
    const faces = new THREE.Mesh(geometryOf(triangles), new THREE.MeshBasicMaterial({
      color, transparent: true, opacity: faceOpacity[label.name] ?? 0.3, side: THREE.DoubleSide,
      depthWrite: false, clippingPlanes: [this.cut],
    }));
    const isDoubtful = component.verdict === "doubtful";
    const lines = new THREE.LineSegments(geometryOf(edges), isDoubtful
        ? new THREE.LineDashedMaterial({ color, dashSize: 0.08, gapSize: 0.06, clippingPlanes: [this.cut] })
        : new THREE.LineBasicMaterial({ color, clippingPlanes: [this.cut] }));
    if (isDoubtful) lines.computeLineDistances();
    const pick = new THREE.Mesh(faces.geometry, new THREE.ShaderMaterial({
      vertexShader: pickVertex, fragmentShader: pickFragment, side: THREE.DoubleSide,
      uniforms: { ...this.pickUniforms, number: { value: index + 1 } },
    }));
    const grasp = component.grasp
        ? new THREE.LineSegments(geometryOf(graspLines(component.grasp)), new THREE.LineBasicMaterial({ color: 0xff8c1a, depthTest: false }))
        : null;
    this.group.add(faces, lines);
    if (grasp) this.group.add(grasp);
    this.pickScene.add(pick);
    return { component, faces, lines, pick, grasp, triangles, edges };
  }

  setCut(height) {
    this.cut.constant = height;
    this.pickUniforms.cutHeight.value = height;
  }

  update(isShown, { faces, edges, grasps }) {
    for (const part of this.parts) {
      const shown = isShown(part.component);
      part.faces.visible = shown && faces;
      part.lines.visible = shown && edges;
      part.pick.visible = shown && (faces || edges);
      if (part.grasp) part.grasp.visible = shown && grasps;
    }
  }

  /// Marks a component, or an outline (of a room).
  select(triangles, edges) {
    for (const object of [...this.highlight.children]) {
      this.highlight.remove(object);
      object.geometry.dispose();
    }
    if (triangles.length) {
      this.highlight.add(new THREE.Mesh(geometryOf(triangles), new THREE.MeshBasicMaterial({
        color: 0xff8c1a, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false,
      })));
    }
    if (edges.length) {
      this.highlight.add(new LineSegments2(new LineSegmentsGeometry().setPositions(edges), this.accent));
    }
  }
}
