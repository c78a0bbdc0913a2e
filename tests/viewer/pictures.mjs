// SPDX-License-Identifier: MIT
// Screenshots as text that stands the noise of drawing and fonts: mean colours of a coarse raster, 16 steps
// a channel. They are kept in pictures.txt; UPDATE_PICTURES=1 writes it anew, to be looked at in the diff.
import { existsSync, readFileSync, writeFileSync } from "node:fs";

const columns = 24, rows = 16;
const stepsApart = 2;       // of 16: what text in another font or one more row of points makes of a cell
const shareThatMayDiffer = 0.08;  // a cell of twelve: an element told otherwise, not a view gone

/// Means of the cells of a PNG, in hexadecimal digits, a text per row; the page reads the PNG.
export async function describePicture(page, png) {
  return page.evaluate(async (data, columns, rows) => {
    const image = new Image();
    image.src = "data:image/png;base64," + data;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const lines = [];
    for (let row = 0; row < rows; ++row) {
      let line = "";
      for (let column = 0; column < columns; ++column) {
        const [left, right] = [column, column + 1].map((k) => Math.floor(k * image.width / columns));
        const [top, bottom] = [row, row + 1].map((k) => Math.floor(k * image.height / rows));
        const { data: pixels } = context.getImageData(left, top, right - left, bottom - top);
        const sums = [0, 0, 0];
        for (let i = 0; i < pixels.length; i += 4) for (let c = 0; c < 3; ++c) sums[c] += pixels[i + c];
        for (const sum of sums) line += Math.round(sum / (pixels.length / 4) / 17).toString(16);
      }
      lines.push(line);
    }
    return lines;
  }, png.toString("base64"), columns, rows);
}

/// Share of the cells that differ.
export function differenceOf(a, b) {
  let differing = 0;
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const steps = [0, 1, 2].map((c) => Math.abs(parseInt(a[row][3 * column + c], 16) - parseInt(b[row][3 * column + c], 16)));
      if (Math.max(...steps) > stepsApart) ++differing;
    }
  }
  return differing / (rows * columns);
}

export function read(path) {
  const pictures = new Map();
  if (!existsSync(path)) return pictures;
  for (const part of readFileSync(path, "utf8").trim().split("\n\n")) {
    const [name, ...lines] = part.split("\n");
    pictures.set(name, lines);
  }
  return pictures;
}

/// Says which of the pictures look otherwise than those that are kept.
export function compare(path, pictures) {
  if (process.env.UPDATE_PICTURES) {
    writeFileSync(path, [...pictures].map(([name, lines]) => [name, ...lines].join("\n") + "\n").join("\n"));
    return [];
  }
  const kept = read(path);
  const complaints = [];
  for (const [name, lines] of pictures) {
    if (!kept.has(name)) complaints.push(`no picture "${name}" is kept`);
    else if (differenceOf(kept.get(name), lines) > shareThatMayDiffer) complaints.push(`"${name}" looks otherwise than it did: ${Math.round(100 * differenceOf(kept.get(name), lines))} % of it`);
  }
  for (const name of kept.keys()) if (!pictures.has(name)) complaints.push(`"${name}" was not taken`);
  return complaints;
}
