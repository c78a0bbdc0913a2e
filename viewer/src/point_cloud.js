// SPDX-License-Identifier: MIT
// The cloud on the graphics card. Whatever is switched is a uniform, so that it takes one frame.
import * as THREE from "three";

export const colorings = ["label", "instance", "height", "intensity", "color", "scan", "confidence"];

/// Colours that stay apart for most eyes (Okabe and Ito 2008), as in the pictures of the report.
export const scanColors = [
  [0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233],
  [120, 94, 180],
];

const vertexShader = `
precision highp int;
attribute vec2 tag;
attribute vec4 look;
attribute vec3 paint;
uniform bool hasIntensity;
uniform int coloring, pass, labelMask;
uniform float cutHeight, selected, pointSize, pixelsPerUnit, maxPixels;
uniform vec2 heights;
uniform vec3 labelColors[10];
uniform vec3 scanColors[7];
uniform sampler2D roomMask, componentMask;
varying vec4 shade;

vec3 viridis(float t) {
  const vec3 c0 = vec3(.2777, .0054, .3340), c1 = vec3(.1050, 1.4046, 1.3845);
  const vec3 c2 = vec3(-.3308, .2148, .0950), c3 = vec3(-4.6342, -5.7991, -19.3324);
  const vec3 c4 = vec3(6.2282, 14.1799, 56.6905), c5 = vec3(4.7763, -13.7451, -65.3530);
  const vec3 c6 = vec3(-5.4354, 4.6458, 26.3124);
  return c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * (c5 + t * c6)))));
}
vec3 hueColor(float number) {
  float hue = fract(number * .61803399);
  vec3 rgb = clamp(abs(mod(hue * 6. + vec3(0., 4., 2.), 6.) - 3.) - 1., 0., 1.);
  return mix(vec3(.72), rgb, .62 + .2 * fract(number * .37));
}
vec3 coloured(float z) {
  int label = int(look.x + .5);
  float component = tag.x;
  // What the scanner saw of the surface shows through its label, where it saw anything.
  if (coloring == 0) return mix(labelColors[label], vec3(.6), .14) * (hasIntensity ? .8 + .28 * look.w / 255. : 1.);
  if (coloring == 1) return component > 0. ? hueColor(component) : vec3(.5);
  if (coloring == 2) return viridis(clamp((z - heights.x) / (heights.y - heights.x), 0., 1.));
  if (coloring == 3) return vec3(.12 + .86 * look.w / 255.);
  if (coloring == 4) return paint / 255.;
  if (coloring == 5) return scanColors[int(mod(tag.y, 7.) + .5)];
  if (coloring == 6) {
    float c = look.z / 255.;
    if (label == 0) return vec3(.55);
    return c < .5 ? mix(vec3(.75, .16, .13), vec3(.95, .75, .28), c * 2.)
                  : mix(vec3(.95, .75, .28), vec3(.10, .55, .45), c * 2. - 1.);
  }
  return vec3(.62);
}

void main() {
  vec4 world = modelMatrix * vec4(position, 1.);
  int label = int(look.x + .5);
  bool hidden = world.z > cutHeight || ((labelMask >> label) & 1) == 0 ||
                texture2D(roomMask, vec2((look.y + .5) / 256., .5)).r < .5 ||
                texture2D(componentMask, (vec2(mod(tag.x, 256.), floor(tag.x / 256.)) + .5) / 256.).r < .5;
  if (hidden) {
    gl_Position = vec4(2., 2., 2., 1.);
    gl_PointSize = 0.;
    return;
  }
  gl_Position = projectionMatrix * viewMatrix * world;
  gl_PointSize = clamp(pointSize * pixelsPerUnit / gl_Position.w, 1.5, maxPixels);
  if (pass == 1) {
    shade = vec4(mod(tag.x, 256.) / 255., floor(tag.x / 256.) / 255., 1. / 255., 1.);
    return;
  }
  vec3 rgb = coloured(world.z);
  if (selected > 0.) {
    rgb = tag.x == selected ? mix(rgb, vec3(1., .55, .1), .55) : mix(rgb, vec3(dot(rgb, vec3(.33))), .35);
  }
  shade = vec4(rgb, 1.);
}`;

