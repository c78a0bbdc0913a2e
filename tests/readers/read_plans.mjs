// SPDX-License-Identifier: MIT
// plan.svg, read by xmldom, and plan.dxf, read by dxf-parser: two files of one drawing.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { dot, Expectations, extent, load, norm, planArea, subtract } from './expectations.mjs';

const paperPerMetre = 20; // mm, at 1:50
const layers = ['ROOMS', 'FURNITURE', 'WALLS', 'FACES', 'WINDOWS', 'DOORS', 'HANDLES', 'DIMENSIONS', 'TEXT'];

/** Shapes of a plan in metres: {layer, id, points, isClosed}, or with the radius of an arc. */
async function readSvg(path, expect) {
    const { DOMParser } = await load('@xmldom/xmldom');
    const root = new DOMParser().parseFromString(readFileSync(path, 'utf8'), 'image/svg+xml').documentElement;
    const sheet = root.getAttribute('viewBox').split(' ').map(Number);
    expect.same(root.getAttribute('width'), `${sheet[2]}mm`, 'width of the sheet');
    expect.same(root.getAttribute('height'), `${sheet[3]}mm`, 'height of the sheet');
    return [...root.getElementsByTagName('path')].map((path) => {
        const d = path.getAttribute('d');
        const shape = { layer: path.parentNode.getAttribute('class'), id: path.getAttribute('data-id') };
        const arc = /^M([-\d.]+) ([-\d.]+)A([-\d.]+) /.exec(d);
        if (arc) return { ...shape, radius: Number(arc[3]) / paperPerMetre };
        const points = [...d.matchAll(/[ML]([-\d.]+) ([-\d.]+)/g)]
            .map(([, x, y]) => [x / paperPerMetre, -y / paperPerMetre]);
        return { ...shape, points, isClosed: d.endsWith('Z') };
    });
}

async function readDxf(path, expect) {
    const { default: DxfParser } = await load('dxf-parser');
    const file = new DxfParser().parseSync(readFileSync(path, 'utf8'));
    expect.same(file.header.$INSUNITS, 6, 'unit (metres)');
    expect.same(Object.keys(file.tables.layer.layers).join(' '), ['0', ...layers].join(' '), 'layers');
    return file.entities.filter((entity) => entity.type !== 'TEXT').map((entity) => {
        const shape = { layer: entity.layer, id: entity.extendedData?.customStrings?.[0] ?? '' };
        if (entity.type === 'ARC') return { ...shape, radius: entity.radius };
        return { ...shape, points: entity.vertices.map(({ x, y }) => [x, y]), isClosed: entity.shape === true };
    });
}

const sideLengths = ({ points }) => points.map((p, i) => norm(subtract(points[(i + 1) % points.length], p)));
const lengthOf = ({ points }) => norm(subtract(points[1], points[0]));

/** A door drawn shut is a line, one that opens has a leaf or two, each with the way of its edge. */
function widthOfDoor(shapes) {
    const arcs = shapes.filter((shape) => shape.radius !== undefined);
    const leaves = shapes.filter((shape) => shape.isClosed);
    const shut = shapes.filter((shape) => shape.points && !shape.isClosed);
    const sum = (lengths) => lengths.reduce((a, b) => a + b, 0);
    if (shut.length === 1 && shapes.length === 1) return [lengthOf(shut[0])];
    return shut.length > 0 ? [NaN]
        : [sum(arcs.map((arc) => arc.radius)), sum(leaves.map((leaf) => Math.max(...sideLengths(leaf))))];
}

function checkPlan(expect, shapes, scene) {
    const on = (layer) => {
        const found = new Map();
        for (const shape of shapes.filter((s) => s.layer === layer)) {
            found.set(shape.id, [...(found.get(shape.id) ?? []), shape]);
        }
        return found;
    };
    const faces = on('FACES');
    expect.ids(faces.keys(), scene.walls, 'walls');
    for (const wall of scene.walls) {
        expect.same(faces.get(wall.id)?.length, 1, `${wall.id}: lines`);
        if (faces.has(wall.id)) expect.near(lengthOf(faces.get(wall.id)[0]), wall.width, `${wall.id}: width`);
    }
    for (const [id, bands] of on('WALLS')) {
        const face = scene.walls.find((wall) => wall.id === id);
        expect.that(face, `the band ${id} is no wall`);
        // Back to back with its face: the band is as thick as scene.json has them apart.
        const back = face && faces.get(id) && scene.walls.find((other) => dot(other.normal, face.normal) < -0.99 &&
            Math.abs(dot(subtract(other.middle, face.middle), face.normal)) < 0.6 &&
            Math.abs(dot(subtract(other.middle, face.middle), face.along)) < face.width / 2);
        if (!back) continue;
        const apart = Math.abs(dot(subtract(back.middle, face.middle), face.normal));
        for (const band of bands) expect.near(sideLengths(band)[1], apart, `${id}: thickness`);
    }
    const doors = on('DOORS');
    expect.ids(doors.keys(), scene.doors, 'doors');
    for (const door of scene.doors) {
        for (const width of widthOfDoor(doors.get(door.id) ?? [])) expect.near(width, door.width, `${door.id}: width`);
    }
    const windows = on('WINDOWS');
    expect.ids(windows.keys(), scene.windows, 'windows');
    for (const window of scene.windows) {
        const drawn = windows.get(window.id) ?? [];
        const panes = drawn.filter((shape) => !shape.isClosed);
        expect.same(panes.length, 2, `${window.id}: lines of glass`);
        for (const pane of panes) expect.near(lengthOf(pane), window.width, `${window.id}: width`);
        for (const hole of drawn.filter((shape) => shape.isClosed)) {
            expect.near(sideLengths(hole)[0], (window.frame ?? window).width, `${window.id}: width of frame`);
        }
    }
    const rooms = on('ROOMS');
    expect.ids(rooms.keys(), scene.rooms, 'rooms');
    for (const room of scene.rooms) {
        const outline = rooms.get(room.id)?.[0].points;
        if (!outline) continue;
        for (const [axis, words] of [[[1, 0], 'width'], [[0, 1], 'depth']]) {
            expect.near(extent(outline, axis), extent(room.plan, axis), `${room.id}: ${words}`);
        }
        // 1 mm along 4 m of wall
        expect.near(planArea(outline), room.area, `${room.id}: area`, 0.004);
    }
    console.log(`${expect.file}: ${faces.size} faces of walls, ${doors.size} doors, ${windows.size} windows, ${rooms.size} rooms`);
}

export async function checkPlans(folder, scene) {
    const failures = [];
    for (const [file, read] of [['plan.svg', readSvg], ['plan.dxf', readDxf]]) {
        const expect = new Expectations(file);
        checkPlan(expect, await read(join(folder, file), expect), scene);
        failures.push(...expect.failures);
    }
    return failures;
}
