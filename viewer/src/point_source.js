// SPDX-License-Identifier: MIT
// Points as the program packs them (docs/viewer.md): planes of bytes, compressed by zlib.

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// The order in which points are drawn: any first part of them is spread over the whole.
function scatteredOrder(count) {
  let stride = Math.max(1, Math.floor(count * 0.618033988749895)) | 1;
  const gcd = (a, b) => (b === 0 ? a : gcd(b, a % b));
  while (count > 1 && gcd(stride, count) !== 1) stride += 2;
  return stride;
}

/// Arrays for the graphics card: place (x, y, z), tag (component, scan), look (label, room,
/// confidence, intensity) and color of each point. Throws if the bytes are not of `layout`.
function unpack(bytes, layout) {
  const hasIntensity = layout.intensities ? 1 : 0;
  const bytesPerPoint = 12 + hasIntensity + (layout.colors ? 3 : 0);
  const count = bytes.length / bytesPerPoint;
  if (!Number.isInteger(count)) throw new Error("the points of this report are damaged");
  const plane = (index) => bytes.subarray(index * count, (index + 1) * count);
  const [xLow, xHigh, yLow, yHigh, zLow, zHigh] = [0, 1, 2, 3, 4, 5].map(plane);
  const [label, room, componentLow, componentHigh, scan, confidence] =
      [6, 7, 8, 9, 10, 11].map(plane);
  const intensity = hasIntensity ? plane(12) : null;
  const color = layout.colors ? [0, 1, 2].map((c) => plane(12 + hasIntensity + c)) : null;

  const place = new Uint16Array(4 * count);
  const tag = new Uint16Array(2 * count);
  const look = new Uint8Array(4 * count);
  const colors = color ? new Uint8Array(4 * count) : null;
  const stride = scatteredOrder(count);
  let x = 0, y = 0, z = 0, at = 0;
  for (let i = 0; i < count; ++i) {
    x = (x + (xLow[i] | (xHigh[i] << 8))) & 0xffff;
    y = (y + (yLow[i] | (yHigh[i] << 8))) & 0xffff;
    z = (z + (zLow[i] | (zHigh[i] << 8))) & 0xffff;
    const four = 4 * at;
    place[four] = x;
    place[four + 1] = y;
    place[four + 2] = z;
    tag[2 * at] = componentLow[i] | (componentHigh[i] << 8);
    tag[2 * at + 1] = scan[i];
    look[four] = label[i];
    look[four + 1] = room[i];
    look[four + 2] = confidence[i];
    look[four + 3] = intensity ? intensity[i] : 0;
    if (colors) {
      colors[four] = color[0][i];
      colors[four + 1] = color[1][i];
      colors[four + 2] = color[2][i];
    }
    at += stride;
    if (at >= count) at -= count;
  }
  return { count, place, tag, look, colors, spacing: spacingOf(xLow, yLow, zLow, xHigh, yHigh, zHigh) };
}

/// Median way from a point to the next along the curve, in steps of the grid.
function spacingOf(xLow, yLow, zLow, xHigh, yHigh, zHigh) {
  const count = xLow.length;
  const ways = [];
  const signed = (low, high) => ((low | (high << 8)) << 16) >> 16;
  for (let i = 1; i < count; i += Math.max(1, Math.floor(count / 5000))) {
    ways.push(Math.hypot(signed(xLow[i], xHigh[i]), signed(yLow[i], yHigh[i]), signed(zLow[i], zHigh[i])));
  }
  ways.sort((a, b) => a - b);
  return ways.length ? ways[ways.length >> 1] : 1;
}

export async function readEmbeddedPoints(element, layout) {
  const bytes = bytesOfBase64(element.textContent);
  element.remove();
  return unpack(await inflate(bytes), layout);
}

export async function fetchPoints(url, layout) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return unpack(await inflate(new Uint8Array(await response.arrayBuffer())), layout);
}
