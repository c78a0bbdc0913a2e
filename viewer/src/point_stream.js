// SPDX-License-Identifier: MIT
// Points by level of detail, from `roomscribe view`: an octree, of which each node adds points to
// those of its parents. Nodes come in the order of how large they are on the screen.
import * as THREE from "three";
import { fetchPoints } from "./point_source.js";

const maxPoints = 4_000_000;
const maxRequests = 4;
/// A node is needed where its points would be further apart than this on the screen.
const pixelsBetweenPoints = 2;

export class PointStream {
  constructor(url, model, cloud, onChange) {
    this.url = url;
    this.model = model;
    this.cloud = cloud;
    this.onChange = onChange;
    this.meshes = new Map();
    this.waiting = new Set();
    this.wanted = [];
    this.nodes = [];
  }

  async start() {
    const response = await fetch(`${this.url}/nodes.json`);
    if (!response.ok) throw new Error(`nodes.json: ${response.status}`);
    const { nodes, cells } = await response.json();
    this.nodes = nodes;
    this.cells = cells;
    await this.#load(this.nodes[0]);
  }

  /// Corner and edge length of a node's cube, in the room frame.
  #cubeOf({ depth, place }) {
    const { low, step } = this.model.cube;
    const edge = (65536 * step) / 2 ** depth;
    return { edge, middle: new THREE.Vector3(...place.map((k, axis) => low[axis] + (k + 0.5) * edge)) };
  }

  update(camera, pixels) {
    const frustum = new THREE.Frustum().setFromProjectionMatrix(new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const scale = pixels / (2 * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)));
    const sized = [];
    for (const node of this.nodes) {
      const { edge, middle } = this.#cubeOf(node);
      const sphere = new THREE.Sphere(middle, edge * 0.87);
      if (node.depth > 0 && !frustum.intersectsSphere(sphere)) continue;
      const far = Math.max(camera.position.distanceTo(middle) - edge * 0.87, 0.3);
      // How far apart the parent's points are on the screen, which this node's would close up.
      const gap = (2 * edge / this.cells) * scale / far;
      if (node.depth > 0 && gap < pixelsBetweenPoints) continue;
      sized.push({ node, gap: node.depth === 0 ? Infinity : gap });
    }
    sized.sort((a, b) => b.gap - a.gap || a.node.number - b.node.number);
    this.wanted = [];
    let total = 0;
    for (const { node } of sized) {
      total += node.count;
      if (total > maxPoints) break;
      this.wanted.push(node);
    }
    const keep = new Set(this.wanted.map((node) => node.number));
    for (const [number, mesh] of [...this.meshes]) {
      if (keep.has(number) || this.cloud.count <= maxPoints) continue;
      this.cloud.remove(mesh);
      this.meshes.delete(number);
    }
    this.#request();
  }

  #request() {
    for (const node of this.wanted) {
      if (this.waiting.size >= maxRequests) return;
      if (!this.meshes.has(node.number) && !this.waiting.has(node.number)) this.#load(node).catch(() => {});
    }
  }

  async #load(node) {
    this.waiting.add(node.number);
    try {
      const points = await fetchPoints(`${this.url}/${node.number}`, this.model.points);
      this.meshes.set(node.number, this.cloud.add(points));
      this.onChange();
    } finally {
      this.waiting.delete(node.number);
    }
    this.#request();
  }
}
