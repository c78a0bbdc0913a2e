// SPDX-License-Identifier: MIT
// Eye-dome lighting (Boucheny 2009): points have no normals, so edges are shaded by the depth of
// their neighbours on the screen. Depth is passed on, so that the model stands among the points.
import * as THREE from "three";

const fragmentShader = `
uniform sampler2D colors, depths;
uniform vec2 pixel;
uniform float near, far, strength;
varying vec2 place;
float distanceAt(vec2 uv) {
  float d = texture2D(depths, uv).x;
  return d >= 1. ? -1. : near * far / (far - d * (far - near));
}
void main() {
  float depth = texture2D(depths, place).x;
  if (depth >= 1.) discard;
  float own = log2(distanceAt(place)), sum = 0.;
  for (int i = 0; i < 8; ++i) {
    float angle = float(i) * .785398;
    float other = distanceAt(place + vec2(cos(angle), sin(angle)) * pixel * 1.4);
    if (other > 0.) sum += clamp(own - log2(other), 0., .25);
  }
  gl_FragColor = vec4(texture2D(colors, place).rgb * (.32 + .68 * exp(-strength * sum / 8.)), 1.);
  gl_FragDepth = depth;
}`;

export class EyeDome {
  constructor() {
    this.target = new THREE.WebGLRenderTarget(1, 1, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
    this.target.depthTexture = new THREE.DepthTexture(1, 1, THREE.FloatType);
    this.uniforms = {
      colors: { value: this.target.texture },
      depths: { value: this.target.depthTexture },
      pixel: { value: new THREE.Vector2() },
      near: { value: 0.1 },
      far: { value: 100 },
      strength: { value: 28 },
    };
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: "varying vec2 place; void main() { place = uv; gl_Position = vec4(position.xy, 0., 1.); }",
      fragmentShader,
      depthFunc: THREE.AlwaysDepth,
    });
    this.quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
    this.quad.frustumCulled = false;
    this.scene = new THREE.Scene();
    this.scene.add(this.quad);
    this.camera = new THREE.Camera();
  }

  setSize(width, height) {
    this.target.setSize(width, height);
    this.uniforms.pixel.value.set(1 / width, 1 / height);
  }

  clear(renderer) {
    this.target.scissorTest = false;
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.setRenderTarget(null);
  }

  /// Adds points to what is drawn already; `half` is [from, to] of the width, 0 to 1.
  add(renderer, scene, camera, half) {
    const { width, height } = this.target;
    this.target.scissorTest = true;
    this.target.scissor.set(Math.round(half[0] * width), 0, Math.round((half[1] - half[0]) * width), height);
    renderer.setRenderTarget(this.target);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
  }

  /// Brings the points to the canvas, within its scissor.
  show(renderer, camera) {
    this.uniforms.near.value = camera.near;
    this.uniforms.far.value = camera.far;
    renderer.render(this.scene, this.camera);
  }
}
