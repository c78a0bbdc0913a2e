// SPDX-License-Identifier: MIT
// How many points the graphics draw in the time of a frame, measured: a fence tells when the card (or the
// software that stands for one) is done with what was sent, which the browser's own frames do not.

const frameTime = 40;        // ms: 25 pictures a second are a motion
const partTime = 100;        // ms: an answer after so long is felt as at once
const leastForPoints = 15;   // ms of a frame, however long the rest of it takes
const fewestPoints = 20_000;  // that still show what a room is

export class Pacing {
  constructor(gl) {
    this.gl = gl;
    this.rate = 3000;  // points per ms; a start that a slow machine draws in half a second
    this.rest = 5;     // ms that a picture takes beside its points
    this.inFlight = 0;
  }

  get isBusy() {
    return this.inFlight > 0;
  }

  /// Points of a picture while things move.
  get pointsOfFrame() {
    return Math.max(fewestPoints, this.rate * Math.max(leastForPoints, frameTime - this.rest));
  }

  /// Points that are added to a picture at rest at a time, so that it still answers in between.
  get pointsOfPart() {
    return Math.max(fewestPoints, this.rate * partTime);
  }

  /// To be called after `points` were sent, alone or (`isFrame`) with all else of a picture. `then`
  /// is called when they are drawn; `isBusy` until then.
  follow(points, isFrame, then) {
    const { gl } = this;
    const start = performance.now();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    ++this.inFlight;
    const ask = () => {
      const state = fence ? gl.clientWaitSync(fence, 0, 0) : gl.CONDITION_SATISFIED;
      if (state === gl.TIMEOUT_EXPIRED) {
        setTimeout(ask, 2);
        return;
      }
      if (fence) gl.deleteSync(fence);
      --this.inFlight;
      this.#learn(points, isFrame, Math.max(0.5, performance.now() - start));
      then();
    };
    setTimeout(ask, 1);
  }

  #learn(points, isFrame, time) {
    if (points < fewestPoints) return;
    const mix = (old, measured) => old + 0.4 * (measured - old);
    if (isFrame) {
      this.rest = mix(this.rest, Math.max(0, Math.min(500, time - points / this.rate)));
      // Points alone cannot be slower than points with all else.
      this.rate = Math.max(this.rate, points / time);
    } else {
      this.rate = mix(this.rate, points / time);
    }
  }
}
