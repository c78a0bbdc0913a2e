// SPDX-License-Identifier: MIT
// What lies under a place of the screen: a few pixels around it are drawn with numbers as colours,
// then with depths.
import * as THREE from "three";

const side = 11;  // pixels: a finger is no needle

export class Picking {
  constructor(renderer, cloud, meshes) {
    this.renderer = renderer;
    this.cloud = cloud;
    this.meshes = meshes;
    this.target = new THREE.WebGLRenderTarget(side, side);
    this.pointScene = new THREE.Scene();
  }

  #draw(camera, pass, withPoints) {
    const { renderer, cloud, meshes, target } = this;
    cloud.material.uniforms.pass.value = pass;
    meshes.pickUniforms.pass.value = pass;
    renderer.setRenderTarget(target);
    renderer.clear();
    if (withPoints) {
      this.pointScene.add(cloud.group);
      renderer.render(this.pointScene, camera);
    }
    renderer.render(meshes.pickScene, camera);
    const pixels = new Uint8Array(4 * side * side);
    renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
    renderer.setRenderTarget(null);
    cloud.material.uniforms.pass.value = 0;
    return pixels;
  }

  /// `x`, `y` in CSS pixels on the canvas. Returns the component's index (or null) and the place in
  /// the room frame, or null where nothing is.
  pick(camera, x, y, width, height, withPoints) {
    const own = camera.clone();
    own.setViewOffset(width, height, x - side / 2, y - side / 2, side, side);
    own.updateProjectionMatrix();
    const parent = this.cloud.group.parent;
    const ids = this.#draw(own, 1, withPoints);
    const depths = this.#draw(own, 2, withPoints);
    if (parent) parent.add(this.cloud.group);
    let best = null;
    for (let row = 0; row < side; ++row) {
      for (let column = 0; column < side; ++column) {
        const at = 4 * (row * side + column);
        if (ids[at + 2] === 0) continue;
        const off = Math.hypot(row - (side - 1) / 2, column - (side - 1) / 2);
        if (best && off >= best.off) continue;
        const depth = (depths[at] + depths[at + 1] / 255 + depths[at + 2] / 65025 + depths[at + 3] / 16581375) / 255;
        best = { off, depth, row, column, number: ids[at] + 256 * ids[at + 1] };
      }
    }
    if (!best) return null;
    const clip = new THREE.Vector3(2 * (best.column + 0.5) / side - 1, 2 * (best.row + 0.5) / side - 1, 2 * best.depth - 1);
    return { index: best.number > 0 ? best.number - 1 : null, place: clip.unproject(own) };
  }
}
