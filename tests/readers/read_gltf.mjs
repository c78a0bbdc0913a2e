// SPDX-License-Identifier: MIT
// model.glb, held against the standard by the Khronos validator and read by glTF Transform.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { areaVector, cross, dot, Expectations, extent, load, middleOf, norm, subtract } from './expectations.mjs';

/** Corners of a node's triangles, z up, in threes. */
function corners(node) {
    const m = node.getWorldMatrix();
    const points = [];
    for (const primitive of node.getMesh().listPrimitives()) {
        const positions = primitive.getAttribute('POSITION');
        for (const index of primitive.getIndices().getArray()) {
            const v = positions.getElement(index, []);
            const [x, y, z] = [0, 1, 2].map((r) =>
                m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r]);
            points.push([x, -z, y]);
        }
    }
    return points;
}

function surface(points) {
    let area = 0;
    for (let i = 0; i < points.length; i += 3) area += norm(areaVector(points.slice(i, i + 3))) / 2;
    return area;
}

/** Faces with holes, leaves and panes: as wide and high as scene.json says, and there. */
function checkPanels(expect, meshes, wanted) {
    for (const thing of wanted) {
        const points = meshes.get(thing.id);
        if (!points) continue;
        expect.near(extent(points, thing.along), thing.width, `${thing.id}: width`);
        expect.near(extent(points, cross(thing.normal, thing.along)), thing.height, `${thing.id}: height`);
        const off = Math.abs(dot(subtract(middleOf(points), thing.middle), thing.normal));
        expect.near(off, 0, `${thing.id}: place across its wall`);
    }
}

export async function checkGlb(folder, scene) {
    const { default: validator } = await load('gltf-validator');
    const { NodeIO } = await load('@gltf-transform/core');
    const expect = new Expectations('model.glb');
    const bytes = new Uint8Array(readFileSync(join(folder, 'model.glb')));
    const report = await validator.validateBytes(bytes);
    for (const message of report.issues.messages) {
        if (message.severity < 2) expect.that(false, `${message.pointer}: ${message.message}`);
    }
    const nodes = (await new NodeIO().readBinary(bytes)).getRoot().listNodes();
    const labelled = (label) => nodes.filter((node) => node.getExtras().label === label);
    const meshes = new Map(nodes.filter((node) => node.getMesh()).map((node) => [node.getName(), corners(node)]));
    for (const [label, wanted] of [['wall', scene.walls], ['door', scene.doors], ['window', scene.windows]]) {
        expect.ids(labelled(label).map((node) => node.getName()), wanted, label + 's');
        for (const node of labelled(label)) {
            const materials = node.getMesh().listPrimitives().map((primitive) => primitive.getMaterial().getName());
            expect.same(materials.join(), label, `${node.getName()}: material`);
        }
        checkPanels(expect, meshes, wanted);
    }
    for (const component of scene.components) {
        if (component.label === 'unknown') continue; // passages are holes
        expect.that(meshes.has(component.id), `no node ${component.id}`);
    }
    const rooms = nodes.filter((node) => node.getExtras().label === 'room');
    expect.ids(rooms.map((node) => node.getName()), scene.rooms, 'rooms');
    for (const node of rooms) {
        const room = scene.rooms.find((r) => r.id === node.getName());
        if (!room) continue;
        const { area, volume, floor_height, ceiling_height } = node.getExtras();
        expect.near(area, room.area, `${room.id}: area`);
        expect.near(volume, room.volume, `${room.id}: volume`);
        expect.near(floor_height, room.floor_height, `${room.id}: height of floor`);
        expect.near(ceiling_height, room.ceiling_height, `${room.id}: height of ceiling`);
    }
    for (const floor of scene.components.filter((c) => c.label === 'floor' && c.polygon)) {
        expect.near(surface(meshes.get(floor.id) ?? []), norm(areaVector(floor.polygon)) / 2, `${floor.id}: area`, 0.004);
    }
    console.log(`model.glb: ${nodes.length} nodes, ${report.info.totalTriangleCount} triangles, ` +
        `${report.issues.numErrors} errors, ${report.issues.numWarnings} warnings`);
    return expect.failures;
}