const fragmentShader = `
precision highp int;
uniform int pass;
varying vec4 shade;
void main() {
  vec2 p = gl_PointCoord * 2. - 1.;
  if (dot(p, p) > 1.) discard;
  if (pass == 2) {
    vec4 e = fract(gl_FragCoord.z * vec4(1., 255., 65025., 16581375.));
    gl_FragColor = e - e.yzww * vec4(1. / 255., 1. / 255., 1. / 255., 0.);
  } else {
    gl_FragColor = shade;
  }
}`;

const toColor = ([red, green, blue]) => new THREE.Vector3(red / 255, green / 255, blue / 255);

export class PointCloud {
  constructor(model) {
    this.cube = model.cube;
    this.hasColors = model.points.colors;
    this.rooms = new THREE.DataTexture(new Uint8Array(256).fill(255), 256, 1, THREE.RedFormat);
    this.rooms.unpackAlignment = 1;
    this.rooms.needsUpdate = true;
    this.components = new THREE.DataTexture(new Uint8Array(65536).fill(255), 256, 256, THREE.RedFormat);
    this.components.needsUpdate = true;
    const heights = model.rooms.length
        ? [Math.min(...model.rooms.map((r) => r.floor)), Math.max(...model.rooms.map((r) => r.ceiling))]
        : [model.cube.low[2], model.cube.low[2] + 3];
    this.heights = heights;
    this.material = new THREE.ShaderMaterial({
      vertexShader,
      fragmentShader,
      uniforms: {
        coloring: { value: 0 },
        pass: { value: 0 },
        labelMask: { value: 1023 },
        cutHeight: { value: 1e9 },
        selected: { value: 0 },
        hasIntensity: { value: model.points.intensities },
        componentMask: { value: this.components },
        pointSize: { value: 0.01 },
        pixelsPerUnit: { value: 1000 },
        maxPixels: { value: 24 },
        heights: { value: new THREE.Vector2(...heights) },
        labelColors: { value: model.labels.map((label) => toColor(label.color)) },
        scanColors: { value: scanColors.map(toColor) },
        roomMask: { value: this.rooms },
      },
    });
    this.group = new THREE.Group();
    this.spacing = 0;
    this.count = 0;
  }

  /// Puts unpacked points on the graphics card; returns what `remove` takes them off by.
  add(points) {
    const geometry = new THREE.BufferGeometry();
    const place = new THREE.InterleavedBuffer(points.place, 4);
    geometry.setAttribute("position", new THREE.InterleavedBufferAttribute(place, 3, 0));
    geometry.setAttribute("tag", new THREE.BufferAttribute(points.tag, 2));
    geometry.setAttribute("look", new THREE.BufferAttribute(points.look, 4));
    if (points.colors) {
      const paint = new THREE.InterleavedBuffer(points.colors, 4);
      geometry.setAttribute("paint", new THREE.InterleavedBufferAttribute(paint, 3, 0));
    }
    const mesh = new THREE.Points(geometry, this.material);
    mesh.frustumCulled = false;
    mesh.matrixAutoUpdate = false;
    const { low, step } = this.cube;
    mesh.matrix.makeScale(step, step, step).setPosition(...low);
    mesh.matrixWorldNeedsUpdate = true;
    mesh.userData.count = points.count;
    this.group.add(mesh);
    this.count += points.count;
    if (!this.spacing) this.spacing = points.spacing * step;
    return mesh;
  }

  remove(mesh) {
    this.group.remove(mesh);
    mesh.geometry.dispose();
    this.count -= mesh.userData.count;
  }

  /// Draws the points from one share of them to another; any part is spread over all of them.
  setRange(from, to) {
    for (const mesh of this.group.children) {
      const { count } = mesh.userData;
      const first = Math.floor(from * count);
      mesh.geometry.setDrawRange(first, Math.ceil(to * count) - first);
    }
  }

  /// Hides the points of some components, by their numbers from 1.
  setHidden(numbers) {
    const { data } = this.components.image;
    data.fill(255);
    for (const number of numbers) data[number] = 0;
    this.components.needsUpdate = true;
  }

  setRooms(isShown) {
    for (let i = 0; i < 256; ++i) this.rooms.image.data[i] = isShown(i) ? 255 : 0;
    this.rooms.needsUpdate = true;
  }
}
