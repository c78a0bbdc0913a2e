// SPDX-License-Identifier: MIT
// Two ways to move: orbit around what is looked at, and walk through it at eye height.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const eyeHeight = 1.6;      // m
const walkingSpeed = 1.6;   // m/s
const turningSpeed = 1.2;   // rad/s
const movingKeys = new Set(["KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", "ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight", "Equal", "Minus", "NumpadAdd", "NumpadSubtract"]);

export class Navigation {
  /// `corners` are what the view of the whole has to show.
  constructor(canvas, corners, onMove) {
    const box = new THREE.Box3().setFromPoints(corners);
    this.corners = corners;
    this.canvas = canvas;
    this.box = box;
    this.onMove = onMove;
    this.camera = new THREE.PerspectiveCamera(55, 1, 0.05, 200);
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.zoomToCursor = true;
    this.orbit.maxPolarAngle = Math.PI * 0.98;
    this.orbit.enableZoom = false;
    this.orbit.addEventListener("change", () => this.onMove());
    this.mode = "orbit";
    this.yaw = 0;
    this.pitch = 0;
    this.held = new Set();
    this.flight = null;
    this.#listen();
    this.showAll(true);
  }

  #listen() {
    const { canvas } = this;
    // Until somebody works with the view, wheel and finger scroll the page.
    const setEngaged = (engaged) => {
      this.orbit.enableZoom = engaged;
      canvas.style.touchAction = engaged ? "none" : "pan-y";
    };
    canvas.addEventListener("focus", () => setEngaged(true));
    canvas.addEventListener("blur", () => { setEngaged(false); this.held.clear(); });
    canvas.addEventListener("pointerdown", () => { canvas.focus({ preventScroll: true }); this.flight = null; });
    setEngaged(false);
    canvas.addEventListener("keydown", (event) => {
      if (!movingKeys.has(event.code) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      this.hold(event.code);
    });
    canvas.addEventListener("keyup", (event) => this.held.delete(event.code));
    let last = null;
    const pointers = new Map();
    let spread = 0;
    canvas.addEventListener("pointerdown", (event) => {
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      last = [event.clientX, event.clientY];
      spread = 0;
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.mode !== "walk" || !pointers.has(event.pointerId)) return;
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      if (pointers.size === 1) {
        const rate = 2.2 / canvas.clientHeight;
        this.yaw += (event.clientX - last[0]) * rate;
        this.pitch = THREE.MathUtils.clamp(this.pitch + (event.clientY - last[1]) * rate, -1.5, 1.5);
      } else {
        const [a, b] = [...pointers.values()];
        const now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (spread) this.#step((now - spread) * 0.012, 0, 0);
        spread = now;
      }
      last = [event.clientX, event.clientY];
      this.#look();
    });
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => { pointers.delete(event.pointerId); spread = 0; });
    }
    canvas.addEventListener("wheel", (event) => {
      if (this.mode !== "walk" || document.activeElement !== canvas) return;
      event.preventDefault();
      this.#step(-event.deltaY * 0.002, 0, 0);
      this.#look();
    }, { passive: false });
  }

  hold(code) {
    this.flight = null;
    this.held.add(code);
    this.onMove();
  }
  release(code) {
    this.held.delete(code);
  }

  get isMoving() {
    return this.held.size > 0 || this.flight !== null;
  }

  /// One frame of what keys and flights do.
  advance(seconds) {
    if (this.flight) this.#fly(seconds);
    if (this.held.size === 0) return;
    const on = (...codes) => (codes.some((code) => this.held.has(code)) ? 1 : 0);
    const zoom = on("Equal", "NumpadAdd") - on("Minus", "NumpadSubtract");
    if (this.mode === "walk") {
      this.yaw += (on("ArrowLeft") - on("ArrowRight")) * turningSpeed * seconds;
      const pace = walkingSpeed * seconds;
      this.#step((on("KeyW", "ArrowUp") - on("KeyS", "ArrowDown") + zoom) * pace, (on("KeyD") - on("KeyA")) * pace, (on("KeyE") - on("KeyQ")) * pace);
      this.#look();
      return;
    }
    const { camera, orbit } = this;
    const offset = camera.position.clone().sub(orbit.target);
    const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    spherical.theta += (on("ArrowRight") - on("ArrowLeft")) * turningSpeed * seconds;
    spherical.phi = THREE.MathUtils.clamp(spherical.phi + (on("ArrowDown") - on("ArrowUp")) * turningSpeed * seconds, 0.02, 3.05);
    spherical.radius *= Math.exp(-1.2 * zoom * seconds);
    const turned = new THREE.Vector3().setFromSpherical(spherical);
    const pace = 0.6 * spherical.radius * seconds;
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0);
    const ahead = new THREE.Vector3(0, 0, 1).cross(right);
    orbit.target.addScaledVector(right, (on("KeyD") - on("KeyA")) * pace)
        .addScaledVector(ahead, (on("KeyW") - on("KeyS")) * pace);
    orbit.target.z += (on("KeyE") - on("KeyQ")) * pace;
    camera.position.copy(orbit.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    orbit.update();
  }

  #step(ahead, right, up) {
    const { camera, yaw } = this;
    camera.position.x += ahead * Math.cos(yaw) + right * Math.sin(yaw);
    camera.position.y += ahead * Math.sin(yaw) - right * Math.cos(yaw);
    camera.position.z += up;
  }

  #look() {
    const { camera, yaw, pitch } = this;
    camera.lookAt(camera.position.x + Math.cos(yaw) * Math.cos(pitch), camera.position.y + Math.sin(yaw) * Math.cos(pitch), camera.position.z + Math.sin(pitch));
    camera.updateMatrixWorld();
    this.onMove();
  }

  #fly(seconds) {
    const flight = this.flight;
    flight.share = Math.min(1, flight.share + seconds / 0.45);
    const eased = flight.share * flight.share * (3 - 2 * flight.share);
    this.camera.position.lerpVectors(flight.from, flight.to, eased);
    this.orbit.target.lerpVectors(flight.fromTarget, flight.toTarget, eased);
    if (flight.share === 1) this.flight = null;
    this.orbit.update();
  }

  #goTo(position, target, atOnce) {
    if (atOnce || matchMedia("(prefers-reduced-motion: reduce)").matches) {
      this.camera.position.copy(position);
      this.orbit.target.copy(target);
      this.orbit.update();
      this.onMove();
      return;
    }
    this.flight = { share: 0, from: this.camera.position.clone(), to: position, fromTarget: this.orbit.target.clone(), toTarget: target };
    this.onMove();
  }

  /// Walking begins at `start`, a place on the floor, with a look at `goal`.
  setMode(mode, start, goal) {
    if (mode === this.mode) return;
    this.mode = mode;
    this.flight = null;
    this.held.clear();
    this.orbit.enabled = mode === "orbit";
    if (mode === "orbit") {
      this.showAll();
      return;
    }
    this.yaw = Math.atan2(goal[1] - start[1], goal[0] - start[0]);
    this.pitch = -0.12;
    this.camera.position.set(start[0], start[1], start[2] + eyeHeight);
    this.#look();
  }

  /// Where to stand and where to look at, so that corners seen along `-way` just fill the picture.
  #standFor(corners, way) {
    const ahead = way.clone().negate().normalize();
    const right = ahead.clone().cross(this.camera.up).normalize();
    const up = right.clone().cross(ahead);
    const tangent = 0.9 * Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    const across = tangent * this.camera.aspect;
    // Each corner asks to be in the picture: of x - k z, and of -x - k z, the greatest decides.
    const extremes = (axis, slope) => {
      const values = corners.map((corner) => [corner.dot(axis), slope * corner.dot(ahead)]);
      return [Math.max(...values.map(([x, z]) => x - z)), Math.max(...values.map(([x, z]) => -x - z))];
    };
    const [right1, right2] = extremes(right, across);
    const [up1, up2] = extremes(up, tangent);
    const depth = Math.max((right1 + right2) / (2 * across), (up1 + up2) / (2 * tangent));
    const position = right.clone().multiplyScalar((right1 - right2) / 2)
        .addScaledVector(up, (up1 - up2) / 2).addScaledVector(ahead, -depth);
    const middle = new THREE.Box3().setFromPoints(corners).getCenter(new THREE.Vector3());
    const target = position.clone().addScaledVector(ahead, Math.max(0.3, middle.sub(position).dot(ahead)));
    return { position, target };
  }

  showAll(atOnce) {
    const { position, target } = this.#standFor(this.corners, new THREE.Vector3(-0.5, -0.72, 1.0).normalize());
    this.#goTo(position, target, atOnce);
  }

  showFromAbove() {
    const { position, target } = this.#standFor(this.corners, new THREE.Vector3(0, -0.001, 1).normalize());
    this.#goTo(position, target);
  }

  /// Looks at a box from where the camera is, or along `front` where that is given.
  lookAt(box, front) {
    if (this.mode === "walk") {
      const middle = box.getCenter(new THREE.Vector3());
      const way = middle.clone().sub(this.camera.position);
      this.yaw = Math.atan2(way.y, way.x);
      this.pitch = Math.atan2(way.z, Math.hypot(way.x, way.y));
      this.#look();
      return;
    }
    const way = front ?? this.camera.position.clone().sub(this.orbit.target).normalize();
    way.z = Math.max(way.z, 0.35);
    // With as much around it as it is large, and half a metre.
    const around = box.clone().expandByScalar(0.25 + 0.25 * box.getSize(new THREE.Vector3()).length());
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => new THREE.Vector3(
      around[i & 1 ? "max" : "min"].x, around[i & 2 ? "max" : "min"].y, around[i & 4 ? "max" : "min"].z));
    const { position, target } = this.#standFor(corners, way.normalize());
    this.#goTo(position, target);
  }
}
