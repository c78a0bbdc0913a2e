// SPDX-License-Identifier: MIT
// What scene.json says of a building, computed anew, and the words for what differs from it.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const skipped = 77; // what ctest takes for "not run"
export const tolerance = 0.001; // m

/** A program that is not ours; without it the whole test is skipped. */
export async function load(name) {
    try {
        return await import(name);
    } catch {
        console.log(`skipped: ${name} is not installed; ./dev readers installs it`);
        process.exit(skipped);
    }
}

export const subtract = (a, b) => a.map((x, i) => x - b[i]);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0]];
export const norm = (a) => Math.sqrt(dot(a, a));
export const scaled = (a, s) => a.map((x) => x * s);
export const middleOf = (points) =>
    points[0].map((_, i) => points.reduce((sum, p) => sum + p[i], 0) / points.length);

/** How far points reach along a direction. */
export function extent(points, direction) {
    let [low, high] = [Infinity, -Infinity];
    for (const point of points) {
        const place = dot(direction, point);
        low = Math.min(low, place);
        high = Math.max(high, place);
    }
    return high - low;
}

/** Twice the area, along the normal. */
export function areaVector(polygon) {
    let sum = [0, 0, 0];
    for (let i = 1; i + 1 < polygon.length; ++i) {
        sum = cross(subtract(polygon[i], polygon[0]), subtract(polygon[i + 1], polygon[0]))
            .map((x, k) => x + sum[k]);
    }
    return sum;
}

/** m2 of a polygon in the plan. */
export const planArea = (polygon) =>
    norm(areaVector(polygon.map(([x, y]) => [x, y, 0]))) / 2;

/** An upright polygon in the room frame: its horizontal direction, normal, width and height. */
function panel(polygon) {
    const normal = scaled(areaVector(polygon), 1 / norm(areaVector(polygon)));
    const level = cross([0, 0, 1], normal);
    const along = scaled(level, 1 / norm(level));
    return {
        along, normal, middle: middleOf(polygon),
        width: extent(polygon, along), height: extent(polygon, cross(normal, along)),
    };
}

/** scene.json in its room frame: lists of walls (faces), doors, windows, frames and rooms. */
export function readScene(folder) {
    const scene = JSON.parse(readFileSync(join(folder, 'scene.json'), 'utf8'));
    const toRoom = (p) => scene.to_room.slice(0, 3).map((row) => dot(row.slice(0, 3), p) + row[3]);
    const upright = (label) => scene.components.filter((c) => c.label === label && c.polygon)
        .map((c) => ({ ...c, ...panel(c.polygon.map(toRoom)), polygon: c.polygon.map(toRoom) }));
    const frames = [...upright('door_frame'), ...upright('window_frame')];
    /** The frame around a door or window: that which holds its middle and lies in its plane. */
    const frameOf = (filling) => frames.find((frame) => {
        const way = subtract(filling.middle, frame.middle);
        return frame.label.startsWith(filling.label) && Math.abs(dot(way, frame.along)) < frame.width / 2 &&
            Math.abs(way[2]) < frame.height / 2 && Math.abs(dot(way, frame.normal)) < 0.25;
    });
    const fillings = (label) => upright(label).map((c) => ({ ...c, frame: frameOf(c) }));
    return {
        components: scene.components,
        walls: upright('wall'),
        doors: fillings('door'),
        windows: fillings('window'),
        rooms: scene.rooms.map((room) => ({ ...room, plan: room.polygon.map((p) => toRoom(p).slice(0, 2)) })),
        count: (label) => scene.components.filter((c) => c.label === label).length,
    };
}

/** Collects what differs in one file. */
export class Expectations {
    constructor(file) {
        this.file = file;
        this.failures = [];
    }
    that(condition, words) {
        if (!condition) this.failures.push(`${this.file}: ${words}`);
    }
    near(value, wanted, words, within = tolerance) {
        this.that(Math.abs(value - wanted) <= within, `${words}: ${value} instead of ${wanted}`);
    }
    same(value, wanted, words) {
        this.that(value === wanted, `${words}: ${value} instead of ${wanted}`);
    }
    /** Every one of the wanted things is there once, and nothing else. */
    ids(found, wanted, words) {
        this.same([...found].sort().join(' '), wanted.map((thing) => thing.id).sort().join(' '), words);
    }
}
