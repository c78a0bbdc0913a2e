// SPDX-License-Identifier: MIT
// Schedules, read by csv-parse, and graph.json.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { areaVector, Expectations, load, norm } from './expectations.mjs';

const areaOf = (thing) => norm(areaVector(thing.polygon)) / 2;

export async function checkSchedules(folder, scene) {
    const { parse } = await load('csv-parse/sync');
    const failures = [];
    const check = (name, wanted, columns) => {
        const expect = new Expectations(name);
        const rows = parse(readFileSync(join(folder, 'schedules', name)), { columns: true });
        expect.ids(rows.map((row) => row.id), wanted, 'rows');
        for (const row of rows) {
            const thing = wanted.find((c) => c.id === row.id);
            if (!thing) continue;
            for (const [column, value] of Object.entries(columns(thing))) {
                if (typeof value === 'number') expect.near(Number(row[column] || NaN), value, `${row.id}: ${column}`);
                else expect.same(row[column], value, `${row.id}: ${column}`);
            }
        }
        failures.push(...expect.failures);
        console.log(`${name}: ${rows.length} rows`);
    };
    check('rooms.csv', scene.rooms, (room) => ({
        area_m2: room.area, volume_m3: room.volume, floor_m: room.floor_height, ceiling_m: room.ceiling_height,
        height_m: room.ceiling_height - room.floor_height,
        neighbours: (room.neighbours ?? []).map((neighbour) => neighbour.room).join(' '),
    }));
    const size = (thing) => ({
        width_m: thing.width, height_m: thing.height, area_m2: areaOf(thing), confidence: thing.confidence, verdict: thing.verdict,
    });
    check('walls.csv', scene.walls, size);
    for (const [name, wanted] of [['doors.csv', scene.doors], ['windows.csv', scene.windows]]) {
        check(name, wanted, (c) => ({
            ...size(c), kind: c.kind ?? '', parent: c.parent ?? '', frame: c.frame?.id ?? '',
            frame_width_m: c.frame?.width ?? '', frame_height_m: c.frame?.height ?? '',
        }));
    }
    check('furniture.csv', scene.components.filter((c) => c.label === 'furniture'), (c) => ({ kind: c.kind ?? '' }));
    check('handles.csv', scene.components.filter((c) => c.label === 'handle'), (c) => ({ kind: c.kind ?? '' }));
    return failures;
}

export function checkGraph(folder, scene) {
    const expect = new Expectations('graph.json');
    const { nodes, edges } = JSON.parse(readFileSync(join(folder, 'graph.json'), 'utf8'));
    const byId = new Map(nodes.map((node) => [node.id, node]));
    expect.same(byId.size, nodes.length, 'nodes of different ids');
    for (const { from, to, relation } of edges) expect.that(byId.has(from) && byId.has(to), `${from} ${relation} ${to} leads nowhere`);
    for (const [type, wanted] of [['wall', scene.walls], ['door', scene.doors], ['window', scene.windows], ['room', scene.rooms]]) {
        expect.ids(nodes.filter((node) => node.type === type).map((node) => node.id), wanted, type + 's');
    }
    for (const thing of [...scene.walls, ...scene.doors, ...scene.windows]) {
        expect.near(byId.get(thing.id)?.size.width, thing.width, `${thing.id}: width`);
        expect.near(byId.get(thing.id)?.size.height, thing.height, `${thing.id}: height`);
    }
    for (const room of scene.rooms) {
        for (const key of ['area', 'volume', 'floor_height', 'ceiling_height']) {
            expect.near(byId.get(room.id)?.[key], room[key], `${room.id}: ${key}`);
        }
        const doors = edges.filter((edge) => edge.relation === 'leads_to' && edge.from === room.id)
            .map((edge) => `${edge.to} through ${edge.through ?? ''}`);
        expect.same(doors.join(), (room.neighbours ?? []).map((n) => `${n.room} through ${n.through ?? ''}`).join(),
            `${room.id}: neighbours`);
    }
    // Everything hangs below a storey, once.
    const holder = new Map();
    for (const edge of edges.filter((e) => e.relation === 'contains')) {
        expect.that(!holder.has(edge.to), `${edge.to} has two holders`);
        holder.set(edge.to, edge.from);
    }
    for (const node of nodes) {
        let top = node.id;
        for (let i = 0; i < nodes.length && holder.has(top); ++i) top = holder.get(top);
        expect.same(byId.get(top)?.type, 'storey', `${node.id}: what holds it at last`);
    }
    console.log(`graph.json: ${nodes.length} nodes, ${edges.length} edges`);
    return expect.failures;
}
